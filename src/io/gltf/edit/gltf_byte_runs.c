#include "io/gltf/edit/gltf_byte_runs.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_read.h"
#include <string.h>

/* Bytes of a buffer that are marked at a time. */
#define WINDOW ((size_t)1 << 20)

/* Who uses a byte. */
enum { IS_FREE, IS_OURS, IS_OTHERS };

/* Adds a run, cut to the bytes that the buffer has: an unknown extension may name any. */
static void add_run(const gltf_document *d, gltf_byte_run run, gltf_byte_runs *list)
{
    const size_t length = d->buffers[run.buffer].kind == BUFFER_EMPTY ? 0 : d->buffers[run.buffer].length;
    if (run.count == 0 || run.size == 0 || run.begin >= length)
        return;
    if (run.stride == run.size) {
        run.size = run.stride = run.count * run.size;
        run.count = 1;
    }
    if (run.count == 1 && run.size > length - run.begin)
        run.size = run.stride = length - run.begin;
    if (!ffd_grow((void **)&list->runs, &list->capacity, list->count + 1, sizeof *list->runs)) {
        list->failed = true;
        return;
    }
    list->runs[list->count++] = run;
}

static void add_bytes(const gltf_document *d, size_t buffer, size_t begin, size_t size, gltf_byte_runs *list)
{
    add_run(d, (gltf_byte_run){buffer, begin, 1, size, size}, list);
}

/* Adds the compressed bytes of a view: of EXT_meshopt_compression, and of any extension that names a buffer.
 */
static void add_compressed(const gltf_document *d, size_t view, gltf_byte_runs *list)
{
    const json_span *const tree = &d->tree;
    const uint32_t extensions = ffd_json_span_member(tree, d->view_values.values[view], "extensions");
    for (uint32_t v = ffd_json_span_first(tree, extensions); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        const size_t buffer =
            ffd_gltf_index(d, ffd_json_span_member(tree, v, "buffer"), d->buffer_values.count);
        const size_t begin = ffd_gltf_index(d, ffd_json_span_member(tree, v, "byteOffset"), GLTF_NONE);
        const size_t size = ffd_gltf_index(d, ffd_json_span_member(tree, v, "byteLength"), GLTF_NONE);
        if (buffer != GLTF_NONE && size != GLTF_NONE)
            add_bytes(d, buffer, begin == GLTF_NONE ? 0 : begin, size, list);
    }
}

/* Adds elements that follow each other in a view from an offset on. */
static void add_packed(const gltf_document *d, int view, uint64_t offset, uint64_t count, size_t size,
                       gltf_byte_runs *list)
{
    const gltf_view *const v = &d->model.views[view];
    add_bytes(d, (size_t)v->buffer, (size_t)(v->offset + offset), (size_t)count * size, list);
    add_compressed(d, (size_t)view, list);
}

void ffd_gltf_add_accessor_bytes(const gltf_document *d, size_t a, gltf_byte_runs *list)
{
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const gltf_sparse *const sparse = &accessor->sparse;
    const gltf_layout *const layout = &d->layouts[a];
    if (accessor->view >= 0 && layout->packing == GLTF_DRACO) {
        ffd_gltf_add_view_bytes(d, (size_t)accessor->view, list); /* for readers that do not know it */
    } else if (accessor->view >= 0) {
        const size_t buffer = (size_t)d->model.views[accessor->view].buffer;
        add_run(d,
                (gltf_byte_run){buffer, layout->begin, (size_t)accessor->count, layout->stride,
                                layout->element_size},
                list);
        add_compressed(d, (size_t)accessor->view, list);
    }
    if (!sparse->present)
        return;
    add_packed(d, sparse->indices_view, sparse->indices_offset, sparse->count,
               ffd_gltf_component_size(sparse->indices_type), list);
    add_packed(d, sparse->values_view, sparse->values_offset, sparse->count, layout->element_size, list);
}

void ffd_gltf_add_view_bytes(const gltf_document *d, size_t view, gltf_byte_runs *list)
{
    const gltf_view *const v = &d->model.views[view];
    add_packed(d, (int)view, 0, 1, (size_t)v->length, list);
}

/* Marks the bytes of a run that are in [begin, end). Returns whether there are any. */
static bool mark_run(const gltf_byte_run *run, size_t begin, size_t end, uint8_t owner, uint8_t *marks)
{
    bool any = false;
    for (size_t i = begin > run->begin ? (begin - run->begin) / run->stride : 0; i < run->count; i++) {
        const size_t at = run->begin + i * run->stride;
        if (at >= end)
            break;
        const size_t from = at > begin ? at : begin, to = at + run->size < end ? at + run->size : end;
        if (from >= to)
            continue;
        memset(marks + (from - begin), owner, to - from);
        any = true;
    }
    return any;
}

static bool mark_runs(const gltf_byte_runs *list, size_t buffer, size_t begin, size_t end, uint8_t owner,
                      uint8_t *marks)
{
    bool any = false;
    for (size_t i = 0; i < list->count; i++)
        if (list->runs[i].buffer == buffer)
            any = mark_run(&list->runs[i], begin, end, owner, marks) || any;
    return any;
}

/* Counts the bytes in [begin, end) of a buffer. */
static uint64_t count_window(const gltf_byte_runs *list, const gltf_byte_runs *others, size_t buffer,
                             size_t begin, size_t end, uint8_t *marks)
{
    uint64_t count = 0;
    memset(marks, IS_FREE, end - begin);
    if (!mark_runs(list, buffer, begin, end, IS_OURS, marks))
        return 0;
    mark_runs(others, buffer, begin, end, IS_OTHERS, marks);
    for (size_t i = 0; i < end - begin; i++)
        count += marks[i] == IS_OURS;
    return count;
}

/* Returns the end of the last run in a buffer. */
static size_t end_of_runs(const gltf_byte_runs *list, size_t buffer)
{
    size_t end = 0;
    for (size_t i = 0; i < list->count; i++) {
        const gltf_byte_run *const run = &list->runs[i];
        const size_t last = run->begin + (run->count - 1) * run->stride + run->size;
        if (run->buffer == buffer && last > end)
            end = last;
    }
    return end;
}

bool ffd_gltf_count_bytes_without(const gltf_document *d, const gltf_byte_runs *list,
                                  const gltf_byte_runs *others, uint64_t *bytes)
{
    uint8_t *const marks = ffd_alloc(WINDOW, 1);
    *bytes = 0;
    for (size_t b = 0; marks && b < d->buffer_values.count; b++) {
        const size_t end = end_of_runs(list, b);
        for (size_t begin = 0; begin < end; begin += WINDOW)
            *bytes +=
                count_window(list, others, b, begin, end - begin > WINDOW ? begin + WINDOW : end, marks);
    }
    ffd_free(marks);
    return marks && !list->failed && !others->failed;
}
