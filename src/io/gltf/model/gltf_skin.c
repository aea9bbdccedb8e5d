#include "io/gltf/model/gltf_skin.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/read/gltf_check.h"
#include "io/gltf/read/gltf_contents.h"
#include "io/gltf/read/gltf_elements.h"
#include <stdio.h>
#include <string.h>

static bool is_whole(const gltf_influence *influence)
{
    return influence->joints >= 0 && influence->weights >= 0;
}

static ffd_status note_half(gltf_document *d, uint32_t primitive, const gltf_influence *influence, size_t set,
                            ffd_error *error)
{
    const bool joints = influence->joints >= 0;
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive, "attributes");
    char key[40];
    snprintf(key, sizeof key, "%s_%zu", joints ? "JOINTS" : "WEIGHTS", set);
    return ffd_gltf_flaw(d, ffd_json_tree_member(&d->tree, attributes, key), error,
                         "%s_%zu without %s_%zu is ignored", joints ? "JOINTS" : "WEIGHTS", set,
                         joints ? "WEIGHTS" : "JOINTS", set);
}

/* Ends the sets of a primitive before the first one that is not whole. If a whole one follows, its meaning is
   not plain: ffd_gltf_prepare_skins refuses it. */
static ffd_status settle_sets(gltf_document *d, gltf_primitive *primitive, ffd_error *error)
{
    static const gltf_influence none = {-1, -1};
    size_t whole = 0;
    while (whole < primitive->influence_count && is_whole(&primitive->influences[whole]))
        whole++;
    for (size_t i = whole; i < primitive->influence_count; i++)
        if (is_whole(&primitive->influences[i]))
            return FFD_OK;
    const gltf_influence first = primitive->influence_count ? primitive->influences[0] : none;
    for (size_t i = whole; i < primitive->influence_count && whole > 0; i++)
        TRY(note_half(d, primitive->value, &primitive->influences[i], i, error));
    primitive->influence_count = whole;
    if (whole > 0)
        return FFD_OK;
    return ffd_gltf_flaw(d, primitive->value, error,
                         "a node uses it with a skin, but it has no %s: it is placed by its node, without "
                         "the skin",
                         first.joints >= 0    ? "WEIGHTS_0"
                         : first.weights >= 0 ? "JOINTS_0"
                                              : "JOINTS_0 and WEIGHTS_0");
}

/* Takes the skins of the nodes of a mesh away if they move none of its primitives. */
static void settle_nodes(gltf_document *d, size_t m)
{
    const gltf_mesh_uses *const uses = &d->mesh_uses[m];
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, m, p));)
        if (ffd_gltf_is_skinned(p))
            return;
    for (size_t n = 0; n < uses->node_count; n++)
        d->model.nodes[uses->nodes[n]].skin = -1;
}

/* Whether one of the nodes that show a mesh has a skin. */
static bool has_skin(const gltf_document *d, const gltf_mesh_uses *uses)
{
    for (size_t n = 0; uses->nodes && n < uses->node_count; n++)
        if (d->model.nodes[uses->nodes[n]].skin >= 0)
            return true;
    return false;
}

ffd_status ffd_gltf_settle_skins(gltf_document *d, ffd_error *error)
{
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        gltf_mesh *const mesh = &d->model.meshes[m];
        if (!has_skin(d, &d->mesh_uses[m]))
            continue;
        for (size_t p = 0; p < mesh->primitive_count; p++)
            if (mesh->primitives[p].accessor[GLTF_POSITION] >= 0)
                TRY(settle_sets(d, &mesh->primitives[p], error));
        settle_nodes(d, m);
    }
    return FFD_OK;
}

bool ffd_gltf_places_mesh(const gltf_document *d, size_t node)
{
    const gltf_node *const placed = &d->model.nodes[node];
    const gltf_mesh *const mesh = placed->mesh < 0 ? NULL : &d->model.meshes[placed->mesh];
    bool places = mesh && placed->skin < 0;
    for (size_t p = 0; mesh && p < mesh->primitive_count && !places; p++)
        places = !ffd_gltf_is_skinned(&mesh->primitives[p]);
    return places;
}

