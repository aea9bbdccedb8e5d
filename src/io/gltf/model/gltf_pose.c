#include "io/gltf/model/gltf_pose.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_scene.h"
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

/* The Hermite spline between two keys. Tangents are per second, so they are scaled by the interval in
 * seconds. */
static void spline(const gltf_animation_sampler *sampler, size_t key, double u, double interval,
                   double *value)
{
    const size_t width = sampler->width;
    const double *const v0 = sampler->values + (3 * key + 1) * width, *const out = v0 + width;
    const double *const in = out + width, *const v1 = in + width;
    const double uu = u * u, uuu = uu * u;
    for (size_t i = 0; i < width; i++)
        value[i] = (2 * uuu - 3 * uu + 1) * v0[i] + interval * (uuu - 2 * uu + u) * out[i] +
                   (3 * uu - 2 * uuu) * v1[i] + interval * (uuu - uu) * in[i];
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
    const double interval = sampler->times[key + 1] - begin, u = (time - begin) / interval;
    if (sampler->interpolation == GLTF_CUBICSPLINE) {
        spline(sampler, key, u, interval, value);
        if (is_rotation)
            normalize(value);
    } else if (is_rotation) {
        ffd_gltf_slerp(at, key_value(sampler, key + 1), u, value);
    } else {
        for (size_t i = 0; i < sampler->width; i++)
            value[i] = at[i] * (1 - u) + key_value(sampler, key + 1)[i] * u;
    }
}

/* Lists the nodes, parents before children. Each node's children are a linked list. */
static ffd_status order_nodes(const gltf_document *d, gltf_pose *pose, ffd_error *error)
{
    const size_t count = d->model.node_count;
    size_t *const first = ffd_alloc(count, sizeof *first), *const next = ffd_alloc(count, sizeof *next);
    if (!first || !next) {
        ffd_free(first);
        ffd_free(next);
        return ffd_fail_memory(error);
    }
    for (size_t n = 0; n < count; n++)
        first[n] = GLTF_NONE;
    for (size_t n = count; n-- > 0;) {
        const size_t parent = d->parents[n];
        next[n] = parent == GLTF_NONE ? GLTF_NONE : first[parent];
        if (parent == GLTF_NONE)
            pose->order[pose->order_count++] = n;
        else
            first[parent] = n;
    }
    for (size_t i = 0; i < pose->order_count; i++)
        for (size_t n = first[pose->order[i]]; n != GLTF_NONE; n = next[n])
            pose->order[pose->order_count++] = n;
    ffd_free(first);
    ffd_free(next);
    return FFD_OK;
}

/* The rotation x,y,z,w of a matrix whose columns have length 1 (Shepperd 1978). For a sheared matrix the
   quaternion is not a unit quaternion: three.js computes the same one, so that it shows the same pose.
   ffd_mat_quaternion would give another. */
static void quaternion_of(const double m[9], double q[4])
{
    const double trace = m[0] + m[4] + m[8];
    if (trace > 0) {
        const double s = 2 * sqrt(trace + 1);
        q[0] = (m[7] - m[5]) / s;
        q[1] = (m[2] - m[6]) / s;
        q[2] = (m[3] - m[1]) / s;
        q[3] = s / 4;
        return;
    }
    const int i = m[0] >= m[4] && m[0] >= m[8] ? 0 : m[4] >= m[8] ? 1 : 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * sqrt(1 + m[4 * i] - m[4 * j] - m[4 * k]);
    q[i] = s / 4;
    q[j] = (m[3 * i + j] + m[3 * j + i]) / s;
    q[k] = (m[3 * i + k] + m[3 * k + i]) / s;
    q[3] = (m[3 * k + j] - m[3 * j + k]) / s;
}

/* As three.js does: the scales are the lengths of the columns, and scale x carries the sign. */
void ffd_gltf_take_apart(gltf_node *node)
{
    double linear[9];
    ffd_gltf_local_matrix(node, linear, node->translation);
    for (int c = 0; c < 3; c++) {
        const double column[3] = {linear[c], linear[3 + c], linear[6 + c]};
        node->scale[c] = vec_length(column);
    }
    if (mat_determinant(linear) < 0)
        node->scale[0] = -node->scale[0];
    for (int i = 0; i < 9; i++)
        linear[i] = node->scale[i % 3] != 0 ? linear[i] / node->scale[i % 3] : i % 4 == 0;
    quaternion_of(linear, node->rotation);
    node->has_matrix = false;
}

