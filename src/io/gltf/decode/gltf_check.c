#include "io/gltf/decode/gltf_check.h"
#include "io/gltf/decode/gltf_draco.h"
#include "io/gltf/decode/gltf_read.h"
#include "io/gltf/decode/gltf_views.h"
#include <stdarg.h>
#include <stdio.h>

/* What an element without bytes counts in the memory budget: without a limit, a few characters of the file
   could ask for any amount of zeros. */
#define ZERO_BYTES 4

/* Fails at a member of a value, or at the value if the member is absent. */
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...) FFD_PRINTF(5, 6);
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const uint32_t member = ffd_json_span_member(&d->tree, value, key);
    return ffd_json_span_fail(&d->tree, member == JSON_NONE ? value : member, d->name, FFD_E_INVALID, error,
                              "%s", message);
}

static ffd_status check_index(const gltf_document *d, uint32_t value, const char *key, int index,
                              size_t count, const char *what, ffd_error *error)
{
    if (index >= 0 && (size_t)index < count)
        return FFD_OK;
    return refuse(d, value, key, error, "there is no %s %d, only %zu", what, index, count);
}

static ffd_status check_view(const gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_view *view = &d->model.views[i];
    const uint32_t value = d->view_values.values[i];
    const ffd_status status =
        check_index(d, value, "buffer", view->buffer, d->buffer_values.count, "buffer", error);
    if (status)
        return status;
    const uint64_t length = d->buffers[view->buffer].length;
    if (view->offset > length || view->length > length - view->offset)
        return refuse(d, value, "byteLength", error, "bytes %llu to %llu are outside buffer %d of %llu bytes",
                      (unsigned long long)view->offset, (unsigned long long)(view->offset + view->length),
                      view->buffer, (unsigned long long)length);
    return FFD_OK;
}

/* Columns of a matrix start at multiples of 4 bytes (glTF 2.0, 3.6.2.4). */
static void measure(const gltf_accessor *accessor, gltf_layout *layout)
{
    const size_t column = (size_t)accessor->rows * ffd_gltf_component_size(accessor->component);
    const size_t padded = accessor->columns > 1 ? ffd_gltf_align(column) : column;
    layout->element_size = padded * (size_t)(accessor->columns - 1) + column;
    layout->stride = padded * (size_t)accessor->columns;
}

static ffd_status check_range(const gltf_document *d, size_t i, const gltf_view *view, ffd_error *error)
{
    const gltf_accessor *accessor = &d->model.accessors[i];
    const gltf_layout *layout = &d->layouts[i];
    const uint32_t value = d->accessor_values.values[i];
    const size_t size = ffd_gltf_component_size(accessor->component);
    if (layout->stride < layout->element_size)
        return refuse(d, value, "bufferView", error,
                      "its elements have %zu bytes, more than the byteStride %zu", layout->element_size,
                      layout->stride);
    if (accessor->offset % size || (view->offset + accessor->offset) % size)
        return refuse(d, value, "byteOffset", error,
                      "byteOffset %llu (in a view at %llu) is not a multiple of the component's %zu bytes",
                      (unsigned long long)accessor->offset, (unsigned long long)view->offset, size);
    const uint64_t needed =
        accessor->count ? accessor->offset + (accessor->count - 1) * layout->stride + layout->element_size
                        : accessor->offset;
    if (needed > view->length)
        return refuse(d, value, "count", error,
                      "%llu elements need %llu bytes of bufferView %d, which has %llu",
                      (unsigned long long)accessor->count, (unsigned long long)needed, accessor->view,
                      (unsigned long long)view->length);
    return FFD_OK;
}

static ffd_status check_sparse_view(const gltf_document *d, uint32_t value, int index, uint64_t offset,
                                    uint64_t bytes, size_t alignment, ffd_error *error)
{
    const ffd_status status =
        check_index(d, value, "bufferView", index, d->model.view_count, "bufferView", error);
    if (status)
        return status;
    const gltf_view *view = &d->model.views[index];
    if ((view->offset + offset) % alignment)
        return refuse(d, value, "byteOffset", error,
                      "byteOffset %llu is not a multiple of the component's %zu bytes",
                      (unsigned long long)offset, alignment);
    if (offset > view->length || bytes > view->length - offset)
        return refuse(d, value, "bufferView", error, "%llu bytes are needed of bufferView %d, which has %llu",
                      (unsigned long long)(offset + bytes), index, (unsigned long long)view->length);
    return FFD_OK;
}

