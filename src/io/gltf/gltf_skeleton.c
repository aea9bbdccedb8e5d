#include "io/gltf/gltf_skeleton.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/read/gltf_elements.h"
#include <string.h>

static const double identity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

#define MOST_INFLUENCES 64 /* of a vertex, in 16 sets */

typedef struct filler {
    const gltf_skeleton *rig;
    rig_influence *to;
    size_t count; /* so far */
} filler;

/* Returns the maximum number of influences of all vertices of a part together. */
static size_t most_of(const gltf_part *part, size_t vertices)
{
    return vertices * (part->skin ? 4 * part->influence_count : 1);
}

/* As in the default pose: weights are divided by their sum, and a vertex whose weights are all 0 follows its
   first joint. */
static void add_vertex(filler *f, size_t first_bone, const double *joints, const double *weights,
                       size_t count)
{
    double total = 0;
    const size_t begin = f->count;
    for (size_t i = 0; i < count; i++)
        total += weights[i];
    for (size_t i = 0; i < count && total > 0; i++)
        if (weights[i] != 0)
            f->to[f->count++] =
                (rig_influence){(uint32_t)(first_bone + (size_t)joints[i]), (float)(weights[i] / total)};
    if (f->count == begin)
        f->to[f->count++] = (rig_influence){(uint32_t)(first_bone + (size_t)joints[0]), 1};
}

static void add_skinned(filler *f, size_t p, size_t count, size_t *starts)
{
    const gltf_document *const d = f->rig->document;
    const gltf_part *const part = &d->parts[p];
    const size_t bone = f->rig->skin_bone[part->skin - d->skins], sets = part->influence_count;
    double joints[MOST_INFLUENCES], weights[MOST_INFLUENCES];
    for (size_t i = 0; i < count; i++) {
        for (size_t s = 0; s < sets; s++) {
            ffd_gltf_read(d, (size_t)part->influences[s].joints, i, 1, 4, joints + 4 * s);
            ffd_gltf_read(d, (size_t)part->influences[s].weights, i, 1, 4, weights + 4 * s);
        }
        for (size_t k = 0; k < 4 * sets; k++) /* beyond the skin: without a weight */
            joints[k] = joints[k] < (double)part->skin->joint_count ? joints[k] : 0;
        starts[i] = f->count;
        add_vertex(f, bone, joints, weights, 4 * sets);
    }
}

static void add_part(filler *f, size_t p, size_t *starts)
{
    const gltf_document *const d = f->rig->document;
    const size_t count = d->mesh_parts[p].vertex_count;
    if (d->parts[p].skin) {
        add_skinned(f, p, count, starts);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        starts[i] = f->count;
        f->to[f->count++] = (rig_influence){(uint32_t)f->rig->node_bone[d->parts[p].node], 1};
    }
}

/* Fills the skeleton's influences. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
static ffd_status make_influences(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    mesh_skeleton *const base = &rig->base;
    size_t most = 0, first = 0;
    base->vertex_count = (size_t)ffd_mesh_vertex_count(&d->base);
    for (size_t p = 0; p < d->base.part_count; p++)
        most += d->mesh_parts[p].repeats_positions ? 0 : most_of(&d->parts[p], d->mesh_parts[p].vertex_count);
    TRY(ffd_gltf_skeleton_take(rig, most, sizeof *base->influences, error));
    TRY(ffd_gltf_skeleton_take(rig, base->vertex_count + 1, sizeof *base->starts, error));
    base->influences = ffd_alloc(most, sizeof *base->influences);
    base->starts = ffd_alloc(base->vertex_count + 1, sizeof *base->starts);
    if (!base->influences || !base->starts)
        return ffd_fail_memory(error);
    filler f = {.rig = rig, .to = base->influences};
    for (size_t p = 0; p < d->base.part_count; p++) {
        if (d->mesh_parts[p].repeats_positions)
            continue;
        add_part(&f, p, base->starts + first);
        first += d->mesh_parts[p].vertex_count;
    }
    base->starts[base->vertex_count] = f.count;
    return FFD_OK;
}

/* Whether a job counts the vertices of a part. */
static bool has_vertices(const gltf_document *d, size_t part)
{
    return !d->mesh_parts[part].repeats_positions && d->parts[part].node != GLTF_NONE;
}

