#include "view/view_scene.h"
#include "base/memory/memory.h"
#include "view/view_edit.h"

static void free_lists(view_scene *scene)
{
    for (size_t i = 0; i < scene->cage_count; i++) {
        ffd_free(scene->cages[i].name);
        ffd_free(scene->cages[i].rest);
        ffd_free(scene->cages[i].deformed);
    }
    for (size_t i = 0; i < scene->part_count; i++)
        ffd_free(scene->parts[i].name);
}

static void free_anchors(mesh_anchors *anchors)
{
    for (size_t t = 0; t < anchors->target_count; t++)
        ffd_free(anchors->targets[t].offsets);
    ffd_free(anchors->targets);
    ffd_free(anchors->points);
    *anchors = (mesh_anchors){0};
}

void ffd_view_scene_free_rigs(view_scene *scene)
{
    mesh_skeleton *const before = scene->rigs[0].skeleton, *const after = scene->rigs[1].skeleton;
    for (int side = 0; side < 2; side++) {
        free_anchors(&scene->rigs[side].anchors);
        ffd_free(scene->rigs[side].order);
        scene->rigs[side].order = NULL;
    }
    if (before)
        before->free(before);
    if (after && after != before)
        after->free(after);
    scene->rigs[0].skeleton = scene->rigs[1].skeleton = NULL;
    for (size_t i = 0; i < scene->animation_count; i++)
        ffd_free(scene->animations[i].name);
    ffd_free(scene->animations);
    scene->animations = NULL;
    scene->animation_count = 0;
}

void ffd_view_scene_free_targets(view_scene *scene)
{
    for (size_t side = 0; side < 2; side++) {
        view_target_list *const targets = &scene->targets[side];
        for (size_t t = 0; t < targets->count; t++) {
            ffd_free(targets->list[t].vertices);
            ffd_free(targets->list[t].offsets);
        }
        ffd_free(targets->list);
        *targets = (view_target_list){0};
    }
    for (size_t i = 0; i < scene->slider_count; i++)
        ffd_free(scene->sliders[i].name);
    ffd_free(scene->sliders);
    scene->sliders = NULL;
    scene->slider_count = 0;
}

void ffd_view_scene_free(view_scene *scene)
{
    void *const blocks[] = {scene->name,
                            scene->output,
                            scene->before,
                            scene->after,
                            scene->indices,
                            scene->statuses,
                            scene->dets,
                            scene->colors,
                            scene->triangles,
                            scene->texcoords,
                            scene->glow_texcoords,
                            scene->flipped,
                            scene->continues,
                            scene->segments,
                            scene->points,
                            scene->parts,
                            scene->cages,
                            scene->tears,
                            scene->report,
                            scene->segment_materials,
                            scene->point_materials,
                            scene->splats[0],
                            scene->splats[1]};
    free_lists(scene);
    ffd_view_edit_free(scene->edit);
    ffd_view_scene_free_rigs(scene);
    ffd_view_scene_free_targets(scene);
    ffd_materials_free(&scene->materials);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    *scene = (view_scene){0};
}
