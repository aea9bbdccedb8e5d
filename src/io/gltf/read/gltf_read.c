#include "io/gltf/read/gltf_read.h"
#include "base/little_endian.h"
#include "base/lower_bound.h"
#include "base/vector/array_kernel.h"
#include "io/gltf/read/gltf_views.h"
#include <string.h>

#define LARGEST_ELEMENT 64     /* a MAT4 of floats */
#define INDICES ((size_t)1024) /* read at a time */

size_t ffd_gltf_component_size(int component)
{
    switch (component) {
    case GLTF_I8:
    case GLTF_U8:
        return 1;
    case GLTF_I16:
    case GLTF_U16:
        return 2;
    default:
        return 4;
    }
}

uint32_t ffd_gltf_read_index(const unsigned char *at, int component)
{
    if (component == GLTF_U8)
        return at[0];
    if (component == GLTF_U16)
        return at[0] | (uint32_t)at[1] << 8;
    return load_u32(at);
}

/* Normalized integers are decoded as glTF 2.0, 3.11 says. */
double ffd_gltf_read_number(const unsigned char *at, int component, bool normalized)
{
    double value, scale;
    switch (component) {
    case GLTF_I8:
        value = (signed char)at[0];
        scale = 127;
        break;
    case GLTF_U8:
        value = at[0];
        scale = 255;
        break;
    case GLTF_I16:
        value = (int16_t)(at[0] | at[1] << 8);
        scale = 32767;
        break;
    case GLTF_U16:
        value = at[0] | at[1] << 8;
        scale = 65535;
        break;
    case GLTF_U32:
        return load_u32(at);
    default:
        return load_float(at);
    }
    if (!normalized)
        return value;
    return value / scale < -1 ? -1 : value / scale;
}

static void read_element(const gltf_accessor *accessor, const unsigned char *at, size_t components,
                         double *values)
{
    const size_t size = ffd_gltf_component_size(accessor->component);
    for (size_t c = 0; c < components; c++)
        values[c] = ffd_gltf_read_number(at + c * size, accessor->component, accessor->normalized);
}

typedef struct sparse_key {
    int type; /* of the indices */
    size_t first;
} sparse_key;

static bool is_index_before(const void *index, const void *key)
{
    const sparse_key *const k = key;
    return ffd_gltf_read_index(index, k->type) < k->first;
}

/* Returns the first sparse element whose index is not below `first`. */
static uint64_t find_sparse(const gltf_sparse *sparse, const unsigned char *indices, size_t first)
{
    const sparse_key key = {sparse->indices_type, first};
    const size_t size = ffd_gltf_component_size(sparse->indices_type);
    return lower_bound(&key, indices, (size_t)sparse->count, size, is_index_before);
}

static const unsigned char *sparse_indices(const gltf_document *d, const gltf_sparse *sparse)
{
    return ffd_gltf_view_bytes(d, (size_t)sparse->indices_view) + sparse->indices_offset;
}

static const unsigned char *sparse_elements(const gltf_document *d, const gltf_sparse *sparse)
{
    return ffd_gltf_view_bytes(d, (size_t)sparse->values_view) + sparse->values_offset;
}

const unsigned char *ffd_gltf_element(const gltf_document *d, size_t a, size_t i)
{
    static const unsigned char zeros[LARGEST_ELEMENT] = {0};
    const gltf_layout *layout = &d->layouts[a];
    const gltf_sparse *sparse = &d->model.accessors[a].sparse;
    if (sparse->present) {
        const unsigned char *indices = sparse_indices(d, sparse);
        const uint64_t found = find_sparse(sparse, indices, i);
        const size_t size = ffd_gltf_component_size(sparse->indices_type);
        if (found < sparse->count && ffd_gltf_read_index(indices + found * size, sparse->indices_type) == i)
            return sparse_elements(d, sparse) + found * layout->element_size;
    }
    return layout->data ? layout->data + i * layout->stride : zeros;
}

void ffd_gltf_originals(const gltf_document *d, size_t a, size_t first, size_t count, float *values)
{
    const gltf_layout *layout = &d->layouts[a];
    const gltf_accessor *accessor = &d->model.accessors[a];
    if (accessor->component != GLTF_FLOAT || accessor->sparse.present || !layout->data) {
        for (size_t i = 0; i < count; i++)
            ffd_gltf_original(d, a, first + i, 3, values + 3 * i);
        return;
    }
    const unsigned char *at = layout->data + first * layout->stride;
    if (LITTLE_ENDIAN_MACHINE && layout->stride == 3 * sizeof *values) {
        memcpy(values, at, 3 * count * sizeof *values);
        return;
    }
    for (size_t i = 0; i < count; i++, at += layout->stride)
        for (size_t c = 0; c < 3; c++) {
            const uint32_t bits = load_u32(at + 4 * c);
            memcpy(values + 3 * i + c, &bits, sizeof bits);
        }
}

