#include "picture/camera.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "mesh/bounds.h"
#include <float.h>
#include <string.h>

/* Directions where y points upwards. */
typedef struct named_side {
    const char *name;
    double direction[3];
} named_side;

static const named_side sides[] = {{"front", {0, 0, 1}}, {"back", {0, 0, -1}}, {"left", {-1, 0, 0}},
                                   {"right", {1, 0, 0}}, {"top", {0, 1, 0}},   {"bottom", {0, -1, 0}}};

/* Angles of the default view in degrees: yaw from +z towards +x, pitch upwards. */
#define ISO_YAW 36
#define ISO_PITCH 26

/* A scene of a single point, or of none, is drawn with this extent. */
#define LEAST_EXTENT 1e-300

void ffd_camera_turn(ffd_up up, double direction[3])
{
    const double x = direction[0], y = direction[1], z = direction[2];
    const double turned[3][3] = {{x, y, z}, {x, -z, y}, {y, -x, z}}; /* by ffd_up */
    memcpy(direction, turned[up], sizeof turned[up]);
}

static void turn_back(ffd_up up, double direction[3])
{
    const double x = direction[0], y = direction[1], z = direction[2];
    const double turned[3][3] = {{x, y, z}, {x, z, -y}, {-y, x, z}};
    memcpy(direction, turned[up], sizeof turned[up]);
}

/* Makes the camera from sines and cosines of yaw and pitch. */
static camera camera_at(ffd_up up, double sy, double cy, double sp, double cp)
{
    camera made = {.right = {cy, 0, -sy}, .up = {-sy * sp, cp, -cy * sp}, .back = {sy * cp, sp, cy * cp}};
    ffd_camera_turn(up, made.right);
    ffd_camera_turn(up, made.up);
    ffd_camera_turn(up, made.back);
    return made;
}

bool ffd_camera_side(const char *name, ffd_up up, double direction[3])
{
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
        if (strcmp(name, sides[i].name) == 0) {
            memcpy(direction, sides[i].direction, sizeof sides[i].direction);
            ffd_camera_turn(up, direction);
            return true;
        }
    return false;
}

bool ffd_camera_from(const double direction[3], ffd_up up, camera *result)
{
    double largest = 0, d[3];
    for (int a = 0; a < 3; a++)
        largest = larger_of(largest, fabs(direction[a]));
    if (!(vec_is_finite(direction) && largest > 0))
        return false;
    for (int a = 0; a < 3; a++)
        d[a] = direction[a] / largest;
    turn_back(up, d);
    const double length = vec_length(d), level = sqrt(d[0] * d[0] + d[2] * d[2]);
    /* Straight from above, what is in front is below in the picture; from below, above. */
    const double sy = level > 0 ? d[0] / level : 0, cy = level > 0 ? d[2] / level : 1;
    *result = camera_at(up, sy, cy, d[1] / length, level / length);
    return true;
}

camera ffd_camera_iso(ffd_up up)
{
    double sy, cy, sp, cp;
    ffd_sincos_degrees(ISO_YAW, &sy, &cy);
    ffd_sincos_degrees(ISO_PITCH, &sp, &cp);
    return camera_at(up, sy, cy, sp, cp);
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
