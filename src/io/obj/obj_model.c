/* obj_model.c - an OBJ file as a model, for conversions. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/buffer.h"
#include "io/obj/obj_faces.h"
#include "io/obj/obj_number.h"
#include "io/text/vectors.h"
#include "mesh/face_filler.h"
#include <string.h>

typedef struct extractor {
    const obj_document *document;
    mesh_model *model;
    obj_walk walk;
    char *object, *group, *material; /* the current names, owned; NULL: none */
    model_corner *corners;           /* of the current element */
    size_t capacity;
    bool has_library;
    ffd_error *error;
} extractor;

/* Whether corners of faces that are not selected need the old normal where others have a new one. The old
   ones then follow the new ones. */
static bool has_both(const obj_document *d)
{
    return d->file.new_directions && d->selected_faces;
}

static size_t count_normals(const obj_document *d)
{
    if (!d->pair_start)
        return 0;
    if (!d->file.new_directions)
        return d->normals;
    return d->file.part.normal_count + (has_both(d) ? d->normals : 0);
}

static void copy_values(const extractor *e)
{
    const obj_document *d = e->document;
    const double *positions = d->file.new_positions ? d->file.new_positions : d->file.positions;
    ffd_vectors_read(positions, 0, d->vertices, e->model->positions);
    const size_t normals = e->model->normal_count,
                 fresh = d->file.new_directions ? d->file.part.normal_count : 0;
    ffd_vectors_read(d->file.new_directions, 0, fresh, e->model->normals);
    if (normals > fresh)
        ffd_vectors_read(d->file.directions, 0, normals - fresh, e->model->normals + 3 * fresh);
}

static ffd_status take_texcoord(extractor *e)
{
    const obj_document *d = e->document;
    double *values = e->model->texcoords + 2 * (e->walk.texcoords.seen - 1);
    double uvw[3] = {0, 0, 0};
    text_word word;
    for (int i = 0; i < 3 && ffd_obj_scan_word(&e->walk.scan, &word); i++)
        if (!ffd_obj_number(word, &uvw[i]))
            return ffd_fail_line(e->error, FFD_E_INVALID, d->file.name, e->walk.scan.line,
                                 "texture coordinate %c is not a number: \"%.*s\"", "uvw"[i],
                                 ffd_text_display_size(word), word.first);
    memcpy(values, uvw, 2 * sizeof *values);
    if (uvw[2] < 0 || uvw[2] > 0)
        e->model->features |= MODEL_HAS_MORE_TEXCOORDS;
    return FFD_OK;
}

/* x y z, then nothing, or w, or r g b, or r g b a. */
static ffd_status take_rest_of_vertex(extractor *e)
{
    double numbers[7];
    size_t count = 0;
    text_word word;
    while (count < 7 && ffd_obj_scan_word(&e->walk.scan, &word) && ffd_obj_number(word, &numbers[count]))
        count++;
    if (count == 4 && (numbers[3] < 1 || numbers[3] > 1))
        e->model->features |= MODEL_HAS_RATIONAL;
    if (count < 6)
        return FFD_OK;
    TRY(ffd_model_make_colours(e->model, e->error));
    memcpy(e->model->colours + 4 * (e->walk.vertices.seen - 1), numbers + 3, (count - 3) * sizeof *numbers);
    return FFD_OK;
}

/* The text after the keyword, from the first word to the last. */
static ffd_status take_name(extractor *e, char **name)
{
    text_word whole = {0}, word;
    while (ffd_obj_scan_word(&e->walk.scan, &word))
        whole = (text_word){whole.first ? whole.first : word.first, word.last};
    ffd_free(*name);
    *name = NULL;
    if (whole.first) {
        byte_buffer text = {0};
        ffd_buffer_append(&text, whole.first, (size_t)(whole.last - whole.first));
        *name = ffd_buffer_finish(&text);
        if (!*name)
            return ffd_fail_memory(e->error);
    }
    return ffd_model_begin_run(e->model, e->object, e->group, e->material, e->error);
}

static ffd_status find_texcoord(const extractor *e, obj_index index, uint32_t *found)
{
    const obj_document *d = e->document;
    size_t element;
    *found = MODEL_NONE;
    if (d->texcoords == 0 || index.text.first == index.text.last)
        return FFD_OK;
    if (!ffd_obj_find(index.value, e->walk.texcoords, &element))
        return ffd_fail_line(e->error, FFD_E_INVALID, d->file.name, e->walk.scan.line,
                             "texture coordinate index %.*s is out of range: the file has %zu",
                             ffd_text_display_size(index.text), index.text.first, d->texcoords);
    *found = (uint32_t)element;
    return FFD_OK;
}

