#include "job/input/rigid_components.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "mesh/cell_list.h"
#include "mesh/model.h"
#include "mesh/places.h"
#include "mesh/twins.h"

/* Temporary memory for each vertex, in bytes. */
#define VERTEX_BYTES (POSITION_TWIN_BYTES + 3 * sizeof(uint32_t))

typedef struct component_search {
    mesh_document *document;
    uint32_t *pieces;
    size_t count;      /* of vertices */
    uint32_t *leaders; /* of each vertex one that comes before it in its component, or itself; MESH_NONE: it
                          is in none */
} component_search;

/* Lets each vertex that may be of a component be one by itself. */
static void begin(const component_search *s)
{
    size_t vertex = 0;
    for (size_t i = 0; i < s->document->part_count; i++) {
        const mesh_part *const part = &s->document->parts[i];
        if (part->repeats_positions)
            continue;
        for (size_t v = 0; v < part->vertex_count; v++, vertex++) {
            const bool counts = ffd_part_selects(part, v) && !part->singular &&
                                (!part->used || part->used[v]) && s->pieces[vertex] == MESH_NONE;
            s->leaders[vertex] = counts ? (uint32_t)vertex : MESH_NONE;
        }
    }
}

/* Returns the first vertex of a component, and shortens the way to it. */
static uint32_t find(const component_search *s, uint32_t vertex)
{
    while (s->leaders[vertex] != vertex) {
        s->leaders[vertex] = s->leaders[s->leaders[vertex]];
        vertex = s->leaders[vertex];
    }
    return vertex;
}

static void join(const component_search *s, uint32_t a, uint32_t b)
{
    const uint32_t first = find(s, a), second = find(s, b);
    s->leaders[first > second ? first : second] = first < second ? first : second;
}

/* Joins those of some vertices that may be of a component. */
static void join_all(const component_search *s, const uint32_t *vertices, size_t count)
{
    uint32_t before = MESH_NONE;
    for (size_t i = 0; i < count; i++) {
        if (s->leaders[vertices[i]] == MESH_NONE)
            continue;
        if (before != MESH_NONE)
            join(s, before, vertices[i]);
        before = vertices[i];
    }
}

/* Joins vertices at equal positions. */
static ffd_status join_twins(const component_search *s, const double *positions, int threads,
                             ffd_error *error)
{
    uint32_t *const twins = ffd_alloc(s->count, sizeof *twins);
    uint32_t *const seen = ffd_alloc(s->count, sizeof *seen);
    ffd_status status;
    TRY_END(twins && seen ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_positions_twins(positions, s->count, threads, twins, error));
    for (size_t v = 0; v < s->count; v++)
        seen[v] = MESH_NONE;
    for (size_t v = 0; v < s->count; v++) {
        uint32_t *const at = &seen[twins[v]];
        if (s->leaders[v] == MESH_NONE)
            continue;
        if (*at == MESH_NONE)
            *at = (uint32_t)v;
        else
            join(s, *at, (uint32_t)v);
    }
end:
    ffd_free(twins);
    ffd_free(seen);
    return status;
}

/* Joins the vertices of lines, which only a model lists. */
static ffd_status join_lines(const component_search *s, mesh_state state, memory_budget *budget,
                             ffd_error *error)
{
    mesh_model model = {.wants_details = true, .budget = budget};
    ffd_status status;
    TRY_END(s->document->format->model(s->document, state, &model, error));
    const model_list *const lines = &model.lists[MODEL_LINES];
    for (size_t i = 0; i < lines->count; i++)
        for (size_t c = lines->starts[i] + 1; c < lines->starts[i + 1]; c++) {
            uint32_t ends[2];
            for (size_t e = 0; e < 2; e++) {
                const uint32_t position = lines->corners[c - 1 + e].position;
                ends[e] = model.indices ? (uint32_t)model.indices[position] : position;
            }
            join_all(s, ends, 2);
        }
end:
    ffd_model_free(&model);
    return status;
}

/* Joins the points of each volume, those between corners too. */
static ffd_status join_cells(const component_search *s, ffd_error *error)
{
    const mesh_cell_calls *const calls = s->document->format->cells;
    const uint64_t count = calls ? calls->count(s->document) : 0;
    for (uint64_t c = 0; c < count; c++) {
        const cell_view cell = calls->get(s->document, c);
        TRY(ffd_deadline_check_at((size_t)c, error));
        if (cell.words && !cell_is_polyhedron(&cell))
            join_all(s, cell.words, cell.count);
        for (size_t at = 1; cell.words && cell_is_polyhedron(&cell) && at < cell.count;
             at += 1 + (size_t)cell.words[at])
            join_all(s, cell.words + at + 1, cell.words[at]);
    }
    return FFD_OK;
}

/* Numbers the components from *end on. */
static ffd_status number(const component_search *s, uint32_t *end, ffd_error *error)
{
    for (size_t v = 0; v < s->count; v++) {
        if (s->leaders[v] == MESH_NONE)
            continue;
        const uint32_t leader = find(s, (uint32_t)v);
        TRY(ffd_deadline_check_at(v, error));
        s->pieces[v] = leader == v ? (*end)++ : s->pieces[leader];
    }
    return FFD_OK;
}

static ffd_status search(const component_search *s, mesh_state state, int threads, uint32_t *end,
                         ffd_error *error)
{
    mesh_faces faces = {0};
    memory_budget budget = s->document->budget;
    ffd_status status;
    TRY_END(ffd_budget_take(&budget, s->count, VERTEX_BYTES, error));
    TRY_END(ffd_mesh_mark_used(s->document, error));
    TRY_END(s->document->format->faces(s->document, state, &faces, error));
    TRY_END(ffd_mesh_faces_take(&faces, faces.start[faces.face_count], &budget, error));
    begin(s);
    TRY_END(join_twins(s, faces.positions, threads, error));
    for (size_t f = 0; f < faces.face_count; f++)
        join_all(s, faces.corners + faces.start[f], faces.start[f + 1] - faces.start[f]);
    TRY_END(join_cells(s, error));
    if (faces.lines > 0)
        TRY_END(join_lines(s, state, &budget, error));
    status = number(s, end, error);
end:
    ffd_mesh_faces_free(&faces);
    return status;
}

ffd_status ffd_rigid_components_find(mesh_document *document, mesh_state state, int threads, uint32_t piece,
                                     uint32_t *pieces, uint32_t *end, ffd_error *error)
{
    component_search s = {
        .document = document, .pieces = pieces, .count = (size_t)ffd_mesh_vertex_count(document)};
    *end = piece;
    if (s.count == 0)
        return FFD_OK;
    s.leaders = ffd_alloc(s.count, sizeof *s.leaders);
    const ffd_status status = s.leaders ? search(&s, state, threads, end, error) : ffd_fail_memory(error);
    ffd_free(s.leaders);
    return status;
}
