/* obj_parts.c - the groups, objects and materials of an OBJ file, and what each draws. The file is read once
   to find its runs: elements in a row that have the same names. Then each name goes through its runs. */
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "io/obj/obj_document.h"
#include "io/obj/obj_names.h"
#include "mesh/listing.h"
#include <string.h>

/* The longest key that is made without a block of its own. */
#define SHORT_KEY 200
#define NO_NAME UINT32_MAX

/* Elements from one place of the file to another. */
typedef struct run {
    const char *first, *last;
    size_t vertices; /* `v` before it */
} run;

/* A name of a run. */
typedef struct use {
    uint32_t name, run;
} use;

typedef struct surveying {
    const obj_document *document;
    intern_table names; /* a byte of the kind, then the name: empty for what has none */
    run *runs;
    size_t run_count, run_capacity;
    use *uses; /* by run */
    size_t use_count, use_capacity;
    /* At the current statement. */
    uint32_t object, material;
    uint32_t *groups; /* none: the group "default" */
    size_t group_count, group_capacity;
    bool in_run; /* the last run goes on */
    bool failed; /* memory ran out */
} surveying;

static uint32_t index_of(surveying *s, selector_kind kind, text_word word)
{
    const size_t size = (size_t)(word.last - word.first);
    char short_key[SHORT_KEY], *const key = size < SHORT_KEY ? short_key : ffd_alloc(size + 1, 1);
    uint32_t index = NO_NAME;
    if (key) {
        key[0] = (char)kind;
        memcpy(key + 1, size > 0 ? word.first : "", size);
    }
    s->failed = s->failed || !key || !ffd_intern(&s->names, key, size + 1, &index);
    if (key != short_key)
        ffd_free(key);
    return index;
}

static void end_run(surveying *s, const char *last)
{
    if (s->in_run)
        s->runs[s->run_count - 1].last = last;
    s->in_run = false;
}

/* `o` and `usemtl`: one name, or none. */
static void enter(surveying *s, selector_kind kind, obj_scan *scan, uint32_t *now)
{
    const char *const begin = scan->name.first;
    const text_word word = ffd_obj_names_line(scan);
    const uint32_t name = word.first == word.last ? NO_NAME : index_of(s, kind, word);
    if (name != *now)
        end_run(s, begin);
    *now = name;
}

static void enter_groups(surveying *s, obj_scan *scan)
{
    const char *const begin = scan->name.first;
    size_t count = 0;
    text_word word;
    while (ffd_obj_scan_word(scan, &word)) {
        const uint32_t name = index_of(s, SELECT_GROUP, word);
        if (!ffd_grow((void **)&s->groups, &s->group_capacity, count + 1, sizeof *s->groups)) {
            s->failed = true;
            return;
        }
        if (count >= s->group_count || s->groups[count] != name)
            end_run(s, begin);
        s->groups[count++] = name;
    }
    if (count != s->group_count)
        end_run(s, begin);
    s->group_count = count;
}

static void add_use(surveying *s, uint32_t name)
{
    if (!ffd_grow((void **)&s->uses, &s->use_capacity, s->use_count + 1, sizeof *s->uses)) {
        s->failed = true;
        return;
    }
    s->uses[s->use_count++] = (use){name, (uint32_t)(s->run_count - 1)};
}

/* Begins a run at the current element. */
static void begin_run(surveying *s, const obj_walk *walk)
{
    static const char fallback[] = "default";
    const text_word none = {fallback, fallback}, standard = {fallback, fallback + sizeof fallback - 1};
    if (s->run_count == NO_NAME ||
        !ffd_grow((void **)&s->runs, &s->run_capacity, s->run_count + 1, sizeof *s->runs)) {
        s->failed = true;
        return;
    }
    s->runs[s->run_count++] = (run){walk->scan.name.first, walk->scan.last, walk->vertices.seen};
    s->in_run = true;
    add_use(s, s->object == NO_NAME ? index_of(s, SELECT_OBJECT, none) : s->object);
    add_use(s, s->material == NO_NAME ? index_of(s, SELECT_MATERIAL, none) : s->material);
    for (size_t i = 0; i < s->group_count; i++)
        add_use(s, s->groups[i]);
    if (s->group_count == 0)
        add_use(s, index_of(s, SELECT_GROUP, standard));
}

