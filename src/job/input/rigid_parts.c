#include "job/input/rigid_parts.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/input/rigid_components.h"
#include "mesh/selector.h"
#include <string.h>

static const char component[] = "component";

/* Memory of the pieces and the marks of a vertex. */
#define VERTEX_BYTES (sizeof(uint32_t) + sizeof(uint8_t))

const char *ffd_rigid_part_text(const rigid_request *request, size_t part)
{
    return part < request->rigid_count ? request->rigid[part] : request->uniform[part - request->rigid_count];
}

static const char *option_of(const rigid_request *request, size_t part)
{
    return part < request->rigid_count ? "rigid" : "uniform";
}

static bool is_component(const char *text)
{
    return strcmp(text, component) == 0;
}

ffd_status ffd_rigid_check(const char *option, const char *text, ffd_error *error)
{
    mesh_selector selector;
    return is_component(text) ? FFD_OK : ffd_selector_parse(option, text, &selector, error);
}

static ffd_status add_piece(rigid_parts *parts, size_t part, ffd_error *error)
{
    if (!ffd_grow((void **)&parts->list, &parts->capacity, parts->count + 1, sizeof *parts->list))
        return ffd_fail_memory(error);
    parts->list[parts->count++] = (rigid_piece){.part = part};
    return FFD_OK;
}

/* Context of the claims of parts. */
typedef struct claim_work {
    const rigid_request *request;
    mesh_document *document;
    const char *name;
    const mesh_log *log;
    uint8_t *marks; /* one a vertex */
    size_t count;   /* of vertices */
    rigid_parts *parts;
} claim_work;

static ffd_status refuse_second(const claim_work *w, size_t vertex, size_t part, ffd_error *error)
{
    char first[120], second[120];
    const size_t other = w->parts->list[w->parts->pieces[vertex]].part;
    ffd_name_shown(ffd_rigid_part_text(w->request, other), first, sizeof first);
    ffd_name_shown(ffd_rigid_part_text(w->request, part), second, sizeof second);
    return ffd_fail_file(error, FFD_E_ARGUMENT, w->name,
                         "{rigid}, {uniform}: vertex %zu (counted from 0) is of %s and of %s, and can move "
                         "with one part only",
                         vertex, first, second);
}

/* Clears the marks of vertices that stay: those that are not selected, and those of nodes of no inverse. */
static void clear_staying(const claim_work *w)
{
    size_t first = 0;
    for (size_t i = 0; i < w->document->part_count; i++) {
        const mesh_part *const part = &w->document->parts[i];
        if (part->repeats_positions)
            continue;
        for (size_t v = 0; v < part->vertex_count; v++)
            w->marks[first + v] = w->marks[first + v] && ffd_part_selects(part, v) && !part->singular;
        first += part->vertex_count;
    }
}

/* Makes a piece of the marked vertices. */
static ffd_status claim_marked(const claim_work *w, size_t part, ffd_error *error)
{
    rigid_parts *const parts = w->parts;
    const uint32_t piece = (uint32_t)parts->count;
    bool any = false;
    for (size_t v = 0; v < w->count; v++) {
        if (!w->marks[v])
            continue;
        if (!any)
            TRY(add_piece(parts, part, error));
        any = true;
        if (parts->pieces[v] != MESH_NONE)
            return refuse_second(w, v, part, error);
        parts->pieces[v] = piece;
    }
    return FFD_OK;
}

static ffd_status claim_named(const claim_work *w, size_t part, ffd_error *error)
{
    const mesh_selector_calls *const calls = w->document->format->selectors;
    const char *const text = ffd_rigid_part_text(w->request, part);
    mesh_selector selector;
    TRY(ffd_selector_parse(option_of(w->request, part), text, &selector, error));
    TRY(ffd_selector_check_kind(&selector, calls ? calls->mark_kinds : 0, w->document->format->name, w->name,
                                error));
    memset(w->marks, 0, w->count);
    TRY(calls->mark(w->document, &selector, w->marks, error));
    clear_staying(w);
    return claim_marked(w, part, error);
}

