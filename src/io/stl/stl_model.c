/* stl_model.c - an STL file as a model, for conversions. */
#include "base/memory/memory.h"
#include "io/stl/stl_document.h"
#include <string.h>

/* Facets share no vertices in the file: corners at the same position become one vertex. Positions before the
   deformation are compared, so that a deformation that moves corners together does not change the number of
   vertices. */
typedef struct extractor {
    const stl_document *document;
    mesh_model *model;
    intern_table positions; /* those of the file; keys: 3 doubles */
    char *name;             /* that of the current solid */
    ffd_error *error;
} extractor;

static ffd_status find_vertex(extractor *e, const double position[3], uint32_t *index)
{
    double key[3];
    for (int a = 0; a < 3; a++)
        key[a] = position[a] + 0.0; /* -0 becomes 0 */
    return ffd_intern(&e->positions, key, sizeof key, index) ? FFD_OK : ffd_fail_memory(e->error);
}

static ffd_status add_facet(extractor *e, size_t facet)
{
    double positions[9];
    model_corner corners[3];
    ffd_stl_read_corners(e->document, 3 * facet, 3, positions);
    for (size_t c = 0; c < 3; c++) {
        corners[c] = (model_corner){0, MODEL_NONE, MODEL_NONE};
        TRY(find_vertex(e, positions + 3 * c, &corners[c].position));
    }
    return ffd_model_add(e->model, MODEL_FACES, corners, 3, e->error);
}

static ffd_status begin_solid(extractor *e, text_word name)
{
    byte_buffer text = {0};
    ffd_buffer_append(&text, name.first, (size_t)(name.last - name.first));
    ffd_free(e->name);
    e->name = ffd_buffer_finish(&text);
    return e->name ? ffd_model_begin_run(e->model, e->name, NULL, NULL, e->error) : ffd_fail_memory(e->error);
}

static ffd_status take_text(extractor *e)
{
    const stl_document *d = e->document;
    stl_text text;
    stl_facet facet;
    stl_event event = STL_AT_SOLID;
    size_t seen = 0;
    ffd_stl_text_begin(&text, d->file.input.data, d->file.input.size, NULL);
    while (event != STL_AT_END) {
        TRY(ffd_stl_text_step(&text, d->file.name, &facet, &event, e->error));
        if (event == STL_AT_SOLID)
            TRY(begin_solid(e, text.name));
        else if (event == STL_AT_FACET)
            TRY(add_facet(e, seen++));
    }
    return FFD_OK;
}

/* Reads a facet's colour of 5 bits each. Some programs write it with the highest bit set and red in the
   highest bits; others, whose header has "COLOR=", with that bit not set and blue there. Returns false if the
   facet has none. */
static bool read_colour(const unsigned char *attribute, bool reversed, double colour[4])
{
    const unsigned bits = attribute[0] | (unsigned)attribute[1] << 8;
    if ((bits >> 15 != 0) == reversed)
        return false;
    for (unsigned c = 0; c < 3; c++)
        colour[c] = (bits >> 5 * (reversed ? c : 2 - c) & 31) / 31.0;
    colour[3] = 1;
    return true;
}

static bool has_colour_header(const unsigned char *header)
{
    for (size_t i = 0; i + 6 <= STL_HEADER; i++)
        if (memcmp(header + i, "COLOR=", 6) == 0)
            return true;
    return false;
}

static ffd_status take_binary(extractor *e)
{
    const bool reversed = has_colour_header(e->document->file.input.data);
    TRY(ffd_model_begin_run(e->model, NULL, NULL, NULL, e->error));
    for (size_t i = 0; i < e->document->facets; i++) {
        const unsigned char *attribute = ffd_stl_facet(e->document, i) + STL_ATTRIBUTE;
        double colour[4];
        TRY(add_facet(e, i));
        if (read_colour(attribute, reversed, colour))
            TRY(ffd_model_colour_face(e->model, colour, e->error));
        else if (attribute[0] || attribute[1])
            e->model->features |= MODEL_HAS_MORE;
    }
    return FFD_OK;
}

/* Gives each vertex the result of its first corner; the results of its other corners are equal. The model's
   corners are those of the file. */
static void copy_results(extractor *e)
{
    const double *results = e->document->file.new_positions;
    const model_list *faces = &e->model->lists[MODEL_FACES];
    for (size_t i = faces->corner_count; i-- > 0;)
        for (size_t a = 0; a < 3; a++)
            e->model->positions[3 * (size_t)faces->corners[i].position + a] = results[3 * i + a] + 0.0;
}

/* Sets the index of each position to that of its first corner. */
static ffd_status index_positions(extractor *e)
{
    const model_list *const faces = &e->model->lists[MODEL_FACES];
    TRY(ffd_model_take(e->model, e->positions.count, sizeof *e->model->indices, e->error));
    e->model->indices = ffd_alloc(e->positions.count, sizeof *e->model->indices);
    if (!e->model->indices)
        return ffd_fail_memory(e->error);
    for (size_t i = faces->corner_count; i-- > 0;)
        e->model->indices[faces->corners[i].position] = i;
    return FFD_OK;
}

static ffd_status fill_positions(extractor *e)
{
    const size_t count = e->positions.count;
    TRY(ffd_model_make_values(e->model, count, 0, 0, e->error));
    for (size_t i = 0; i < count; i++)
        memcpy(e->model->positions + 3 * i, ffd_intern_key(&e->positions, (uint32_t)i), 3 * sizeof(double));
    if (e->document->file.new_positions)
        copy_results(e);
    return FFD_OK;
}

ffd_status ffd_stl_model(const mesh_document *document, mesh_state state, mesh_model *model, ffd_error *error)
{
    extractor e = {.document = ffd_stl_of(document), .model = model, .error = error};
    ffd_status status;
    (void)state;
    TRY_END(e.document->binary ? take_binary(&e) : take_text(&e));
    TRY_END(fill_positions(&e));
    if (model->wants_details)
        TRY_END(index_positions(&e));
    TRY_END(ffd_model_finish(model, error));
end:
    ffd_intern_free(&e.positions);
    ffd_free(e.name);
    return status;
}
