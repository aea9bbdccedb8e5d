#include "picture/camera.h"
#include "base/text/number.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "mesh/bounds.h"
#include <float.h>
#include <string.h>

/* Angles in degrees: yaw from +z towards +x, pitch upwards. */
typedef struct named_view {
    const char *name;
    double yaw, pitch;
} named_view;

static const named_view views[] = {{"front", 0, 0},  {"back", 180, 0}, {"left", -90, 0},
                                   {"right", 90, 0}, {"top", 0, 90},   {"iso", 36, 26}};

/* A scene of a single point, or of none, is drawn with this extent. */
#define LEAST_EXTENT 1e-300

static camera turned(double yaw, double pitch)
{
    double sy, cy, sp, cp;
    ffd_sincos_degrees(yaw, &sy, &cy);
    ffd_sincos_degrees(pitch, &sp, &cp);
    return (camera){.right = {cy, 0, -sy}, .up = {-sy * sp, cp, -cy * sp}, .back = {sy * cp, sp, cy * cp}};
}

bool ffd_camera_from(const double direction[3], camera *result)
{
    double largest = 0, d[3];
    for (int a = 0; a < 3; a++)
        largest = larger_of(largest, fabs(direction[a]));
    if (!(vec_is_finite(direction) && largest > 0))
        return false;
    for (int a = 0; a < 3; a++)
        d[a] = direction[a] / largest;
    const double length = vec_length(d), level = sqrt(d[0] * d[0] + d[2] * d[2]);
    /* Straight from above, +z points down in the picture; from below, up. */
    const double sy = level > 0 ? d[0] / level : 0, cy = level > 0 ? d[2] / level : 1;
    const double sp = d[1] / length, cp = level / length;
    *result = (camera){.right = {cy, 0, -sy}, .up = {-sy * sp, cp, -cy * sp}, .back = {sy * cp, sp, cy * cp}};
    return true;
}

bool ffd_camera_parse(const char *text, camera *result)
{
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        if (strcmp(text, views[i].name) == 0) {
            *result = turned(views[i].yaw, views[i].pitch);
            return true;
        }
    double direction[3];
    const char *at = text;
    for (int a = 0; a < 3; a++) {
        const char *const comma = strchr(at, ',');
        const char *const end = comma ? comma : at + strlen(at);
        if (!comma != (a == 2) || ffd_number_parse(at, end, &direction[a]) != end)
            return false;
        at = end + 1;
    }
    return ffd_camera_from(direction, result);
}

void ffd_camera_widen(const camera *from, const double *points, size_t count, ffd_bounds *seen)
{
    for (size_t i = 0; i < count; i++) {
        const double *const p = points + 3 * i;
        const double along[3] = {vec_dot(from->right, p), vec_dot(from->up, p), vec_dot(from->back, p)};
        if (vec_is_finite(along))
            ffd_bounds_widen(seen, along);
    }
}

projection ffd_camera_fit(const camera *from, const ffd_bounds *seen, double x, double y, double width,
                          double height)
{
    double middle[3] = {0, 0, 0}, extent[3] = {0, 0, 0};
    for (int a = 0; a < 3; a++)
        if (seen->min[a] <= seen->max[a]) {
            middle[a] = seen->min[a] / 2 + seen->max[a] / 2;
            extent[a] = lesser_of(2 * (seen->max[a] / 2 - seen->min[a] / 2), DBL_MAX);
        }
    const double room = larger_of(lesser_of(width, height), 1), most = larger_of(extent[0], extent[1]);
    double scale = room / (most > LEAST_EXTENT ? most : larger_of(extent[2], 1));
    if (most > LEAST_EXTENT) {
        const double across = larger_of(width, 1) / larger_of(extent[0], LEAST_EXTENT),
                     upwards = larger_of(height, 1) / larger_of(extent[1], LEAST_EXTENT);
        scale = lesser_of(across, upwards);
    }
    return (projection){.camera = *from,
                        .scale = scale,
                        .offset = {x - scale * middle[0], y + scale * middle[1], scale * middle[2]}};
}