static ffd_status check_sparse_indices(const gltf_document *d, const gltf_accessor *accessor, uint32_t value,
                                       ffd_error *error)
{
    const gltf_sparse *sparse = &accessor->sparse;
    const unsigned char *at = ffd_gltf_view_bytes(d, (size_t)sparse->indices_view);
    if (!at)
        return FFD_OK;
    at += sparse->indices_offset;
    const size_t size = ffd_gltf_component_size(sparse->indices_type);
    for (uint64_t i = 0; i < sparse->count; i++) {
        const uint32_t index = ffd_gltf_read_index(at + i * size, sparse->indices_type);
        if (index >= accessor->count)
            return refuse(d, value, "indices", error, "sparse index %lu is not below the count %llu",
                          (unsigned long)index, (unsigned long long)accessor->count);
        if (i > 0 && index <= ffd_gltf_read_index(at + (i - 1) * size, sparse->indices_type))
            return refuse(d, value, "indices", error, "sparse index %lu is not above the one before it",
                          (unsigned long)index);
    }
    return FFD_OK;
}

static ffd_status check_sparse(gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_accessor *accessor = &d->model.accessors[i];
    const gltf_sparse *sparse = &accessor->sparse;
    gltf_layout *layout = &d->layouts[i];
    const uint32_t value = ffd_json_span_member(&d->tree, d->accessor_values.values[i], "sparse");
    const uint32_t indices = ffd_json_span_member(&d->tree, value, "indices");
    const uint32_t values = ffd_json_span_member(&d->tree, value, "values");
    if (sparse->count > accessor->count)
        return refuse(d, value, "count", error, "%llu sparse elements are more than the accessor's %llu",
                      (unsigned long long)sparse->count, (unsigned long long)accessor->count);
    if (sparse->indices_type != GLTF_U8 && sparse->indices_type != GLTF_U16 &&
        sparse->indices_type != GLTF_U32)
        return refuse(d, indices, "componentType", error, "sparse indices cannot have component type %d",
                      sparse->indices_type);
    const size_t size = ffd_gltf_component_size(sparse->indices_type);
    ffd_status status = check_sparse_view(d, indices, sparse->indices_view, sparse->indices_offset,
                                          sparse->count * size, size, error);
    if (status == FFD_OK)
        status = check_sparse_view(d, values, sparse->values_view, sparse->values_offset,
                                   sparse->count * layout->element_size,
                                   ffd_gltf_component_size(accessor->component), error);
    if (status)
        return status;
    layout->readable = layout->readable && ffd_gltf_view_bytes(d, (size_t)sparse->indices_view) &&
                       ffd_gltf_view_bytes(d, (size_t)sparse->values_view);
    return check_sparse_indices(d, accessor, value, error);
}

static ffd_status check_accessor(gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_accessor *accessor = &d->model.accessors[i];
    gltf_layout *layout = &d->layouts[i];
    measure(accessor, layout);
    layout->readable = true; /* zeros, unless it has a view */
    if (accessor->view >= 0 ||
        ffd_json_span_member(&d->tree, d->accessor_values.values[i], "bufferView") != JSON_NONE) {
        ffd_status status = check_index(d, d->accessor_values.values[i], "bufferView", accessor->view,
                                        d->model.view_count, "bufferView", error);
        if (status)
            return status;
        const gltf_view *view = &d->model.views[accessor->view];
        const unsigned char *bytes = ffd_gltf_view_bytes(d, (size_t)accessor->view);
        if (view->stride)
            layout->stride = (size_t)view->stride;
        status = check_range(d, i, view, error);
        if (status)
            return status;
        if (ffd_gltf_meshopt_value(d, (size_t)accessor->view) != JSON_NONE)
            layout->packing = GLTF_MESHOPT;
        layout->readable = bytes != NULL;
        layout->begin = (size_t)(view->offset + accessor->offset);
        layout->data = bytes ? bytes + accessor->offset : NULL;
    }
    return accessor->sparse.present ? check_sparse(d, i, error) : FFD_OK;
}

