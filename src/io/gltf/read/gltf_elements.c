#include "io/gltf/read/gltf_elements.h"
#include "base/arithmetic.h"
#include "base/little_endian.h"
#include "base/lower_bound.h"
#include "base/vector/array_kernel.h"
#include "io/gltf/read/gltf_views.h"
#include "mesh/meshopt/meshopt_view.h"
#include <math.h>
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

typedef struct number_range {
    double least, largest; /* the integers' range */
} number_range;

static number_range range_of(int component)
{
    switch (component) {
    case GLTF_I8:
        return (number_range){-128, 127};
    case GLTF_U8:
        return (number_range){0, 255};
    case GLTF_I16:
        return (number_range){-32768, 32767};
    default:
        return (number_range){0, 65535};
    }
}

static double scale_of(const gltf_accessor *accessor)
{
    return accessor->normalized ? range_of(accessor->component).largest : 1;
}

double ffd_gltf_step(const gltf_accessor *accessor)
{
    return 1 / scale_of(accessor);
}

float ffd_gltf_round(const gltf_accessor *accessor, double value)
{
    if (accessor->component == GLTF_FLOAT)
        return (float)value;
    const double scale = scale_of(accessor);
    return (float)(nearest_integer(value * scale) / scale + 0.0); /* + 0.0: integers have no -0 */
}

/* Returns the integer q that a float encodes. The float nearest to q/s gives q again: its error is 2^-24
   relative, and q is at most 65535. */
static double integer_of(const gltf_accessor *accessor, float value)
{
    return nearest_integer((double)value * scale_of(accessor));
}

bool ffd_gltf_fits(const gltf_accessor *accessor, const float *values, size_t count)
{
    if (accessor->component == GLTF_FLOAT)
        return true;
    const number_range range = range_of(accessor->component);
    const double scale = scale_of(accessor);
    for (size_t i = 0; i < count; i++) {
        const double integer = integer_of(accessor, values[i]);
        const float back = (float)(integer / scale);
        if (!(integer >= range.least && integer <= range.largest) || back < values[i] || back > values[i])
            return false;
    }
    return true;
}

static void put_integer(double integer, size_t size, unsigned char *bytes)
{
    const uint32_t bits = (uint32_t)(int32_t)integer;
    for (size_t i = 0; i < size; i++)
        bytes[i] = (unsigned char)(bits >> 8 * i);
}

void ffd_gltf_encode(const gltf_accessor *accessor, int component, const unsigned char *original,
                     const float *values, size_t components, unsigned char *element)
{
    const size_t count = (size_t)accessor->rows, size = ffd_gltf_component_size(accessor->component);
    if (component == accessor->component)
        memcpy(element, original, count * size);
    for (size_t c = 0; c < count; c++) {
        const unsigned char *at = original + c * size;
        const double old = ffd_gltf_read_number(at, accessor->component, accessor->normalized);
        const float wanted = c < components ? values[c] : (float)old;
        if (component == GLTF_FLOAT)
            store_float(element + 4 * c, wanted);
        else if (wanted < (float)old || wanted > (float)old)
            put_integer(integer_of(accessor, wanted), size, element + c * size);
    }
}

/* The distance between neighbouring numbers of an integer type (glTF 2.0, 3.11: c / 127 and so on). */
static double integer_step(const gltf_accessor *accessor)
{
    if (!accessor->normalized)
        return 1;
    switch (accessor->component) {
    case GLTF_I8:
        return 1.0 / 127;
    case GLTF_U8:
        return 1.0 / 255;
    case GLTF_I16:
        return 1.0 / 32767;
    case GLTF_U16:
        return 1.0 / 65535;
    default:
        return 1.0 / 4294967295.0;
    }
}

/* The steps of floats that meshopt's filter EXPONENTIAL has quantized. */
static void filter_steps(const gltf_document *d, size_t a, double step[3])
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const int8_t *exponents = accessor->view >= 0 ? d->view_exponents[accessor->view] : NULL;
    const size_t column = (size_t)(accessor->offset % d->layouts[a].stride) / 4;
    for (size_t c = 0; exponents && !accessor->sparse.present && c < 3 && column + c < MESHOPT_COLUMNS; c++)
        step[c] = ldexp(1, exponents[column + c]);
}

mesh_rounding ffd_gltf_rounding(const gltf_document *d, size_t a)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    mesh_rounding rounding = {{false, false, false}, {0, 0, 0}};
    const bool is_float = accessor->component == GLTF_FLOAT;
    for (int c = 0; c < 3; c++) {
        rounding.is_float[c] = is_float;
        rounding.step[c] = is_float ? d->unpacked[a].step : integer_step(accessor);
    }
    if (is_float && d->layouts[a].packing == GLTF_MESHOPT)
        filter_steps(d, a, rounding.step);
    return rounding;
}
