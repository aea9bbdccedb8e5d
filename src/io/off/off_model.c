/* off_model.c - an OFF file as a model, for conversions. */
#include "base/memory/memory.h"
#include "io/off/off_document.h"
#include <string.h>

/* A colour, a texture coordinate, and one more word, to notice too many. */
#define REST_MAX 7

typedef struct extractor {
    const off_document *document;
    mesh_model *model;
    off_walk walk;
    model_corner *corners; /* those of the current face */
    size_t capacity;
    bool decimals, wholes; /* faces have colours with a decimal point, in whole numbers */
    double largest_whole;
    ffd_error *error;
} extractor;

/* Reads the numbers after a vertex, at most REST_MAX. Returns how many. */
static size_t take_rest(extractor *e, double *numbers)
{
    size_t count = 0;
    text_word word;
    while (ffd_off_walk_rest(&e->walk, &word))
        if (count < REST_MAX && ffd_text_number(word, &numbers[count]))
            count++;
    return count;
}

/* Takes a vertex's colour and u v. A single number would be an index into a table of colours, which no file
   contains. */
static ffd_status take_vertex(extractor *e, size_t i)
{
    const bool texcoords = e->document->header.has_texcoords;
    off_vertex vertex;
    double rest[REST_MAX];
    ffd_off_walk_vertex(&e->walk, &vertex);
    size_t count = take_rest(e, rest);
    if (texcoords && count >= 2) {
        count -= 2;
        memcpy(e->model->texcoords + 2 * i, rest + count, 2 * sizeof *rest);
    }
    if (count != 3 && count != 4) {
        e->model->features |= count > 0 ? MODEL_HAS_MORE : 0;
        return FFD_OK;
    }
    TRY(ffd_model_make_colours(e->model, e->error));
    memcpy(e->model->colours + 4 * i, rest, count * sizeof *rest);
    return FFD_OK;
}

/* Reads the colour behind a face's corners: whole numbers up to 255, or numbers up to 1, of which one has a
   point or an exponent (*whole tells which). Returns how many words there are, SIZE_MAX if one is not a
   number; colour is set if there are 3 or 4 numbers. */
static size_t read_colour(extractor *e, double colour[4], bool *whole)
{
    size_t words = 0, numbers = 0;
    text_word word;
    *whole = true;
    for (; ffd_off_walk_rest(&e->walk, &word); words++)
        if (words < 4 && ffd_text_number(word, &colour[words])) {
            uint64_t number;
            *whole = *whole && ffd_text_whole(word, &number);
            numbers++;
        }
    return numbers == words ? words : SIZE_MAX;
}

static void note_colour(extractor *e, double colour[4], size_t words, bool whole)
{
    e->wholes = e->wholes || whole;
    e->decimals = e->decimals || !whole;
    for (size_t c = 0; c < words && whole; c++) {
        e->largest_whole = colour[c] > e->largest_whole ? colour[c] : e->largest_whole;
        colour[c] /= 255;
    }
}

static ffd_status colour_face(extractor *e, bool is_face)
{
    double colour[4] = {0, 0, 0, 1};
    bool whole;
    const size_t words = read_colour(e, colour, &whole);
    if (words == 0)
        return FFD_OK;
    if (is_face && (words == 3 || words == 4)) {
        note_colour(e, colour, words, whole);
        return ffd_model_colour_face(e->model, colour, e->error);
    }
    e->model->features |= MODEL_HAS_MORE; /* of a line or point, or the number of a colour in a table */
    return FFD_OK;
}

/* Colours in whole numbers up to 1 beside others with a decimal point are fractions too: many programs write
   1.0 as "1". Only when all faces are read is that known, so that their colours are read again. */
static void mend_whole_colours(extractor *e, const off_walk *faces)
{
    if (!e->wholes || !e->decimals || e->largest_whole > 1)
        return;
    e->walk = *faces;
    for (size_t i = 0, face = 0; i < e->document->header.faces && face < e->model->coloured_faces; i++) {
        const size_t count = ffd_off_walk_face_size(&e->walk);
        double colour[4] = {0, 0, 0, 1};
        bool whole;
        for (size_t c = 0; c < count && ffd_off_walk_corner_index(&e->walk) != UINT32_MAX; c++)
            ;
        const size_t words = read_colour(e, colour, &whole);
        if (count > 2 && (words == 3 || words == 4) && whole)
            memcpy(e->model->face_colours + 4 * face, colour, sizeof colour);
        face += count > 2;
    }
}

static ffd_status take_face(extractor *e)
{
    const size_t count = ffd_off_walk_face_size(&e->walk);
    const bool texcoords = e->model->texcoord_count > 0, normals = e->model->normal_count > 0;
    /* It was checked when the file was opened: the file has changed since. */
    if (count > (size_t)(e->walk.scan.last - e->walk.scan.at))
        return ffd_file_document_changed(&e->document->file, e->error);
    if (!ffd_grow((void **)&e->corners, &e->capacity, count, sizeof *e->corners))
        return ffd_fail_memory(e->error);
    for (size_t c = 0; c < count; c++) {
        const uint32_t vertex = ffd_off_walk_corner_index(&e->walk);
        if (vertex >= e->document->header.vertices)
            return ffd_file_document_changed(&e->document->file, e->error);
        e->corners[c] =
            (model_corner){vertex, texcoords ? vertex : MODEL_NONE, normals ? vertex : MODEL_NONE};
    }
    TRY(ffd_model_add(e->model, MODEL_FACES, e->corners, count, e->error));
    return colour_face(e, count > 2);
}

ffd_status ffd_off_model(const mesh_document *document, mesh_state state, mesh_model *model, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    extractor e = {.document = d, .model = model, .error = error};
    (void)state;
    TRY(ffd_file_document_model(&d->file, d->header.has_texcoords ? d->header.vertices : 0, model, error));
    TRY(ffd_model_begin_run(model, NULL, NULL, NULL, error));
    ffd_off_walk_begin(&d->header, &e.walk);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->header.vertices; i++)
        TRY_END(take_vertex(&e, i));
    const off_walk faces = e.walk;
    for (size_t i = 0; i < d->header.faces; i++)
        TRY_END(take_face(&e));
    mend_whole_colours(&e, &faces);
    TRY_END(ffd_model_finish(model, error));
end:
    ffd_free(e.corners);
    return status;
}
