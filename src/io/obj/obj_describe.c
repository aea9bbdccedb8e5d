/* obj_describe.c - what `ffd info` says of an OBJ file. */
#include "io/obj/obj_document.h"
#include "io/obj/obj_names.h"
#include "mesh/face_sizes.h"

typedef struct obj_facts {
    face_sizes sizes;
    size_t coloured; /* vertices with 6 numbers or more: x y z r g b [a] */
    obj_names groups, objects, materials;
    bool failed; /* memory ran out */
} obj_facts;

static size_t count_words(obj_scan *scan)
{
    text_word word;
    size_t count = 0;
    while (ffd_obj_scan_word(scan, &word))
        count++;
    return count;
}

/* A group's words are names of their own; an object's or material's name may hold blanks. */
static void count_names(obj_facts *facts, obj_names *names, obj_scan *scan, bool each_word)
{
    text_word name = {0}, word;
    while (ffd_obj_scan_word(scan, &word)) {
        if (each_word)
            facts->failed = facts->failed || !ffd_obj_names_add(names, word);
        name = (text_word){name.first ? name.first : word.first, word.last};
    }
    if (name.first && !each_word)
        facts->failed = facts->failed || !ffd_obj_names_add(names, name);
}

static void survey_statement(obj_facts *facts, obj_scan *scan)
{
    switch (scan->keyword) {
    case OBJ_VERTEX:
        facts->coloured += count_words(scan) >= 6;
        break;
    case OBJ_FACE:
        face_sizes_count(&facts->sizes, count_words(scan));
        break;
    case OBJ_GROUP:
        count_names(facts, &facts->groups, scan, true);
        break;
    case OBJ_OBJECT:
        count_names(facts, &facts->objects, scan, false);
        break;
    case OBJ_MATERIAL:
        count_names(facts, &facts->materials, scan, false);
        break;
    default:
        break;
    }
}

ffd_status ffd_obj_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    obj_facts facts = {0};
    obj_walk walk;
    ffd_obj_document_walk(d, &walk);
    while (!facts.failed && ffd_obj_walk_next(&walk))
        survey_statement(&facts, &walk.scan);
    const json_count members[] = {
        {"vertices", d->vertices},
        {"vertices_with_color", facts.coloured},
        {"normals", d->normals},
        {"texcoords", d->texcoords},
        {"faces", d->faces},
        {"triangles", facts.sizes.triangles},
        {"quads", facts.sizes.quads},
        {"ngons", facts.sizes.ngons},
        {"lines", d->lines},
        {"points", d->points},
        {"groups", ffd_obj_names_distinct(&facts.groups)},
        {"objects", ffd_obj_names_distinct(&facts.objects)},
        {"materials", ffd_obj_names_distinct(&facts.materials)},
    };
    ffd_json_counts(json, members, sizeof members / sizeof *members);
    ffd_json_string(json, "line_endings", ffd_text_line_ends(d->file.input.data, d->file.input.size));
    ffd_obj_names_free(&facts.groups);
    ffd_obj_names_free(&facts.objects);
    ffd_obj_names_free(&facts.materials);
    return facts.failed ? ffd_fail_memory(error) : FFD_OK;
}
