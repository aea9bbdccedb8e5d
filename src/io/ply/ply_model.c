/* ply_model.c - a PLY file as a model, for conversions. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/ply/ply_document.h"
#include "io/ply/ply_textures.h"
#include "splat/splat_color.h"
#include <string.h>

/* What the model takes of a vertex besides its position and normal. */
enum { ROLE_U, ROLE_V, ROLE_RED, ROLE_GREEN, ROLE_BLUE, ROLE_ALPHA, ROLE_COUNT };

typedef struct extractor {
    const ply_document *document;
    mesh_model *model;
    const ply_property *roles[ROLE_COUNT]; /* NULL: absent */
    bool has_harmonics;                    /* the colours are those of splats */
    const ply_property *face_texcoords;    /* the list texcoord of the faces; NULL: none */
    size_t taken_texcoords;                /* of the faces so far */
    const ply_property *face_colours[4];   /* red, green, blue, alpha of the faces; red NULL: none */
    double colour[4];                      /* of the current face */
    mesh_faces faces;
    ffd_error *error;
} extractor;

static const ply_property *find_scalar(const ply_element *element, const char *name)
{
    const ply_property *found = ffd_ply_find_property(element, name);
    return found && !found->is_list ? found : NULL;
}

/* Finds the colours of Gaussian splats, if details are wanted: for pictures and pages. */
static void find_harmonics(extractor *e)
{
    static const char *const names[] = {"f_dc_0", "f_dc_1", "f_dc_2", "opacity"};
    const ply_property *found[4];
    if (e->roles[ROLE_RED] || !e->model->wants_details)
        return;
    for (size_t c = 0; c < 4; c++)
        found[c] = find_scalar(e->document->vertex, names[c]);
    for (int c = 0; c < 4 && found[0] && found[1] && found[2]; c++)
        e->roles[ROLE_RED + c] = found[c];
    e->has_harmonics = e->roles[ROLE_RED];
}

/* Finds texture coordinates and colours by the names that programs use. Both coordinates, or all three
   colours, must be present. */
static void find_roles(extractor *e)
{
    static const char *const colours[][4] = {
        {"red", "green", "blue", "alpha"}, {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}};
    const ply_element *vertex = e->document->vertex;
    for (size_t i = 0; i < PLY_TEXCOORD_NAMES && !e->roles[ROLE_U]; i++) {
        const ply_property *u = find_scalar(vertex, ffd_ply_texcoord_names[i][0]),
                           *v = find_scalar(vertex, ffd_ply_texcoord_names[i][1]);
        e->roles[ROLE_U] = v ? u : NULL;
        e->roles[ROLE_V] = u ? v : NULL;
    }
    for (size_t i = 0; i < sizeof colours / sizeof *colours && !e->roles[ROLE_RED]; i++) {
        const ply_property *found[4];
        for (size_t c = 0; c < 4; c++)
            found[c] = find_scalar(vertex, colours[i][c]);
        for (int c = 0; c < 4 && found[0] && found[1] && found[2]; c++)
            e->roles[ROLE_RED + c] = found[c];
    }
    find_harmonics(e);
    const ply_element *face = e->document->face;
    for (size_t i = 0; face && i < sizeof colours / sizeof *colours && !e->face_colours[0]; i++) {
        const ply_property *found[4];
        for (size_t c = 0; c < 4; c++)
            found[c] = find_scalar(face, colours[i][c]);
        if (found[0] && found[1] && found[2])
            memcpy(e->face_colours, found, sizeof found);
    }
    const ply_property *list = face ? ffd_ply_find_property(face, "texcoord") : NULL;
    e->face_texcoords = list && list->is_list ? list : NULL;
}

static ffd_status make_values(const extractor *e)
{
    const ply_document *d = e->document;
    const size_t corners = e->faces.start[e->faces.face_count];
    const size_t texcoords = e->face_texcoords ? corners : e->roles[ROLE_U] ? d->file.part.vertex_count : 0;
    TRY(ffd_file_document_model(&d->file, texcoords, e->model, e->error));
    return !e->roles[ROLE_RED] ? FFD_OK : ffd_model_make_colours(e->model, e->error);
}

/* Returns the value of an integer type that stands for 1: the largest. */
static double scale_of(number_type type)
{
    return type == NUMBER_UINT8 ? 255 : type == NUMBER_UINT16 ? 65535 : 1;
}