#define MOST_SETS ((size_t)16) /* JOINTS_0 to JOINTS_15 */
#define BLOCK ((size_t)32)     /* vertices read at a time */

static ffd_status list_joints(const gltf_document *d, uint32_t value, gltf_skin *skin, ffd_error *error)
{
    const uint32_t joints = ffd_json_tree_member(&d->tree, value, "joints");
    skin->joints = ffd_alloc(d->tree.values[joints].count, sizeof *skin->joints);
    if (!skin->joints)
        return ffd_fail_memory(error);
    for (uint32_t v = ffd_json_tree_first(&d->tree, joints); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        double node = 0;
        ffd_json_tree_number(&d->tree, v, &node);
        if (!(node < (double)d->model.node_count))
            return ffd_json_tree_fail(&d->tree, v, d->name, FFD_E_INVALID, error, "there is no node %.0f%s",
                                      node, ffd_only(d->model.node_count, "").text);
        skin->joints[skin->joint_count++] = (size_t)node;
    }
    return FFD_OK;
}

static ffd_status find_inverse_bind(const gltf_document *d, uint32_t value, gltf_skin *skin, ffd_error *error)
{
    const uint32_t member = ffd_json_tree_member(&d->tree, value, "inverseBindMatrices");
    double number;
    skin->inverse_bind = -1;
    if (!ffd_json_tree_number(&d->tree, member, &number))
        return FFD_OK;
    if (!(number < (double)d->model.accessor_count))
        return ffd_json_tree_fail(&d->tree, member, d->name, FFD_E_INVALID, error,
                                  "there is no accessor %.0f%s", number,
                                  ffd_only(d->model.accessor_count, "").text);
    skin->inverse_bind = (int)number;
    return FFD_OK;
}

static ffd_status check_inverse_bind(const gltf_document *d, const gltf_skin *skin, ffd_error *error)
{
    const gltf_accessor *accessor = &d->model.accessors[skin->inverse_bind];
    const uint32_t member =
        ffd_json_tree_member(&d->tree, d->skin_values.values[skin - d->skins], "inverseBindMatrices");
    if (accessor->columns != 4 || accessor->rows != 4 || accessor->component != GLTF_FLOAT)
        return ffd_json_tree_fail(&d->tree, member, d->name, FFD_E_INVALID, error,
                                  "accessor %d is not a MAT4 of floats", skin->inverse_bind);
    if (accessor->count < skin->joint_count)
        return ffd_json_tree_fail(&d->tree, member, d->name, FFD_E_INVALID, error,
                                  "accessor %d has %llu %s for %zu joints", skin->inverse_bind,
                                  (unsigned long long)accessor->count,
                                  ffd_plural(accessor->count, "matrix", "matrices"), skin->joint_count);
    return FFD_OK;
}

ffd_status ffd_gltf_list_skins(gltf_document *d, ffd_error *error)
{
    d->skins = ffd_alloc_zero(d->skin_values.count, sizeof *d->skins);
    if (!d->skins)
        return ffd_fail_memory(error);
    for (size_t s = 0; s < d->skin_values.count; s++) {
        TRY(list_joints(d, d->skin_values.values[s], &d->skins[s], error));
        TRY(find_inverse_bind(d, d->skin_values.values[s], &d->skins[s], error));
    }
    return FFD_OK;
}

void ffd_gltf_free_skins(gltf_document *d)
{
    for (size_t s = 0; d->skins && s < d->skin_values.count; s++) {
        ffd_free(d->skins[s].joints);
        ffd_free(d->skins[s].matrices);
    }
    ffd_free(d->skins);
}