/* Marks the nodes of the bones and their ancestors: their places become 0 instead of GLTF_NONE. */
static void mark_needed(gltf_skeleton *rig)
{
    const gltf_document *const d = rig->document;
    for (size_t n = 0; n < d->model.node_count; n++)
        if (rig->node_bone[n] != GLTF_NONE)
            rig->places[n] = 0;
    for (size_t s = 0; s < d->skin_values.count; s++)
        for (size_t j = 0; rig->skin_bone[s] != GLTF_NONE && j < d->skins[s].joint_count; j++)
            rig->places[d->skins[s].joints[j]] = 0;
    for (size_t i = rig->pose.order_count; i-- > 0;) {
        const size_t node = rig->pose.order[i], parent = d->parents[node];
        if (parent != GLTF_NONE && rig->places[node] != GLTF_NONE)
            rig->places[parent] = 0;
    }
}

static void fill_node(const gltf_skeleton *rig, const gltf_node *from, size_t parent, rig_node *to)
{
    *to = (rig_node){.parent = parent == GLTF_NONE ? RIG_NONE : rig->places[parent],
                     .has_matrix = from->has_matrix};
    if (from->has_matrix)
        ffd_gltf_local_matrix(from, to->matrix, to->matrix + 9);
    memcpy(to->translation, from->translation, sizeof to->translation);
    memcpy(to->rotation, from->rotation, sizeof to->rotation);
    memcpy(to->scale, from->scale, sizeof to->scale);
}

/* Marks animated nodes: they must not have a matrix. */
static void mark_animated(const gltf_skeleton *rig, bool *animated)
{
    for (size_t a = 0; a < rig->animations.count; a++)
        for (size_t c = 0; c < rig->animations.list[a].channel_count; c++) {
            const gltf_channel *const channel = &rig->animations.list[a].channels[c];
            if (channel->path < GLTF_WEIGHTS)
                animated[channel->node] = true;
        }
}

static ffd_status make_nodes(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    const size_t count = d->model.node_count;
    mesh_skeleton *const base = &rig->base;
    bool *const animated = ffd_alloc_zero(count, sizeof *animated);
    base->nodes = ffd_alloc(count, sizeof *base->nodes);
    rig->order = ffd_alloc(count, sizeof *rig->order);
    if (!animated || !base->nodes || !rig->order) {
        ffd_free(animated);
        return ffd_fail_memory(error);
    }
    mark_animated(rig, animated);
    for (size_t i = 0; i < rig->pose.order_count; i++) {
        const size_t node = rig->pose.order[i];
        gltf_node own = rig->nodes ? rig->nodes[node] : d->model.nodes[node];
        if (rig->places[node] == GLTF_NONE)
            continue;
        if (own.has_matrix && animated[node])
            ffd_gltf_take_apart(&own);
        rig->places[node] = base->node_count;
        rig->order[base->node_count] = node;
        fill_node(rig, &own, d->parents[node], &base->nodes[base->node_count++]);
    }
    for (size_t s = 0; s < d->skin_values.count; s++)
        for (size_t j = 0; rig->skin_bone[s] != GLTF_NONE && j < d->skins[s].joint_count; j++)
            if (rig->places[d->skins[s].joints[j]] < base->node_count)
                base->nodes[rig->places[d->skins[s].joints[j]]].is_joint = true;
    ffd_free(animated);
    return FFD_OK;
}

/* Inverts a matrix. Returns false, with the identity, if it has no inverse. */
static bool invert(const double matrix[12], double inverse[12])
{
    if (!mat_invert(matrix, inverse)) {
        memcpy(inverse, identity, sizeof identity);
        return false;
    }
    mat_apply(inverse, matrix + 9, inverse + 9);
    for (int a = 9; a < 12; a++)
        inverse[a] = -inverse[a];
    return true;
}

static void count_bones(gltf_skeleton *rig)
{
    const gltf_document *const d = rig->document;
    for (size_t p = 0; p < d->base.part_count; p++) {
        const gltf_skin *const skin = d->parts[p].skin;
        size_t *const first = skin ? &rig->skin_bone[skin - d->skins] : &rig->node_bone[d->parts[p].node];
        if (!has_vertices(d, p) || *first != GLTF_NONE)
            continue;
        *first = rig->base.bone_count;
        rig->base.bone_count += skin ? skin->joint_count : 1;
    }
}

/* A skin's vertices are stored where its first joint places them at rest: most are at rest there, and all
   have the scale of the scene. unmoved: the identity for each node. */
static ffd_status fill_skin(gltf_skeleton *rig, size_t s, const double *unmoved, ffd_error *error)
{
    const gltf_skin *const skin = &rig->document->skins[s];
    double *const rest = rig->skin_rest + 12 * s;
    double back[12], *const binds = ffd_alloc(skin->joint_count, 12 * sizeof *binds);
    ffd_status status;
    TRY_END(binds ? ffd_gltf_skeleton_binds(rig, s, unmoved, binds, error) : ffd_fail_memory(error));
    memcpy(rest, identity, sizeof identity);
    if (skin->joint_count > 0)
        ffd_gltf_join_matrix(ffd_gltf_skeleton_world(rig, skin->joints[0]), binds, binds + 9, rest);
    if (!invert(rest, back))
        memcpy(rest, identity, sizeof identity);
    for (size_t j = 0; j < skin->joint_count; j++) {
        rig_bone *const bone = &rig->base.bones[rig->skin_bone[s] + j];
        bone->node = rig->places[skin->joints[j]];
        ffd_gltf_join_matrix(binds + 12 * j, back, back + 9, bone->bind);
    }
end:
    ffd_free(binds);
    return status;
}

