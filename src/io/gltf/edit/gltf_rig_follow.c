/* gltf_rig_follow.c - makes the nodes, skins and animations of a file follow the deformation, and logs
   what follows together with them, and what does not. */
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/read/gltf_elements.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Vertices that are read at a time. */
#define BLOCK ((size_t)64)

/* Fills the distances by which the joints of a skin have moved; 0 where that is rounding. Returns whether any
   has. */
static bool measure(const gltf_document *d, const gltf_rig *rig, const gltf_skin *skin, double *distances)
{
    bool any = false;
    for (size_t j = 0; j < skin->joint_count; j++) {
        const double *const old = d->world + 12 * skin->joints[j] + 9;
        const double *const made = rig->world + 12 * skin->joints[j] + 9;
        const double off[3] = {made[0] - old[0], made[1] - old[1], made[2] - old[2]};
        const double by = vec_length(off);
        distances[j] = by > RIG_PLACE_ROUNDING * (vec_length(old) + vec_length(made)) ? by : 0;
        any = any || distances[j] > 0;
    }
    return any;
}

/* Returns the largest distance of a joint that has a weight in a set. */
static double farthest(const gltf_document *d, const gltf_influence *set, size_t vertices,
                       const double *distances, size_t joint_count)
{
    double joints[4 * BLOCK], weights[4 * BLOCK], most = 0;
    for (size_t first = 0; first < vertices; first += BLOCK) {
        const size_t count = vertices - first < BLOCK ? vertices - first : BLOCK;
        ffd_gltf_read(d, (size_t)set->joints, first, count, 4, joints);
        ffd_gltf_read(d, (size_t)set->weights, first, count, 4, weights);
        for (size_t i = 0; i < 4 * count; i++)
            if (weights[i] > 0 && joints[i] < (double)joint_count)
                most = larger_of(most, distances[(size_t)joints[i]]);
    }
    return most;
}

/* Finds the largest distance by which a joint has moved that has a weight in a vertex of a part; 0 if the
   part is selected, has no skin, or no such joint has moved. Call it after ffd_gltf_follow_skins. Errors:
   FFD_E_MEMORY. */
static ffd_status left_by_joints(const gltf_document *d, const gltf_rig *rig, size_t part, double *distance,
                                 ffd_error *error)
{
    const gltf_part *const p = &d->parts[part];
    *distance = 0;
    if (!p->skin || !d->mesh_parts[part].skipped || p->skin->joint_count == 0)
        return FFD_OK;
    double *const distances = ffd_alloc(p->skin->joint_count, sizeof *distances);
    if (!distances)
        return ffd_fail_memory(error);
    const bool moved = measure(d, rig, p->skin, distances);
    for (size_t s = 0; moved && s < p->influence_count; s++)
        *distance = larger_of(*distance, farthest(d, &p->influences[s], d->mesh_parts[part].vertex_count,
                                                  distances, p->skin->joint_count));
    ffd_free(distances);
    return FFD_OK;
}

/* The maximum number of names in a log line. */
#define NAMES 3
#define NAME_SIZE 80

/* Places with something in common: their number and the first names. */
typedef struct place_group {
    size_t count;
    char names[NAMES * (NAME_SIZE + 2) + 40]; /* ": hand, foot, tail and 2 more" */
} place_group;

static ffd_status add_place(const gltf_document *d, size_t node, place_group *group, ffd_error *error)
{
    if (group->count++ >= NAMES)
        return FFD_OK;
    char shown[NAME_SIZE], *const name = ffd_gltf_place_name(&d->base, node);
    if (!name)
        return ffd_fail_memory(error);
    ffd_name_shown(name, shown, sizeof shown);
    ffd_free(name);
    const size_t used = strlen(group->names);
    snprintf(group->names + used, sizeof group->names - used, "%s%s", used ? ", " : ": ", shown);
    return FFD_OK;
}

static void end_group(place_group *group)
{
    const size_t used = strlen(group->names);
    if (group->count > NAMES)
        snprintf(group->names + used, sizeof group->names - used, " and %zu more", group->count - NAMES);
}

/* What does not change at nodes that move; turned: nodes that had no rotation and now have one. */
typedef struct staying {
    place_group shapes, springs, eyes, aims, turned, splats;
    size_t splat_count;
} staying;

static bool is_turned(const gltf_document *d, const gltf_moved_node *node)
{
    const double *const old = d->model.nodes[node->node].rotation;
    return node->rotates && old[0] == 0 && old[1] == 0 && old[2] == 0;
}

/* Counts unselected splats that should be turned back after their nodes turned, but whose rotations and
   scales cannot be changed. Marks their nodes. */
static size_t count_turned_splats(const gltf_document *d, bool *marked)
{
    size_t count = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *const part = &d->mesh_parts[i];
        const bool is_left = part->splats && part->carried && part->skipped && !part->has_ellipsoids;
        bool is_turned = false;
        for (int k = 0; k < 9; k++)
            is_turned = is_turned || part->carry[k] != 0;
        if (!is_left || !is_turned || part->repeats_positions)
            continue;
        marked[d->parts[i].node] = true;
        count += part->vertex_count;
    }
    return count;
}

