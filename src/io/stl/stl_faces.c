/* stl_faces.c - the faces of an STL file. Corners at the same position are one vertex of the topology, which
   would otherwise be separate triangles: the first of them represents all. */
#include "base/memory/memory.h"
#include "io/stl/stl_document.h"
#include <stdlib.h>
#include <string.h>

/* A position's bits, 0 and -0 being the same position, and the number of its vertex. */
typedef struct stl_key {
    uint64_t bits[3];
    uint32_t vertex;
} stl_key;

static int compare_positions(const stl_key *a, const stl_key *b)
{
    for (int i = 0; i < 3; i++)
        if (a->bits[i] != b->bits[i])
            return a->bits[i] < b->bits[i] ? -1 : 1;
    return 0;
}

static int compare_keys(const void *a, const void *b)
{
    const stl_key *x = a, *y = b;
    const int order = compare_positions(x, y);
    return order ? order : (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

static void fill_keys(const double *positions, size_t count, stl_key *keys)
{
    for (size_t i = 0; i < count; i++) {
        keys[i].vertex = (uint32_t)i;
        for (size_t a = 0; a < 3; a++) {
            const double value = positions[3 * i + a] + 0.0; /* -0 becomes 0 */
            memcpy(&keys[i].bits[a], &value, sizeof value);
        }
    }
}

static void join_corners(mesh_faces *faces, const stl_key *keys)
{
    uint32_t first = 0;
    for (size_t i = 0; i < faces->vertex_count; i++) {
        if (i == 0 || compare_positions(&keys[i - 1], &keys[i]) != 0)
            first = keys[i].vertex;
        else
            faces->repeated++;
        faces->corners[keys[i].vertex] = first;
    }
}

ffd_status ffd_stl_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const stl_document *d = ffd_stl_of(document);
    const size_t vertices = 3 * d->facets;
    *faces = (mesh_faces){.vertex_count = vertices, .face_count = d->facets};
    const ffd_status status = ffd_mesh_faces_make(document, faces, vertices, error);
    if (status)
        return status;
    stl_key *keys = ffd_alloc(vertices, sizeof *keys);
    if (!keys) {
        ffd_mesh_faces_free(faces);
        return ffd_fail_memory(error);
    }
    ffd_stl_read_positions(document, 0, 0, vertices, faces->positions);
    for (size_t i = 0; i <= d->facets; i++)
        faces->start[i] = 3 * i;
    fill_keys(faces->positions, vertices, keys);
    qsort(keys, vertices, sizeof *keys, compare_keys);
    join_corners(faces, keys);
    ffd_free(keys);
    return FFD_OK;
}