static ffd_status fill_bones(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    double *const unmoved = ffd_alloc(d->model.node_count, 12 * sizeof *unmoved);
    if (!unmoved)
        return ffd_fail_memory(error);
    for (size_t n = 0; n < d->model.node_count; n++) {
        memcpy(unmoved + 12 * n, identity, sizeof identity);
        if (rig->node_bone[n] == GLTF_NONE)
            continue;
        rig->base.bones[rig->node_bone[n]].node = rig->places[n];
        invert(ffd_gltf_skeleton_world(rig, n), rig->base.bones[rig->node_bone[n]].bind);
    }
    ffd_status status = FFD_OK;
    for (size_t s = 0; s < d->skin_values.count; s++)
        if (rig->skin_bone[s] != GLTF_NONE)
            TRY_END(fill_skin(rig, s, unmoved, error));
end:
    ffd_free(unmoved);
    return status;
}

static ffd_status make_bones(gltf_skeleton *rig, ffd_error *error)
{
    TRY(ffd_gltf_skeleton_take(rig, rig->base.bone_count, sizeof *rig->base.bones, error));
    rig->base.bones = ffd_alloc(rig->base.bone_count, sizeof *rig->base.bones);
    return rig->base.bones ? fill_bones(rig, error) : ffd_fail_memory(error);
}

static ffd_status list_animations(gltf_skeleton *rig, ffd_error *error)
{
    mesh_skeleton *const base = &rig->base;
    const size_t count = rig->animations.count;
    base->animations = ffd_alloc_zero(count, sizeof *base->animations);
    if (!base->animations)
        return ffd_fail_memory(error);
    base->animation_count = count;
    for (size_t a = 0; a < count; a++) {
        const gltf_animation *const from = &rig->animations.list[a];
        base->animations[a].name = from->name;
        for (size_t c = 0; c < from->channel_count; c++)
            base->animations[a].left += !ffd_gltf_channel_drives(&from->channels[c]);
    }
    return FFD_OK;
}

/* Whether a channel drives anything visible. */
static bool is_seen(const gltf_skeleton *rig, const gltf_channel *channel)
{
    return ffd_gltf_channel_drives(channel) &&
           (channel->path == GLTF_WEIGHTS || rig->places[channel->node] != GLTF_NONE);
}

static void fill_channel(const gltf_skeleton *rig, const gltf_animation *of, const gltf_channel *from,
                         rig_channel *to)
{
    static const rig_interpolation kinds[] = {RIG_STEP, RIG_LINEAR, RIG_CUBICSPLINE};
    const gltf_animation_sampler *const keys = &of->samplers[from->sampler];
    const bool weights = from->path == GLTF_WEIGHTS;
    *to = (rig_channel){.node = weights ? RIG_NONE : rig->places[from->node],
                        .first_weight = weights ? rig->pose.first_weight[from->node] : 0,
                        .path = (rig_path)from->path,
                        .interpolation = kinds[keys->interpolation],
                        .key_count = keys->key_count,
                        .width = keys->width,
                        .times = keys->times,
                        .values = keys->values,
                        .input = keys->input};
}

static ffd_status load(mesh_skeleton *skeleton, size_t index, ffd_error *error)
{
    gltf_skeleton *const rig = (gltf_skeleton *)skeleton;
    gltf_animation *const from = &rig->animations.list[index];
    rig_animation *const to = &skeleton->animations[index];
    TRY(to->channels ? FFD_OK : ffd_gltf_load_animation(rig->document, from, error));
    if (to->channels)
        return FFD_OK;
    TRY(ffd_gltf_follow_keys(rig, index, error));
    TRY(ffd_gltf_skeleton_take(rig, from->channel_count, sizeof *to->channels, error));
    to->channels = ffd_alloc(from->channel_count, sizeof *to->channels);
    if (!to->channels)
        return ffd_fail_memory(error);
    for (size_t c = 0; c < from->channel_count; c++)
        if (is_seen(rig, &from->channels[c]))
            fill_channel(rig, from, &from->channels[c], &to->channels[to->channel_count++]);
    to->begin = from->begin;
    to->end = from->end;
    return FFD_OK;
}