static ffd_status set_value(extractor *e, const ply_walk *walk, size_t vertex, int role, text_word word)
{
    const ply_document *d = e->document;
    const number_type type = e->roles[role]->type;
    double value;
    if (!ffd_ply_load(d->header.encoding, type, word, &value))
        return ffd_fail_line(e->error, FFD_E_INVALID, d->file.name, walk->line,
                             "%.*s of vertex %zu (counted from 0) is not a number: \"%.*s\"",
                             ffd_text_display_size(e->roles[role]->name), e->roles[role]->name.first, vertex,
                             ffd_text_display_size(word), word.first);
    if (role >= ROLE_RED && e->has_harmonics)
        e->model->colours[4 * vertex + (size_t)(role - ROLE_RED)] =
            role == ROLE_ALPHA ? splat_opacity(value) : splat_color(value);
    else if (role >= ROLE_RED)
        e->model->colours[4 * vertex + (size_t)(role - ROLE_RED)] = value / scale_of(type);
    else if (!e->face_texcoords)
        e->model->texcoords[2 * vertex + (size_t)role] = value;
    return FFD_OK;
}

static int role_of(const extractor *e, const ply_property *property)
{
    int role = 0;
    while (role < ROLE_COUNT && e->roles[role] != property)
        role++;
    return role;
}

static ffd_status take_vertices(extractor *e)
{
    const ply_document *d = e->document;
    ply_walk walk;
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (size_t row = 0; row < d->file.part.vertex_count; row++) {
        TRY(ffd_deadline_check_at(row, e->error));
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *property = &d->vertex->properties[i];
            const int role = role_of(e, property);
            text_word word;
            if (role == ROLE_COUNT)
                ffd_ply_walk_skip(&walk, property);
            else if (ffd_ply_walk_value(&walk, property->type, &word))
                TRY(set_value(e, &walk, row, role, word));
        }
    }
    return FFD_OK;
}

/* Takes the texture coordinates of a face's corners, a list of twice as many numbers. A list of another
   length is left out, which is counted unless it is empty. Returns whether they were taken. */
static bool take_face_texcoords(extractor *e, ply_walk *walk, size_t face)
{
    const ply_document *d = e->document;
    const size_t corners = e->faces.start[face + 1] - e->faces.start[face];
    const ply_property *list = e->face_texcoords;
    text_word word;
    size_t count;
    double value;
    ffd_ply_walk_list(walk, list, &word, &count);
    bool there = count == 2 * corners;
    for (size_t i = 0; i < count; i++) {
        const bool read = ffd_ply_walk_value(walk, list->type, &word) &&
                          ffd_ply_load(d->header.encoding, list->type, word, &value);
        there = there && read;
        if (there)
            e->model->texcoords[2 * e->taken_texcoords + i] = value;
    }
    e->taken_texcoords += there ? corners : 0;
    e->model->odd_texcoords += !there && count > 0;
    return there;
}

/* Returns which of the face's colours a property is; 4: none. */
static size_t colour_of(const extractor *e, const ply_property *property)
{
    size_t c = 0;
    while (c < 4 && e->face_colours[c] != property)
        c++;
    return c;
}

static void take_face_colour(extractor *e, ply_walk *walk, size_t c)
{
    const number_type type = e->face_colours[c]->type;
    text_word word;
    double value;
    if (ffd_ply_walk_value(walk, type, &word) &&
        ffd_ply_load(e->document->header.encoding, type, word, &value))
        e->colour[c] = value / scale_of(type);
}

static bool walk_face(extractor *e, ply_walk *walk, size_t face)
{
    const ply_element *element = e->document->face;
    bool there = false;
    ffd_ply_walk_row(walk);
    for (size_t i = 0; i < element->property_count; i++) {
        const size_t c = colour_of(e, &element->properties[i]);
        if (&element->properties[i] == e->face_texcoords)
            there = take_face_texcoords(e, walk, face);
        else if (c < 4)
            take_face_colour(e, walk, c);
        else
            ffd_ply_walk_skip(walk, &element->properties[i]);
    }
    return there;
}

static ffd_status take_faces(extractor *e)
{
    const bool normals = e->model->normal_count > 0;
    model_corner *corners = NULL;
    size_t capacity = 0;
    ply_walk walk;
    const bool walks = e->face_texcoords || e->face_colours[0];
    if (walks)
        ffd_ply_document_walk(e->document, e->document->face, &walk);
    ffd_status status = FFD_OK;
    for (size_t face = 0; face < e->faces.face_count; face++) {
        const size_t first = e->faces.start[face], count = e->faces.start[face + 1] - first;
        const size_t first_texcoord = e->taken_texcoords;
        const bool is_row = walks && face < e->document->face->count;
        e->colour[3] = 1;
        const bool own = is_row && walk_face(e, &walk, face);
        const bool texcoords = own || (!e->face_texcoords && e->model->texcoord_count > 0);
        if (!ffd_grow((void **)&corners, &capacity, count, sizeof *corners))
            TRY_END(ffd_fail_memory(e->error));
        for (size_t c = 0; c < count; c++) {
            const uint32_t vertex = e->faces.corners[first + c];
            const uint32_t texcoord = own ? (uint32_t)(first_texcoord + c) : vertex;
            corners[c] =
                (model_corner){vertex, texcoords ? texcoord : MODEL_NONE, normals ? vertex : MODEL_NONE};
        }
        TRY_END(ffd_model_add(e->model, MODEL_FACES, corners, count, e->error));
        if (is_row && e->face_colours[0] && count > 2)
            TRY_END(ffd_model_colour_face(e->model, e->colour, e->error));
    }
end:
    ffd_free(corners);
    return status;
}

