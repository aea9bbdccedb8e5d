#include "io/gltf/model/gltf_mixed.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/model/gltf_shown.h"
#include "io/gltf/read/gltf_read.h"
#include "mesh/mixed_faces.h"
#include <string.h>

/* Triangles that a thread searches at a time, and triangles whose indices it reads at a time. */
#define TILE ((size_t)1 << 14)
#define RUN ((size_t)1024)

/* The triangles of one primitive under one node. */
typedef struct mixed_work {
    const gltf_document *document;
    const vertex_marks *marks;
    size_t indices; /* the accessor; GLTF_NONE: no indices */
    size_t first, vertices;
    face_list *lists; /* per tile; vertex numbers are those of the document */
} mixed_work;

/* Lists the mixed triangles in [first, last), at most RUN triangles. The list fails if an index is out of
   range. */
static void search_run(const mixed_work *work, size_t first, size_t last, face_list *list)
{
    const vertex_marks own = {work->marks->bytes + work->first, work->marks->planes, work->marks->vertices};
    const size_t count = 3 * (last - first);
    uint32_t indices[3 * RUN];
    uint32_t largest = (uint32_t)(3 * last - 1);
    for (size_t i = 0; i < count && work->indices == GLTF_NONE; i++)
        indices[i] = (uint32_t)(3 * first + i);
    if (work->indices != GLTF_NONE)
        largest = ffd_gltf_read_indices(work->document, work->indices, 3 * first, count, indices);
    list->failed = list->failed || largest >= work->vertices;
    for (size_t i = 0; i < count && !list->failed; i += 3) {
        if (!ffd_marks_differ(&own, indices + i, 3))
            continue;
        for (size_t c = i; c < i + 3; c++)
            ffd_face_list_corner(list, (uint32_t)work->first + indices[c]);
        ffd_face_list_end(list, work->marks);
    }
}

static void search_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const mixed_work *const work = context;
    face_list list = {0};
    (void)worker;
    for (size_t run = first; run < last && !list.failed; run += RUN)
        search_run(work, run, last - run < RUN ? last : run + RUN, &list);
    work->lists[tile] = list;
    if (work->indices != GLTF_NONE)
        ffd_gltf_forget_elements(work->document, work->indices, 3 * first, 3 * (last - first));
}

/* Whether all vertices of a part have equal marks: its triangles need not be read then. */
static bool is_uniform(const mixed_work *work)
{
    for (size_t p = 0; p < work->marks->planes; p++) {
        const uint8_t *const marks = work->marks->bytes + p * work->marks->vertices + work->first;
        if (work->vertices > 1 && memcmp(marks, marks + 1, work->vertices - 1) != 0)
            return false;
    }
    return true;
}

/* The lists of all primitives under all nodes. */
typedef struct mixed_lists {
    face_list *lists;
    size_t count, capacity;
} mixed_lists;

static bool search(mixed_work *work, size_t triangles, mixed_lists *all)
{
    const size_t tiles = triangles / TILE + (triangles % TILE != 0);
    bool done = ffd_grow((void **)&all->lists, &all->capacity, all->count + tiles, sizeof *all->lists);
    if (!done)
        return false;
    work->lists = all->lists + all->count;
    memset(work->lists, 0, tiles * sizeof *work->lists);
    all->count += tiles;
    ffd_parallel_tiles(triangles, TILE, work->document->threads, search_tile, work);
    for (size_t t = 0; t < tiles; t++)
        done = done && !work->lists[t].failed;
    return done;
}

/* Searches a primitive under all nodes. Returns false for anything this simple search cannot handle: all
   faces must then be read. */
static bool search_primitive(mixed_work *work, const size_t *first, size_t m, size_t p, mixed_lists *all)
{
    const gltf_document *const d = work->document;
    const gltf_primitive *const primitive = &d->model.meshes[m].primitives[p];
    if (primitive->accessor[GLTF_POSITION] < 0)
        return true;
    const size_t triangles = ffd_gltf_count_triangles(d, m, p);
    if (primitive->indices >= 0 && ffd_gltf_refuse_unreadable(d, m, p, primitive->indices, NULL))
        return false;
    work->indices = primitive->indices >= 0 ? (size_t)primitive->indices : GLTF_NONE;
    for (size_t n = 0; triangles > 0 && n < d->mesh_uses[m].node_count; n++) {
        const size_t part = ffd_gltf_instances(d, m, p)[n].part[GLTF_POSITION];
        if (part == GLTF_NONE)
            return false;
        work->first = first[part];
        work->vertices = d->mesh_parts[part].vertex_count;
        if (!is_uniform(work) &&
            (primitive->mode != MODE_TRIANGLES || primitive->drawn || !search(work, triangles, all)))
            return false;
    }
    return true;
}

static void read_positions(const gltf_document *d, const size_t *first, const mesh_faces *faces)
{
    size_t part = 0;
    for (size_t v = 0; v < faces->vertex_count; v++) {
        const size_t vertex = faces->numbers[v];
        double *const xyz = faces->positions + 3 * v;
        if (d->mesh_parts[part].repeats_positions || vertex < first[part] ||
            vertex >= first[part] + d->mesh_parts[part].vertex_count)
            for (part = 0; d->mesh_parts[part].repeats_positions || vertex < first[part] ||
                           vertex >= first[part] + d->mesh_parts[part].vertex_count;)
                part++;
        ffd_gltf_read_shown(d, part, GLTF_POSITION, vertex - first[part], 1, 3, xyz);
        ffd_part_transform(&d->base, part, vertex - first[part], 1, xyz);
    }
}

static bool search_all(mixed_work *work, const size_t *first, mixed_lists *all)
{
    const gltf_model *const model = &work->document->model;
    bool plain = true;
    for (size_t m = 0; m < model->mesh_count && plain; m++)
        for (size_t p = 0; p < model->meshes[m].primitive_count && plain; p++)
            plain = search_primitive(work, first, m, p, all);
    return plain;
}

ffd_status ffd_gltf_mixed_faces(const mesh_document *document, const vertex_marks *marks, mesh_faces *faces,
                                ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    mixed_work work = {.document = d, .marks = marks};
    mixed_lists all = {0};
    size_t *first;
    ffd_status status = ffd_parts_number(document, &first, error);
    if (status)
        return status;
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    if (search_all(&work, first, &all)) {
        status = ffd_face_lists_narrow(document, all.lists, all.count, faces, error);
        if (!status)
            read_positions(d, first, faces);
    } else
        status = ffd_gltf_faces(document, faces, error);
    for (size_t l = 0; l < all.count; l++)
        ffd_free(all.lists[l].words);
    ffd_free(all.lists);
    ffd_free(first);
    return status;
}