/* Checks that an attribute has the type that glTF 2.0 (3.7.2) and KHR_mesh_quantization allow. */
static ffd_status check_shape(const gltf_document *d, uint32_t value, const char *key, int rows,
                              const gltf_accessor *accessor, ffd_error *error)
{
    if (accessor->columns != 1 || accessor->rows != rows)
        return refuse(d, value, key, error, "its accessor is not a VEC%d", rows);
    if (accessor->component == GLTF_U32)
        return refuse(d, value, key, error, "its accessor has component type %d", accessor->component);
    return FFD_OK;
}

/* Checks those of a primitive, whose tangents have 4 components, or of a morph target, whose offsets
   have 3. */
static ffd_status check_shapes(const gltf_document *d, uint32_t value, int tangent_rows, const int *accessors,
                               ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (int s = 0; s < GLTF_DEFORMED && status == FFD_OK; s++)
        if (accessors[s] >= 0)
            status = check_shape(d, value, ffd_gltf_semantic_names[s], s == GLTF_TANGENT ? tangent_rows : 3,
                                 &d->model.accessors[accessors[s]], error);
    return status;
}

static ffd_status check_attributes(const gltf_document *d, uint32_t object, const gltf_attribute *attributes,
                                   size_t attribute_count, uint64_t *vertices, ffd_error *error)
{
    for (size_t i = 0; i < attribute_count; i++) {
        const char *key =
            attributes[i].semantic == GLTF_OTHER ? "" : ffd_gltf_semantic_names[attributes[i].semantic];
        const ffd_status status =
            check_index(d, object, key, attributes[i].accessor, d->model.accessor_count, "accessor", error);
        if (status)
            return status;
        const uint64_t count = d->model.accessors[attributes[i].accessor].count;
        if (*vertices == UINT64_MAX)
            *vertices = count;
        if (count != *vertices)
            return refuse(d, object, key, error, "accessor %d has %llu elements, another attribute has %llu",
                          attributes[i].accessor, (unsigned long long)count, (unsigned long long)*vertices);
    }
    return FFD_OK;
}

static ffd_status check_primitive(const gltf_document *d, size_t mesh, size_t p, uint32_t value,
                                  ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[mesh].primitives[p];
    const uint32_t attributes = ffd_json_span_member(&d->tree, value, "attributes");
    const uint32_t targets = ffd_json_span_member(&d->tree, value, "targets");
    uint64_t vertices = UINT64_MAX;
    ffd_status status =
        check_attributes(d, attributes, primitive->attributes, primitive->attribute_count, &vertices, error);
    if (status == FFD_OK)
        status = check_attributes(d, targets, primitive->targets, primitive->target_attribute_count,
                                  &vertices, error);
    if (status == FFD_OK)
        status = check_shapes(d, attributes, 4, primitive->accessor, error);
    const int *accessors = primitive->target_accessors;
    for (uint32_t v = ffd_json_span_first(&d->tree, targets); v != JSON_NONE && status == FFD_OK;
         v = ffd_json_span_after(&d->tree, v), accessors += GLTF_DEFORMED)
        status = check_shapes(d, v, 3, accessors, error);
    if (status || ffd_json_span_member(&d->tree, value, "indices") == JSON_NONE)
        return status;
    status = check_index(d, value, "indices", primitive->indices, d->model.accessor_count, "accessor", error);
    if (status)
        return status;
    const gltf_accessor *indices = &d->model.accessors[primitive->indices];
    if (indices->columns * indices->rows != 1 || indices->normalized ||
        (indices->component != GLTF_U8 && indices->component != GLTF_U16 && indices->component != GLTF_U32))
        return refuse(d, value, "indices", error,
                      "accessor %d does not hold indices (SCALAR of component type 5121, 5123 or 5125)",
                      primitive->indices);
    return FFD_OK;
}

/* In a primitive compressed by Draco, accessors without a bufferView are in the compressed data. */
static void mark_compressed(gltf_document *d, size_t mesh, size_t p, uint32_t value)
{
    const gltf_primitive *primitive = &d->model.meshes[mesh].primitives[p];
    if (!ffd_gltf_has_extension(d, value, "KHR_draco_mesh_compression"))
        return;
    for (size_t i = 0; i < primitive->attribute_count; i++) {
        const int accessor = primitive->attributes[i].accessor;
        if (d->model.accessors[accessor].view < 0)
            d->layouts[accessor].readable = false;
    }
    if (primitive->indices >= 0 && d->model.accessors[primitive->indices].view < 0)
        d->layouts[primitive->indices].readable = false;
}

/* A few bytes can state any number of elements without bytes of their own, and visiting them takes
   time. */
