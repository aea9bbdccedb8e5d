#include "view/view_textures.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include <stdio.h>

/* Makes the luminance of an image its alpha, unless it has an alpha of its own. */
static void make_opacity(image *of)
{
    const size_t count = (size_t)of->width * of->height;
    bool is_opaque = true;
    for (size_t i = 0; i < count && is_opaque; i++)
        is_opaque = of->pixels[4 * i + 3] == 255;
    /* ITU-R BT.709, in 256ths */
    for (size_t i = 0; i < count && is_opaque; i++) {
        uint8_t *const pixel = of->pixels + 4 * i;
        pixel[3] = (uint8_t)((54u * pixel[0] + 183u * pixel[1] + 19u * pixel[2]) / 256);
    }
}

/* An image that becomes a texture. */
typedef struct texture_task {
    const mesh_image *from;
    size_t image;
    bool is_opacity;
    texture *to;
    ffd_status status;
    ffd_error error;
} texture_task;

typedef struct texture_work {
    texture_task *tasks;
    size_t count;
    memory_budget *budget;
} texture_work;

/* Decodes an image as long as the budget allows it, and takes nothing. */
static void decode(texture_task *task, const memory_budget *budget)
{
    image decoded = {0};
    ffd_status status;
    TRY_END(ffd_image_decode(task->from->bytes, task->from->size, budget, &decoded, &task->error));
    if (task->is_opacity)
        make_opacity(&decoded);
    TRY_END(ffd_budget_check(budget, ffd_texture_size(decoded.width, decoded.height), 1, &task->error));
    TRY_END(ffd_texture_make(&decoded, task->to, &task->error));
end:
    if (status)
        ffd_free(decoded.pixels);
    task->status = status;
}

static void decode_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    const texture_work *const work = context;
    (void)tile;
    (void)worker;
    for (size_t i = begin; i < end; i++)
        decode(&work->tasks[i], work->budget);
}

/* All textures are in memory at the same time. */
static ffd_status take(const texture_task *task, memory_budget *budget, ffd_error *error)
{
    const image *const kept = &task->to->image;
    return task->status ? FFD_OK
                        : ffd_budget_take(budget, ffd_texture_size(kept->width, kept->height), 1, error);
}

/* Whether all images fit in the budget while they are decoded, by the sizes that they state. */
static bool all_fit(const texture_work *work)
{
    uint64_t left = ffd_budget_left(work->budget);
    for (size_t i = 0; i < work->count; i++) {
        const mesh_image *const from = work->tasks[i].from;
        uint32_t width, height;
        if (!ffd_image_measure(from->bytes, from->size, &width, &height) || width > IMAGE_MOST_SIDE ||
            height > IMAGE_MOST_SIDE)
            return false;
        const uint64_t needed =
            ffd_texture_size(width, height) + (uint64_t)IMAGE_DECODING_BYTES * width * height;
        if (needed > left)
            return false;
        left -= needed;
    }
    return true;
}

/* What is decoded does not depend on the number of threads: several work only where each image has its
   memory whatever the others do. */
static ffd_status decode_all(texture_work *work, int threads, ffd_error *error)
{
    if (work->count > 1 && all_fit(work)) {
        ffd_parallel_tiles(work->count, 1, ffd_threads_for(threads, work->count), decode_tile, work);
        for (size_t i = 0; i < work->count; i++)
            TRY(take(&work->tasks[i], work->budget, error));
        return FFD_OK;
    }
    for (size_t i = 0; i < work->count; i++) {
        decode(&work->tasks[i], work->budget);
        TRY(take(&work->tasks[i], work->budget, error));
    }
    return FFD_OK;
}

/* An image that cannot be decoded is logged, and its material is drawn grey; running out of memory is an
   error. One that is used as colour and opacity counts once. */
static ffd_status report(const texture_work *work, const mesh_log *log, ffd_error *error)
{
    const texture_task *first = NULL, *last = NULL;
    size_t lost = 0;
    for (size_t i = 0; i < work->count; i++) {
        const texture_task *const task = &work->tasks[i];
        if (task->status == FFD_E_MEMORY)
            return ffd_fail_memory(error);
        if (task->status && !(last && last->image == task->image)) {
            first = first ? first : task;
            last = task;
            lost++;
        }
    }
    if (lost)
        ffd_log_line(log, FFD_LOG_WARNING, "grey in the picture: %zu %s, as %.100s: %.180s", lost,
                     ffd_plural(lost, "image", "images"), first->from->name, first->error.message);
    return FFD_OK;
}

/* How materials use an image: it may be two textures. */
enum { USED_AS_COLOR = 1, USED_AS_OPACITY = 2 };

static void note_use(const mesh_materials *from, const mesh_texture *of, uint8_t use, uint8_t *uses)
{
    if (of->image < from->image_count)
        uses[of->image] |= use;
}

static void find_uses(const mesh_materials *from, uint8_t *uses)
{
    for (size_t i = 0; i < from->count; i++) {
        note_use(from, &from->list[i].base, USED_AS_COLOR, uses);
        note_use(from, &from->list[i].glow, USED_AS_COLOR, uses);
        note_use(from, &from->list[i].opacity, USED_AS_OPACITY, uses);
    }
}

static void add_task(texture_work *work, const mesh_materials *from, size_t index, bool is_opacity,
                     const view_textures *t)
{
    work->tasks[work->count++] = (texture_task){.from = &from->images[index],
                                                .image = index,
                                                .is_opacity = is_opacity,
                                                .to = (is_opacity ? t->opacities : t->colors) + index};
}

ffd_status ffd_view_textures_decode(const mesh_materials *from, memory_budget *budget, int threads,
                                    const mesh_log *log, view_textures *t, ffd_error *error)
{
    texture_work work = {.tasks = ffd_alloc(2 * from->image_count, sizeof *work.tasks), .budget = budget};
    uint8_t *const uses = ffd_alloc_zero(from->image_count, 1);
    ffd_status status;
    *t = (view_textures){.colors = ffd_alloc_zero(from->image_count, sizeof *t->colors),
                         .opacities = ffd_alloc_zero(from->image_count, sizeof *t->opacities),
                         .count = from->image_count};
    TRY_END(t->colors && t->opacities && work.tasks && uses ? FFD_OK : ffd_fail_memory(error));
    find_uses(from, uses);
    for (size_t i = 0; i < from->image_count; i++) {
        if (uses[i] & USED_AS_COLOR)
            add_task(&work, from, i, false, t);
        if (uses[i] & USED_AS_OPACITY)
            add_task(&work, from, i, true, t);
    }
    TRY_END(decode_all(&work, threads, error));
    TRY_END(report(&work, log, error));
end:
    ffd_free(work.tasks);
    ffd_free(uses);
    return status;
}

void ffd_view_textures_free(view_textures *t)
{
    for (size_t i = 0; t->colors && i < t->count; i++)
        ffd_texture_free(&t->colors[i]);
    for (size_t i = 0; t->opacities && i < t->count; i++)
        ffd_texture_free(&t->opacities[i]);
    ffd_free(t->colors);
    ffd_free(t->opacities);
    *t = (view_textures){0};
}
