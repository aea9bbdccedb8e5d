#include "io/stl/stl_document.h"
#include "base/file/path.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <float.h>
#include <inttypes.h>
#include <string.h>

/* The size that the number of facets in a binary file's header asks for. */
static uint64_t stated_size(const file_input *input)
{
    return STL_START + (uint64_t)STL_FACET * load_u32(input->data + STL_HEADER);
}

static bool begins_with_solid(const file_input *input)
{
    text_scan scan;
    text_word word;
    ffd_text_begin(&scan, input->data, input->size, false);
    return ffd_text_find(&scan) && ffd_text_word(&scan, &word) && ffd_text_is_any_case(word, "solid");
}

/* The header of a binary file may say "solid" too: its size decides, or (where bytes are missing or follow) a
   0 among its first bytes, which text has not and the number of facets nearly always. */
static bool is_binary(const file_input *input)
{
    if (input->size >= STL_START && stated_size(input) == input->size)
        return true;
    if (!begins_with_solid(input))
        return true;
    return memchr(input->data, 0, input->size < STL_START ? input->size : STL_START) != NULL;
}

static ffd_status refuse_facets(const stl_document *d, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_LIMIT, d->name, "more facets than the limit of %" PRIu32,
                         STL_FACETS_MAX);
}

static ffd_status read_binary(stl_document *d, ffd_error *error)
{
    if (d->input.size < STL_START)
        return ffd_fail_file(
            error, FFD_E_INVALID, d->name,
            "is not an STL file: it neither begins with \"solid\" nor has, with %zu bytes, the "
            "%d of a binary file's header",
            d->input.size, STL_START);
    const uint32_t facets = load_u32(d->input.data + STL_HEADER);
    if (stated_size(&d->input) > d->input.size)
        return ffd_fail_file(error, FFD_E_INVALID, d->name,
                             "%" PRIu32 " facets are stated, which take %" PRIu64 " bytes: the file has %zu",
                             facets, stated_size(&d->input), d->input.size);
    if (facets > STL_FACETS_MAX)
        return refuse_facets(d, error);
    d->facets = facets;
    return FFD_OK;
}

static ffd_status add_facet(stl_document *d, const stl_facet *facet, size_t *capacity, ffd_error *error)
{
    if (d->facets == STL_FACETS_MAX)
        return refuse_facets(d, error);
    if (!ffd_grow((void **)&d->positions, capacity, d->facets + 1, 9 * sizeof *d->positions))
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 9; i++)
        ffd_text_number(facet->corners[i], &d->positions[9 * d->facets + i]);
    d->facets++;
    return FFD_OK;
}

static ffd_status read_text(stl_document *d, ffd_error *error)
{
    stl_text text;
    stl_facet facet;
    size_t capacity = 0;
    bool found = true;
    ffd_status status = FFD_OK;
    ffd_stl_text_begin(&text, d->input.data, d->input.size);
    while (status == FFD_OK && found) {
        status = ffd_stl_text_next(&text, d->name, &facet, &found, error);
        if (status == FFD_OK && found)
            status = add_facet(d, &facet, &capacity, error);
    }
    /* Gives back what growing has reserved too much; where that fails the larger block serves as well. */
    double *block = ffd_realloc(d->positions, d->facets, 9 * sizeof *d->positions);
    d->positions = block ? block : d->positions;
    return status;
}

static void describe_part(stl_document *d)
{
    d->part = (mesh_part){.vertex_count = 3 * d->facets, .identity = true};
    d->base = (mesh_document){
        .parts = &d->part, .part_count = 1, .largest_coordinate = d->binary ? FLT_MAX : DBL_MAX};
}

static void free_document(stl_document *d)
{
    ffd_free(d->name);
    ffd_free(d->positions);
    ffd_free(d->new_positions);
    ffd_free(d);
}

ffd_status ffd_stl_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    stl_document *d = ffd_alloc_zero(1, sizeof *d);
    if (!d)
        return ffd_fail_memory(error);
    d->input = *input;
    d->binary = is_binary(input);
    d->name = ffd_text_copy(ffd_path_display_name(source->path));
    ffd_status status = FFD_OK;
    if (!d->name)
        status = ffd_fail_memory(error);
    else
        status = d->binary ? read_binary(d, error) : read_text(d, error);
    if (status) {
        free_document(d);
        return status;
    }
    describe_part(d);
    d->base.budget = ffd_budget_for_file(d->input.size, !d->binary, source->memory);
    *document = &d->base;
    return FFD_OK;
}

void ffd_stl_close(mesh_document *document)
{
    stl_document *d = (stl_document *)document;
    if (!d)
        return;
    ffd_file_unload(&d->input);
    free_document(d);
}
