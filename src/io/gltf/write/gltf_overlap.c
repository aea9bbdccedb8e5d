/* gltf_overlap.c - finds bytes that several accessors share. */
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_users.h"
#include "io/gltf/write/gltf_plan.h"
#include <stdlib.h>
#include <string.h>

/* More pairs than any real file has; with more, everything counts as overlapping. */
#define MOST_PAIRS ((size_t)1 << 24)

/* A user of bytes of a buffer: elements of `size` bytes, `stride` bytes apart. */
typedef struct byte_user {
    size_t buffer, begin, end, stride, size;
    size_t accessor; /* GLTF_NONE: an image, sparse or compressed data, or unknown */
} byte_user;

typedef struct user_list {
    byte_user *users;
    size_t count, capacity;
    bool failed;
} user_list;

static void add_user(user_list *list, byte_user user)
{
    if (user.end <= user.begin)
        return;
    if (!ffd_grow((void **)&list->users, &list->capacity, list->count + 1, sizeof *list->users)) {
        list->failed = true;
        return;
    }
    list->users[list->count++] = user;
}

/* Adds the uncompressed elements that readers without Draco use. */
static void add_fallback(const gltf_view *view, user_list *list)
{
    const size_t begin = (size_t)view->offset, length = (size_t)view->length;
    add_user(list, (byte_user){(size_t)view->buffer, begin, begin + length, 0, length, GLTF_NONE});
}

static void add_accessor(const gltf_document *d, size_t a, user_list *list)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const gltf_layout *layout = &d->layouts[a];
    if (accessor->view < 0 || accessor->count == 0)
        return;
    if (layout->packing == GLTF_DRACO) {
        add_fallback(&d->model.views[accessor->view], list);
        return;
    }
    const size_t end = layout->begin + ((size_t)accessor->count - 1) * layout->stride + layout->element_size;
    add_user(list, (byte_user){(size_t)d->model.views[accessor->view].buffer, layout->begin, end,
                               layout->stride, layout->element_size, a});
}

static size_t size_member(const gltf_document *d, uint32_t object, const char *key)
{
    double number = 0;
    if (!ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, object, key), &number) ||
        !(number >= 0) || number > (double)GLTF_LARGEST_SIZE)
        return 0;
    return (size_t)number;
}

/* Adds the compressed bytes of EXT_meshopt_compression, and of any view extension that names a buffer. */
static void add_compressed(const gltf_document *d, uint32_t view, user_list *list)
{
    const json_tree *tree = &d->tree;
    const uint32_t extensions = ffd_json_tree_member(tree, view, "extensions");
    for (uint32_t v = ffd_json_tree_first(tree, extensions); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        if (ffd_json_tree_member(tree, v, "buffer") == JSON_NONE)
            continue;
        const size_t begin = size_member(d, v, "byteOffset"), length = size_member(d, v, "byteLength");
        add_user(list, (byte_user){size_member(d, v, "buffer"), begin, begin + length, 0, length, GLTF_NONE});
    }
}

/* Marks the views that hold anything but the elements of accessors. */
static void mark_other_views(const gltf_document *d, bool *others)
{
    ffd_gltf_mark_other_views(d, others);
    for (size_t a = 0; a < d->model.accessor_count; a++) {
        const gltf_sparse *const sparse = &d->model.accessors[a].sparse;
        if (sparse->present)
            others[sparse->indices_view] = others[sparse->values_view] = true;
    }
}

static void list_users(const gltf_document *d, bool *others, user_list *list)
{
    for (size_t a = 0; a < d->model.accessor_count; a++)
        add_accessor(d, a, list);
    mark_other_views(d, others);
    for (size_t v = 0; v < d->model.view_count; v++) {
        const gltf_view *view = &d->model.views[v];
        const size_t begin = (size_t)view->offset, length = (size_t)view->length;
        if (others[v])
            add_user(list, (byte_user){(size_t)view->buffer, begin, begin + length, 0, length, GLTF_NONE});
        add_compressed(d, d->view_values.values[v], list);
    }
}

