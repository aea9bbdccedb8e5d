/* vtk.c - structured grids of VTK in its legacy format: the control points at rest, with the offsets, weights
   and knots as arrays beside them. Written as text, read as text and in binary (big-endian), versions to 5.1.
 */
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "lattice/formats/grid_arrays.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/written_text.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The types of arrays. vtkIdType is written as int. size: 0: those that are only skipped, bits and texts. */
typedef struct vtk_type {
    const char *name;
    size_t size;
    bool is_float, is_signed;
} vtk_type;

#define BITS "bit"
#define TEXTS "string"

static const vtk_type types[] = {{"unsigned_char", 1, false, false},
                                 {"char", 1, false, true},
                                 {"unsigned_short", 2, false, false},
                                 {"short", 2, false, true},
                                 {"unsigned_int", 4, false, false},
                                 {"int", 4, false, true},
                                 {"unsigned_long", 8, false, false},
                                 {"long", 8, false, true},
                                 {"float", 4, true, true},
                                 {"double", 8, true, true},
                                 {"vtkidtype", 4, false, true},
                                 {"vtktypeint64", 8, false, true},
                                 {"vtktypeuint64", 8, false, false},
                                 {BITS, 0, false, false},
                                 {TEXTS, 0, false, false}};

typedef struct vtk_reader {
    const char *name;
    const format_wish *wish;
    text_scan scan;
    bool is_binary, is_of_vtk; /* is_of_vtk: by the title that VTK writes */
    size_t dimensions[3];
    bool has_dimensions, in_points; /* in_points: arrays are those of the points */
    grid_arrays arrays;
    ffd_error *error;
} vtk_reader;

#define REFUSE(r, ...) ffd_fail_line((r)->error, FFD_E_INVALID, (r)->name, (r)->scan.line, __VA_ARGS__)

static ffd_status take_word(vtk_reader *r, const char *what, text_word *word)
{
    return ffd_next_word(&r->scan, word) ? FFD_OK : REFUSE(r, "the file ends where %s is expected", what);
}

static ffd_status take_count(vtk_reader *r, const char *what, uint64_t *count)
{
    text_word word;
    TRY(take_word(r, what, &word));
    return ffd_text_whole(word, count) && *count <= UINT64_C(1) << 40
               ? FFD_OK
               : REFUSE(r, "\"%s\" is not %s", ffd_text_shown(word).text, what);
}

static ffd_status refuse_type(vtk_reader *r, const char *type)
{
    return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, r->scan.line,
                         "arrays of the type \"%s\" are not supported", type);
}

static ffd_status take_type(vtk_reader *r, const vtk_type **type)
{
    text_word word;
    TRY(take_word(r, "a type", &word));
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        if (ffd_text_is_any_case(word, types[t].name)) {
            *type = &types[t];
            return FFD_OK;
        }
    return refuse_type(r, ffd_text_shown(word).text);
}

/* Where binary data begin: behind the line. */
static const char *begin_binary(const vtk_reader *r)
{
    const char *at = r->scan.at;
    while (at < r->scan.last && *at != '\n')
        at++;
    return at + (at < r->scan.last);
}

/* Skips texts in binary. In front of each is its length in 1, 2, 4 or 8 bytes: 3 less the upper two bits is
   the power of two. */
static ffd_status skip_binary_texts(vtk_reader *r, uint64_t count)
{
    const char *at = begin_binary(r);
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t left = (uint64_t)(r->scan.last - at);
        const size_t size = left ? (size_t)1 << (3 - ((unsigned char)*at >> 6)) : 1;
        uint64_t length = left ? (unsigned char)*at & 63 : 0;
        for (size_t b = 1; b < size && b < left; b++)
            length = length << 8 | (unsigned char)at[b];
        if (size > left || length > left - size)
            return REFUSE(r, "the file ends within an array of %" PRIu64 " texts", count);
        at += size + length;
    }
    r->scan.at = at;
    return FFD_OK;
}

/* Skips bits, or texts, which are a line each. */
static ffd_status skip_array(vtk_reader *r, const vtk_type *type, uint64_t count)
{
    const bool is_text = strcmp(type->name, TEXTS) == 0;
    text_word word;
    if (r->is_binary && is_text)
        return skip_binary_texts(r, count);
    if (r->is_binary) {
        const char *const at = begin_binary(r);
        if ((uint64_t)(r->scan.last - at) < (count + 7) / 8)
            return REFUSE(r, "the file ends within an array of %" PRIu64 " bits", count);
        r->scan.at = at + (count + 7) / 8;
        return FFD_OK;
    }
    for (uint64_t i = 0; i < count; i++)
        if (is_text ? !ffd_text_next_line(&r->scan) : !ffd_next_word(&r->scan, &word))
            return REFUSE(r, "the file ends within an array of %" PRIu64 " texts or bits", count);
    if (is_text && count)
        ffd_text_next_line(&r->scan);
    return FFD_OK;
}

