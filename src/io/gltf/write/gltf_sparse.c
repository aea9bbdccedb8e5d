/* gltf_sparse.c - stores only the nonzero offsets of morph targets that are mostly 0. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_saver.h"
#include <string.h>

#define VECTOR (3 * sizeof(float))

/* The largest number of elements that 16-bit indices can number. */
#define SHORT_INDICES ((size_t)65536)

static bool is_zero(const float *xyz)
{
    static const float zero[3] = {0, 0, 0};
    return memcmp(xyz, zero, VECTOR) == 0; /* -0 is stored: sparse or not, a target has the same bits */
}

static bool may_be_sparse(const gltf_document *d, const gltf_version *version)
{
    if (!d->base.sparse_targets || version->accessor == GLTF_NONE)
        return false;
    const gltf_accessor *const accessor = &d->model.accessors[version->accessor];
    return version->accessor >= d->model.accessor_count - d->own_accessors && accessor->view < 0 &&
           version->component == GLTF_FLOAT && accessor->rows == 3;
}

static void put_index(gltf_stored_part *sparse, size_t k, size_t index)
{
    if (sparse->index_size == 2) {
        sparse->bytes[2 * k] = index & 255;
        sparse->bytes[2 * k + 1] = (unsigned char)(index >> 8 & 255);
    } else {
        store_u32(sparse->bytes + 4 * k, (uint32_t)index);
    }
}

/* Stores the nonzero vectors; their number is sparse->count. */
static ffd_status store(const float *values, size_t count, memory_budget *budget, gltf_stored_part *sparse,
                        ffd_error *error)
{
    sparse->index_size = count <= SHORT_INDICES ? 2 : 4;
    sparse->values_at = ffd_gltf_align(sparse->count * sparse->index_size);
    sparse->size = sparse->values_at + sparse->count * VECTOR;
    TRY(ffd_budget_take(budget, sparse->size, 1, error));
    sparse->bytes = ffd_alloc_zero(sparse->size, 1);
    if (!sparse->bytes)
        return ffd_fail_memory(error);
    for (size_t i = 0, k = 0; i < count; i++) {
        if (is_zero(values + 3 * i))
            continue;
        put_index(sparse, k, i);
        for (size_t c = 0; c < 3; c++)
            store_float(sparse->bytes + sparse->values_at + k * VECTOR + c * sizeof(float),
                        values[3 * i + c]);
        k++;
    }
    return FFD_OK;
}

ffd_status ffd_gltf_list_sparse(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *const d = saver->document;
    memory_budget budget = d->base.budget;
    ffd_status status = FFD_OK;
    saver->sparse = ffd_alloc_zero(saver->plan.appended_count, sizeof *saver->sparse);
    if (!saver->sparse)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < saver->plan.appended_count && !status; i++) {
        const gltf_version *const version = &saver->plan.versions[saver->plan.appended[i]];
        gltf_stored_part *const sparse = &saver->sparse[i];
        if (!may_be_sparse(d, version))
            continue;
        const size_t count = (size_t)d->model.accessors[version->accessor].count;
        for (size_t v = 0; v < count; v++)
            sparse->count += !is_zero(version->values + 3 * v);
        if (sparse->count <= count / 3)
            status = store(version->values, count, &budget, sparse, error);
    }
    return status;
}

void ffd_gltf_write_sparse(const gltf_stored_part *sparse, size_t view, byte_buffer *text)
{
    ffd_buffer_format(text,
                      "\"sparse\":{\"count\":%zu,\"indices\":{\"bufferView\":%zu,\"componentType\":%d},"
                      "\"values\":{\"bufferView\":%zu,\"byteOffset\":%zu}},",
                      sparse->count, view, sparse->index_size == 2 ? GLTF_U16 : GLTF_U32, view,
                      sparse->values_at);
}

void ffd_gltf_free_sparse(gltf_saver *saver)
{
    for (size_t i = 0; saver->sparse && i < saver->plan.appended_count; i++)
        ffd_free(saver->sparse[i].bytes);
    ffd_free(saver->sparse);
}
