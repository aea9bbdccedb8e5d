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

void ffd_stl_read_corners(const stl_document *d, size_t first, size_t count, double *xyz)
{
    if (!d->binary) {
        ffd_vectors_read(d->file.positions, first, count, xyz);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = first + i;
        ffd_stl_load(ffd_stl_facet(d, vertex / 3) + STL_NORMAL * (1 + vertex % 3), xyz + 3 * i);
    }
}

void ffd_stl_read(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                  size_t first, size_t count, double *xyz)
{
    (void)part; /* the only one, with positions only */
    (void)stream;
    (void)state;
    ffd_stl_read_corners(ffd_stl_of(document), first, count, xyz);
}

ffd_status ffd_stl_begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    stl_document *d = (stl_document *)document;
    d->renew_normals = results->directions;
    if (!d->file.new_positions)
        d->file.new_positions = ffd_alloc(d->facets, 9 * sizeof *d->file.new_positions);
    if (!d->file.new_positions)
        return ffd_fail_memory(error);
    ffd_stl_read_corners(d, 0, 3 * d->facets, d->file.new_positions);
    return FFD_OK;
}

void ffd_stl_write(mesh_document *document, size_t part, mesh_stream stream, size_t first, size_t count,
                   const double *xyz, const uint8_t *changed)
{
    const stl_document *d = ffd_stl_of(document);
    (void)part;
    (void)stream;
    for (size_t i = 0; i < count; i++)
        for (size_t a = 0; a < 3 && changed[i]; a++) {
            const double value = xyz[3 * i + a];
            d->file.new_positions[3 * (first + i) + a] = d->binary ? (double)(float)value : value;
        }
}