/* Reads or skips `count` numbers in binary. */
static ffd_status take_binary(vtk_reader *r, const vtk_type *type, uint64_t count, double *values)
{
    const char *const at = begin_binary(r);
    if ((uint64_t)(r->scan.last - at) / type->size < count)
        return REFUSE(r, "the file ends within an array of %" PRIu64 " numbers", count);
    for (uint64_t i = 0; values && i < count; i++)
        values[i] = ffd_grid_number((const unsigned char *)at + i * type->size, type->size, type->is_float,
                                    type->is_signed, true);
    r->scan.at = at + count * type->size;
    return FFD_OK;
}

/* Reads `count` numbers; values: NULL: skips them. */
static ffd_status take_numbers(vtk_reader *r, const vtk_type *type, uint64_t count, double *values)
{
    text_word word;
    if (r->is_binary)
        return take_binary(r, type, count, values);
    for (uint64_t i = 0; i < count; i++) {
        if (values)
            TRY(ffd_next_number(&r->scan, r->name, &values[i], r->error));
        else
            TRY(take_word(r, "a number", &word));
    }
    return FFD_OK;
}

/* Takes an array: keeps it if it is one of a lattice. */
static ffd_status take_array(vtk_reader *r, text_word name, const vtk_type *type, uint64_t components,
                             uint64_t tuples)
{
    const uint64_t per_byte = strcmp(type->name, BITS) == 0 ? 8 : 1;
    const uint64_t left = (uint64_t)(r->scan.last - r->scan.at) * per_byte;
    double **kept = NULL;
    if (components > left || tuples > left || components * tuples > left)
        return REFUSE(r, "the file ends within the array \"%s\"", ffd_text_shown(name).text);
    const uint64_t count = components * tuples;
    if (type->size == 0)
        return ffd_grid_array_is_known(name, r->in_points) ? refuse_type(r, type->name)
                                                           : skip_array(r, type, count);
    TRY(ffd_grid_array_take(&r->arrays, name, r->in_points, components, tuples, &kept, r->name, r->wish,
                            r->error));
    return take_numbers(r, type, count, kept ? *kept : NULL);
}

/* FIELD name count, then arrays: name components tuples type */
static ffd_status take_field(vtk_reader *r)
{
    text_word name;
    uint64_t count;
    TRY(take_word(r, "the name of a field", &name));
    TRY(take_count(r, "the number of arrays", &count));
    for (uint64_t a = 0; a < count; a++) {
        const vtk_type *type;
        uint64_t components, tuples;
        do {
            TRY(take_word(r, "the name of an array", &name));
            if (ffd_text_is(name, "METADATA"))
                while (ffd_text_next_line(&r->scan) && ffd_text_word(&r->scan, &name))
                    ;
        } while (ffd_text_is(name, "METADATA") || name.first == name.last);
        TRY(take_count(r, "the number of components", &components));
        TRY(take_count(r, "the number of tuples", &tuples));
        TRY(take_type(r, &type));
        TRY(take_array(r, name, type, components, tuples));
    }
    return FFD_OK;
}

static ffd_status take_dimensions(vtk_reader *r)
{
    for (int a = 0; a < 3; a++) {
        uint64_t count;
        TRY(take_count(r, "a dimension", &count));
        r->dimensions[a] = (size_t)count;
    }
    r->has_dimensions = true;
    return ffd_format_check_size(r->dimensions, r->name, r->wish, r->error);
}

static ffd_status take_points(vtk_reader *r)
{
    static const char name[] = "points";
    const vtk_type *type;
    uint64_t count;
    if (!r->has_dimensions)
        return REFUSE(r, "POINTS are there before DIMENSIONS");
    TRY(take_count(r, "the number of points", &count));
    TRY(take_type(r, &type));
    if (count != (uint64_t)r->dimensions[0] * r->dimensions[1] * r->dimensions[2])
        return REFUSE(r, "there are %" PRIu64 " points, but the dimensions are %zu by %zu by %zu", count,
                      r->dimensions[0], r->dimensions[1], r->dimensions[2]);
    r->in_points = true;
    const ffd_status status = take_array(r, (text_word){name, name + sizeof name - 1}, type, 3, count);
    r->in_points = false;
    return status;
}