/* Reads joint j's inverse bind matrix, which is stored column by column. */
static ffd_status read_inverse_bind(const gltf_document *d, const gltf_skin *skin, size_t j,
                                    double matrix[12], ffd_error *error)
{
    double read[16];
    bool affine = true;
    ffd_gltf_read(d, (size_t)skin->inverse_bind, j, 1, 16, read);
    for (size_t r = 0; r < 3; r++) {
        for (size_t c = 0; c < 3; c++)
            matrix[3 * r + c] = read[4 * c + r];
        matrix[9 + r] = read[12 + r];
        affine = affine && fabs(read[4 * r + 3]) <= LAST_ROW_TOLERANCE;
    }
    for (int i = 0; i < 12; i++)
        if (!isfinite(matrix[i]))
            return ffd_json_tree_fail(&d->tree, d->accessor_values.values[skin->inverse_bind], d->name,
                                      FFD_E_INVALID, error, "inverse bind matrix %zu is not finite", j);
    if (!affine || !(fabs(read[15] - 1) <= LAST_ROW_TOLERANCE))
        return ffd_json_tree_fail(&d->tree, d->accessor_values.values[skin->inverse_bind], d->name,
                                  FFD_E_INVALID, error,
                                  "the last row of inverse bind matrix %zu is %g %g %g %g, not 0 0 0 1", j,
                                  read[3], read[7], read[11], read[15]);
    return FFD_OK;
}

/* The matrix of joint j: that of its node after its inverse bind matrix. */
static ffd_status make_joint_matrix(const gltf_document *d, const gltf_skin *skin, size_t j,
                                    const double *worlds, double matrix[12], ffd_error *error)
{
    const double *const world = worlds + 12 * skin->joints[j];
    double bind[12];
    if (skin->inverse_bind < 0) {
        memcpy(matrix, world, 12 * sizeof *matrix);
    } else {
        const ffd_status failed = read_inverse_bind(d, skin, j, bind, error);
        if (failed)
            return failed;
        ffd_gltf_join_matrix(world, bind, bind + 9, matrix);
    }
    for (int i = 0; i < 12; i++)
        if (!isfinite(matrix[i]))
            return ffd_json_tree_fail(&d->tree, d->node_values.values[skin->joints[j]], d->name,
                                      FFD_E_INVALID, error, "the joint's matrix is not finite");
    return FFD_OK;
}

ffd_status ffd_gltf_joint_matrices(const gltf_document *d, const gltf_skin *skin, const double *worlds,
                                   double *matrices, ffd_error *error)
{
    for (size_t j = 0; j < skin->joint_count; j++)
        TRY(make_joint_matrix(d, skin, j, worlds, matrices + 12 * j, error));
    return FFD_OK;
}

bool ffd_gltf_has_joint_matrices(const gltf_document *d, const gltf_skin *skin)
{
    double matrix[12];
    bool has = skin->inverse_bind < 0 ||
               (check_inverse_bind(d, skin, NULL) == FFD_OK && d->layouts[skin->inverse_bind].readable);
    for (size_t j = 0; j < skin->joint_count && has; j++)
        has = make_joint_matrix(d, skin, j, d->world, matrix, NULL) == FFD_OK;
    return has;
}

static ffd_status make_joint_matrices(gltf_document *d, gltf_skin *skin, ffd_error *error)
{
    TRY(ffd_budget_take(&d->base.budget, skin->joint_count, 12 * sizeof *skin->matrices, error));
    skin->matrices = ffd_alloc_zero(skin->joint_count, 12 * sizeof *skin->matrices);
    if (!skin->matrices)
        return ffd_fail_memory(error);
    if (skin->inverse_bind >= 0)
        TRY(check_inverse_bind(d, skin, error));
    if (skin->inverse_bind >= 0 && !d->layouts[skin->inverse_bind].readable)
        return FFD_OK; /* ffd_gltf_refuse_read refuses the skin where it is used */
    return ffd_gltf_joint_matrices(d, skin, d->world, skin->matrices, error);
}

static ffd_status refuse_attribute(const gltf_document *d, uint32_t primitive, const char *name, size_t set,
                                   const char *what, ffd_error *error)
{
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive, "attributes");
    char key[40];
    snprintf(key, sizeof key, "%s_%zu", name, set);
    const uint32_t member = ffd_json_tree_member(&d->tree, attributes, key);
    return ffd_json_tree_fail(&d->tree, member == JSON_NONE ? attributes : member, d->name, FFD_E_INVALID,
                              error, "%s %s", key, what);
}

