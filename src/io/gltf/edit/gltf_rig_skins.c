/* gltf_rig_skins.c - changes inverse bind matrices for joints that have moved, and sets the maps that carry
   vertices back, so that the moved nodes and skins show them in the right place. */
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/polar.h"
#include "base/vector/vec.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/read/gltf_elements.h"
#include <float.h>
#include <string.h>

/* A map x -> linear x + offset. */
typedef struct affine {
    double linear[9], offset[3];
} affine;

static const affine still = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

/* Sets a linear part that is the identity up to rounding to the identity. Returns whether it is. */
static bool settle_turn(double linear[9])
{
    const bool is_still = ffd_mat_is_near_identity(linear, RIG_TURN_ROUNDING);
    if (is_still)
        memcpy(linear, still.linear, sizeof still.linear);
    return is_still;
}

/* The same for a map. size: of the coordinates that its offset was computed from. Returns whether the whole
   map is the identity. */
static bool settle(affine *map, double size)
{
    bool is_still = settle_turn(map->linear);
    for (int a = 0; a < 3; a++)
        is_still = is_still && fabs(map->offset[a]) <= RIG_PLACE_ROUNDING * size;
    return is_still;
}

static double size_of(const double a[3], const double b[3])
{
    double size = 0;
    for (int i = 0; i < 3; i++)
        size = larger_of(size, larger_of(fabs(a[i]), fabs(b[i])));
    return size;
}

/* Sets the offset of a map so that it takes the point `from` to `to`. */
static void pin(const double from[3], const double to[3], affine *map)
{
    double turned[3];
    mat_apply(map->linear, from, turned);
    for (int a = 0; a < 3; a++)
        map->offset[a] = to[a] - turned[a];
}

static bool is_of_node_before(const void *place, const void *node)
{
    return ((const mesh_place *)place)->index < *(const size_t *)node;
}

/* Finds a node among the places, which are sorted by node. */
static size_t find_place(const mesh_places *places, size_t node)
{
    const size_t at =
        lower_bound(&node, places->list, places->count, sizeof *places->list, is_of_node_before);
    return at < places->count && places->list[at].index == node ? at : SIZE_MAX;
}

/* Finds the similarity nearest to the motion of a skin's first joint, and its inverse. If one similarity
   moves everything, applying it to the skin's vertices is right whatever the default pose. */
static void find_similarity(const mesh_place *place, const mesh_place_move *move, affine *similarity,
                            affine *inverse)
{
    double f[9], rotation[9];
    *similarity = *inverse = still;
    if (place->stays || !move->moves)
        return;
    for (int i = 0; i < 9; i++)
        f[i] = still.linear[i] + move->gradient[i];
    const double scale = ffd_mat_rotation(f, rotation) ? ffd_cube_root(mat_determinant(f)) : 1;
    if (!(scale > 0) || !isfinite(scale) || !isfinite(1 / scale))
        return;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            similarity->linear[3 * r + c] = scale * rotation[3 * r + c];
            inverse->linear[3 * c + r] = rotation[3 * r + c] / scale;
        }
    settle(similarity, 0);
    settle(inverse, 0);
    pin(place->at, move->to, similarity);
    pin(move->to, place->at, inverse);
}

/* Marks the skins that the scene shows, and those that show something which stays as it is: it is not
   selected, or it is in another scene. */
static void mark_skins(const gltf_document *d, bool *shown, bool *staying)
{
    for (size_t n = 0; n < d->model.node_count; n++)
        if (!d->in_scene[n] && d->model.nodes[n].mesh >= 0 && d->model.nodes[n].skin >= 0)
            staying[d->model.nodes[n].skin] = true;
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const gltf_skin *const skin = ffd_gltf_skin_of(d, instance);
        if (!skin)
            continue;
        shown[skin - d->skins] = true;
        if (ffd_gltf_is_skinned(instance->primitive) && !instance->selected)
            staying[skin - d->skins] = true;
    }
}