/* The attributes of points or cells, by their keyword: how many components they have. */
static const struct {
    const char *keyword;
    uint64_t components;
} attributes[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                  {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};

/* SCALARS name type [components], then LOOKUP_TABLE name. */
static ffd_status take_scalars(vtk_reader *r, uint64_t tuples)
{
    const vtk_type *type;
    text_word name, word;
    uint64_t components = 1;
    TRY(take_word(r, "the name of an array", &name));
    TRY(take_type(r, &type));
    if (ffd_text_word(&r->scan, &word) && !ffd_text_whole(word, &components))
        return REFUSE(r, "\"%s\" is not a number of components", ffd_text_shown(word).text);
    const text_scan before = r->scan;
    if (ffd_next_word(&r->scan, &word) && ffd_text_is(word, "LOOKUP_TABLE"))
        TRY(take_word(r, "the name of a table", &word));
    else
        r->scan = before;
    return take_array(r, name, type, components, tuples);
}

/* TEXTURE_COORDINATES name dimension type; COLOR_SCALARS name components; LOOKUP_TABLE name size */
static ffd_status skip_attribute(vtk_reader *r, text_word keyword, uint64_t tuples)
{
    const vtk_type *type = &types[0];
    text_word name;
    uint64_t count;
    const bool is_table = ffd_text_is(keyword, "LOOKUP_TABLE");
    TRY(take_word(r, "a name", &name));
    TRY(take_count(r, "a count", &count));
    if (ffd_text_is(keyword, "TEXTURE_COORDINATES"))
        TRY(take_type(r, &type));
    else if (!ffd_text_is(keyword, "COLOR_SCALARS") && !is_table)
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, r->scan.line, "\"%s\" is not supported",
                             ffd_text_shown(keyword).text);
    return take_array(r, name, type, is_table ? 4 : count, is_table ? count : tuples);
}

static ffd_status take_attribute(vtk_reader *r, text_word keyword, uint64_t tuples)
{
    const vtk_type *type;
    text_word name;
    if (ffd_text_is(keyword, "FIELD"))
        return take_field(r);
    if (ffd_text_is(keyword, "SCALARS"))
        return take_scalars(r, tuples);
    for (size_t a = 0; a < sizeof attributes / sizeof *attributes; a++)
        if (ffd_text_is(keyword, attributes[a].keyword)) {
            TRY(take_word(r, "the name of an array", &name));
            TRY(take_type(r, &type));
            return take_array(r, name, type, attributes[a].components, tuples);
        }
    return skip_attribute(r, keyword, tuples);
}

static bool has_title(text_scan scan, const char *title)
{
    const size_t length = strlen(title);
    return (size_t)(scan.last - scan.at) > length && memcmp(scan.at, title, length) == 0 &&
           (scan.at[length] == '\n' || scan.at[length] == '\r');
}

static ffd_status take_front(vtk_reader *r)
{
    text_word word;
    if (!ffd_text_word(&r->scan, &word) || !ffd_text_is(word, "#") || !ffd_text_word(&r->scan, &word) ||
        !ffd_text_is(word, "vtk"))
        return ffd_fail_file(r->error, FFD_E_INVALID, r->name,
                             "does not begin with \"# vtk DataFile Version\"");
    ffd_text_next_line(&r->scan);
    r->is_of_vtk = has_title(r->scan, "vtk output");
    ffd_text_next_line(&r->scan);
    TRY(take_word(r, "ASCII or BINARY", &word));
    r->is_binary = ffd_text_is_any_case(word, "binary");
    if (!r->is_binary && !ffd_text_is_any_case(word, "ascii"))
        return REFUSE(r, "\"%s\" is not ASCII or BINARY", ffd_text_shown(word).text);
    TRY(take_word(r, "DATASET", &word));
    if (!ffd_text_is(word, "DATASET"))
        return REFUSE(r, "\"%s\" is not DATASET", ffd_text_shown(word).text);
    TRY(take_word(r, "a kind of data", &word));
    return ffd_text_is(word, "STRUCTURED_GRID")
               ? FFD_OK
               : ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, r->scan.line,
                               "the data are a %s, not a STRUCTURED_GRID", ffd_text_shown(word).text);
}

