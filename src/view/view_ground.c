#include "view/view_ground.h"
#include "mesh/bounds.h"
#include "picture/camera.h"

bool ffd_view_ground(const view_scene *scene, const uint8_t *framed, ffd_up up,
                     double corners[3 * GROUND_CORNERS])
{
    static const uint8_t turns[GROUND_CORNERS][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    /* Two level directions, and upwards. */
    camera axes = {.right = {1, 0, 0}, .up = {0, 1, 0}, .back = {0, 0, 1}};
    ffd_bounds seen = ffd_bounds_empty();
    ffd_camera_turn(up, axes.right);
    ffd_camera_turn(up, axes.up);
    ffd_camera_turn(up, axes.back);
    for (size_t v = 0; v < scene->vertex_count; v++)
        if (!framed || framed[v])
            ffd_camera_widen(&axes, scene->before + 3 * v, 1, &seen);
    if (!(seen.min[0] < seen.max[0] || seen.min[2] < seen.max[2]))
        return false;
    for (int i = 0; i < GROUND_CORNERS; i++)
        for (int a = 0; a < 3; a++)
            corners[3 * i + a] = (turns[i][0] ? seen.max : seen.min)[0] * axes.right[a] +
                                 seen.min[1] * axes.up[a] +
                                 (turns[i][1] ? seen.max : seen.min)[2] * axes.back[a];
    return true;
}
