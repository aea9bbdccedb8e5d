#include "io/gltf/model/gltf_sample.h"
#include "base/lower_bound.h"
#include "base/vector/trig.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define DEGREES 57.295779513082320877 /* per radian */

static bool is_time_up_to(const void *key, const void *time)
{
    return *(const double *)key <= *(const double *)time;
}

/* Returns the last key whose time is not after `time`; 0 if all are after it. */
static size_t find_key(const gltf_animation_sampler *sampler, double time)
{
    return last_up_to(&time, sampler->times, sampler->key_count, sizeof *sampler->times, is_time_up_to);
}

static double sine(double radians)
{
    double s, c;
    ffd_sincos_degrees(radians * DEGREES, &s, &c);
    return s;
}

static void normalize(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4 && length > 0; i++)
        q[i] /= length;
}

/* As three.js does: linear interpolation, normalized, where the arc is too short for its sine. */
void ffd_gltf_slerp(const double a[4], const double b[4], double t, double turned[4])
{
    const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double sign = cosine >= 0 ? 1 : -1, square = 1 - cosine * cosine;
    double from = 1 - t, to = t;
    const bool is_arc = square > DBL_EPSILON;
    if (is_arc) {
        const double s = sqrt(square), arc = ffd_arc_tangent(s, cosine * sign);
        from = sine((1 - t) * arc) / s;
        to = sine(t * arc) / s;
    }
    for (int i = 0; i < 4; i++)
        turned[i] = a[i] * from + b[i] * (to * sign);
    if (!is_arc)
        normalize(turned);
}

/* The Hermite spline between two keys. Tangents are per second, so they are scaled by the span in seconds. */
static void spline(const gltf_animation_sampler *sampler, size_t key, double u, double span, double *value)
{
    const size_t width = sampler->width;
    const double *const v0 = sampler->values + (3 * key + 1) * width, *const out = v0 + width;
    const double *const in = out + width, *const v1 = in + width;
    const double uu = u * u, uuu = uu * u;
    for (size_t i = 0; i < width; i++)
        value[i] = (2 * uuu - 3 * uu + 1) * v0[i] + span * (uuu - 2 * uu + u) * out[i] +
                   (3 * uu - 2 * uuu) * v1[i] + span * (uuu - uu) * in[i];
}

static const double *key_value(const gltf_animation_sampler *sampler, size_t key)
{
    return sampler->values +
           (sampler->interpolation == GLTF_CUBICSPLINE ? 3 * key + 1 : key) * sampler->width;
}

void ffd_gltf_sample(const gltf_animation_sampler *sampler, bool is_rotation, double time, double *value)
{
    const size_t key = find_key(sampler, time);
    const double begin = sampler->times[key];
    const bool is_last = key + 1 == sampler->key_count;
    const double *const at = key_value(sampler, key);
    if (is_last || !(time > begin) || sampler->interpolation == GLTF_STEP) {
        memcpy(value, at, sampler->width * sizeof *value);
        return;
    }
    const double span = sampler->times[key + 1] - begin, u = (time - begin) / span;
    if (sampler->interpolation == GLTF_CUBICSPLINE) {
        spline(sampler, key, u, span, value);
        if (is_rotation)
            normalize(value);
    } else if (is_rotation) {
        ffd_gltf_slerp(at, key_value(sampler, key + 1), u, value);
    } else {
        for (size_t i = 0; i < sampler->width; i++)
            value[i] = at[i] * (1 - u) + key_value(sampler, key + 1)[i] * u;
    }
}
