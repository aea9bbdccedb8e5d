#include "io/gltf/morph/gltf_left_bytes.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/decode/gltf_read.h"
#include "io/gltf/decode/gltf_views.h"
#include "io/gltf/morph/gltf_morph_reuse.h"
#include <inttypes.h>

/* Who uses a view: nobody, only unused accessors, or others as well. */
enum { IS_FREE, IS_LEFT, IS_KEPT };

static void mark_view(int view, bool dropped, uint8_t *views)
{
    if (view >= 0 && views[view] != IS_KEPT)
        views[view] = dropped ? IS_LEFT : IS_KEPT;
}

static void mark_views(const gltf_document *d, const bool *dropped, uint8_t *views)
{
    for (size_t a = 0; a < d->model.accessor_count; a++) {
        const gltf_accessor *const accessor = &d->model.accessors[a];
        mark_view(accessor->view, dropped[a], views);
        if (!accessor->sparse.present)
            continue;
        mark_view(accessor->sparse.indices_view, dropped[a], views);
        mark_view(accessor->sparse.values_view, dropped[a], views);
    }
}

/* Returns the bytes of elements in a view, 0 if the view is compressed. */
static uint64_t plain_bytes(const gltf_document *d, int view, uint64_t count, size_t size)
{
    const bool is_plain = view >= 0 && ffd_gltf_meshopt_value(d, (size_t)view) == JSON_NONE;
    return is_plain ? count * size : 0;
}

static uint64_t accessor_bytes(const gltf_document *d, size_t a)
{
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const gltf_sparse *const sparse = &accessor->sparse;
    const size_t size = d->layouts[a].element_size;
    uint64_t bytes = plain_bytes(d, accessor->view, accessor->count, size);
    if (sparse->present)
        bytes += plain_bytes(d, sparse->values_view, sparse->count, size) +
                 plain_bytes(d, sparse->indices_view, sparse->count,
                             ffd_gltf_component_size(sparse->indices_type));
    return bytes;
}

bool ffd_gltf_count_left_bytes(const gltf_document *d, const bool *dropped, uint64_t *bytes)
{
    uint8_t *const views = ffd_alloc_zero(d->model.view_count, sizeof *views);
    *bytes = 0;
    if (!views)
        return false;
    mark_views(d, dropped, views);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (dropped[a])
            *bytes += accessor_bytes(d, a);
    for (size_t v = 0; v < d->model.view_count; v++) {
        const uint32_t packed = views[v] == IS_LEFT ? ffd_gltf_meshopt_value(d, v) : JSON_NONE;
        double length;
        if (ffd_json_span_number(&d->tree, ffd_json_span_member(&d->tree, packed, "byteLength"), &length))
            *bytes += (uint64_t)length;
    }
    ffd_free(views);
    return true;
}

ffd_status ffd_gltf_warn_of_left(const gltf_document *d, const unsigned char *before, size_t count,
                                 const char *name, const mesh_log *log, uint64_t *bytes, ffd_error *error)
{
    char shown[80];
    uint64_t left = 0;
    unsigned char *const users = ffd_gltf_count_users(d, JSON_NONE);
    bool *const dropped = ffd_alloc_zero(d->model.accessor_count, sizeof *dropped);
    for (size_t a = 0; a < count && users && dropped; a++)
        dropped[a] = before[a] > 0 && users[a] == 0;
    const bool counted = users && dropped && ffd_gltf_count_left_bytes(d, dropped, &left);
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