static ffd_status list_staying(const gltf_document *d, const mesh_places *places, const gltf_rig *rig,
                               const bool *has_splats, staying *found, mesh_following *following,
                               ffd_error *error)
{
    const bool is_old = ffd_gltf_has_extension(d, 0, "VRM");
    for (size_t i = 0; i < places->count; i++) {
        const mesh_place *const place = &places->list[i];
        const bool has_shape = place->kinds & PLACE_BIT(FFD_BEHIND_PHYSICS_SHAPE);
        const size_t moved = rig->motions[place->index].moved;
        const size_t at = 12 * place->index;
        const bool moves =
            !place->stays && memcmp(rig->world + at, d->world + at, 12 * sizeof *d->world) != 0;
        const struct {
            bool is_one;
            place_group *group;
        } groups[] = {{has_splats[place->index], &found->splats},
                      {moves && has_shape, &found->shapes},
                      {moves && place->holds & PLACE_HOLDS_SPRING, &found->springs},
                      {moves && place->holds & PLACE_HOLDS_EYES, &found->eyes},
                      {moves && place->holds & PLACE_HOLDS_AIM, &found->aims},
                      /* Also nodes that stay below one that turns. */
                      {is_old && moved != GLTF_NONE && is_turned(d, &rig->nodes[moved]), &found->turned}};
        for (size_t g = 0; g < sizeof groups / sizeof *groups; g++)
            if (groups[g].is_one)
                TRY(add_place(d, place->index, groups[g].group, error));
        following->unscaled += groups[0].is_one || groups[1].is_one || groups[2].is_one || groups[3].is_one;
    }
    end_group(&found->splats);
    end_group(&found->shapes);
    end_group(&found->springs);
    end_group(&found->eyes);
    end_group(&found->aims);
    end_group(&found->turned);
    return FFD_OK;
}

static ffd_status find_staying(const gltf_document *d, const mesh_places *places, const gltf_rig *rig,
                               staying *found, mesh_following *following, ffd_error *error)
{
    bool *const has_splats = ffd_alloc_zero(d->model.node_count, sizeof *has_splats);
    if (!has_splats)
        return ffd_fail_memory(error);
    found->splat_count = count_turned_splats(d, has_splats);
    const ffd_status status = list_staying(d, places, rig, has_splats, found, following, error);
    ffd_free(has_splats);
    return status;
}

static void warn_of_vrm(const staying *found, const mesh_log *log)
{
    if (found->turned.count)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu %s in the default pose, where VRM 0.x wants none: viewers may pose it wrongly%s",
                     found->turned.count,
                     ffd_plural(found->turned.count, "node has a rotation now", "nodes have rotations now"),
                     found->turned.names);
    if (found->springs.count)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu %s%s", found->springs.count,
                     ffd_plural(found->springs.count, "spring bone goes with the mesh, but keeps its radius",
                                "spring bones go with the mesh, but keep their radii"),
                     found->springs.names);
    if (found->eyes.count)
        ffd_log_line(log, FFD_LOG_WARNING, "the offset of the eyes from the head bone (VRM) stays%s",
                     found->eyes.names);
    if (found->aims.count)
        ffd_log_line(
            log, FFD_LOG_WARNING, "%zu %s (VRMC_node_constraint), and may turn otherwise than the mesh%s",
            found->aims.count, ffd_plural(found->aims.count, "node aims at another", "nodes aim at others"),
            found->aims.names);
}

/* Logs what changes. */
static void log_changes(const gltf_document *d, const gltf_rig *rig, const mesh_log *log)
{
    size_t skins = 0, animations = 0;
    for (size_t s = 0; s < d->skin_values.count; s++)
        skins += rig->skin_contents[s] != GLTF_NONE;
    for (size_t a = 0; a < rig->animations.count; a++)
        animations += rig->changes[a].contents != NULL;
    ffd_log_line(log, FFD_LOG_INFO, "%zu %s the deformation, and with %s %zu %s and %zu %s", rig->node_count,
                 ffd_plural(rig->node_count, "node follows", "nodes follow"),
                 ffd_plural(rig->node_count, "it", "them"), skins, ffd_plural(skins, "skin", "skins"),
                 animations, ffd_plural(animations, "animation", "animations"));
}