/* Components are what no other selector names: they come last. A second one claims what the first has. */
static ffd_status claim_components(const claim_work *w, mesh_state state, int threads, ffd_error *error)
{
    size_t before = SIZE_MAX;
    for (size_t k = 0; k < w->parts->part_count; k++) {
        if (!is_component(ffd_rigid_part_text(w->request, k)))
            continue;
        if (before != SIZE_MAX)
            return ffd_fail_file(error, FFD_E_ARGUMENT, w->name,
                                 "{rigid}, {uniform}: component is given twice: each connected part can move "
                                 "in one way only");
        before = k;
        uint32_t end;
        TRY(ffd_rigid_components_find(w->document, state, threads, (uint32_t)w->parts->count,
                                      w->parts->pieces, &end, error));
        while (w->parts->count < end)
            TRY(add_piece(w->parts, k, error));
    }
    return FFD_OK;
}

static void warn_of_empty(const claim_work *w)
{
    for (size_t k = 0; k < w->parts->part_count; k++) {
        bool any = false;
        for (size_t i = 0; i < w->parts->count && !any; i++)
            any = w->parts->list[i].part == k;
        char shown[120], braced[20];
        if (any)
            continue;
        ffd_name_shown(ffd_rigid_part_text(w->request, k), shown, sizeof shown);
        braced[0] = 0;
        strcat(strcat(strcat(braced, "{"), option_of(w->request, k)), "}");
        ffd_log_line(w->log, FFD_LOG_WARNING, "%s: %s has no vertices%s%s", SPELLED(braced), shown,
                     w->request->leaves ? SPELLED(" that {only} leaves") : "",
                     is_component(ffd_rigid_part_text(w->request, k)) ? " that no other part has" : "");
    }
}

static ffd_status claim_all(const claim_work *w, mesh_state state, int threads, ffd_error *error)
{
    for (size_t k = 0; k < w->parts->part_count; k++)
        if (!is_component(ffd_rigid_part_text(w->request, k)))
            TRY(claim_named(w, k, error));
    TRY(claim_components(w, state, threads, error));
    warn_of_empty(w);
    return FFD_OK;
}

ffd_status ffd_rigid_parts_load(const rigid_request *request, mesh_document *document, mesh_state state,
                                const char *name, int threads, const mesh_log *log, rigid_parts *parts,
                                ffd_error *error)
{
    claim_work w = {.request = request,
                    .document = document,
                    .name = name,
                    .log = log,
                    .count = (size_t)ffd_mesh_vertex_count(document),
                    .parts = parts};
    parts->rigid_count = request->rigid_count;
    parts->part_count = request->rigid_count + request->uniform_count;
    if (parts->part_count > FFD_RIGID_PARTS)
        return ffd_fail(error, FFD_E_ARGUMENT, "{rigid}, {uniform}: %zu parts are named, but %d are the most",
                        parts->part_count, FFD_RIGID_PARTS);
    TRY(ffd_budget_take(&document->budget, w.count, VERTEX_BYTES, error));
    parts->budget = &document->budget;
    parts->vertices = w.count;
    TRY(ffd_first_vertices(document, &parts->first, error));
    parts->pieces = ffd_alloc_whole(w.count, sizeof *parts->pieces);
    w.marks = ffd_alloc_whole(w.count, sizeof *w.marks);
    ffd_status status;
    TRY_END(parts->pieces && w.marks ? FFD_OK : ffd_fail_memory(error));
    for (size_t v = 0; v < w.count; v++)
        parts->pieces[v] = MESH_NONE;
    status = claim_all(&w, state, threads, error);
end:
    ffd_free(w.marks);
    return status;
}

void ffd_rigid_parts_free(rigid_parts *parts)
{
    ffd_free(parts->first);
    ffd_free(parts->pieces);
    ffd_free(parts->list);
    if (parts->budget)
        ffd_budget_return(parts->budget, parts->vertices, VERTEX_BYTES);
    *parts = (rigid_parts){0};
}