static bool has_shape(const gltf_accessor *accessor, bool weights)
{
    const bool small = accessor->component == GLTF_U8 || accessor->component == GLTF_U16;
    if (accessor->columns != 1 || accessor->rows != 4)
        return false;
    return weights ? accessor->component == GLTF_FLOAT || (small && accessor->normalized)
                   : small && !accessor->normalized;
}

/* Returns the largest joint index of an accessor plus 1. largest caches it (0: not computed yet). */
static size_t count_joints(const gltf_document *d, size_t accessor, size_t *largest)
{
    const size_t count = (size_t)d->model.accessors[accessor].count;
    double joints[4 * BLOCK];
    size_t most = 1;
    if (largest[accessor] > 0)
        return largest[accessor];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        ffd_gltf_read(d, accessor, at, size, 4, joints);
        for (size_t i = 0; i < 4 * size; i++)
            most = (size_t)joints[i] >= most ? (size_t)joints[i] + 1 : most;
    }
    largest[accessor] = most;
    return most;
}

/* Whether a joint of an index beyond `joints` counts: it has a weight, or its vertex may follow it because
   it is the first one and no joint of the set has a weight. */
static bool uses_beyond(const gltf_document *d, const gltf_influence *influence, size_t joints,
                        bool first_set)
{
    const size_t named = (size_t)d->model.accessors[influence->joints].count,
                 weighted = (size_t)d->model.accessors[influence->weights].count;
    const size_t count = named < weighted ? named : weighted;
    double index[4 * BLOCK], weights[4 * BLOCK];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        ffd_gltf_read(d, (size_t)influence->joints, at, size, 4, index);
        ffd_gltf_read(d, (size_t)influence->weights, at, size, 4, weights);
        for (size_t i = 0; i < 4 * size; i++) {
            const double *const of = weights + (i - i % 4);
            const bool follows =
                first_set && i % 4 == 0 && of[0] == 0 && of[1] == 0 && of[2] == 0 && of[3] == 0;
            if (index[i] >= (double)joints && (weights[i] != 0 || follows))
                return true;
        }
    }
    return false;
}

/* Notes that a set names a joint beyond the skin without a weight, or refuses one that counts. */
static ffd_status check_beyond(gltf_document *d, const gltf_skin *skin, const gltf_influence *influence,
                               size_t set, size_t joint, ffd_error *error)
{
    const uint32_t value = d->accessor_values.values[influence->joints];
    if (!d->layouts[influence->joints].readable || !d->layouts[influence->weights].readable ||
        uses_beyond(d, influence, skin->joint_count, set == 0))
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "names joint %zu, but the skin has only %zu", joint, skin->joint_count);
    return ffd_gltf_flaw(d, value, error, "names joint %zu without a weight, but the skin has only %zu",
                         joint, skin->joint_count);
}

static ffd_status check_set(gltf_document *d, const gltf_skin *skin, uint32_t primitive,
                            const gltf_influence *influence, size_t set, size_t *largest, ffd_error *error)
{
    if (influence->joints < 0)
        return refuse_attribute(d, primitive, "JOINTS", set, "is missing", error);
    if (influence->weights < 0)
        return refuse_attribute(d, primitive, "WEIGHTS", set, "is missing", error);
    if (!has_shape(&d->model.accessors[influence->joints], false))
        return refuse_attribute(d, primitive, "JOINTS", set,
                                "is not a VEC4 of unsigned bytes or shorts (5121, 5123)", error);
    if (!has_shape(&d->model.accessors[influence->weights], true))
        return refuse_attribute(d, primitive, "WEIGHTS", set,
                                "is not a VEC4 of floats or of normalized unsigned bytes or shorts", error);
    const size_t joints = count_joints(d, (size_t)influence->joints, largest);
    return joints > skin->joint_count ? check_beyond(d, skin, influence, set, joints - 1, error) : FFD_OK;
}

static ffd_status check_primitive(gltf_document *d, const gltf_skin *skin, const gltf_primitive *primitive,
                                  size_t *largest, ffd_error *error)
{
    const uint32_t value = primitive->value;
    if (primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    if (primitive->influence_count > MOST_SETS)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_LIMIT, error,
                                  "%zu sets of joints are more than the %zu that are supported",
                                  primitive->influence_count, MOST_SETS);
    for (size_t i = 0; i < primitive->influence_count; i++)
        TRY(check_set(d, skin, value, &primitive->influences[i], i, largest, error));
    return FFD_OK;
}