/* Computes W'^-1 E W for a joint. Returns false if it is the identity, or if W' has no inverse. */
static bool find_change(const gltf_document *d, const gltf_rig *rig, size_t joint, const affine *similarity,
                        affine *change)
{
    const double *const old = d->world + 12 * joint, *const made = rig->world + 12 * joint;
    double inverse[9], product[9], place[3], singular;
    if (ffd_mat_is_singular(old, &singular) || ffd_mat_is_singular(made, &singular) ||
        !mat_invert(made, inverse))
        return false;
    mat_multiply(similarity->linear, old, product);
    mat_multiply(inverse, product, change->linear);
    mat_apply(similarity->linear, old + 9, place);
    for (int a = 0; a < 3; a++)
        place[a] += similarity->offset[a];
    const double size = size_of(place, made + 9);
    for (int a = 0; a < 3; a++)
        place[a] -= made[9 + a];
    mat_apply(inverse, place, change->offset);
    double row = 0;
    for (int a = 0; a < 3; a++)
        row = larger_of(row, fabs(inverse[3 * a]) + fabs(inverse[3 * a + 1]) + fabs(inverse[3 * a + 2]));
    return !settle(change, row * size);
}

static ffd_status refuse_infinite(const gltf_document *d, size_t skin, size_t joint, ffd_error *error)
{
    return ffd_json_tree_fail(&d->tree, d->skin_values.values[skin], d->name, FFD_E_INVALID, error,
                              "with the deformation, inverse bind matrix %zu is too large for floats", joint);
}

/* Multiplies an inverse bind matrix (16 numbers, column by column) by a change from the left. Returns false
   if floats cannot hold the result. */
static bool put_matrix(const affine *change, float *values)
{
    double matrix[12], joined[12];
    bool fits = true;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            matrix[3 * r + c] = values[4 * c + r];
        matrix[9 + r] = values[12 + r];
    }
    double whole[12];
    memcpy(whole, change->linear, sizeof change->linear);
    memcpy(whole + 9, change->offset, sizeof change->offset);
    ffd_gltf_join_matrix(whole, matrix, matrix + 9, joined);
    for (int i = 0; i < 12; i++)
        fits = fits && fabs(joined[i]) <= FLT_MAX;
    for (int r = 0; r < 3 && fits; r++) {
        for (int c = 0; c < 3; c++)
            values[4 * c + r] = (float)joined[3 * r + c];
        values[12 + r] = (float)joined[9 + r];
    }
    return fits;
}