static void set_default(const gltf_document *d, gltf_pose *pose)
{
    const size_t count = d->model.node_count;
    if (count > 0)
        memcpy(pose->nodes, pose->rest ? pose->rest : d->model.nodes, count * sizeof *pose->nodes);
    for (size_t n = 0; n < count; n++) {
        const int mesh = d->model.nodes[n].mesh;
        uint32_t value = mesh < 0 ? JSON_NONE : ffd_gltf_first_weight(d, (size_t)mesh, n);
        for (size_t w = pose->first_weight[n]; w < pose->first_weight[n + 1]; w++) {
            double weight = 0;
            pose->weights[w] = value != JSON_NONE && ffd_gltf_weight(d, value, &weight) ? weight : 0;
            value = value == JSON_NONE ? value : ffd_json_tree_after(&d->tree, value);
        }
    }
}

static void apply_channel(const gltf_animation *animation, const gltf_channel *channel, double time,
                          gltf_pose *pose)
{
    const gltf_animation_sampler *const sampler = &animation->samplers[channel->sampler];
    gltf_node *const node = &pose->nodes[channel->node];
    if (channel->path < GLTF_WEIGHTS && node->has_matrix)
        ffd_gltf_take_apart(node);
    double *const values[] = {[GLTF_TRANSLATION] = node->translation,
                              [GLTF_ROTATION] = node->rotation,
                              [GLTF_SCALE] = node->scale,
                              [GLTF_WEIGHTS] = pose->weights + pose->first_weight[channel->node]};
    ffd_gltf_sample(sampler, channel->path == GLTF_ROTATION, time, values[channel->path]);
}

static void set_world(const gltf_document *d, gltf_pose *pose)
{
    for (size_t i = 0; i < pose->order_count; i++) {
        const size_t n = pose->order[i], parent = d->parents[n];
        double *const world = pose->world + 12 * n;
        double linear[9], offset[3];
        ffd_gltf_local_matrix(&pose->nodes[n], linear, offset);
        if (parent != GLTF_NONE) {
            ffd_gltf_join_matrix(pose->world + 12 * parent, linear, offset, world);
            continue;
        }
        memcpy(world, linear, sizeof linear);
        memcpy(world + 9, offset, sizeof offset);
    }
}

void ffd_gltf_set_pose(const gltf_document *d, const gltf_animation *animation, double time, gltf_pose *pose)
{
    set_default(d, pose);
    for (size_t c = 0; animation && c < animation->channel_count; c++)
        if (ffd_gltf_channel_drives(&animation->channels[c]))
            apply_channel(animation, &animation->channels[c], time, pose);
    set_world(d, pose);
}

/* Checks the memory budget first: a short file can show a mesh of many targets at many nodes. */
static ffd_status count_weights(const gltf_document *d, gltf_pose *pose, ffd_error *error)
{
    size_t total = 0;
    for (size_t n = 0; n < d->model.node_count; n++) {
        pose->first_weight[n] = total;
        total += ffd_gltf_node_targets(d, n);
    }
    pose->first_weight[d->model.node_count] = total;
    TRY(ffd_budget_check(&d->base.budget, total, sizeof *pose->weights, error));
    pose->weights = ffd_alloc_zero(total, sizeof *pose->weights);
    return pose->weights ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_gltf_make_pose(const gltf_document *d, gltf_pose *pose, ffd_error *error)
{
    const size_t count = d->model.node_count;
    *pose = (gltf_pose){.nodes = ffd_alloc(count, sizeof *pose->nodes),
                        .world = ffd_alloc_zero(count, 12 * sizeof *pose->world),
                        .first_weight = ffd_alloc(count + 1, sizeof *pose->first_weight),
                        .order = ffd_alloc(count, sizeof *pose->order)};
    if (!pose->nodes || !pose->world || !pose->first_weight || !pose->order)
        return ffd_fail_memory(error);
    if (count > 0)
        memcpy(pose->world, d->world, count * 12 * sizeof *pose->world);
    TRY(order_nodes(d, pose, error));
    TRY(count_weights(d, pose, error));
    ffd_gltf_set_pose(d, NULL, 0, pose);
    return FFD_OK;
}

void ffd_gltf_free_pose(gltf_pose *pose)
{
    ffd_free(pose->nodes);
    ffd_free(pose->world);
    ffd_free(pose->weights);
    ffd_free(pose->first_weight);
    ffd_free(pose->order);
    *pose = (gltf_pose){0};
}
