#include "job/pass/cut_faces.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "job/chain/nearest_faces.h"
#include "job/pass/pass.h"
#include "mesh/mixed_faces.h"
#include <stdatomic.h>
#include <string.h>

/* Vertices for which a thread looks for the nearest border point at a time. */
#define NEAREST_TILE 64

/* What is known of a link. */
typedef struct found_cut {
    atomic_uint faces;
    atomic_ullong vertices;
} found_cut;

/* Scratch of a thread. */
typedef struct cut_worker {
    ffd_status status;
    ffd_error error;
} cut_worker;

typedef struct cut_search {
    const mesh_pass *pass;
    uint8_t *places;   /* of each vertex of the document: PASS_INSIDE, ..; LISTED */
    double *positions; /* 3 a vertex of the document, as it reaches the link; NULL: as in faces */
    mesh_faces faces;
    uint32_t *listed; /* list_count vertices of faces: outside, with a neighbour inside */
    size_t list_count, list_capacity;
    found_cut *found; /* of the link; of blocks an element for each */
    cut_worker *workers;
} cut_search;

/* In place of PASS_OUTSIDE: it is listed. */
#define LISTED 3

static void note(void *context, size_t link, unsigned faces)
{
    const cut_search *const search = context;
    found_cut *const found = &search->found[search->pass->chain->blocks ? link : 0];
    atomic_fetch_or(&found->faces, faces);
    atomic_fetch_add(&found->vertices, 1);
}

static ffd_status look(cut_search *search, uint32_t vertex, ffd_error *error)
{
    const mesh_pass *const pass = search->pass;
    const double *const p =
        search->positions ? search->positions + 3 * (size_t)ffd_faces_document_vertex(&search->faces, vertex)
                          : search->faces.positions + 3 * (size_t)vertex;
    TRY(ffd_deadline_check(error));
    return ffd_nearest_faces(pass->chain, pass->links, p, note, search, error);
}

static void look_at_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    cut_search *const search = context;
    cut_worker *const own = &search->workers[worker];
    (void)tile;
    for (size_t i = first; i < last && !own->status; i++)
        own->status = look(search, search->listed[i], &own->error);
}

/* Finds the nearest border points of the listed vertices. */
static ffd_status look_at_all(cut_search *search, ffd_error *error)
{
    const int threads = search->pass->threads;
    search->workers = ffd_alloc_zero((size_t)threads, sizeof *search->workers);
    if (!search->workers)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(search->list_count, NEAREST_TILE, threads, look_at_tile, search);
    for (int i = 0; i < threads; i++)
        if (search->workers[i].status) {
            if (error)
                *error = search->workers[i].error;
            return search->workers[i].status;
        }
    return FFD_OK;
}

/* Lists an end of an edge if it is outside and the other one is inside. */
static ffd_status list_end(cut_search *search, uint32_t end, uint32_t other, ffd_error *error)
{
    uint8_t *const place = &search->places[ffd_faces_document_vertex(&search->faces, end)];
    if (*place != PASS_OUTSIDE ||
        search->places[ffd_faces_document_vertex(&search->faces, other)] != PASS_INSIDE)
        return FFD_OK;
    if (!ffd_grow((void **)&search->listed, &search->list_capacity, search->list_count + 1,
                  sizeof *search->listed))
        return ffd_fail_memory(error);
    search->listed[search->list_count++] = end;
    *place = LISTED;
    return FFD_OK;
}

static ffd_status list_ends(cut_search *search, ffd_error *error)
{
    const mesh_faces *const faces = &search->faces;
    for (size_t f = 0; f < faces->face_count; f++) {
        const size_t first = faces->start[f], end = faces->start[f + 1];
        for (size_t i = first; i < end; i++) {
            const uint32_t a = faces->corners[i], b = faces->corners[i + 1 < end ? i + 1 : first];
            TRY(list_end(search, a, b, error));
            TRY(list_end(search, b, a, error));
        }
    }
    return FFD_OK;
}

static ffd_status allocate(cut_search *search, size_t count, ffd_error *error)
{
    const mesh_pass *const pass = search->pass;
    const bool moves = pass->links > 0;
    const size_t blocks = pass->chain->blocks ? pass->chain->count : 1;
    TRY(ffd_budget_check(&pass->document->budget, count, 1 + (moves ? 3 * sizeof *search->positions : 0),
                         error));
    search->places = ffd_alloc(count, 1);
    search->positions = moves ? ffd_alloc_whole(count, 3 * sizeof *search->positions) : NULL;
    search->found = ffd_alloc_zero(blocks, sizeof *search->found);
    return search->places && search->found && (search->positions || !moves) ? FFD_OK : ffd_fail_memory(error);
}

/* Finds where the vertices are. */
static ffd_status locate(const cut_search *search, ffd_error *error)
{
    mesh_pass pass = *search->pass;
    pass_totals totals;
    pass.places = search->places;
    pass.deformed = search->positions;
    return ffd_pass_over_mesh(&pass, &totals, error);
}

static bool has(const cut_search *search, size_t count, pass_place place)
{
    return count > 0 && memchr(search->places, place, count);
}

static ffd_status find(cut_search *search, size_t count, ffd_error *error)
{
    const mesh_pass *const pass = search->pass;
    const vertex_marks marks = {search->places, 1, count};
    TRY(locate(search, error));
    if (!has(search, count, PASS_OUTSIDE) || !has(search, count, PASS_INSIDE))
        return FFD_OK;
    TRY(ffd_deadline_check(error));
    TRY(pass->document->format->mixed_faces(pass->document, pass->state, &marks, &search->faces, error));
    TRY(list_ends(search, error));
    return look_at_all(search, error);
}

ffd_status ffd_cut_faces_find(const mesh_pass *pass, cut_faces *cuts, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(pass->document);
    const size_t links = pass->chain->blocks ? pass->chain->count : 1;
    cut_search search = {.pass = pass};
    ffd_status status;
    memset(cuts, 0, links * sizeof *cuts);
    TRY_END(allocate(&search, count, error));
    TRY_END(find(&search, count, error));
    for (size_t l = 0; l < links; l++)
        cuts[l] = (cut_faces){atomic_load(&search.found[l].faces), atomic_load(&search.found[l].vertices)};
end:
    ffd_mesh_faces_free(&search.faces);
    ffd_free(search.places);
    ffd_free(search.positions);
    ffd_free(search.listed);
    ffd_free(search.found);
    ffd_free(search.workers);
    return status;
}
