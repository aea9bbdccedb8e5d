#include "io/stl/stl_document.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/content.h"
#include "base/text/words.h"
#include <float.h>
#include <inttypes.h>
#include <string.h>

/* Where the first lines of a text are looked for. */
#define FIRST_BYTES 1024

/* Returns the size of a binary file with the number of facets in its header. */
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

/* Whether a line among the first ones, behind what may be a header, begins with a word of a facet: no binary
   file has one there. */
static bool has_text_line(const file_input *input)
{
    static const char *const words[] = {"facet", "outer", "vertex", "endloop", "endfacet", "endsolid"};
    text_scan scan;
    text_word word;
    ffd_text_begin(&scan, input->data, input->size < FIRST_BYTES ? input->size : FIRST_BYTES, false);
    while (ffd_text_find(&scan)) {
        ffd_text_word(&scan, &word);
        const bool is_behind = word.first - (const char *)input->data >= STL_START;
        for (size_t i = 0; is_behind && i < sizeof words / sizeof *words; i++)
            if (ffd_text_is_any_case(word, words[i]))
                return true;
        ffd_text_next_line(&scan);
    }
    return false;
}

/* Whether the file is binary. The header of a binary file may begin with "solid" too, so its size decides. If
   bytes are missing or follow, the lines of a text decide, else a 0 among the first bytes: the number of
   facets nearly always has one. */
static bool is_binary(const file_input *input)
{
    if (input->size >= STL_START && stated_size(input) == input->size)
        return true;
    if (has_text_line(input))
        return false;
    return !begins_with_solid(input) ||
           memchr(input->data, 0, input->size < STL_START ? input->size : STL_START) != NULL;
}

static ffd_status refuse_facets(const stl_document *d, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_LIMIT, d->file.name, "more facets than the limit of %" PRIu32,
                         STL_FACETS_MAX);
}

/* Whether it is another kind of file: bytes may follow the facets, but not if the header is that of another
   program's files. */
static bool is_other_file(const file_input *input)
{
    const content_kind *const kind = ffd_content_kind(input->data, input->size);
    return stated_size(input) < input->size && kind && kind->is_binary;
}

static ffd_status read_binary(stl_document *d, ffd_error *error)
{
    if (d->file.input.size < STL_START)
        return ffd_fail_file(error, FFD_E_INVALID, d->file.name,
                             "is not an STL file: it neither begins with \"solid\" nor has, with %zu %s, the "
                             "%d of a binary file's header",
                             d->file.input.size, ffd_plural(d->file.input.size, "byte", "bytes"), STL_START);
    const uint32_t facets = load_u32(d->file.input.data + STL_HEADER);
    if (stated_size(&d->file.input) > d->file.input.size)
        return ffd_fail_file(
            error, FFD_E_INVALID, d->file.name, "%" PRIu32 " %s %" PRIu64 " bytes: the file has %zu", facets,
            ffd_plural(facets, "facet is stated, which takes", "facets are stated, which take"),
            stated_size(&d->file.input), d->file.input.size);
    if (facets > STL_FACETS_MAX)
        return refuse_facets(d, error);
    if (is_other_file(&d->file.input))
        return ffd_fail_file(error, FFD_E_INVALID, d->file.name, "is not an STL file");
    const size_t behind = d->file.input.size - STL_START;
    if (facets == 0 && behind >= STL_FACET)
        return ffd_fail_file(error, FFD_E_INVALID, d->file.name,
                             "0 facets are stated, but %zu bytes follow, which hold %zu: the count was not "
                             "filled in",
                             behind, behind / STL_FACET);
    d->facets = facets;
    const size_t further = behind - STL_FACET * d->facets;
    if (further == 0 || further % STL_FACET != 0)
        return FFD_OK;
    return ffd_flaw_line(&d->file.base.flaws, d->file.name, 0, error,
                         "%" PRIu32 " %s stated, but %zu bytes follow, as many as %zu more %s: they stay as "
                         "they are",
                         facets, ffd_plural(facets, "facet is", "facets are"), further, further / STL_FACET,
                         ffd_plural(further / STL_FACET, "takes", "take"));
}

static ffd_status add_facet(stl_document *d, const stl_facet *facet, size_t *capacity, ffd_error *error)
{
    if (d->facets == STL_FACETS_MAX)
        return refuse_facets(d, error);
    if (!ffd_grow((void **)&d->file.positions, capacity, d->facets + 1, 9 * sizeof *d->file.positions))
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 9; i++)
        ffd_text_number(facet->corners[i], &d->file.positions[9 * d->facets + i]);
    d->facets++;
    return FFD_OK;
}

static ffd_status read_text(stl_document *d, ffd_error *error)
{
    stl_text text;
    stl_facet facet;
    size_t capacity = 0;
    bool found = true;
    TRY(ffd_file_document_note_mark(&d->file, ffd_text_size(d->file.input.data, d->file.input.size), error));
    ffd_stl_text_begin(&text, d->file.input.data, d->file.input.size, &d->file.base.flaws);
    while (found) {
        TRY(ffd_deadline_check_at(d->facets, error));
        TRY(ffd_stl_text_next(&text, d->file.name, &facet, &found, error));
        if (found)
            TRY(add_facet(d, &facet, &capacity, error));
    }
    /* Releases the surplus capacity; if that fails, the larger block stays. */
    double *block = ffd_realloc(d->file.positions, d->facets, 9 * sizeof *d->file.positions);
    d->file.positions = block ? block : d->file.positions;
    return FFD_OK;
}

ffd_status ffd_stl_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    stl_document *d = ffd_file_document_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    d->binary = is_binary(input);
    const ffd_status status = d->binary ? read_binary(d, error) : read_text(d, error);
    if (status) {
        ffd_file_document_free(&d->file);
        return status;
    }
    d->file.part.vertex_count = 3 * d->facets;
    for (size_t a = 0; a < 3; a++)
        d->file.part.rounding.is_float[a] = d->binary;
    d->file.base.has_face_normals = true;
    d->file.base.largest_coordinate = d->binary ? FLT_MAX : DBL_MAX;
    *document = ffd_file_document_ready(&d->file, !d->binary, source);
    return FFD_OK;
}
