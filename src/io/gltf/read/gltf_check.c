#include "io/gltf/read/gltf_check.h"
#include "base/text/words.h"
#include "io/gltf/read/gltf_conformance.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_drawing.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_views.h"
#include <math.h>
#include <stdio.h>

/* Bytes that an element without stored bytes takes from the memory budget: otherwise a few characters of the
   file could ask for any amount of zeros. */
#define ZERO_BYTES 4

/* Returns a member of a value, or the value if it is absent. */
static uint32_t place_of(const gltf_document *d, uint32_t value, const char *key)
{
    const uint32_t member = ffd_json_tree_member(&d->tree, value, key);
    return member == JSON_NONE ? value : member;
}

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
    return ffd_json_tree_fail(&d->tree, place_of(d, value, key), d->name, FFD_E_INVALID, error, "%s",
                              message);
}

static ffd_status check_index(const gltf_document *d, uint32_t value, const char *key, int index,
                              size_t count, const char *what, ffd_error *error)
{
    if (index >= 0 && (size_t)index < count)
        return FFD_OK;
    return refuse(d, value, key, error, "there is no %s %d%s", what, index, ffd_only(count, "").text);
}

/* Reads a view's stride from the JSON that tinygltf does not get. Some programs write 0 for none. */
static ffd_status read_stride(gltf_document *d, size_t i, ffd_error *error)
{
    const uint32_t value = ffd_json_tree_member(&d->tree, d->view_values.values[i], "byteStride");
    double number;
    if (!ffd_json_tree_number(&d->tree, value, &number))
        return FFD_OK;
    d->model.views[i].stride = (uint64_t)number;
    if (d->model.views[i].stride > 0 && d->model.views[i].stride % 4 == 0)
        return FFD_OK;
    return ffd_gltf_flaw(d, value, error, "a byteStride is a multiple of 4 from 4 to 252, not %g", number);
}

static ffd_status check_view(gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_view *view = &d->model.views[i];
    const uint32_t value = d->view_values.values[i];
    TRY(check_index(d, value, "buffer", view->buffer, d->buffer_values.count, "buffer", error));
    TRY(read_stride(d, i, error));
    const gltf_buffer *const buffer = &d->buffers[view->buffer];
    const uint64_t length = buffer->length;
    const bool is_outside = view->offset > length || view->length > length - view->offset;
    if (is_outside && buffer->flaws & BUFFER_SHORT)
        return ffd_json_tree_fail(&d->tree, d->buffer_values.values[view->buffer], d->name, FFD_E_INVALID,
                                  error, "the buffer has %zu %s, less than its byteLength %zu", buffer->size,
                                  ffd_plural(buffer->size, "byte", "bytes"), buffer->stated);
    if (is_outside)
        return refuse(d, value, "byteLength", error, "bytes %llu to %llu are outside buffer %d of %llu %s",
                      (unsigned long long)view->offset, (unsigned long long)(view->offset + view->length),
                      view->buffer, (unsigned long long)length, ffd_plural(length, "byte", "bytes"));
    return FFD_OK;
}

/* The columns of a matrix start at multiples of 4 bytes (glTF 2.0, 3.6.2.4). */
static void measure(const gltf_accessor *accessor, gltf_layout *layout)
{
    const size_t column = (size_t)accessor->rows * ffd_gltf_component_size(accessor->component);
    const size_t padded = accessor->columns > 1 ? ffd_gltf_align(column) : column;
    layout->element_size = padded * (size_t)(accessor->columns - 1) + column;
    layout->stride = padded * (size_t)accessor->columns;
}

/* Misaligned elements can be read all the same: bytes are read one by one. */
static ffd_status check_alignment(gltf_document *d, uint32_t value, uint64_t offset, uint64_t view_offset,
                                  size_t size, ffd_error *error)
{
    if (offset % size == 0 && (view_offset + offset) % size == 0)
        return FFD_OK;
    return ffd_gltf_flaw(d, place_of(d, value, "byteOffset"), error,
                         "byteOffset %llu (in a view at %llu) is not a multiple of the component's %zu bytes",
                         (unsigned long long)offset, (unsigned long long)view_offset, size);
}

