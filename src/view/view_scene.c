#include "view/view_scene.h"
#include "base/memory/memory.h"

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

void ffd_view_scene_free(view_scene *scene)
{
    void *const blocks[] = {
        scene->name,   scene->output, scene->before,    scene->after,     scene->numbers, scene->statuses,
        scene->dets,   scene->colors, scene->triangles, scene->texcoords, scene->flipped, scene->segments,
        scene->points, scene->parts,  scene->cages,     scene->tears,     scene->report};
    free_lists(scene);
    ffd_materials_free(&scene->materials);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    *scene = (view_scene){0};
}