static int compare_users(const void *a, const void *b)
{
    const byte_user *x = a, *y = b;
    if (x->buffer != y->buffer)
        return x->buffer < y->buffer ? -1 : 1;
    return (x->begin > y->begin) - (x->begin < y->begin);
}

/* Whether two users with overlapping ranges share a byte; x begins first. Interleaved elements do not. */
static bool share_bytes(const byte_user *x, const byte_user *y)
{
    if (x->stride == 0 || x->stride != y->stride)
        return true;
    const size_t distance = (y->begin - x->begin) % x->stride;
    return distance < x->size || distance + y->size > x->stride;
}

static bool is_candidate(const gltf_plan *plan, const byte_user *user)
{
    return user->accessor != GLTF_NONE && plan->in_place[user->accessor] != GLTF_NONE;
}

/* Whether two accessors are equal except for their indices, and get the same new content. */
static bool agree(const gltf_document *d, const gltf_plan *plan, const byte_user *x, const byte_user *y)
{
    if (!is_candidate(plan, x) || !is_candidate(plan, y) || x->begin != y->begin || x->end != y->end ||
        x->stride != y->stride || x->size != y->size)
        return false;
    const gltf_version *a = &plan->versions[plan->in_place[x->accessor]];
    const gltf_version *b = &plan->versions[plan->in_place[y->accessor]];
    const gltf_accessor *first = &d->model.accessors[x->accessor], *second = &d->model.accessors[y->accessor];
    const size_t values = (a->width ? a->width : a->components) * (size_t)first->count;
    return first->component == second->component && first->normalized == second->normalized &&
           first->rows == second->rows && first->count == second->count && a->width == b->width &&
           a->components == b->components && memcmp(a->values, b->values, values * sizeof *a->values) == 0;
}

/* Visits all pairs that share bytes. Returns whether any version was withdrawn. */
static bool take_back(const gltf_document *d, const user_list *list, gltf_plan *plan, size_t *pairs)
{
    bool changed = false;
    for (size_t i = 0; i < list->count; i++) {
        const byte_user *x = &list->users[i];
        for (size_t j = i + 1; j < list->count; j++) {
            const byte_user *y = &list->users[j];
            if (y->buffer != x->buffer || y->begin >= x->end || ++*pairs > MOST_PAIRS)
                break;
            if ((!is_candidate(plan, x) && !is_candidate(plan, y)) || !share_bytes(x, y) ||
                agree(d, plan, x, y))
                continue;
            if (x->accessor != GLTF_NONE)
                plan->in_place[x->accessor] = GLTF_NONE;
            if (y->accessor != GLTF_NONE)
                plan->in_place[y->accessor] = GLTF_NONE;
            changed = true;
        }
    }
    return changed;
}

ffd_status ffd_gltf_resolve_overlaps(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    if (plan->version_count == 0)
        return FFD_OK;
    user_list list = {0};
    bool *others = ffd_alloc_zero(d->model.view_count, sizeof *others);
    ffd_status status = FFD_OK;
    if (!others)
        TRY_END(ffd_fail_memory(error));
    list_users(d, others, &list);
    if (list.failed)
        TRY_END(ffd_fail_memory(error));
    if (list.count > 0)
        qsort(list.users, list.count, sizeof *list.users, compare_users);
    /* Withdrawing a version can end an agreement found before. */
    size_t pairs = 0;
    while (take_back(d, &list, plan, &pairs) && pairs <= MOST_PAIRS)
        ;
    if (pairs > MOST_PAIRS)
        for (size_t a = 0; a < d->model.accessor_count; a++)
            plan->in_place[a] = GLTF_NONE;
end:
    ffd_free(others);
    ffd_free(list.users);
    return status;
}