static ffd_status check_range(gltf_document *d, size_t i, const gltf_view *view, ffd_error *error)
{
    const gltf_accessor *accessor = &d->model.accessors[i];
    const gltf_layout *layout = &d->layouts[i];
    const uint32_t value = d->accessor_values.values[i];
    const size_t size = ffd_gltf_component_size(accessor->component);
    if (layout->stride < layout->element_size)
        return refuse(d, value, "bufferView", error,
                      "its elements have %zu bytes, more than the byteStride %zu", layout->element_size,
                      layout->stride);
    TRY(check_alignment(d, value, accessor->offset, view->offset, size, error));
    const uint64_t needed =
        accessor->count ? accessor->offset + (accessor->count - 1) * layout->stride + layout->element_size
                        : accessor->offset;
    if (needed > view->length)
        return refuse(d, value, "count", error, "%llu %s %llu %s of bufferView %d, which has %llu",
                      (unsigned long long)accessor->count,
                      ffd_plural(accessor->count, "element needs", "elements need"),
                      (unsigned long long)needed, ffd_plural(needed, "byte", "bytes"), accessor->view,
                      (unsigned long long)view->length);
    return FFD_OK;
}

static ffd_status check_sparse_view(gltf_document *d, uint32_t value, int index, uint64_t offset,
                                    uint64_t bytes, size_t alignment, ffd_error *error)
{
    TRY(check_index(d, value, "bufferView", index, d->model.view_count, "bufferView", error));
    const gltf_view *view = &d->model.views[index];
    TRY(check_alignment(d, value, offset, view->offset, alignment, error));
    if (offset > view->length || bytes > view->length - offset)
        return refuse(d, value, "bufferView", error, "%llu %s needed of bufferView %d, which has %llu",
                      (unsigned long long)(offset + bytes),
                      ffd_plural(offset + bytes, "byte is", "bytes are"), index,
                      (unsigned long long)view->length);
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
    const uint32_t value = ffd_json_tree_member(&d->tree, d->accessor_values.values[i], "sparse");
    const uint32_t indices = ffd_json_tree_member(&d->tree, value, "indices");
    const uint32_t values = ffd_json_tree_member(&d->tree, value, "values");
    if (sparse->count > accessor->count)
        return refuse(d, value, "count", error, "the sparse count %llu is more than the accessor's %llu",
                      (unsigned long long)sparse->count, (unsigned long long)accessor->count);
    if (sparse->indices_type != GLTF_U8 && sparse->indices_type != GLTF_U16 &&
        sparse->indices_type != GLTF_U32)
        return refuse(d, indices, "componentType", error, "sparse indices cannot have component type %d",
                      sparse->indices_type);
    const size_t size = ffd_gltf_component_size(sparse->indices_type);
    TRY(check_sparse_view(d, indices, sparse->indices_view, sparse->indices_offset, sparse->count * size,
                          size, error));
    TRY(check_sparse_view(d, values, sparse->values_view, sparse->values_offset,
                          sparse->count * layout->element_size, ffd_gltf_component_size(accessor->component),
                          error));
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
        ffd_json_tree_member(&d->tree, d->accessor_values.values[i], "bufferView") != JSON_NONE) {
        TRY(check_index(d, d->accessor_values.values[i], "bufferView", accessor->view, d->model.view_count,
                        "bufferView", error));
        const gltf_view *view = &d->model.views[accessor->view];
        const unsigned char *bytes = ffd_gltf_view_bytes(d, (size_t)accessor->view);
        if (view->stride)
            layout->stride = (size_t)view->stride;
        TRY(check_range(d, i, view, error));
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

/* Checks the shapes of a primitive's attributes (tangents have 4 components) or of a morph target's (offsets
   have 3). */
static ffd_status check_shapes(const gltf_document *d, uint32_t value, int tangent_rows, const int *accessors,
                               ffd_error *error)
{
    for (int s = 0; s < GLTF_DEFORMED; s++)
        if (accessors[s] >= 0 &&
            ffd_json_tree_member(&d->tree, value, ffd_gltf_semantic_names[s]) == JSON_NONE)
            TRY(refuse(d, value, "", error, "tinygltf read a %s that it has not",
                       ffd_gltf_semantic_names[s]));
        else if (accessors[s] >= 0)
            TRY(check_shape(d, value, ffd_gltf_semantic_names[s], s == GLTF_TANGENT ? tangent_rows : 3,
                            &d->model.accessors[accessors[s]], error));
    return FFD_OK;
}

static ffd_status check_attributes(const gltf_document *d, uint32_t object, const gltf_attribute *attributes,
                                   size_t attribute_count, uint64_t *vertices, ffd_error *error)
{
    for (size_t i = 0; i < attribute_count; i++) {
        const char *key =
            attributes[i].semantic == GLTF_OTHER ? "" : ffd_gltf_semantic_names[attributes[i].semantic];
        TRY(check_index(d, object, key, attributes[i].accessor, d->model.accessor_count, "accessor", error));
        const uint64_t count = d->model.accessors[attributes[i].accessor].count;
        if (*vertices == UINT64_MAX)
            *vertices = count;
        if (count != *vertices)
            return refuse(d, object, key, error, "accessor %d has %llu %s, another attribute has %llu",
                          attributes[i].accessor, (unsigned long long)count,
                          ffd_plural(count, "element", "elements"), (unsigned long long)*vertices);
    }
    return FFD_OK;
}

/* Whether an accessor of indices without bytes of its own states others than zeros: something unknown holds
   them. */
static bool states_indices_elsewhere(const gltf_document *d, uint32_t primitive, int a, double *most)
{
    const uint32_t max = ffd_json_tree_member(&d->tree, d->accessor_values.values[a], "max");
    return d->model.accessors[a].view < 0 && !d->model.accessors[a].sparse.present &&
           !ffd_gltf_has_extension(d, primitive, "KHR_draco_mesh_compression") &&
           ffd_json_tree_number(&d->tree, ffd_json_tree_first(&d->tree, max), most) && *most > 0;
}

/* Checks the accessor of a primitive's indices. */
static ffd_status check_indices(gltf_document *d, gltf_primitive *primitive, ffd_error *error)
{
    const int index = primitive->indices;
    const uint32_t place = place_of(d, primitive->value, "indices");
    if (index < 0)
        return FFD_OK;
    if ((size_t)index >= d->model.accessor_count)
        return ffd_gltf_drop_drawing(d, primitive, place, error,
                                     "there is no accessor %d%s: what the primitive draws is not known",
                                     index, ffd_only(d->model.accessor_count, "").text);
    const gltf_accessor *indices = &d->model.accessors[index];
    double most;
    if (states_indices_elsewhere(d, primitive->value, index, &most))
        return ffd_gltf_drop_drawing(
            d, primitive, place, error,
            "accessor %d has no bytes, but its max is %g: what the primitive draws is not known", index,
            most);
    if (indices->columns * indices->rows == 1 && !indices->normalized &&
        (indices->component == GLTF_U8 || indices->component == GLTF_U16 || indices->component == GLTF_U32))
        return FFD_OK;
    return ffd_gltf_drop_drawing(d, primitive, place, error,
                                 "accessor %d does not hold indices (SCALAR of component type 5121, 5123 or "
                                 "5125): what the primitive draws is not known",
                                 index);
}

static ffd_status check_primitive(gltf_document *d, gltf_primitive *primitive, ffd_error *error)
{
    const uint32_t value = primitive->value;
    const uint32_t attributes = ffd_json_tree_member(&d->tree, value, "attributes");
    const uint32_t targets = ffd_json_tree_member(&d->tree, value, "targets");
    uint64_t vertices = UINT64_MAX;
    TRY(check_attributes(d, attributes, primitive->attributes, primitive->attribute_count, &vertices, error));
    TRY(check_attributes(d, targets, primitive->targets, primitive->target_attribute_count, &vertices,
                         error));
    TRY(check_shapes(d, attributes, 4, primitive->accessor, error));
    const int *accessors = primitive->target_accessors;
    for (uint32_t v = ffd_json_tree_first(&d->tree, targets); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v), accessors += GLTF_DEFORMED)
        TRY(check_shapes(d, v, 3, accessors, error));
    return check_indices(d, primitive, error);
}