static void find_runs(surveying *s)
{
    obj_walk walk;
    ffd_obj_document_walk(s->document, &walk);
    while (!s->failed && ffd_obj_walk_next(&walk))
        switch (walk.scan.keyword) {
        case OBJ_GROUP:
            enter_groups(s, &walk.scan);
            break;
        case OBJ_OBJECT:
            enter(s, SELECT_OBJECT, &walk.scan, &s->object);
            break;
        case OBJ_MATERIAL:
            enter(s, SELECT_MATERIAL, &walk.scan, &s->material);
            break;
        default:
            if (ffd_obj_walk_uses(&walk) && !s->in_run)
                begin_run(s, &walk);
            break;
        }
}

/* The last thing draws the elements of a run. */
static void draw(const obj_document *d, const run *elements, mesh_listing *listing)
{
    obj_walk walk;
    obj_face_corner corner;
    ffd_obj_document_walk(d, &walk);
    walk.scan.at = elements->first;
    walk.scan.last = elements->last;
    walk.vertices.seen = elements->vertices;
    while (ffd_obj_walk_next(&walk)) {
        if (!ffd_obj_walk_uses(&walk))
            continue;
        while (ffd_obj_walk_corner(&walk, &corner)) {
            const uint32_t vertex = (uint32_t)corner.vertex;
            ffd_listing_draw(listing, 0, &vertex, 1);
        }
        ffd_listing_draw_faces(listing, walk.scan.keyword == OBJ_FACE);
    }
}

/* Sorts the uses by name, and by run within it: start[n] .. start[n+1]-1 of runs are those of name n. */
static bool sort_uses(const surveying *s, size_t **start, uint32_t **runs)
{
    *start = ffd_alloc_zero(s->names.count + 2, sizeof **start);
    *runs = ffd_alloc(s->use_count, sizeof **runs);
    if (!*start || !*runs)
        return false;
    for (size_t i = 0; i < s->use_count; i++)
        ++(*start)[s->uses[i].name + 2];
    for (size_t n = 2; n < s->names.count + 2; n++)
        (*start)[n] += (*start)[n - 1];
    for (size_t i = 0; i < s->use_count; i++)
        (*runs)[(*start)[s->uses[i].name + 1]++] = s->uses[i].run;
    return true;
}

static ffd_status list_kind(const surveying *s, selector_kind kind, const size_t *start, const uint32_t *runs,
                            mesh_listing *listing, ffd_error *error)
{
    for (uint32_t n = 0; n < s->names.count; n++) {
        const char *const key = ffd_intern_key(&s->names, n);
        if (key[0] != (char)kind)
            continue;
        TRY(ffd_listing_add(listing, kind, key + 1, strlen(key + 1), 0, error));
        for (size_t i = start[n]; i < start[n + 1]; i++)
            draw(s->document, &s->runs[runs[i]], listing);
    }
    return FFD_OK;
}

ffd_status ffd_obj_list_parts(const mesh_document *document, mesh_listing *listing, ffd_error *error)
{
    static const selector_kind kinds[] = {SELECT_OBJECT, SELECT_GROUP, SELECT_MATERIAL};
    surveying s = {.document = ffd_obj_of(document), .object = NO_NAME, .material = NO_NAME};
    size_t *start = NULL;
    uint32_t *runs = NULL;
    find_runs(&s);
    ffd_status status = FFD_OK;
    if (s.failed || !sort_uses(&s, &start, &runs))
        TRY_END(ffd_fail_memory(error));
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        TRY_END(list_kind(&s, kinds[i], start, runs, listing, error));
end:
    ffd_free(start);
    ffd_free(runs);
    ffd_free(s.runs);
    ffd_free(s.uses);
    ffd_free(s.groups);
    ffd_intern_free(&s.names);
    return status;
}