static void pose(mesh_skeleton *skeleton, size_t animation, double time, double *worlds, double *weights)
{
    gltf_skeleton *const rig = (gltf_skeleton *)skeleton;
    const gltf_animation *const of = animation == RIG_NONE ? NULL : &rig->animations.list[animation];
    ffd_gltf_set_pose(rig->document, of, time, &rig->pose);
    for (size_t n = 0; n < skeleton->node_count; n++)
        memcpy(worlds + 12 * n, rig->pose.world + 12 * rig->order[n], 12 * sizeof *worlds);
    if (skeleton->weight_count > 0)
        memcpy(weights, rig->pose.weights, skeleton->weight_count * sizeof *weights);
}

static void free_rig(mesh_skeleton *skeleton)
{
    gltf_skeleton *const rig = (gltf_skeleton *)skeleton;
    for (size_t a = 0; a < skeleton->animation_count; a++)
        ffd_free(skeleton->animations[a].channels);
    void *const blocks[] = {skeleton->nodes,  skeleton->weights,    skeleton->bones, skeleton->animations,
                            skeleton->starts, skeleton->influences, rig->places,     rig->order,
                            rig->node_bone,   rig->skin_bone,       rig->skin_rest,  rig->nodes};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    ffd_gltf_free_pose(&rig->pose);
    ffd_gltf_free_animations(rig->document, &rig->animations);
    ffd_budget_return(&rig->document->base.budget, 1, rig->taken);
    ffd_free(rig);
}

static ffd_status make_tables(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    const size_t nodes = d->model.node_count, skins = d->skin_values.count;
    rig->places = ffd_alloc(nodes, sizeof *rig->places);
    rig->node_bone = ffd_alloc(nodes, sizeof *rig->node_bone);
    rig->skin_bone = ffd_alloc(skins, sizeof *rig->skin_bone);
    rig->skin_rest = ffd_alloc_zero(skins, 12 * sizeof *rig->skin_rest);
    if (!rig->places || !rig->node_bone || !rig->skin_bone || !rig->skin_rest)
        return ffd_fail_memory(error);
    for (size_t n = 0; n < nodes; n++)
        rig->places[n] = rig->node_bone[n] = GLTF_NONE;
    for (size_t s = 0; s < skins; s++)
        rig->skin_bone[s] = GLTF_NONE;
    return FFD_OK;
}

static ffd_status keep_weights(gltf_skeleton *rig, ffd_error *error)
{
    const size_t count = rig->pose.first_weight[rig->document->model.node_count];
    rig->base.weights = ffd_alloc(count, sizeof *rig->base.weights);
    if (!rig->base.weights)
        return ffd_fail_memory(error);
    rig->base.weight_count = count;
    if (count > 0)
        memcpy(rig->base.weights, rig->pose.weights, count * sizeof *rig->base.weights);
    return FFD_OK;
}

/* Memory per node: its pose, its entries in three lists, and the node itself. */
#define NODE_BYTES (sizeof(gltf_node) + 12 * sizeof(double) + 6 * sizeof(size_t) + sizeof(rig_node) + 1)

static ffd_status make_rig(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    TRY(ffd_gltf_skeleton_take(rig, d->model.node_count, NODE_BYTES, error));
    TRY(ffd_gltf_list_animations(rig->document, &rig->animations, error));
    TRY(ffd_gltf_make_pose(d, &rig->pose, error));
    TRY(ffd_gltf_follow_transforms(rig, error));
    rig->pose.rest = rig->nodes;
    TRY(make_tables(rig, error));
    count_bones(rig);
    mark_needed(rig);
    TRY(make_nodes(rig, error));
    TRY(make_bones(rig, error));
    TRY(keep_weights(rig, error));
    TRY(list_animations(rig, error));
    return rig->animations.count > 0 ? make_influences(rig, error) : FFD_OK;
}

static bool has_any(const gltf_document *d, const char *list)
{
    return ffd_gltf_first(d, 0, list) != JSON_NONE;
}

ffd_status ffd_gltf_read_skeleton(mesh_document *document, bool after, mesh_skeleton **skeleton,
                                  ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    *skeleton = NULL;
    if (d->space == FFD_SPACE_MESH || (!has_any(d, "animations") && !has_any(d, "skins")))
        return FFD_OK;
    gltf_skeleton *const rig = ffd_alloc_zero(1, sizeof *rig);
    if (!rig)
        return ffd_fail_memory(error);
    rig->document = d;
    rig->follows = after && ffd_gltf_follows(d);
    rig->base.load = load;
    rig->base.pose = pose;
    rig->base.free = free_rig;
    const ffd_status status = make_rig(rig, error);
    if (status)
        free_rig(&rig->base);
    else
        *skeleton = &rig->base;
    return status;
}