ffd_status ffd_gltf_prepare_skins(gltf_document *d, ffd_error *error)
{
    size_t *largest = ffd_alloc_zero(d->model.accessor_count, sizeof *largest);
    if (!largest)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->instance_count; i++) {
        gltf_skin *const skin = ffd_gltf_skin_of(d, &d->instances[i]);
        if (skin && !skin->matrices)
            TRY_END(make_joint_matrices(d, skin, error));
        if (skin)
            TRY_END(check_primitive(d, skin, d->instances[i].primitive, largest, error));
    }
end:
    ffd_free(largest);
    return status;
}

/* The influence of one joint on a vertex. */
typedef struct joint_weight {
    size_t joint;
    double weight;
} joint_weight;

/* Sorts the terms, so that the sum does not depend on their order in the file. */
static void sort_joint_weights(joint_weight *terms, size_t count)
{
    for (size_t i = 1; i < count; i++)
        for (size_t k = i;
             k > 0 && (terms[k].joint < terms[k - 1].joint ||
                       (terms[k].joint == terms[k - 1].joint && terms[k].weight < terms[k - 1].weight));
             k--) {
            const joint_weight other = terms[k - 1];
            terms[k - 1] = terms[k];
            terms[k] = other;
        }
}

static void note_sum(double total, skin_weights *found)
{
    const double off = fabs(total - 1);
    if (!(total > 0))
        found->none++;
    else if (off > WEIGHT_SUM_ROUNDING)
        found->off++;
    if (total > 0 && off > found->farthest && off > WEIGHT_SUM_ROUNDING)
        found->farthest = off;
}

/* Computes the sum of weight * matrix, divided by the sum of the weights. That sum should be 1; if it is not,
   viewers normalize the weights. If all weights are 0, viewers let the vertex follow its first joint. */
static void blend(const gltf_skin *skin, joint_weight *terms, size_t count, double transform[12],
                  skin_weights *found)
{
    const size_t first_joint = terms[0].joint;
    double total = 0;
    sort_joint_weights(terms, count);
    for (size_t i = 0; i < count; i++)
        total += terms[i].weight;
    if (found && isfinite(total))
        note_sum(total, found);
    if (!(total > 0) && !isnan(total)) {
        memcpy(transform, skin->matrices + 12 * first_joint, 12 * sizeof *transform);
        return;
    }
    memset(transform, 0, 12 * sizeof *transform);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 12 && terms[i].weight != 0; k++)
            transform[k] += terms[i].weight / total * skin->matrices[12 * terms[i].joint + k];
}

/* The joint of a checked index; the first one where it is beyond the skin and has no weight, or another
   program has changed the file since (mmap). */
static size_t known_joint(const gltf_skin *skin, double index)
{
    return index < (double)skin->joint_count ? (size_t)index : 0;
}

void ffd_gltf_read_transforms(const mesh_document *document, size_t p, size_t first, size_t count,
                              double *transforms, skin_weights *found)
{
    const gltf_document *d = ffd_gltf_of(document);
    const gltf_part *part = &d->parts[p];
    joint_weight terms[BLOCK][4 * MOST_SETS];
    for (size_t i = 0; d->skins_status && i < 12 * count; i++)
        transforms[i] = NAN;
    if (d->skins_status)
        return;
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        for (size_t s = 0; s < part->influence_count; s++) {
            double joints[4 * BLOCK], weights[4 * BLOCK];
            ffd_gltf_read(d, (size_t)part->influences[s].joints, first + at, size, 4, joints);
            ffd_gltf_read(d, (size_t)part->influences[s].weights, first + at, size, 4, weights);
            for (size_t i = 0; i < 4 * size; i++)
                terms[i / 4][4 * s + i % 4] = (joint_weight){known_joint(part->skin, joints[i]), weights[i]};
        }
        for (size_t i = 0; i < size; i++)
            blend(part->skin, terms[i], 4 * part->influence_count, transforms + 12 * (at + i), found);
    }
}