/* In a primitive compressed by Draco, the elements of accessors without a bufferView are in the compressed
   data. */
static void mark_compressed(gltf_document *d, const gltf_primitive *primitive)
{
    if (!ffd_gltf_has_extension(d, primitive->value, "KHR_draco_mesh_compression"))
        return;
    for (size_t i = 0; i < primitive->attribute_count; i++) {
        const int accessor = primitive->attributes[i].accessor;
        if (d->model.accessors[accessor].view < 0)
            d->layouts[accessor].readable = false;
    }
    if (primitive->indices >= 0 && d->model.accessors[primitive->indices].view < 0)
        d->layouts[primitive->indices].readable = false;
}

/* Limits elements without stored bytes: a few characters can state any number of them, and visiting them
   takes time. */
static ffd_status limit_zeros(const gltf_document *d, ffd_error *error)
{
    memory_budget budget = d->base.budget;
    for (size_t i = 0; i < d->model.accessor_count; i++) {
        const gltf_accessor *accessor = &d->model.accessors[i];
        ffd_error problem = {0};
        if (accessor->view >= 0 || d->layouts[i].data || !d->layouts[i].readable)
            continue;
        const ffd_status status = ffd_budget_take(&budget, accessor->count, ZERO_BYTES, &problem);
        if (status)
            return ffd_json_tree_fail(&d->tree, d->accessor_values.values[i], d->name, status, error, "%s",
                                      problem.message);
    }
    return FFD_OK;
}