/* Takes vertex1 and vertex2 of a row. Returns false if one is not the number of a vertex. */
static bool take_ends(const extractor *e, ply_walk *walk, const ply_element *edges, model_corner ends[2])
{
    const ply_property *named[2] = {find_scalar(edges, "vertex1"), find_scalar(edges, "vertex2")};
    bool valid = true;
    ffd_ply_walk_row(walk);
    for (size_t i = 0; i < edges->property_count; i++) {
        const ply_property *property = &edges->properties[i];
        const int end = property == named[0] ? 0 : property == named[1] ? 1 : -1;
        text_word word;
        size_t vertex = 0;
        if (end < 0) {
            ffd_ply_walk_skip(walk, property);
            continue;
        }
        ffd_ply_walk_value(walk, property->type, &word);
        valid = ffd_ply_load_count(e->document->header.encoding, property->type, word, &vertex) &&
                vertex < e->model->position_count && valid;
        const uint32_t index = (uint32_t)vertex;
        ends[end] =
            (model_corner){index, e->model->texcoord_count > 0 && !e->face_texcoords ? index : MODEL_NONE,
                           e->model->normal_count > 0 ? index : MODEL_NONE};
    }
    return valid && named[0] && named[1];
}

static ffd_status take_edges(extractor *e)
{
    const ply_document *d = e->document;
    const ply_element *edges = ffd_ply_find_edges(d);
    ply_walk walk;
    if (!edges)
        return FFD_OK;
    ffd_ply_document_walk(d, edges, &walk);
    for (uint64_t row = 0; row < edges->count; row++) {
        model_corner ends[2] = {{0, 0, 0}, {0, 0, 0}};
        if (!take_ends(e, &walk, edges, ends))
            return ffd_fail_line(
                e->error, FFD_E_INVALID, d->file.name, d->header.encoding == PLY_ASCII ? walk.line : 0,
                "edge %llu (counted from 0) names a vertex that does not exist", (unsigned long long)row);
        TRY(ffd_model_add(e->model, MODEL_LINES, ends, 2, e->error));
    }
    return FFD_OK;
}

/* Returns the features of the file that the model cannot hold. */
static uint32_t features_of(const extractor *e)
{
    const ply_document *d = e->document;
    const ply_element *edges = ffd_ply_find_edges(d);
    uint32_t found = 0;
    text_word name;
    for (size_t i = 0; i < d->vertex->property_count; i++)
        if (d->vertex->properties[i].slot >= PLY_ROTATION_SLOT &&
            role_of(e, &d->vertex->properties[i]) == ROLE_COUNT)
            found |= MODEL_HAS_MORE;
    for (size_t i = 0; d->face && i < d->face->property_count; i++) {
        const ply_property *property = &d->face->properties[i];
        if (property != d->face_corners && property != e->face_texcoords && colour_of(e, property) == 4)
            found |= MODEL_HAS_MORE;
    }
    for (size_t i = 0; i < d->header.element_count; i++) {
        const ply_element *element = &d->header.elements[i];
        if (element != d->vertex && element != d->face && element != d->strips && element != edges &&
            element->count > 0)
            found |= MODEL_HAS_MORE;
    }
    for (size_t i = 0; i < d->header.note_count; i++)
        found |= ffd_ply_texture_name(d->header.notes[i], &name) ? MODEL_HAS_TEXTURES : 0;
    return found;
}

ffd_status ffd_ply_model(const mesh_document *document, mesh_state state, mesh_model *model, ffd_error *error)
{
    extractor e = {.document = ffd_ply_of(document), .model = model, .error = error};
    TRY(ffd_ply_faces(document, state, &e.faces, error));
    find_roles(&e);
    ffd_status status;
    TRY_END(make_values(&e));
    TRY_END(take_vertices(&e));
    TRY_END(ffd_model_begin_run(model, NULL, NULL, NULL, error));
    TRY_END(take_faces(&e));
    if (e.face_texcoords)
        model->texcoord_count = e.taken_texcoords;
    TRY_END(take_edges(&e));
    model->features |= features_of(&e);
    TRY_END(ffd_model_finish(model, error));
end:
    ffd_mesh_faces_free(&e.faces);
    return status;
}