/* Warns of what --only does not select, and what hangs on nodes that follow. */
static ffd_status warn_of_left(const gltf_document *d, const gltf_rig *rig, const mesh_following *following,
                               const mesh_log *log, ffd_error *error)
{
    char off[60] = ", though";
    place_group left = {0}, above = {0};
    const uint64_t count = following->unselected;
    if (rig->left == GLTF_NONE)
        return FFD_OK;
    TRY(add_place(d, rig->left, &left, error));
    if (rig->left_below != GLTF_NONE && rig->left_below != rig->left)
        TRY(add_place(d, rig->left_below, &above, error));
    if (following->unselected_by > 0)
        snprintf(off, sizeof off, ", up to %g from where", following->unselected_by);
    ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s%s %s %s %s: %s%s%s", count,
                 ffd_plural(count, SPELLED("node that {only} does not select stays where it is"),
                            SPELLED("nodes that {only} does not select stay where they are")),
                 off, ffd_plural(count, "the node that it hangs on", "the nodes that they hang on"),
                 following->unselected_by > 0 ? "would carry" : "would turn", ffd_plural(count, "it", "them"),
                 left.names + 2, above.count ? " on " : "", above.count ? above.names + 2 : "");
    return FFD_OK;
}

/* Warns of skinned nodes that --only does not select, some of whose joints have moved: the joints no longer
   fit the mesh that they move. */
static ffd_status warn_of_left_skins(const gltf_document *d, const gltf_rig *rig, const mesh_log *log,
                                     mesh_following *following, ffd_error *error)
{
    place_group left = {0};
    double most = 0;
    bool *const listed = ffd_alloc_zero(d->model.node_count, sizeof *listed);
    if (!listed)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->base.part_count; i++) {
        double by;
        const size_t node = d->parts[i].node;
        TRY_END(left_by_joints(d, rig, i, &by, error));
        if (!(by > 0))
            continue;
        most = by > most ? by : most;
        if (!listed[node])
            TRY_END(add_place(d, node, &left, error));
        listed[node] = true;
    }
    end_group(&left);
    following->unselected += left.count;
    following->unselected_by = most > following->unselected_by ? most : following->unselected_by;
    if (left.count > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu skinned %s, though joints %s on move, by up to %g%s",
                     left.count,
                     ffd_plural(left.count, SPELLED("mesh that {only} does not select stays where it is"),
                                SPELLED("meshes that {only} does not select stay where they are")),
                     ffd_plural(left.count, "that it hangs", "that they hang"), most, left.names);
end:
    ffd_free(listed);
    return status;
}

/* Logs what follows (-v), and warns of what does not, with one line per kind and the first names: physics
   shapes, spring bones and look-at offsets of VRM, rest rotations of VRM 0.x, constraints that aim, channels
   with unsupported pointers. Sets following->unscaled, and adds to following->unselected. Errors:
   FFD_E_MEMORY. */
static ffd_status warn_of_rig(const gltf_document *d, const mesh_places *places, const gltf_rig *rig,
                              const mesh_log *log, mesh_following *following, ffd_error *error)
{
    staying found = {0};
    if (rig->node_count == 0)
        return FFD_OK;
    TRY(find_staying(d, places, rig, &found, following, error));
    log_changes(d, rig, log);
    ffd_status warned = warn_of_left(d, rig, following, log, error);
    if (warned == FFD_OK)
        warned = warn_of_left_skins(d, rig, log, following, error);
    if (warned)
        return warned;
    if (found.shapes.count)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu physics %s%s", found.shapes.count,
                     ffd_plural(found.shapes.count, "shape goes with its node, but keeps its size",
                                "shapes go with their nodes, but keep their sizes"),
                     found.shapes.names);
    if (found.splat_count)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu Gaussian %s%s", found.splat_count,
                     ffd_plural(found.splat_count,
                                "splat that is not selected turns with its node: its rotation and scale stay",
                                "splats that are not selected turn with their nodes: their rotations and "
                                "scales stay"),
                     found.splats.names);
    warn_of_vrm(&found, log);
    if (rig->pointers_left)
        ffd_log_line(
            log, FFD_LOG_WARNING, "%zu %s", rig->pointers_left,
            ffd_plural(rig->pointers_left,
                       "channel of KHR_animation_pointer drives a node that has moved, and stays as it is",
                       "channels of KHR_animation_pointer drive nodes that have moved, and stay as "
                       "they are"));
    return FFD_OK;
}

/* Checks the memory of the arrays, which opening the file has not counted. */
static ffd_status check_memory(const gltf_document *d, ffd_error *error)
{
    return ffd_budget_check(&d->base.budget, d->model.node_count,
                            12 * sizeof(double) + sizeof(gltf_node_motion) + sizeof(gltf_moved_node), error);
}

ffd_status ffd_gltf_follow(mesh_document *document, const mesh_places *places, mesh_place_move *moves,
                           const mesh_log *log, mesh_following *following, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    gltf_rig *const rig = &d->edit->rig;
    ffd_gltf_clear_edit(d);
    *following = (mesh_following){0};
    TRY(check_memory(d, error));
    ffd_status status;
    TRY_END(ffd_gltf_follow_nodes(d, places, moves, following, error));
    TRY_END(ffd_gltf_follow_skins(d, places, moves, error));
    TRY_END(ffd_gltf_follow_animations(d, error));
    TRY_END(warn_of_rig(d, places, rig, log, following, error));
end:
    d->edit->any = rig->node_count > 0;
    if (status)
        ffd_gltf_clear_edit(d);
    return status;
}
