#include "io/gltf/read/gltf_views.h"
#include "base/memory/memory.h"
#include "mesh/meshopt/meshopt_view.h"
#include <string.h>

/* Elements may end before their view does: the view may include the padding before the next one. */
#define ALIGNMENT 4

uint32_t ffd_gltf_meshopt_value(const gltf_document *d, size_t view)
{
    const uint32_t value = d->view_values.values[view];
    const uint32_t compression = ffd_gltf_extension(d, value, "EXT_meshopt_compression");
    return compression != JSON_NONE ? compression : ffd_gltf_extension(d, value, "KHR_meshopt_compression");
}

const unsigned char *ffd_gltf_view_bytes(const gltf_document *d, size_t view)
{
    const gltf_view *v = &d->model.views[view];
    if (d->decoded_views[view])
        return d->decoded_views[view];
    if (ffd_gltf_meshopt_value(d, view) != JSON_NONE || d->buffers[v->buffer].kind == BUFFER_EMPTY)
        return NULL;
    return d->buffers[v->buffer].data + v->offset;
}

static ffd_status refuse(const gltf_document *d, uint32_t value, ffd_error *error, const char *what)
{
    return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error, "%s", what);
}

/* Returns a member that the schema has checked to be an integer; 0 if it is absent. */
static uint64_t integer(const gltf_document *d, uint32_t object, const char *key)
{
    double number = 0;
    ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, object, key), &number);
    return (uint64_t)number;
}

/* Finds a string among `count` names; returns false if it is none of them. */
static bool find_name(const gltf_document *d, uint32_t value, const char *const *names, size_t count,
                      size_t *found)
{
    for (size_t i = 0; i < count; i++)
        if (ffd_json_tree_string_is(&d->tree, value, names[i])) {
            *found = i;
            return true;
        }
    return false;
}

static ffd_status read_words(const gltf_document *d, uint32_t value, meshopt_view *view, ffd_error *error)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
    const uint32_t mode = ffd_json_tree_member(&d->tree, value, "mode");
    const uint32_t filter = ffd_json_tree_member(&d->tree, value, "filter");
    size_t found = 0;
    if (!find_name(d, mode, modes, sizeof modes / sizeof *modes, &found))
        return ffd_json_tree_fail(&d->tree, mode, d->name, FFD_E_UNSUPPORTED, error,
                                  "only the modes ATTRIBUTES, TRIANGLES and INDICES are known");
    view->mode = (meshopt_mode)found;
    found = 0;
    if (filter != JSON_NONE && !find_name(d, filter, filters, sizeof filters / sizeof *filters, &found))
        return ffd_json_tree_fail(
            &d->tree, filter, d->name, FFD_E_UNSUPPORTED, error,
            "only the filters NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL and COLOR are known");
    view->filter = (meshopt_filter)found;
    return FFD_OK;
}

/* Finds the compressed bytes of a view. */
static ffd_status find_bytes(const gltf_document *d, uint32_t value, meshopt_view *view, ffd_error *error)
{
    const uint64_t buffer = integer(d, value, "buffer");
    const uint64_t offset = integer(d, value, "byteOffset"), length = integer(d, value, "byteLength");
    if (buffer >= d->buffer_values.count || d->buffers[buffer].kind == BUFFER_EMPTY)
        return refuse(d, ffd_json_tree_member(&d->tree, value, "buffer"), error,
                      "the buffer does not exist or has no bytes");
    if (offset > d->buffers[buffer].length || length > d->buffers[buffer].length - offset)
        return refuse(d, ffd_json_tree_member(&d->tree, value, "byteLength"), error,
                      "the compressed bytes are outside their buffer");
    view->bytes = d->buffers[buffer].data + offset;
    view->size = (size_t)length;
    return FFD_OK;
}

const unsigned char *ffd_gltf_compressed_bytes(const gltf_document *d, size_t view, size_t *size)
{
    const uint32_t value = ffd_gltf_meshopt_value(d, view);
    meshopt_view found = {0};
    if (value == JSON_NONE || find_bytes(d, value, &found, NULL))
        return NULL;
    *size = found.size;
    return found.bytes;
}

/* Reads and checks the extension of view i. */
static ffd_status read_compression(const gltf_document *d, size_t i, meshopt_view *view, ffd_error *error)
{
    const uint32_t value = ffd_gltf_meshopt_value(d, i);
    const uint64_t length = d->model.views[i].length;
    *view = (meshopt_view){.count = integer(d, value, "count"), .stride = integer(d, value, "byteStride")};
    TRY(read_words(d, value, view, error));
    TRY(find_bytes(d, value, view, error));
    ffd_error problem;
    ffd_status status = ffd_meshopt_check(view, &problem);
    status = status ? status : ffd_meshopt_ready(view, &problem);
    if (status)
        return ffd_json_tree_fail(&d->tree, value, d->name, status, error, "%s", problem.message);
    const uint64_t size = view->count * view->stride;
    if (size > length || length - size >= ALIGNMENT)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "count %llu times byteStride %llu is not the bufferView's byteLength %llu",
                                  (unsigned long long)view->count, (unsigned long long)view->stride,
                                  (unsigned long long)length);
    return FFD_OK;
}

static ffd_status decode_view(gltf_document *d, size_t i, ffd_error *error)
{
    const uint32_t value = ffd_gltf_meshopt_value(d, i);
    meshopt_view view;
    ffd_error problem = {0};
    TRY(read_compression(d, i, &view, error));
    ffd_status status = ffd_budget_take(&d->base.budget, d->model.views[i].length, 1, &problem);
    if (status)
        return ffd_json_tree_fail(&d->tree, value, d->name, status, error, "%s", problem.message);
    d->decoded_views[i] = ffd_alloc_zero((size_t)d->model.views[i].length, 1);
    if (!d->decoded_views[i])
        return ffd_fail_memory(error);
    if (view.filter == MESHOPT_EXPONENTIAL) {
        d->view_exponents[i] = ffd_alloc(MESHOPT_COLUMNS, sizeof *view.exponents);
        if (!d->view_exponents[i])
            return ffd_fail_memory(error);
        memset(d->view_exponents[i], INT8_MIN, MESHOPT_COLUMNS);
        view.exponents = d->view_exponents[i];
    }
    status = ffd_meshopt_decode(&view, d->decoded_views[i], &problem);
    return status ? ffd_json_tree_fail(&d->tree, value, d->name, status, error, "%s", problem.message)
                  : FFD_OK;
}

ffd_status ffd_gltf_decode_views(gltf_document *d, ffd_error *error)
{
    d->decoded_views = ffd_alloc_zero(d->model.view_count, sizeof *d->decoded_views);
    d->view_exponents = ffd_alloc_zero(d->model.view_count, sizeof *d->view_exponents);
    if (!d->decoded_views || !d->view_exponents)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->model.view_count; i++) {
        if (ffd_gltf_meshopt_value(d, i) == JSON_NONE)
            continue;
        const ffd_status status = decode_view(d, i, error);
        /* Unsupported data is a failure only where it is used (gltf_refuse.c). */
        if (status != FFD_OK && status != FFD_E_UNSUPPORTED)
            return status;
    }
    return FFD_OK;
}

ffd_status ffd_gltf_refuse_view(const gltf_document *d, size_t view, ffd_error *error)
{
    meshopt_view unused;
    return ffd_gltf_meshopt_value(d, view) == JSON_NONE || d->decoded_views[view]
               ? FFD_OK
               : read_compression(d, view, &unused, error);
}