static ffd_status check_matrix(gltf_document *d, uint32_t value, const double *m, ffd_error *error)
{
    const double row[4] = {m[3], m[7], m[11], m[15] - 1};
    double largest = 0;
    for (int i = 0; i < 4; i++)
        largest = maximum_number(largest, fabs(row[i]));
    if (largest <= 0)
        return FFD_OK;
    if (largest <= LAST_ROW_TOLERANCE)
        return ffd_gltf_flaw(d, place_of(d, value, "matrix"), error,
                             "the matrix's last row differs from 0 0 0 1 by %.3g", largest);
    return refuse(d, value, "matrix", error, "the matrix's last row is %g %g %g %g, not 0 0 0 1", m[3], m[7],
                  m[11], m[15]);
}

static ffd_status check_node(gltf_document *d, size_t n, size_t skins, ffd_error *error)
{
    const gltf_node *node = &d->model.nodes[n];
    const uint32_t value = d->node_values.values[n];
    if (ffd_json_tree_member(&d->tree, value, "mesh") != JSON_NONE)
        TRY(check_index(d, value, "mesh", node->mesh, d->model.mesh_count, "mesh", error));
    if (ffd_json_tree_member(&d->tree, value, "skin") != JSON_NONE)
        TRY(check_index(d, value, "skin", node->skin, skins, "skin", error));
    for (size_t i = 0; i < node->child_count; i++)
        TRY(check_index(d, value, "children", node->children[i], d->model.node_count, "node", error));
    if (node->has_matrix)
        TRY(check_matrix(d, value, node->matrix, error));
    return FFD_OK;
}

static ffd_status check_scenes(const gltf_document *d, ffd_error *error)
{
    const uint32_t scenes = ffd_json_tree_member(&d->tree, 0, "scenes");
    uint32_t value = ffd_json_tree_first(&d->tree, scenes);
    for (size_t s = 0; s < d->model.scene_count; s++, value = ffd_json_tree_after(&d->tree, value))
        for (size_t i = 0; i < d->model.scenes[s].node_count; i++)
            TRY(check_index(d, value, "nodes", d->model.scenes[s].nodes[i], d->model.node_count, "node",
                            error));
    if (ffd_json_tree_member(&d->tree, 0, "scene") != JSON_NONE)
        TRY(check_index(d, 0, "scene", d->model.scene, d->model.scene_count, "scene", error));
    return FFD_OK;
}

ffd_status ffd_gltf_check(gltf_document *d, ffd_error *error)
{
    for (size_t i = 0; i < d->model.view_count; i++)
        TRY(check_view(d, i, error));
    TRY(ffd_gltf_decode_views(d, error));
    for (size_t i = 0; i < d->model.accessor_count; i++)
        TRY(check_accessor(d, i, error));
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        TRY(check_primitive(d, &d->model.primitives[i], error));
        mark_compressed(d, &d->model.primitives[i]);
    }
    TRY(ffd_gltf_decode_draco(d, error));
    TRY(limit_zeros(d, error));
    const uint32_t skins = ffd_json_tree_member(&d->tree, 0, "skins");
    const size_t skin_count = ffd_json_tree_count(&d->tree, skins);
    for (size_t i = 0; i < d->model.node_count; i++)
        TRY(check_node(d, i, skin_count, error));
    TRY(check_scenes(d, error));
    return ffd_gltf_note_errors(d, error);
}
