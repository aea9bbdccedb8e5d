/* stl_results.c - stores the results of an STL file. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/stl/stl_document.h"
#include "io/text/vectors.h"

void ffd_stl_load(const unsigned char *bytes, double xyz[3])
{
    for (size_t a = 0; a < 3; a++)
        xyz[a] = load_float(bytes + 4 * a);
}

void ffd_stl_store(unsigned char *bytes, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        store_float(bytes + 4 * i, (float)values[i]);
}

void ffd_stl_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    const stl_document *d = ffd_stl_of(document);
    (void)part; /* the only one */
    if (!d->binary) {
        ffd_vectors_read(d->file.positions, first, count, xyz);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = first + i;
        ffd_stl_load(ffd_stl_facet(d, vertex / 3) + STL_NORMAL * (1 + vertex % 3), xyz + 3 * i);
    }
}

ffd_status ffd_stl_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    stl_document *d = (stl_document *)document;
    (void)tangents; /* STL has none */
    d->renew_normals = normals;
    if (!d->file.new_positions)
        d->file.new_positions = ffd_alloc(d->facets, 9 * sizeof *d->file.new_positions);
    if (!d->file.new_positions)
        return ffd_fail_memory(error);
    ffd_stl_read_positions(document, 0, 0, 3 * d->facets, d->file.new_positions);
    return FFD_OK;
}

void ffd_stl_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    const stl_document *d = ffd_stl_of(document);
    (void)part;
    for (size_t i = 0; i < count; i++)
        for (size_t a = 0; a < 3 && changed[i]; a++) {
            const double value = xyz[3 * i + a];
            d->file.new_positions[3 * (first + i) + a] = d->binary ? (double)(float)value : value;
        }
}