static uint32_t find_normal(const extractor *e, obj_index index, size_t vertex)
{
    const obj_document *d = e->document;
    obj_face_corner corner = {.vertex = vertex, .has_normal = true};
    size_t pair;
    if (!d->pair_start || index.text.first == index.text.last ||
        !ffd_obj_find(index.value, e->walk.normals, &corner.normal))
        return MODEL_NONE;
    if (!d->file.new_directions)
        return (uint32_t)corner.normal;
    if (has_both(d) && !d->selected_faces[e->walk.faces.seen - 1])
        return (uint32_t)(d->file.part.normal_count + corner.normal);
    return ffd_obj_find_pair(d, &corner, &pair) ? (uint32_t)pair : MODEL_NONE;
}

static ffd_status take_element(extractor *e, model_kind kind)
{
    size_t count = 0, vertex;
    text_word word;
    obj_corner text;
    while (ffd_obj_scan_word(&e->walk.scan, &word)) {
        if (!ffd_grow((void **)&e->corners, &e->capacity, count + 1, sizeof *e->corners))
            return ffd_fail_memory(e->error);
        model_corner *corner = &e->corners[count++];
        if (!ffd_obj_corner(word, &text) || !ffd_obj_find(text.vertex.value, e->walk.vertices, &vertex))
            return ffd_faces_changed(e->document->file.name, e->error);
        corner->position = (uint32_t)vertex;
        corner->normal = kind == MODEL_FACES ? find_normal(e, text.normal, vertex) : MODEL_NONE;
        TRY(find_texcoord(e, text.texcoord, &corner->texcoord));
    }
    return ffd_model_add(e->model, kind, e->corners, count, e->error);
}

/* Keywords that only leave a word in the features. */
static void note_other(extractor *e)
{
    static const char *const free_form[] = {"curv", "curv2", "surf", "vp"};
    const text_word name = e->walk.scan.name;
    const size_t size = (size_t)(name.last - name.first);
    text_word value;
    for (size_t i = 0; i < sizeof free_form / sizeof *free_form; i++)
        if (strlen(free_form[i]) == size && memcmp(free_form[i], name.first, size) == 0)
            e->model->features |= MODEL_HAS_FREE_FORM;
    if (size != 1 || *name.first != 's' || !ffd_obj_scan_word(&e->walk.scan, &value))
        return;
    const bool off = (value.last - value.first == 1 && *value.first == '0') ||
                     (value.last - value.first == 3 && memcmp(value.first, "off", 3) == 0);
    e->model->features |= off ? 0 : MODEL_HAS_SMOOTHING;
}

static ffd_status take_statement(extractor *e)
{
    switch (e->walk.scan.keyword) {
    case OBJ_VERTEX:
        return take_rest_of_vertex(e);
    case OBJ_TEXCOORD:
        return take_texcoord(e);
    case OBJ_FACE:
        return take_element(e, MODEL_FACES);
    case OBJ_LINE:
        return take_element(e, MODEL_LINES);
    case OBJ_POINT:
        return take_element(e, MODEL_POINTS);
    case OBJ_GROUP:
        return take_name(e, &e->group);
    case OBJ_OBJECT:
        return take_name(e, &e->object);
    case OBJ_MATERIAL:
        return take_name(e, &e->material);
    case OBJ_LIBRARY:
        e->has_library = true;
        return FFD_OK;
    default:
        note_other(e);
        return FFD_OK;
    }
}

ffd_status ffd_obj_model(const mesh_document *document, mesh_state state, mesh_model *model, ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    extractor e = {.document = d, .model = model, .error = error};
    (void)state;
    TRY(ffd_model_make_values(model, d->vertices, d->texcoords, count_normals(d), error));
    copy_values(&e);
    TRY(ffd_model_begin_run(model, NULL, NULL, NULL, error));
    ffd_obj_document_walk(d, &e.walk);
    ffd_status status = FFD_OK;
    for (size_t i = 0; ffd_obj_walk_next(&e.walk); i++) {
        TRY_END(ffd_deadline_check_at(i, error));
        TRY_END(take_statement(&e));
    }
    TRY_END(ffd_model_finish(model, error));
    if (model->features & MODEL_HAS_MATERIAL_NAMES && e.has_library)
        model->features |= MODEL_HAS_MATERIALS;
end:
    ffd_free(e.object);
    ffd_free(e.group);
    ffd_free(e.material);
    ffd_free(e.corners);
    return status;
}
