#include "io/obj/obj_document.h"
#include "base/memory.h"
#include "base/path.h"
#include "io/formats.h"
#include <inttypes.h>

static void set_totals(const obj_document *d, obj_walk *walk)
{
    walk->vertices.total = d->vertices;
    walk->texcoords.total = d->texcoords;
    walk->normals.total = d->normals;
}

void ffd_obj_document_walk(const obj_document *d, obj_walk *walk)
{
    ffd_obj_walk_begin(walk, d->input.data, d->input.size);
    set_totals(d, walk);
}

void ffd_obj_document_walk_users(const obj_document *d, obj_walk *walk)
{
    *walk = d->users;
}

/* Elements of 3 numbers while they are being read. */
typedef struct vectors {
    double *xyz;
    size_t count, capacity;
} vectors;

static ffd_status read_vector(const obj_document *d, obj_scan *scan, const char *what, vectors *list,
                              ffd_error *error)
{
    text_word word;
    if (list->count == OBJ_ELEMENTS_MAX)
        return ffd_fail_line(error, FFD_E_LIMIT, d->name, scan->keyword_line,
                             "one %s too many: the limit is %" PRIu32, what, OBJ_ELEMENTS_MAX);
    if (!ffd_grow((void **)&list->xyz, &list->capacity, list->count + 1, 3 * sizeof *list->xyz))
        return ffd_fail_memory(error);
    for (int a = 0; a < 3; a++) {
        if (!ffd_obj_scan_word(scan, &word))
            return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->keyword_line,
                                 "a %s needs 3 numbers, found %d", what, a);
        if (!ffd_obj_number(word, &list->xyz[3 * list->count + (size_t)a]))
            return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line,
                                 "coordinate %c of a %s is not a number: \"%.*s\"", "xyz"[a], what,
                                 ffd_text_shown(word), word.first);
    }
    list->count++;
    return FFD_OK;
}

/* Gives back what growing has reserved too much; where that fails the larger block serves as well. */
static double *trimmed(vectors *list)
{
    double *block = ffd_realloc(list->xyz, list->count, 3 * sizeof *list->xyz);
    return block ? block : list->xyz;
}

/* Whether a statement may name elements by their numbers. */
static bool may_name_elements(obj_keyword keyword)
{
    return keyword == OBJ_FACE || keyword == OBJ_LINE || keyword == OBJ_POINT || keyword == OBJ_OTHER;
}

static ffd_status read_vectors(obj_document *d, ffd_error *error)
{
    vectors positions = {0}, directions = {0};
    obj_walk walk;
    bool before_users = true;
    ffd_status status = FFD_OK;
    ffd_obj_document_walk(d, &walk);
    d->users = walk;
    while (status == FFD_OK && ffd_obj_walk_next(&walk)) {
        if (walk.scan.keyword == OBJ_VERTEX)
            status = read_vector(d, &walk.scan, "vertex", &positions, error);
        else if (walk.scan.keyword == OBJ_NORMAL)
            status = read_vector(d, &walk.scan, "normal", &directions, error);
        before_users = before_users && !may_name_elements(walk.scan.keyword);
        if (!before_users)
            continue;
        if (walk.scan.keyword == OBJ_NORMAL) {
            ffd_obj_scan_finish(&walk.scan);
            d->addition = (size_t)(walk.scan.at - (const char *)d->input.data);
        }
        d->users = walk;
    }
    d->vertices = positions.count;
    d->normals = directions.count;
    d->texcoords = walk.texcoords.seen;
    d->positions = trimmed(&positions);
    d->directions = trimmed(&directions);
    set_totals(d, &d->users);
    return status;
}

/* UTF-16 would be a file without any known statement, and so an empty mesh. */
static ffd_status check_encoding(const obj_document *d, ffd_error *error)
{
    const unsigned char *data = d->input.data;
    if (d->input.size >= 2 && ((data[0] == 0xff && data[1] == 0xfe) || (data[0] == 0xfe && data[1] == 0xff)))
        return ffd_fail_line(error, FFD_E_INVALID, d->name, 1,
                             "is UTF-16 text: an OBJ file is ASCII or UTF-8");
    return FFD_OK;
}

static void describe_part(obj_document *d)
{
    d->part.vertex_count = d->vertices;
    d->part.identity = true;
    if (d->pair_start) {
        d->part.normal_start = d->pair_start;
        d->part.normal_count = d->pair_start[d->vertices];
    }
    d->base = (mesh_document){.format = &ffd_obj_format, .parts = &d->part, .part_count = 1};
}

static void free_document(obj_document *d)
{
    ffd_free(d->name);
    ffd_free(d->positions);
    ffd_free(d->directions);
    ffd_free(d->pair_start);
    ffd_free(d->pair_normal);
    ffd_free(d->selected_vertices);
    ffd_free(d->selected_faces);
    ffd_free(d->selected_pairs);
    ffd_free(d->held_normals);
    ffd_free(d->new_positions);
    ffd_free(d->new_directions);
    ffd_free(d);
}

ffd_status ffd_obj_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    obj_document *d = ffd_alloc_zero(1, sizeof *d);
    if (!d)
        return ffd_fail_memory(error);
    d->input = *input;
    d->name = ffd_text_copy(ffd_path_shown(source->path));
    ffd_status status = d->name ? check_encoding(d, error) : ffd_fail_memory(error);
    if (status == FFD_OK)
        status = read_vectors(d, error);
    if (status == FFD_OK)
        status = ffd_obj_read_faces(d, error);
    if (status) {
        free_document(d);
        return status;
    }
    describe_part(d);
    d->base.room = ffd_room_of_file(d->input.size, source->memory);
    *document = &d->base;
    return FFD_OK;
}

void ffd_obj_close(mesh_document *document)
{
    obj_document *d = (obj_document *)document;
    if (!d)
        return;
    ffd_file_unload(&d->input);
    free_document(d);
}