static ffd_status limit_zeros(const gltf_document *d, ffd_error *error)
{
    memory_budget budget = d->base.budget;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->model.accessor_count && status == FFD_OK; i++) {
        const gltf_accessor *accessor = &d->model.accessors[i];
        ffd_error problem = {0};
        if (accessor->view >= 0 || d->layouts[i].data || !d->layouts[i].readable)
            continue;
        status = ffd_budget_take(&budget, accessor->count, ZERO_BYTES, &problem);
        if (status)
            ffd_json_span_fail(&d->tree, d->accessor_values.values[i], d->name, status, error, "%s",
                               problem.message);
    }
    return status;
}

static ffd_status check_mesh(gltf_document *d, size_t m, ffd_error *error)
{
    ffd_status status = FFD_OK;
    size_t p = 0;
    const uint32_t primitives = ffd_json_span_member(&d->tree, d->mesh_values.values[m], "primitives");
    for (uint32_t v = ffd_json_span_first(&d->tree, primitives); v != JSON_NONE && status == FFD_OK;
         v = ffd_json_span_after(&d->tree, v), p++) {
        status = check_primitive(d, m, p, v, error);
        if (status == FFD_OK)
            mark_compressed(d, m, p, v);
    }
    return status;
}

static ffd_status check_node(const gltf_document *d, size_t n, size_t skins, ffd_error *error)
{
    const gltf_node *node = &d->model.nodes[n];
    const uint32_t value = d->node_values.values[n];
    ffd_status status = FFD_OK;
    if (ffd_json_span_member(&d->tree, value, "mesh") != JSON_NONE)
        status = check_index(d, value, "mesh", node->mesh, d->model.mesh_count, "mesh", error);
    if (status == FFD_OK && ffd_json_span_member(&d->tree, value, "skin") != JSON_NONE)
        status = check_index(d, value, "skin", node->skin, skins, "skin", error);
    for (size_t i = 0; i < node->child_count && status == FFD_OK; i++)
        status = check_index(d, value, "children", node->children[i], d->model.node_count, "node", error);
    const double *m = node->matrix;
    if (status == FFD_OK && node->has_matrix &&
        (m[3] < 0 || m[3] > 0 || m[7] < 0 || m[7] > 0 || m[11] < 0 || m[11] > 0 || m[15] < 1 || m[15] > 1))
        status = refuse(d, value, "matrix", error, "the matrix's last row is %g %g %g %g, not 0 0 0 1", m[3],
                        m[7], m[11], m[15]);
    return status;
}

static ffd_status check_scenes(const gltf_document *d, ffd_error *error)
{
    const uint32_t scenes = ffd_json_span_member(&d->tree, 0, "scenes");
    ffd_status status = FFD_OK;
    uint32_t value = ffd_json_span_first(&d->tree, scenes);
    for (size_t s = 0; s < d->model.scene_count; s++, value = ffd_json_span_after(&d->tree, value))
        for (size_t i = 0; i < d->model.scenes[s].node_count && status == FFD_OK; i++)
            status = check_index(d, value, "nodes", d->model.scenes[s].nodes[i], d->model.node_count, "node",
                                 error);
    if (status == FFD_OK && ffd_json_span_member(&d->tree, 0, "scene") != JSON_NONE)
        status = check_index(d, 0, "scene", d->model.scene, d->model.scene_count, "scene", error);
    return status;
}

ffd_status ffd_gltf_check(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->model.view_count && status == FFD_OK; i++)
        status = check_view(d, i, error);
    if (status == FFD_OK)
        status = ffd_gltf_decode_views(d, error);
    for (size_t i = 0; i < d->model.accessor_count && status == FFD_OK; i++)
        status = check_accessor(d, i, error);
    for (size_t i = 0; i < d->model.mesh_count && status == FFD_OK; i++)
        status = check_mesh(d, i, error);
    if (status == FFD_OK)
        status = ffd_gltf_decode_draco(d, error);
    if (status == FFD_OK)
        status = limit_zeros(d, error);
    const uint32_t skins = ffd_json_span_member(&d->tree, 0, "skins");
    const size_t skin_count = skins == JSON_NONE ? 0 : d->tree.values[skins].count;
    for (size_t i = 0; i < d->model.node_count && status == FFD_OK; i++)
        status = check_node(d, i, skin_count, error);
    return status ? status : check_scenes(d, error);
}
