#include "io/gltf/edit/gltf_left_bytes.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_users.h"
#include <inttypes.h>
#include <string.h>

/* `count` pieces of `size` bytes in a buffer, one every `stride` bytes. */
typedef struct gltf_byte_run {
    size_t buffer, begin, count, stride, size;
} gltf_byte_run;

/* A list of runs, which may overlap. All zeros: empty. The caller frees runs. */
typedef struct gltf_byte_runs {
    gltf_byte_run *runs;
    size_t count, capacity;
    bool failed; /* memory ran out: runs are missing */
} gltf_byte_runs;

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
    const json_tree *const tree = &d->tree;
    const uint32_t extensions = ffd_json_tree_member(tree, d->view_values.values[view], "extensions");
    for (uint32_t v = ffd_json_tree_first(tree, extensions); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        const size_t buffer =
            ffd_gltf_index(d, ffd_json_tree_member(tree, v, "buffer"), d->buffer_values.count);
        const size_t begin = ffd_gltf_index(d, ffd_json_tree_member(tree, v, "byteOffset"), GLTF_NONE);
        const size_t size = ffd_gltf_index(d, ffd_json_tree_member(tree, v, "byteLength"), GLTF_NONE);
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

/* Adds a whole view, and its compressed bytes. */
static void add_view_bytes(const gltf_document *d, size_t view, gltf_byte_runs *list)
{
    const gltf_view *const v = &d->model.views[view];
    add_packed(d, (int)view, 0, 1, (size_t)v->length, list);
}

/* Adds the bytes of an accessor: its elements, sparse indices and values, the compressed bytes of its views.
 */
static void add_accessor_bytes(const gltf_document *d, size_t a, gltf_byte_runs *list)
{
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const gltf_sparse *const sparse = &accessor->sparse;
    const gltf_layout *const layout = &d->layouts[a];
    if (accessor->view >= 0 && layout->packing == GLTF_DRACO) {
        add_view_bytes(d, (size_t)accessor->view, list); /* for readers that do not know it */
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

/* Counts the bytes that are in runs and not in others, each once. Returns false if memory runs out. */
static bool count_bytes_without(const gltf_document *d, const gltf_byte_runs *list,
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

/* Adds the bytes that something uses. Returns false if memory runs out. */
static bool add_used(const gltf_document *d, const unsigned char *users, gltf_byte_runs *kept)
{
    bool *const views = ffd_alloc_zero(d->model.view_count, sizeof *views);
    if (!views)
        return false;
    ffd_gltf_mark_other_views(d, views);
    for (size_t v = 0; v < d->model.view_count; v++)
        if (views[v])
            add_view_bytes(d, v, kept);
    ffd_free(views);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (users[a] > 0)
            add_accessor_bytes(d, a, kept);
    return true;
}

bool ffd_gltf_count_left_bytes(const gltf_document *d, const bool *dropped, const unsigned char *users,
                               uint64_t *bytes)
{
    gltf_byte_runs left = {0}, kept = {0};
    *bytes = 0;
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (dropped[a] && users[a] == 0)
            add_accessor_bytes(d, a, &left);
    const bool counted = (left.count == 0 && !left.failed) ||
                         (add_used(d, users, &kept) && count_bytes_without(d, &left, &kept, bytes));
    ffd_free(left.runs);
    ffd_free(kept.runs);
    return counted;
}

ffd_status ffd_gltf_warn_of_left(const gltf_document *d, const unsigned char *before, size_t count,
                                 const char *name, const mesh_log *log, uint64_t *bytes, ffd_error *error)
{
    char shown[80];
    uint64_t left = 0;
    unsigned char *const users = ffd_gltf_count_users(d, NULL);
    bool *const dropped = ffd_alloc_zero(d->model.accessor_count, sizeof *dropped);
    for (size_t a = 0; a < count && dropped; a++)
        dropped[a] = before[a] > 0;
    const bool counted = users && dropped && ffd_gltf_count_left_bytes(d, dropped, users, &left);
    ffd_free(users);
    ffd_free(dropped);
    if (!counted)
        return ffd_fail_memory(error);
    *bytes += left;
    ffd_name_shown(name, shown, sizeof shown);
    if (left > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " bytes that only the old morph target \"%s\" used stay in the file", left,
                     shown);
    return FFD_OK;
}
