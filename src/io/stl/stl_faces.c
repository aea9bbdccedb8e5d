/* stl_faces.c - the faces of an STL file. Corners at the same position count as one vertex, because otherwise
   the topology would be that of separate triangles. The first corner there represents all. */
#include "base/memory/memory.h"
#include "base/system/sort.h"
#include "io/stl/stl_document.h"
#include "mesh/mixed_faces.h"
#include "mesh/positions.h"
#include <string.h>

/* The bits of a position (-0 becomes 0), and the number of its vertex. */
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

ffd_status ffd_stl_faces(const mesh_document *document, mesh_state state, mesh_faces *faces, ffd_error *error)
{
    const stl_document *d = ffd_stl_of(document);
    const size_t vertices = 3 * d->facets;
    (void)state;
    *faces = (mesh_faces){.vertex_count = vertices, .face_count = d->facets};
    TRY(ffd_mesh_faces_make(document, faces, vertices, error));
    stl_key *keys = ffd_alloc(vertices, sizeof *keys);
    if (!keys) {
        ffd_mesh_faces_free(faces);
        return ffd_fail_memory(error);
    }
    ffd_stl_read_corners(d, 0, vertices, faces->positions);
    for (size_t i = 0; i <= d->facets; i++)
        faces->start[i] = 3 * i;
    fill_keys(faces->positions, vertices, keys);
    const ffd_status status = ffd_sort(keys, vertices, sizeof *keys, compare_keys, error);
    if (status)
        ffd_mesh_faces_free(faces);
    else
        join_corners(faces, keys);
    ffd_free(keys);
    return status;
}

/* Whether a vertex has any mark. */
static bool is_marked(const vertex_marks *marks, size_t vertex)
{
    unsigned any = 0;
    for (size_t p = 0; p < marks->planes; p++)
        any |= marks->bytes[p * marks->vertices + vertex];
    return any != 0;
}

/* Replaces each marked corner by the first vertex at its position, as in the list of all faces. Edges are
   determined by marked corners only. */
static ffd_status join_marked(const stl_document *d, const vertex_marks *marks, mesh_faces *faces,
                              ffd_error *error)
{
    const size_t corners = faces->start[faces->face_count];
    position_table table;
    TRY(ffd_budget_check(&d->file.base.budget, corners, POSITION_TABLE_BYTES, error));
    TRY(ffd_positions_begin(&table, faces->positions, corners, error));
    for (size_t c = 0; c < corners; c++)
        if (is_marked(marks, faces->corners[c]))
            ffd_positions_add(&table, faces->corners[c]);
    for (size_t v = 0; v < marks->vertices; v++) {
        double position[3];
        if (!is_marked(marks, v))
            continue;
        ffd_stl_read_corners(d, v, 1, position);
        uint32_t *const first = ffd_positions_at(&table, position);
        if (*first == UINT32_MAX || *first <= v)
            continue;
        memcpy(faces->positions + 3 * v, position, sizeof position);
        *first = (uint32_t)v;
    }
    for (size_t c = 0; c < corners; c++)
        if (is_marked(marks, faces->corners[c]))
            faces->corners[c] = ffd_positions_add(&table, faces->corners[c]);
    ffd_positions_end(&table);
    return FFD_OK;
}

ffd_status ffd_stl_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                               mesh_faces *faces, ffd_error *error)
{
    const stl_document *d = ffd_stl_of(document);
    face_list list = {0};
    (void)state;
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    for (uint32_t first = 0; first < marks->vertices; first += 3) {
        const uint32_t corners[3] = {first, first + 1, first + 2};
        if (!ffd_marks_differ(marks, corners, 3))
            continue;
        for (size_t c = 0; c < 3; c++)
            ffd_face_list_corner(&list, corners[c]);
        ffd_face_list_end(&list, marks);
    }
    ffd_status status = ffd_face_lists_join(document, &list, 1, faces, error);
    ffd_free(list.words);
    TRY(status);
    ffd_file_document_fill_positions(&d->file, faces);
    status = join_marked(d, marks, faces, error);
    if (status)
        ffd_mesh_faces_free(faces);
    return status;
}
