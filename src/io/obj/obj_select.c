/* obj_select.c - which faces, lines, points and free-form geometry `--only` leaves, and so which vertices and
   normals. A `g` puts what follows into each group that it names, one without names, and the file's
   beginning, into "default"; an `o` or `usemtl` has one name, which may hold blanks. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/obj/obj_faces.h"
#include "io/obj/obj_names.h"
#include <stdio.h>
#include <string.h>

#define LONGEST_NAME 200 /* bytes of a part's name in messages */

typedef struct selecting {
    obj_document *document;
    const mesh_selector *selectors;
    size_t count;
    bool *found;                  /* a selector: its name was there */
    bool group, object, material; /* is selected, at the current statement */
    bool in_default;              /* no `g` has named a group */
    uint8_t *marks; /* one a vertex: to be marked in place of the document's selection; or NULL */
} selecting;

/* Whether a selector has this name. */
static bool names(const selecting *s, selector_kind kind, text_word name)
{
    bool any = false;
    for (size_t i = 0; i < s->count; i++)
        if (s->selectors[i].kind == kind &&
            ffd_selector_is(&s->selectors[i], name.first, (size_t)(name.last - name.first)))
            any = s->found[i] = true;
    return any;
}

static void enter_groups(selecting *s, obj_scan *scan)
{
    text_word word;
    s->group = false;
    s->in_default = true;
    while (ffd_obj_scan_word(scan, &word)) {
        s->group = names(s, SELECT_GROUP, word) || s->group;
        s->in_default = false;
    }
}

/* Whether an element at the current statement is selected. */
static bool is_selected(selecting *s)
{
    static const char text[] = "default";
    if (s->in_default)
        s->group = names(s, SELECT_GROUP, (text_word){text, text + sizeof text - 1});
    return s->group || s->object || s->material;
}

static void mark_corners(selecting *s, obj_walk *walk, bool selected)
{
    obj_document *d = s->document;
    obj_face_corner corner;
    size_t pair;
    while (ffd_obj_walk_corner(walk, &corner)) {
        if (selected)
            (s->marks ? s->marks : d->selected_vertices)[corner.vertex] = 1;
        if (s->marks)
            continue;
        if (walk->scan.keyword != OBJ_FACE || !ffd_obj_find_pair(d, &corner, &pair))
            continue;
        if (selected)
            d->selected_pairs[pair] = 1;
        else
            d->held_normals[corner.normal] = 1;
    }
}

static void mark_elements(selecting *s)
{
    obj_walk walk;
    ffd_obj_document_walk(s->document, &walk);
    while (ffd_obj_walk_next(&walk)) {
        switch (walk.scan.keyword) {
        case OBJ_GROUP:
            enter_groups(s, &walk.scan);
            break;
        case OBJ_OBJECT:
            s->object = names(s, SELECT_OBJECT, ffd_obj_names_line(&walk.scan));
            break;
        case OBJ_MATERIAL:
            s->material = names(s, SELECT_MATERIAL, ffd_obj_names_line(&walk.scan));
            break;
        case OBJ_FACE:
            if (!s->marks)
                s->document->selected_faces[walk.faces.seen - 1] = is_selected(s);
            mark_corners(s, &walk, is_selected(s));
            break;
        default:
            if (ffd_obj_walk_uses(&walk))
                mark_corners(s, &walk, is_selected(s));
            break;
        }
    }
}

static bool offer_line(const selector_nearest *nearest, obj_names *known, obj_scan *scan)
{
    text_word word;
    if (nearest->selector->kind != SELECT_GROUP)
        return ffd_obj_names_add(known, ffd_obj_names_line(scan));
    while (ffd_obj_scan_word(scan, &word))
        if (!ffd_obj_names_add(known, word))
            return false;
    return true;
}

/* Each distinct name once: their distances cost time. */
static ffd_status refuse_unknown(const obj_document *d, const mesh_selector *selector, ffd_error *error)
{
    static const obj_keyword keywords[SELECTOR_KINDS] = {
        [SELECT_GROUP] = OBJ_GROUP, [SELECT_OBJECT] = OBJ_OBJECT, [SELECT_MATERIAL] = OBJ_MATERIAL};
    selector_nearest nearest = {.selector = selector};
    obj_names known = {0};
    obj_walk walk;
    bool has_memory = true;
    ffd_obj_document_walk(d, &walk);
    while (has_memory && ffd_obj_walk_next(&walk))
        if (walk.scan.keyword == keywords[selector->kind])
            has_memory = offer_line(&nearest, &known, &walk.scan);
    const size_t distinct = has_memory ? ffd_obj_names_distinct(&known) : 0;
    for (size_t i = 0; i < distinct; i++)
        if (known.words[i].first < known.words[i].last)
            ffd_selector_offer(&nearest, known.words[i].first,
                               (size_t)(known.words[i].last - known.words[i].first));
    ffd_obj_names_free(&known);
    return has_memory ? ffd_selector_unknown(&nearest, d->file.name, error) : ffd_fail_memory(error);
}

