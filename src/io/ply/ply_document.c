#include "io/ply/ply_document.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

void ffd_ply_document_walk(const ply_document *d, const ply_element *element, ply_walk *walk)
{
    const char *first = (const char *)d->file.input.data;
    *walk = (ply_walk){.header = &d->header,
                       .at = first + element->begin,
                       .last = first + d->header.end,
                       .line = element->begin_line};
}

ffd_status ffd_ply_refuse_vertex(const ply_document *d, const ply_walk *walk, const char *what, uint64_t row,
                                 number_type type, text_word word, ffd_error *error)
{
    const bool text = d->header.encoding == PLY_ASCII;
    double value = 0;
    ffd_ply_load(d->header.encoding, type, word, &value);
    const number_text number = ffd_number_text(value);
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, text ? walk->line : 0,
                         "%s %" PRIu64 ": there is no vertex %.*s%s", what, row,
                         text ? ffd_text_display_size(word) : (int)strlen(number.text),
                         text ? word.first : number.text,
                         ffd_only(d->file.part.vertex_count, " (both counted from 0)").text);
}

/* Returns where the number of a slot is stored. Harmonics are not stored, but stay in the file: `nowhere`. */
static double *place_of(ply_document *d, size_t slot, size_t row, double *nowhere)
{
    if (slot >= PLY_REST_SLOT)
        return nowhere;
    if (slot >= PLY_ROTATION_SLOT)
        return ffd_ply_splat_number(&d->splats[row], slot);
    double *const list = slot < PLY_NORMAL_SLOT ? d->file.positions : d->file.directions;
    return &list[3 * row + slot % PLY_NORMAL_SLOT];
}

static ffd_status read_number(ply_document *d, const ply_walk *walk, const ply_property *property,
                              text_word word, uint64_t row, ffd_error *error)
{
    double nowhere, *const value = place_of(d, property->slot, (size_t)row, &nowhere);
    if (ffd_ply_load(d->header.encoding, property->type, word, value))
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->line,
                         "%.*s of vertex %" PRIu64 " (counted from 0) is not a number: \"%s\"",
                         ffd_text_display_size(property->name), property->name.first, row,
                         ffd_text_shown(word).text);
}

static ffd_status read_vertex(ply_document *d, ply_walk *walk, uint64_t row, ffd_error *error)
{
    ffd_ply_walk_row(walk);
    for (size_t i = 0; i < d->vertex->property_count; i++) {
        const ply_property *property = &d->vertex->properties[i];
        text_word word;
        if (property->slot == PLY_NO_SLOT)
            ffd_ply_walk_skip(walk, property);
        else {
            ffd_ply_walk_value(walk, property->type, &word);
            TRY(read_number(d, walk, property, word, row, error));
        }
    }
    return FFD_OK;
}

/* Rows of fixed size that a thread reads at a time. */
#define READ_TILE ((size_t)4096)

/* Reads rows of fixed size, in which each number has a fixed offset. The numbers of splats stay in the
   file. */
static void read_rows(void *context, size_t tile, size_t first, size_t last, int worker)
{
    ply_document *const d = context;
    size_t slots[PLY_ROTATION_SLOT], slot_count = 0;
    (void)tile;
    (void)worker;
    for (size_t slot = 0; slot < PLY_ROTATION_SLOT; slot++)
        if (d->offsets[slot] != PLY_NOWHERE)
            slots[slot_count++] = slot;
    ffd_file_prefault(ply_row(d, first), (last - first) * d->vertex->least);
    for (size_t row = first; row < last; row++) {
        const char *const at = ply_row(d, row);
        for (size_t i = 0; i < slot_count; i++) {
            const size_t slot = slots[i];
            const double value = ply_load_binary(d->header.encoding, d->types[slot], at + d->offsets[slot]);
            /* The array of normals is zeroed already; not touching its pages saves their memory. */
            if (slot < PLY_NORMAL_SLOT || value != 0 || signbit(value))
                *place_of(d, slot, row, NULL) = value;
        }
    }
}