/* Reads the inverse bind matrices of the file: identities if the skin has none. */
static void read_matrices(const gltf_document *d, const gltf_skin *skin, const gltf_content *content)
{
    for (size_t j = 0; j < content->count; j++) {
        double read[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        if (skin->inverse_bind >= 0)
            ffd_gltf_read(d, (size_t)skin->inverse_bind, j, 1, 16, read);
        for (size_t i = 0; i < 16; i++)
            content->values[16 * j + i] = (float)read[i];
    }
}

/* Makes new inverse bind matrices for a skin if any of them changes. */
static ffd_status make_matrices(const gltf_document *d, size_t s, const affine *similarity,
                                gltf_content *content, ffd_error *error)
{
    const gltf_skin *const skin = &d->skins[s];
    affine change;
    for (size_t j = 0; j < skin->joint_count; j++) {
        if (!find_change(d, &d->edit->rig, skin->joints[j], similarity, &change))
            continue;
        if (!content->values) {
            TRY(ffd_gltf_make_elements(d->edit, content, error));
            read_matrices(d, skin, content);
        }
        if (!put_matrix(&change, content->values + 16 * j))
            return refuse_infinite(d, s, j, error);
    }
    return FFD_OK;
}

static ffd_status follow_skin(const gltf_document *d, size_t s, const affine *similarity, ffd_error *error)
{
    const gltf_skin *const skin = &d->skins[s];
    size_t *const index = &d->edit->rig.skin_contents[s];
    gltf_content content = {.accessor = GLTF_NONE, .count = skin->joint_count, .width = 16};
    if (skin->inverse_bind >= 0) {
        content.accessor = (size_t)skin->inverse_bind;
        content.count = (size_t)d->model.accessors[skin->inverse_bind].count;
    }
    const ffd_status status = make_matrices(d, s, similarity, &content, error);
    if (status || !content.values) {
        ffd_gltf_free_elements(d->edit, &content);
        return status;
    }
    *index = ffd_gltf_add_content(d->edit, &content);
    return *index == GLTF_NONE ? ffd_fail_memory(error) : FFD_OK;
}

/* Sets the map that a part's vertices are carried by. */
static void set_carry(const affine *map, mesh_part *part)
{
    part->carried = true;
    for (int i = 0; i < 9; i++)
        part->carry[i] = map->linear[i] - still.linear[i];
    memcpy(part->carry + 9, map->offset, sizeof map->offset);
}

/* Carries a part by the map W W'^-1 of the node that shows it. */
static void carry_by_node(const gltf_document *d, const gltf_rig *rig, size_t node, mesh_part *part)
{
    const double *const old = d->world + 12 * node, *const made = rig->world + 12 * node;
    double inverse[9];
    affine map;
    if (part->singular || memcmp(old, made, 12 * sizeof *old) == 0 || !mat_invert(made, inverse))
        return;
    mat_multiply(old, inverse, map.linear);
    settle_turn(map.linear);
    pin(made + 9, old + 9, &map);
    if (!settle(&map, size_of(old + 9, made + 9)))
        set_carry(&map, part);
}

static void carry_parts(gltf_document *d, const gltf_rig *rig, const affine *inverses)
{
    for (size_t i = 0; i < d->base.part_count; i++) {
        const gltf_part *const part = &d->parts[i];
        if (part->node == GLTF_NONE)
            continue;
        if (!part->skin) {
            carry_by_node(d, rig, part->node, &d->mesh_parts[i]);
            continue;
        }
        affine map = inverses[part->skin - d->skins];
        if (!settle(&map, 0))
            set_carry(&map, &d->mesh_parts[i]);
    }
}

ffd_status ffd_gltf_follow_skins(gltf_document *d, const mesh_places *places, const mesh_place_move *moves,
                                 ffd_error *error)
{
    gltf_rig *const rig = &d->edit->rig;
    const size_t count = d->skin_values.count;
    affine *const inverses = ffd_alloc(count, sizeof *inverses);
    bool *const shown = ffd_alloc_zero(count, sizeof *shown);
    bool *const staying = ffd_alloc_zero(count, sizeof *staying);
    rig->skin_contents = ffd_alloc(count, sizeof *rig->skin_contents);
    ffd_status status;
    TRY_END(inverses && shown && staying && rig->skin_contents ? FFD_OK : ffd_fail_memory(error));
    mark_skins(d, shown, staying);
    for (size_t s = 0; s < count; s++) {
        affine similarity = still;
        const gltf_skin *const skin = &d->skins[s];
        const size_t first = skin->joint_count ? find_place(places, skin->joints[0]) : SIZE_MAX;
        inverses[s] = still;
        rig->skin_contents[s] = GLTF_NONE;
        if (shown[s] && !staying[s] && first != SIZE_MAX)
            find_similarity(&places->list[first], &moves[first], &similarity, &inverses[s]);
        if (shown[s] || (staying[s] && ffd_gltf_has_joint_matrices(d, skin)))
            TRY_END(follow_skin(d, s, &similarity, error));
    }
    carry_parts(d, rig, inverses);
    for (size_t i = 0; i < d->base.part_count; i++)
        if (d->mesh_parts[i].carried && d->mesh_parts[i].skipped)
            TRY_END(ffd_gltf_add_results(d, i, error));
end:
    ffd_free(inverses);
    ffd_free(shown);
    ffd_free(staying);
    return status;
}
