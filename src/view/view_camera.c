/* view_camera.c - ffd_view_camera: where the named sides of a view are. */
#include "picture/camera.h"
#include <ffd/job.h>
#include <string.h>

ffd_status ffd_view_camera(const char *name, ffd_up up, double direction[3])
{
    const bool is_up = (int)up >= FFD_UP_Y && up <= FFD_UP_X, is_iso = name && strcmp(name, "iso") == 0;
    if (!is_up || !name || !(is_iso || ffd_camera_side(name, up, direction)))
        return FFD_E_ARGUMENT;
    for (int a = 0; a < 3 && is_iso; a++)
        direction[a] = 0;
    return FFD_OK;
}
