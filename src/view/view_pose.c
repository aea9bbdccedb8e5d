#include "view/view_pose.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include <string.h>

typedef struct pose_work {
    mesh_skeleton *skeleton;
    double *worlds, *weights, *bones;
    double *points; /* anchors with the offsets of morph targets added */
} pose_work;

static ffd_status allocate(const view_rig *rig, pose_work *w, ffd_error *error)
{
    mesh_skeleton *const s = rig->skeleton;
    *w = (pose_work){.skeleton = s,
                     .worlds = ffd_alloc(s->node_count, 12 * sizeof(double)),
                     .weights = ffd_alloc(s->weight_count, sizeof(double)),
                     .bones = ffd_alloc(s->bone_count, 12 * sizeof(double)),
                     .points = ffd_alloc(s->vertex_count, 3 * sizeof(double))};
    return w->worlds && w->weights && w->bones && w->points ? FFD_OK : ffd_fail_memory(error);
}

static void free_work(pose_work *w)
{
    ffd_free(w->worlds);
    ffd_free(w->weights);
    ffd_free(w->bones);
    ffd_free(w->points);
}

static void join_bones(const pose_work *w)
{
    for (size_t b = 0; b < w->skeleton->bone_count; b++) {
        const rig_bone *const bone = &w->skeleton->bones[b];
        const double *const world = w->worlds + 12 * bone->node;
        double *const to = w->bones + 12 * b;
        mat_multiply(world, bone->bind, to);
        mat_apply(world, bone->bind + 9, to + 9);
        for (int a = 0; a < 3; a++)
            to[9 + a] += world[9 + a];
    }
}

double *ffd_view_rest_matrices(mesh_skeleton *s, ffd_error *error)
{
    const view_rig rig = {.skeleton = s};
    double *const matrices = ffd_alloc_zero(s->vertex_count, 9 * sizeof *matrices);
    pose_work w = {0};
    const bool made = matrices && !allocate(&rig, &w, error);
    if (made) {
        s->pose(s, RIG_NONE, 0, w.worlds, w.weights);
        join_bones(&w);
    }
    for (size_t v = 0; made && v < s->vertex_count; v++)
        for (size_t i = s->starts[v]; i < s->starts[v + 1]; i++)
            for (size_t k = 0; k < 9; k++)
                matrices[9 * v + k] +=
                    (double)s->influences[i].weight * w.bones[12 * (size_t)s->influences[i].bone + k];
    free_work(&w);
    if (made)
        return matrices;
    ffd_free(matrices);
    ffd_fail_memory(error);
    return NULL;
}

static void add_targets(const view_rig *rig, const pose_work *w)
{
    if (w->skeleton->vertex_count > 0)
        memcpy(w->points, rig->anchors.points, 3 * w->skeleton->vertex_count * sizeof *w->points);
    for (size_t t = 0; t < rig->anchors.target_count; t++) {
        const rig_target *const target = &rig->anchors.targets[t];
        const double weight = w->weights[target->weight] - w->skeleton->weights[target->weight];
        double *const points = w->points + 3 * target->first;
        for (size_t i = 0; i < 3 * target->count && weight != 0; i++)
            points[i] += weight * target->offsets[i];
    }
}

static void place(const pose_work *w, size_t vertex, double to[3])
{
    const mesh_skeleton *const s = w->skeleton;
    const double *const point = w->points + 3 * vertex;
    to[0] = to[1] = to[2] = 0;
    for (size_t i = s->starts[vertex]; i < s->starts[vertex + 1]; i++) {
        const double *const bone = w->bones + 12 * (size_t)s->influences[i].bone;
        double moved[3];
        mat_apply(bone, point, moved);
        for (int a = 0; a < 3; a++)
            to[a] += (double)s->influences[i].weight * (moved[a] + bone[9 + a]);
    }
}

ffd_status ffd_view_pose(const view_scene *scene, int side, size_t animation, double time, double **positions,
                         ffd_error *error)
{
    const view_rig *const rig = &scene->rigs[side];
    const size_t of = scene->animations[animation].of[side];
    double *const points = ffd_alloc(scene->vertex_count, 3 * sizeof *points);
    pose_work w = {0};
    *positions = points;
    if (!points)
        return ffd_fail_memory(error);
    if (!rig->skeleton || of == RIG_NONE) {
        if (scene->vertex_count > 0)
            memcpy(points, side ? scene->after : scene->before, 3 * scene->vertex_count * sizeof *points);
        return FFD_OK;
    }
    ffd_status status;
    TRY_END(allocate(rig, &w, error));
    rig->skeleton->pose(rig->skeleton, of, time, w.worlds, w.weights);
    join_bones(&w);
    add_targets(rig, &w);
    for (size_t v = 0; v < scene->vertex_count; v++)
        place(&w, ffd_view_vertex_of(scene, side, v), points + 3 * v);
end:
    free_work(&w);
    return status;
}