void ffd_gltf_original(const gltf_document *d, size_t a, size_t i, size_t components, float *values)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const unsigned char *element = ffd_gltf_element(d, a, i);
    if (accessor->component == GLTF_FLOAT) {
        for (size_t c = 0; c < components; c++) {
            const uint32_t bits = load_u32(element + 4 * c);
            memcpy(values + c, &bits, sizeof bits);
        }
        return;
    }
    double numbers[4];
    read_element(accessor, element, components, numbers);
    for (size_t c = 0; c < components; c++)
        values[c] = (float)numbers[c];
}

static void read_sparse(const gltf_document *d, const gltf_accessor *accessor, size_t element_size,
                        size_t first, size_t count, size_t components, double *values)
{
    const gltf_sparse *sparse = &accessor->sparse;
    const unsigned char *indices = sparse_indices(d, sparse), *elements = sparse_elements(d, sparse);
    const size_t size = ffd_gltf_component_size(sparse->indices_type);
    for (uint64_t i = find_sparse(sparse, indices, first); i < sparse->count; i++) {
        const size_t index = ffd_gltf_read_index(indices + i * size, sparse->indices_type);
        if (index - first >= count)
            return;
        read_element(accessor, elements + i * element_size, components,
                     values + (index - first) * components);
    }
}

/* The fast path for vectors of floats. */
static void read_vectors(const unsigned char *at, size_t stride, size_t count, double *xyz)
{
    if (stride == 3 * sizeof(float)) {
        ffd_array_kernel(FFD_ISA_AUTO)->read_floats(at, 3 * count, xyz);
        return;
    }
    for (size_t i = 0; i < count; i++, at += stride, xyz += 3) {
        xyz[0] = load_float(at);
        xyz[1] = load_float(at + 4);
        xyz[2] = load_float(at + 8);
    }
}

void ffd_gltf_read(const gltf_document *d, size_t a, size_t first, size_t count, size_t components,
                   double *values)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const gltf_layout *layout = &d->layouts[a];
    if (!layout->data) {
        memset(values, 0, count * components * sizeof *values);
    } else if (accessor->component == GLTF_FLOAT && components == 3) {
        read_vectors(layout->data + first * layout->stride, layout->stride, count, values);
    } else if (accessor->component == GLTF_FLOAT) {
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < components; c++)
                values[i * components + c] = load_float(layout->data + (first + i) * layout->stride + 4 * c);
    } else {
        for (size_t i = 0; i < count; i++)
            read_element(accessor, layout->data + (first + i) * layout->stride, components,
                         values + i * components);
    }
    if (accessor->sparse.present)
        read_sparse(d, accessor, layout->element_size, first, count, components, values);
}

static void read_indices(const gltf_document *d, size_t a, size_t first, size_t count, uint32_t *indices)
{
    double values[INDICES];
    for (size_t done = 0; done < count; done += INDICES) {
        const size_t size = count - done < INDICES ? count - done : INDICES;
        ffd_gltf_read(d, a, first + done, size, 1, values);
        for (size_t i = 0; i < size; i++)
            indices[done + i] = values[i] >= 0 && values[i] < UINT32_MAX ? (uint32_t)values[i] : UINT32_MAX;
    }
}

/* Converts contiguous indices of 8 or 16 bits to 32 bits, and returns the largest. */
static uint32_t widen_indices(const unsigned char *restrict at, size_t size, size_t count,
                              uint32_t *restrict indices)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < count && size == 1; i++)
        indices[i] = at[i];
    for (size_t i = 0; i < count && size == 2; i++)
        indices[i] = at[2 * i] | (uint32_t)at[2 * i + 1] << 8;
    for (size_t i = 0; i < count; i++)
        largest = indices[i] > largest ? indices[i] : largest;
    return largest;
}

uint32_t ffd_gltf_read_indices(const gltf_document *d, size_t a, size_t first, size_t count,
                               uint32_t *indices)
{
    const gltf_layout *layout = &d->layouts[a];
    const gltf_accessor *accessor = &d->model.accessors[a];
    const size_t size = ffd_gltf_component_size(accessor->component);
    const unsigned char *const at = layout->data ? layout->data + size * first : NULL;
    const bool is_plain = at && !accessor->sparse.present && layout->stride == size;
    if (is_plain && accessor->component == GLTF_U32)
        return ffd_array_kernel(FFD_ISA_AUTO)->read_u32(at, count, indices);
    if (is_plain && (accessor->component == GLTF_U16 || accessor->component == GLTF_U8))
        return widen_indices(at, size, count, indices);
    uint32_t largest = 0;
    read_indices(d, a, first, count, indices);
    for (size_t i = 0; i < count; i++)
        largest = indices[i] > largest ? indices[i] : largest;
    return largest;
}