static ffd_status take_parts(vtk_reader *r)
{
    text_word word;
    uint64_t tuples = 0;
    while (ffd_next_word(&r->scan, &word)) {
        if (ffd_text_is(word, "METADATA")) /* to the next empty line */
            while (ffd_text_next_line(&r->scan) && ffd_text_word(&r->scan, &word))
                ;
        else if (ffd_text_is(word, "DIMENSIONS"))
            TRY(take_dimensions(r));
        else if (ffd_text_is(word, "POINTS"))
            TRY(take_points(r));
        else if (ffd_text_is(word, "POINT_DATA") || ffd_text_is(word, "CELL_DATA")) {
            r->in_points = ffd_text_is(word, "POINT_DATA");
            TRY(take_count(r, "a number of tuples", &tuples));
        } else
            TRY(take_attribute(r, word, tuples));
    }
    return r->has_dimensions ? FFD_OK : ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has no DIMENSIONS");
}

ffd_status ffd_lattice_read_vtk(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    vtk_reader r = {.name = name, .wish = wish, .error = error};
    ffd_status status;
    *spec = NULL;
    ffd_text_begin(&r.scan, file->data, file->size, false);
    TRY_END(take_front(&r));
    TRY_END(take_parts(&r));
    TRY_END(ffd_grid_arrays_make(&r.arrays, r.dimensions, name, wish, spec, error));
    if (wish->notes)
        wish->notes->is_rounded = r.is_of_vtk && !r.is_binary;
end:
    ffd_grid_arrays_free(&r.arrays);
    return status;
}

/* Writes numbers, so many a line. */
static ffd_status write_numbers(const double *values, size_t count, size_t line, byte_buffer *text,
                                file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        ffd_buffer_number(text, values[i]);
        ffd_buffer_text(text, i % line == line - 1 || i + 1 == count ? "\n" : " ");
        if (i % line == line - 1)
            TRY(ffd_text_written(text, false, output, error));
    }
    return FFD_OK;
}

static ffd_status write_front(const ffd_lattice *lattice, byte_buffer *text, file_output *output,
                              ffd_error *error)
{
    const knot_vector *const knots = lattice->knots;
    ffd_buffer_text(
        text,
        "# vtk DataFile Version 3.0\nlattice of ffd\nASCII\nDATASET STRUCTURED_GRID\nFIELD FieldData 5\n");
    ffd_buffer_format(text, "ffd_degree 3 1 int\n%d %d %d\n", knots[0].degree, knots[1].degree,
                      knots[2].degree);
    ffd_buffer_format(text, "ffd_closed 3 1 int\n%d %d %d\n", ffd_knots_closed(&knots[0]),
                      ffd_knots_closed(&knots[1]), ffd_knots_closed(&knots[2]));
    for (int a = 0; a < 3; a++) {
        size_t count;
        const double *const list = ffd_grid_knots(&knots[a], &count);
        ffd_buffer_format(text, "ffd_knots_%c %zu 1 double\n", "uvw"[a], count);
        TRY(write_numbers(list, count, 9, text, output, error));
    }
    ffd_buffer_format(text, "DIMENSIONS %zu %zu %zu\nPOINTS %zu double\n", lattice->size[0], lattice->size[1],
                      lattice->size[2], lattice->count);
    return FFD_OK;
}

static ffd_status write_weights(const char *name, const double *weights, size_t count, byte_buffer *text,
                                file_output *output, ffd_error *error)
{
    ffd_buffer_format(text, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
    return write_numbers(weights, count, 1, text, output, error);
}

ffd_status ffd_lattice_write_vtk(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    byte_buffer text = {0};
    const size_t count = lattice->count;
    ffd_status status;
    TRY_END(write_front(lattice, &text, output, error));
    TRY_END(write_numbers(lattice->rest, 3 * count, 3, &text, output, error));
    ffd_buffer_format(&text, "POINT_DATA %zu\nVECTORS offset double\n", count);
    TRY_END(write_numbers(lattice->difference, 3 * count, 3, &text, output, error));
    if (lattice->rest_weights)
        TRY_END(write_weights("weight", lattice->rest_weights, count, &text, output, error));
    if (lattice->rest_weights &&
        memcmp(lattice->rest_weights, lattice->deformed_weights, count * sizeof(double)) != 0)
        TRY_END(write_weights("weight_deformed", lattice->deformed_weights, count, &text, output, error));
    TRY_END(ffd_text_written(&text, true, output, error));
end:
    ffd_buffer_free(&text);
    return status;
}
