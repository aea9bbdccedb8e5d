#include "view/page_targets.h"
#include "base/arithmetic.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "view/page_text.h"
#include <math.h>
#include <string.h>

#define STEPS 32767

/* Chooses the step of a target's offsets: of the vertices that the page has. */
static double step_of(const page_mesh *mesh, const view_target *target)
{
    double most = 0;
    for (size_t i = 0; i < target->count; i++)
        for (size_t a = 0; a < 3 && mesh->places[target->vertices[i]] != VIEW_NONE; a++)
            most = larger_of(most, fabs((double)target->offsets[3 * i + a]));
    return most / STEPS;
}

/* Rounds an offset. Returns false if all of it is 0, or the page lacks the vertex. */
static bool round_offset(const page_mesh *mesh, const view_target *target, double step, size_t entry,
                         int16_t rounded[3])
{
    bool moves = false;
    for (size_t a = 0; a < 3; a++) {
        const double q = step > 0 ? nearest_integer((double)target->offsets[3 * entry + a] / step) : 0;
        rounded[a] = (int16_t)(q > STEPS ? STEPS : q < -STEPS ? -STEPS : q);
        moves = moves || rounded[a] != 0;
    }
    return moves && mesh->places[target->vertices[entry]] != VIEW_NONE;
}

static size_t count_entries(const page_mesh *mesh, const view_target *target, double step)
{
    size_t count = 0;
    int16_t rounded[3];
    for (size_t i = 0; i < target->count; i++)
        count += round_offset(mesh, target, step, i, rounded);
    return count;
}

/* Chooses the sliders. */
static void choose(page_targets *t, bool full, const size_t *counts)
{
    size_t all = 0;
    for (size_t s = 0; s < t->mesh->scene->slider_count; s++) {
        const bool fits = full || all + counts[s] <= VIEW_PAGE_OFFSETS;
        t->has_slider[s] = fits && counts[s] > 0;
        t->numbers[s] = t->slider_count;
        t->slider_count += t->has_slider[s];
        t->left_out += !fits;
        all += t->has_slider[s] ? counts[s] : 0;
    }
}

static void put(byte_buffer *to, const void *bytes, size_t size)
{
    ffd_buffer_append(to, bytes, size);
}

static void put_target(page_targets *t, const view_target *target, double step)
{
    for (size_t i = 0; i < target->count; i++) {
        int16_t rounded[3];
        unsigned char bytes[6];
        if (!round_offset(t->mesh, target, step, i, rounded))
            continue;
        store_u32(bytes, t->mesh->places[target->vertices[i]]);
        put(&t->vertices, bytes, 4);
        for (size_t a = 0; a < 3; a++)
            store_u16(bytes + 2 * a, (uint16_t)rounded[a]);
        put(&t->offsets, bytes, 6);
    }
}

ffd_status ffd_page_targets_make(const page_mesh *mesh, bool full, page_targets *t, ffd_error *error)
{
    const view_scene *const scene = mesh->scene;
    *t = (page_targets){.mesh = mesh};
    if (scene->slider_count == 0)
        return FFD_OK;
    t->has_slider = ffd_alloc_zero(scene->slider_count, sizeof *t->has_slider);
    t->numbers = ffd_alloc(scene->slider_count, sizeof *t->numbers);
    size_t *const counts = ffd_alloc_zero(scene->slider_count, sizeof *counts);
    bool made = t->has_slider && t->numbers && counts;
    for (size_t side = 0; side < 2 && made; side++) {
        const view_target_list *const list = &scene->targets[side];
        t->counts[side] = ffd_alloc(list->count, sizeof *t->counts[side]);
        t->steps[side] = ffd_alloc(list->count, sizeof *t->steps[side]);
        made = t->counts[side] && t->steps[side];
        for (size_t i = 0; i < list->count && made; i++) {
            t->steps[side][i] = step_of(mesh, &list->list[i]);
            t->counts[side][i] = count_entries(mesh, &list->list[i], t->steps[side][i]);
            counts[list->list[i].slider] += t->counts[side][i];
        }
    }
    if (made)
        choose(t, full, counts);
    for (size_t side = 0; side < 2 && made; side++)
        for (size_t i = 0; i < scene->targets[side].count; i++)
            if (t->has_slider[scene->targets[side].list[i].slider])
                put_target(t, &scene->targets[side].list[i], t->steps[side][i]);
    ffd_free(counts);
    return made && !t->vertices.failed && !t->offsets.failed ? FFD_OK : ffd_fail_memory(error);
}

static void fill(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    memcpy(bytes, ((const byte_buffer *)of)->data + first, count);
}

void ffd_page_targets_write(const page_targets *t, page_writer *w)
{
    if (t->slider_count == 0)
        return;
    ffd_page_write_block(w, "data-target-vertex", t->vertices.size, 1, fill, &t->vertices);
    ffd_page_write_block(w, "data-target-offset", t->offsets.size, 1, fill, &t->offsets);
}

/* Adds the sliders: [name, weight]. */
static void describe_sliders(const page_targets *t, json_text *json)
{
    const view_scene *const scene = t->mesh->scene;
    ffd_json_array(json, "sliders", false);
    for (size_t s = 0; s < scene->slider_count && t->has_slider; s++) {
        if (!t->has_slider[s])
            continue;
        char *const name = ffd_page_name(scene->sliders[s].name);
        json->out->failed = json->out->failed || !name;
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "name", name);
        ffd_json_number(json, "weight", scene->sliders[s].weight);
        ffd_json_end(json, '}');
        ffd_free(name);
    }
    ffd_json_end(json, ']');
}

/* Adds the index among the page's sliders, the number of entries, the step, and the weight of the rig or
   -1. */
static void describe_target(const page_targets *t, size_t side, size_t target, json_text *json)
{
    const view_target *const from = &t->mesh->scene->targets[side].list[target];
    if (!t->has_slider || !t->has_slider[from->slider])
        return;
    const double numbers[4] = {(double)t->numbers[from->slider], (double)t->counts[side][target],
                               t->steps[side][target],
                               from->rig_weight == RIG_NONE ? -1 : (double)from->rig_weight};
    ffd_json_vector(json, NULL, numbers, 4);
}

void ffd_page_targets_describe(const page_targets *t, json_text *json)
{
    const view_scene *const scene = t->mesh->scene;
    describe_sliders(t, json);
    ffd_json_bool(json, "sameTargets", scene->same_targets);
    ffd_json_array(json, "targets", false);
    for (size_t side = 0; side < 2; side++) {
        ffd_json_array(json, NULL, false);
        for (size_t i = 0; i < scene->targets[side].count; i++)
            describe_target(t, side, i, json);
        ffd_json_end(json, ']');
    }
    ffd_json_end(json, ']');
}

void ffd_page_targets_free(page_targets *t)
{
    for (size_t side = 0; side < 2; side++) {
        ffd_free(t->counts[side]);
        ffd_free(t->steps[side]);
    }
    ffd_free(t->has_slider);
    ffd_free(t->numbers);
    ffd_buffer_free(&t->vertices);
    ffd_buffer_free(&t->offsets);
    *t = (page_targets){0};
}