static ffd_status read_vertices(ply_document *d, ffd_error *error)
{
    const size_t count = (size_t)d->vertex->count;
    ply_walk walk;
    d->file.positions = ffd_alloc_whole(count, 3 * sizeof *d->file.positions);
    if (d->has_normals)
        d->file.directions = ffd_alloc_sparse(count, 3 * sizeof *d->file.directions);
    const bool holds_splats = d->file.part.has_ellipsoids && !d->has_fixed_rows;
    if (holds_splats)
        d->splats = ffd_alloc(count, sizeof *d->splats);
    if (!d->file.positions || (d->has_normals && !d->file.directions) || (holds_splats && !d->splats))
        return ffd_fail_memory(error);
    if (d->has_fixed_rows) {
        ffd_parallel_tiles(count, READ_TILE, d->threads, read_rows, d);
        return FFD_OK;
    }
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (uint64_t row = 0; row < count; row++)
        TRY(read_vertex(d, &walk, row, error));
    return FFD_OK;
}

static void describe_part(ply_document *d)
{
    const bool narrow =
        d->types[0] == NUMBER_FLOAT || d->types[1] == NUMBER_FLOAT || d->types[2] == NUMBER_FLOAT;
    d->file.part.vertex_count = (size_t)d->vertex->count;
    for (size_t a = 0; a < 3; a++)
        d->file.part.rounding.is_float[a] = d->types[a] == NUMBER_FLOAT;
    d->file.part.normal_count = d->has_normals ? d->file.part.vertex_count : 0;
    d->file.base.largest_coordinate = narrow ? FLT_MAX : DBL_MAX;
}

/* Notes marks that text files may have. */
static ffd_status note_marks(ply_document *d, ffd_error *error)
{
    const file_input *const input = &d->file.input;
    ffd_status status = FFD_OK;
    if (ffd_text_has_mark(input->data, input->size))
        status =
            ffd_flaw_line(&d->file.base.flaws, d->file.name, 1, error, "a byte order mark is before \"ply\"");
    return status ? status : ffd_file_document_note_mark(&d->file, d->header.end, error);
}

/* More rows than the header states would stay where they are, and a text behind them belongs to no format. A
   Ctrl-Z, the end mark of old texts, is a flaw of its own. */
static ffd_status note_behind(ply_document *d, const file_input *input, ffd_error *error)
{
    const char *at = (const char *)input->data + d->behind;
    const char *const last = (const char *)input->data + input->size;
    while (at < last && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n' || *at == '\x1a'))
        at++;
    if (at == last)
        return FFD_OK;
    return ffd_flaw_line(&d->file.base.flaws, d->file.name, 0, error,
                         "%zu %s behind the rows that the header states: %s as %s", (size_t)(last - at),
                         ffd_plural((uint64_t)(last - at), "byte stands", "bytes stand"),
                         ffd_plural((uint64_t)(last - at), "it stays", "they stay"),
                         ffd_plural((uint64_t)(last - at), "it is", "they are"));
}

ffd_status ffd_ply_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    ply_document *d = ffd_file_document_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    d->threads = ffd_threads_for_bytes(source->threads, input->size);
    ffd_status status;
    TRY_END(ffd_ply_header_read(input, d->file.name, &d->header, error));
    TRY_END(note_marks(d, error));
    TRY_END(ffd_ply_find_roles(d, error));
    TRY_END(ffd_ply_walk_check(&d->header, input, d->file.name, &d->behind, error));
    TRY_END(note_behind(d, input, error));
    TRY_END(read_vertices(d, error));
    describe_part(d);
    *document = ffd_file_document_ready(&d->file, d->header.encoding == PLY_ASCII, source);
    return FFD_OK;
end:
    ffd_ply_header_free(&d->header);
    ffd_free(d->splats);
    ffd_file_document_free(&d->file);
    return status;
}

void ffd_ply_close(mesh_document *document)
{
    ply_document *const d = (ply_document *)document;
    if (d) {
        ffd_ply_header_free(&d->header);
        ffd_free(d->splats);
        ffd_free(d->float_splats);
        ffd_free(d->double_splats);
        ffd_free(d->new_turns);
        ffd_free(d->splat_marks);
    }
    ffd_file_document_close(document);
}