ffd_status ffd_obj_select(mesh_document *document, const mesh_selector *selectors, size_t count,
                          ffd_error *error)
{
    obj_document *d = (obj_document *)document;
    selecting s = {.document = d, .selectors = selectors, .count = count, .in_default = true};
    s.found = ffd_alloc_zero(count, sizeof *s.found);
    d->selected_vertices = ffd_alloc_zero(d->vertices, 1);
    d->selected_faces = ffd_alloc_zero(d->faces, 1);
    d->selected_pairs = ffd_alloc_zero(d->file.part.normal_count, 1);
    d->held_normals = ffd_alloc_zero(d->normals, 1);
    ffd_status status = FFD_OK;
    if (!s.found || !d->selected_vertices || !d->selected_faces || !d->selected_pairs || !d->held_normals)
        TRY_END(ffd_fail_memory(error));
    mark_elements(&s);
    for (size_t i = 0; i < count; i++)
        if (!s.found[i])
            TRY_END(refuse_unknown(d, &selectors[i], error));
end:
    d->file.part.selected = d->selected_vertices;
    d->file.part.selected_normals = d->selected_pairs;
    ffd_free(s.found);
    return status;
}

ffd_status ffd_obj_mark(mesh_document *document, const mesh_selector *selector, uint8_t *marks,
                        ffd_error *error)
{
    obj_document *const d = (obj_document *)document;
    bool found = false;
    selecting s = {.document = d,
                   .selectors = selector,
                   .count = 1,
                   .found = &found,
                   .in_default = true,
                   .marks = marks};
    mark_elements(&s);
    return found ? FFD_OK : refuse_unknown(d, selector, error);
}

/* The name of a face's group or, where no `g` has named one, of its object. */
typedef struct face_name {
    text_word group, object;
} face_name;

static void note_name(face_name *name, obj_scan *scan)
{
    text_word word;
    if (scan->keyword == OBJ_GROUP)
        name->group = ffd_obj_scan_word(scan, &word) ? word : (text_word){0};
    else if (scan->keyword == OBJ_OBJECT)
        name->object = ffd_obj_names_line(scan);
}

static text_word name_of(const face_name *name, const char **kind)
{
    *kind = name->group.first ? "group:" : "object:";
    return name->group.first ? name->group : name->object;
}

static bool is_same(text_word a, text_word b)
{
    return a.last - a.first == b.last - b.first && memcmp(a.first, b.first, (size_t)(a.last - a.first)) == 0;
}

/* Finds the name of the first face, line, point, curve or surface that has the vertex. */
static text_word find_name(const obj_document *d, uint64_t vertex, const char **kind)
{
    obj_walk walk;
    obj_face_corner corner;
    face_name name = {0};
    ffd_obj_document_walk(d, &walk);
    while (ffd_obj_walk_next(&walk)) {
        note_name(&name, &walk.scan);
        if (!ffd_obj_walk_uses(&walk))
            continue;
        while (ffd_obj_walk_corner(&walk, &corner))
            if (corner.vertex == vertex)
                return name_of(&name, kind);
    }
    return (text_word){0};
}

/* Counts the marked vertices of all that has the name, and clears their marks. */
static uint64_t count_marked(const obj_document *d, const char *kind, text_word wanted, uint8_t *marks)
{
    obj_walk walk;
    obj_face_corner corner;
    face_name name = {0};
    uint64_t count = 0;
    ffd_obj_document_walk(d, &walk);
    while (ffd_obj_walk_next(&walk)) {
        const char *own;
        note_name(&name, &walk.scan);
        if (!ffd_obj_walk_uses(&walk))
            continue;
        const text_word text = name_of(&name, &own);
        if (!text.first || strcmp(own, kind) != 0 || !is_same(text, wanted))
            continue;
        while (ffd_obj_walk_corner(&walk, &corner)) {
            count += marks[corner.vertex] != 0;
            marks[corner.vertex] = 0;
        }
    }
    return count;
}

/* Whether there are names of groups or objects. */
static bool has_names(const obj_document *d)
{
    for (size_t b = 0; b < d->blocks.count; b++)
        if (d->blocks.list[b].names_groups)
            return true;
    return false;
}

uint64_t ffd_obj_name_part(const mesh_document *document, uint64_t vertex, uint8_t *marks, char *name,
                           size_t capacity)
{
    const obj_document *d = ffd_obj_of(document);
    const char *kind = "";
    const text_word found = has_names(d) ? find_name(d, vertex, &kind) : (text_word){0};
    *name = 0;
    if (!found.first)
        return 0;
    /* One byte more than is kept tells whether a character would be cut. */
    char word[LONGEST_NAME + 2], shown[LONGEST_NAME + 1];
    const size_t length = (size_t)(found.last - found.first);
    const size_t size = length < sizeof word ? length : sizeof word - 1;
    memcpy(word, found.first, size);
    word[size] = 0;
    ffd_name_shown(word, shown, sizeof shown);
    snprintf(name, capacity, "%s%s", kind, shown);
    return count_marked(d, kind, found, marks);
}
