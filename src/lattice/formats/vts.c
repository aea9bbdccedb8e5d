/* vts.c - structured grids of VTK in XML, with the arrays of vtk.c. Written as text; read as text, as base64
   within the file, and appended to it raw or as base64, of both byte orders, plain or compressed by zlib. */
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include "base/text/buffer.h"
#include "base/text/xml_scan.h"
#include "io/deflate/inflate.h"
#include "lattice/formats/grid_arrays.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/written_text.h"
#include <inttypes.h>
#include <string.h>

#define DOCUMENT "VTKFile"
/* The most blocks of a compressed array. */
#define MOST_BLOCKS ((uint64_t)1 << 24)

typedef struct vts_type {
    const char *name;
    size_t size;
    bool is_float, is_signed;
} vts_type;

static const vts_type types[] = {{"int8", 1, false, true},   {"uint8", 1, false, false},
                                 {"int16", 2, false, true},  {"uint16", 2, false, false},
                                 {"int32", 4, false, true},  {"uint32", 4, false, false},
                                 {"int64", 8, false, true},  {"uint64", 8, false, false},
                                 {"float32", 4, true, true}, {"float64", 8, true, true}};

/* An array that is kept. */
typedef struct vts_array {
    double *values;
    uint64_t count, offset; /* offset: in what is appended */
    const vts_type *type;
    text_word text; /* between its tags */
    enum { IN_TEXT, IN_BASE64, APPENDED } place;
} vts_array;

typedef struct vts_reader {
    const char *name;
    const format_wish *wish;
    xml_scan scan;
    bool is_big_endian, is_compressed;
    size_t word; /* bytes of a number in a header */
    size_t size[3];
    bool has_size, is_whole; /* is_whole: the end of the document has been seen */
    enum { NOWHERE, OF_GRID, OF_POINTS, COORDINATES } place;
    grid_arrays arrays;
    vts_array kept[GRID_ARRAYS];
    size_t kept_count;
    text_word appended;
    bool is_raw; /* what is appended; else base64 */
    ffd_error *error;
} vts_reader;

#define REFUSE(r, ...) ffd_fail_file((r)->error, FFD_E_INVALID, (r)->name, __VA_ARGS__)

static ffd_status take_file(vts_reader *r, const xml_tag *tag)
{
    text_word value;
    if (!ffd_xml_attribute(tag, "type", &value) || !ffd_text_is(value, "StructuredGrid"))
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name, "is a %s of VTK, not a StructuredGrid",
                             ffd_text_shown(value).text);
    r->is_big_endian = ffd_xml_attribute(tag, "byte_order", &value) && ffd_text_is(value, "BigEndian");
    r->word = ffd_xml_attribute(tag, "header_type", &value) && ffd_text_is(value, "UInt64") ? 8 : 4;
    r->is_compressed = ffd_xml_attribute(tag, "compressor", &value) && value.first < value.last;
    return !r->is_compressed || ffd_text_is(value, "vtkZLibDataCompressor")
               ? FFD_OK
               : ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                               "is compressed by %s; vtkZLibDataCompressor is supported",
                               ffd_text_shown(value).text);
}

/* "0 3 0 3 0 3" */
static ffd_status take_extent(vts_reader *r, const xml_tag *tag)
{
    text_word value, word;
    text_scan scan;
    double ends[6];
    if (!ffd_xml_attribute(tag, "Extent", &value))
        return REFUSE(r, "has a Piece without an Extent");
    if (r->has_size)
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                             "has several pieces, which are several lattices");
    ffd_text_begin(&scan, value.first, (size_t)(value.last - value.first), false);
    for (int e = 0; e < 6; e++)
        if (!ffd_next_word(&scan, &word) || !ffd_text_number(word, &ends[e]) || !(fabs(ends[e]) < 1e9) ||
            ends[e] != (double)(long)ends[e])
            return REFUSE(r, "has the Extent \"%s\", not six whole numbers", ffd_text_shown(value).text);
    for (int a = 0; a < 3; a++) {
        if (ends[2 * a + 1] < ends[2 * a])
            return REFUSE(r, "has the Extent \"%s\", which is empty", ffd_text_shown(value).text);
        r->size[a] = (size_t)(ends[2 * a + 1] - ends[2 * a]) + 1;
    }
    r->has_size = true;
    return ffd_format_check_size(r->size, r->name, r->wish, r->error);
}

static ffd_status take_whole(vts_reader *r, const xml_tag *tag, const char *name, uint64_t unless,
                             uint64_t *number)
{
    text_word value;
    *number = unless;
    if (!ffd_xml_attribute(tag, name, &value))
        return FFD_OK;
    return ffd_text_whole(value, number) && *number <= UINT64_C(1) << 48
               ? FFD_OK
               : REFUSE(r, "has the %s \"%s\", not a whole number", name, ffd_text_shown(value).text);
}

static ffd_status find_type(vts_reader *r, const xml_tag *tag, const vts_type **type)
{
    text_word value;
    ffd_xml_attribute(tag, "type", &value);
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        if (ffd_text_is_any_case(value, types[t].name)) {
            *type = &types[t];
            return FFD_OK;
        }
    return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                         "has an array of the type \"%s\", which is not supported",
                         ffd_text_shown(value).text);
}

static ffd_status find_place(vts_reader *r, const xml_tag *tag, vts_array *array)
{
    text_word value;
    ffd_xml_attribute(tag, "format", &value);
    if (ffd_text_is(value, "appended")) {
        array->place = APPENDED;
        return take_whole(r, tag, "offset", 0, &array->offset);
    }
    if (!ffd_text_is(value, "binary") && !ffd_text_is(value, "ascii") && value.first < value.last)
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name, "has an array of the format \"%s\"",
                             ffd_text_shown(value).text);
    array->place = ffd_text_is(value, "binary") ? IN_BASE64 : IN_TEXT;
    const char *const end =
        tag->is_empty ? r->scan.at : memchr(r->scan.at, '<', (size_t)(r->scan.last - r->scan.at));
    array->text = (text_word){r->scan.at, end ? end : r->scan.last};
    return FFD_OK;
}

/* Takes an array: keeps it if it is one of a lattice. */
static ffd_status take_array(vts_reader *r, const xml_tag *tag)
{
    static const char points[] = "points";
    vts_array array = {.values = NULL};
    text_word name;
    double **values;
    uint64_t components, tuples;
    const bool of_points = r->place != OF_GRID;
    if (r->place == NOWHERE)
        return FFD_OK;
    if (of_points && !r->has_size)
        return REFUSE(r, "has an array of points outside of a Piece");
    ffd_xml_attribute(tag, "Name", &name);
    if (r->place == COORDINATES)
        name = (text_word){points, points + sizeof points - 1};
    TRY(take_whole(r, tag, "NumberOfComponents", 1, &components));
    TRY(take_whole(r, tag, "NumberOfTuples", 1, &tuples));
    if (of_points)
        tuples = (uint64_t)r->size[0] * r->size[1] * r->size[2];
    if (!ffd_grid_array_is_known(name, of_points))
        return FFD_OK;
    if (components > 3 * FFD_MAX_CONTROL_POINTS || tuples > 3 * FFD_MAX_CONTROL_POINTS)
        return ffd_fail_file(r->error, FFD_E_LIMIT, r->name, "has more than %zu numbers in the array \"%s\"",
                             3 * FFD_MAX_CONTROL_POINTS, ffd_text_shown(name).text);
    if (tuples * components > 16 * (uint64_t)(r->scan.last - r->scan.at) + 1024 && !r->is_compressed)
        return REFUSE(r, "ends within the array \"%s\"", ffd_text_shown(name).text);
    TRY(ffd_grid_array_take(&r->arrays, name, of_points, components, tuples, &values, r->name, r->wish,
                            r->error));
    if (!values)
        return FFD_OK;
    TRY(find_type(r, tag, &array.type));
    TRY(find_place(r, tag, &array));
    array.values = *values;
    array.count = components * tuples;
    r->kept[r->kept_count++] = array;
    return FFD_OK;
}

/* Returns where a text stands last, or NULL. */
static const char *find_last(const char *first, const char *last, const char *text)
{
    const size_t length = strlen(text);
    for (const char *at = last; (size_t)(at - first) >= length; at--)
        if (memcmp(at - length, text, length) == 0)
            return at - length;
    return NULL;
}

/* What is appended begins behind _, and ends with the document. */
static ffd_status take_appended(vts_reader *r, const xml_tag *tag)
{
    text_word value;
    const char *const mark = memchr(r->scan.at, '_', (size_t)(r->scan.last - r->scan.at));
    ffd_xml_attribute(tag, "encoding", &value);
    r->is_raw = ffd_text_is(value, "raw");
    if (!mark || (!r->is_raw && !ffd_text_is(value, "base64")))
        return REFUSE(r, "has appended data of the encoding \"%s\"", ffd_text_shown(value).text);
    const char *const end = find_last(mark + 1, r->scan.last, "</" DOCUMENT ">");
    r->is_whole = end;
    r->appended = (text_word){mark + 1, end ? end : r->scan.last};
    r->scan.at = r->scan.last;
    return FFD_OK;
}

static ffd_status take_tag(vts_reader *r, const xml_tag *tag)
{
    const bool is_grid = ffd_text_is(tag->name, "FieldData"), is_points = ffd_text_is(tag->name, "PointData");
    const bool is_place = is_grid || is_points || ffd_text_is(tag->name, "Points");
    if (tag->is_end || (is_place && tag->is_empty)) {
        r->place = is_place ? NOWHERE : r->place;
        r->is_whole = r->is_whole || (tag->is_end && ffd_text_is(tag->name, DOCUMENT));
        return FFD_OK;
    }
    if (is_place)
        r->place = is_grid ? OF_GRID : is_points ? OF_POINTS : COORDINATES;
    else if (ffd_text_is(tag->name, DOCUMENT))
        return take_file(r, tag);
    else if (!r->word)
        return REFUSE(r, "does not begin with " DOCUMENT);
    else if (ffd_text_is(tag->name, "Piece"))
        return take_extent(r, tag);
    else if (ffd_text_is(tag->name, "DataArray"))
        return take_array(r, tag);
    else if (ffd_text_is(tag->name, "AppendedData"))
        return take_appended(r, tag);
    return FFD_OK;
}

/* A document begins with its first tag, behind an optional mark of its encoding. */
static ffd_status check_start(vts_reader *r)
{
    text_scan scan;
    ffd_text_begin(&scan, r->scan.at, (size_t)(r->scan.last - r->scan.at), false);
    return ffd_text_find(&scan) && *scan.at == '<' ? FFD_OK : REFUSE(r, "does not begin with a tag of XML");
}

static ffd_status take_tags(vts_reader *r)
{
    bool found = true;
    while (found) {
        xml_tag tag;
        TRY(ffd_xml_next(&r->scan, &tag, &found, r->error));
        if (found)
            TRY(take_tag(r, &tag));
    }
    if (!r->has_size)
        return REFUSE(r, "has no Piece of a StructuredGrid");
    return r->is_whole ? FFD_OK : REFUSE(r, "ends before </" DOCUMENT ">");
}

/* Bytes of an array: as they are, or of base64. */
typedef struct vts_bytes {
    const unsigned char *raw; /* raw: size bytes */
    size_t size;
    text_word base64;
} vts_bytes;

/* Takes the next bytes. */
static ffd_status take_bytes(const vts_reader *r, vts_bytes *from, unsigned char *bytes, size_t count)
{
    size_t taken = from->size < count ? from->size : count;
    if (from->raw) {
        memcpy(bytes, from->raw, taken);
        from->raw += taken;
        from->size -= taken;
    } else
        taken = ffd_base64_take(&from->base64.first, from->base64.last, bytes, count);
    return taken == count ? FFD_OK : REFUSE(r, "ends within an array");
}

static uint64_t word_at(const vts_reader *r, const unsigned char *bytes)
{
    uint64_t number = 0;
    for (size_t i = 0; i < r->word; i++)
        number |= (uint64_t)bytes[r->is_big_endian ? r->word - 1 - i : i] << (8 * i);
    return number;
}

/* Data that are not compressed have their size in front, in one text with them. */
static ffd_status read_plain(const vts_reader *r, vts_bytes *from, unsigned char *bytes, size_t count)
{
    unsigned char *const all = ffd_alloc(count + r->word, 1);
    if (!all)
        return ffd_fail_memory(r->error);
    ffd_status status = take_bytes(r, from, all, count + r->word);
    if (!status && word_at(r, all) != count)
        status = REFUSE(r, "has an array of %" PRIu64 " bytes, not of %zu", word_at(r, all), count);
    if (!status)
        memcpy(bytes, all + r->word, count);
    ffd_free(all);
    return status;
}

/* The sizes of blocks: how many, of a whole one, of the last, if it is shorter, and of each when compressed.
 */
static ffd_status read_head(const vts_reader *r, vts_bytes *from, uint64_t **head, uint64_t *blocks)
{
    unsigned char first[3 * 8];
    const text_word begin = from->base64;
    *head = NULL;
    TRY(take_bytes(r, from, first, 3 * r->word));
    *blocks = word_at(r, first);
    const size_t left = from->raw ? from->size : (size_t)(from->base64.last - begin.first);
    if (*blocks > MOST_BLOCKS || *blocks > left)
        return REFUSE(r, "has a compressed array of %" PRIu64 " blocks", *blocks);
    const size_t size = (3 + (size_t)*blocks) * r->word;
    unsigned char *const bytes = ffd_alloc(size, 1);
    *head = ffd_alloc(3 + (size_t)*blocks, sizeof **head);
    ffd_status status = bytes && *head ? FFD_OK : ffd_fail_memory(r->error);
    if (!status && !from->raw) { /* it is a text of its own, with the rest of its last four characters */
        from->base64 = begin;
        status = take_bytes(r, from, bytes, size);
    } else if (!status) {
        memcpy(bytes, first, 3 * r->word);
        status = take_bytes(r, from, bytes + 3 * r->word, size - 3 * r->word);
    }
    for (size_t i = 0; !status && i < 3 + *blocks; i++)
        (*head)[i] = word_at(r, bytes + i * r->word);
    ffd_free(bytes);
    return status;
}

static ffd_status read_blocks(const vts_reader *r, vts_bytes *from, const uint64_t *head,
                              unsigned char *bytes, size_t count)
{
    const uint64_t blocks = head[0];
    size_t done = 0;
    uint64_t whole = 0;
    for (uint64_t b = 0; b < blocks; b++)
        whole += head[3 + b] < UINT32_MAX ? head[3 + b] : UINT32_MAX;
    const size_t most = from->raw ? from->size : (size_t)(from->base64.last - from->base64.first);
    if (whole > most)
        return REFUSE(r, "ends within a compressed array");
    unsigned char *const packed = ffd_alloc((size_t)whole + 1, 1);
    if (!packed)
        return ffd_fail_memory(r->error);
    const unsigned char *at = packed;
    ffd_status status = take_bytes(r, from, packed, (size_t)whole);
    for (uint64_t b = 0; b < blocks && !status; b++) {
        const uint64_t size = b + 1 == blocks && head[2] ? head[2] : head[1];
        if (size > count - done)
            status = REFUSE(r, "has a compressed array of more than %zu bytes", count);
        else
            status = ffd_inflate(at, (size_t)head[3 + b], false, bytes + done, (size_t)size, r->error);
        done += status ? 0 : (size_t)size;
        at += head[3 + b];
    }
    ffd_free(packed);
    return !status && done != count
               ? REFUSE(r, "has a compressed array of %zu bytes, not of %zu", done, count)
               : status;
}

static ffd_status read_packed(const vts_reader *r, vts_bytes *from, unsigned char *bytes, size_t count)
{
    uint64_t *head, blocks;
    ffd_status status = read_head(r, from, &head, &blocks);
    if (!status)
        status = read_blocks(r, from, head, bytes, count);
    ffd_free(head);
    return status;
}

static ffd_status read_encoded(const vts_reader *r, const vts_array *array)
{
    const size_t count = (size_t)array->count * array->type->size;
    vts_bytes from = {.base64 = array->text};
    if (array->place == APPENDED) {
        const size_t size = (size_t)(r->appended.last - r->appended.first);
        if (!r->appended.first || array->offset > size)
            return REFUSE(r, "has an array at the offset %" PRIu64 " of its appended data, which end before",
                          array->offset);
        from.base64 = (text_word){r->appended.first + array->offset, r->appended.last};
        from.raw = r->is_raw ? (const unsigned char *)from.base64.first : NULL;
        from.size = size - (size_t)array->offset;
    }
    unsigned char *const bytes = ffd_alloc(count, 1);
    if (!bytes)
        return ffd_fail_memory(r->error);
    const ffd_status status =
        r->is_compressed ? read_packed(r, &from, bytes, count) : read_plain(r, &from, bytes, count);
    for (size_t i = 0; !status && i < array->count; i++)
        array->values[i] = ffd_grid_number(bytes + i * array->type->size, array->type->size,
                                           array->type->is_float, array->type->is_signed, r->is_big_endian);
    ffd_free(bytes);
    return status;
}

static ffd_status read_array(const vts_reader *r, const vts_array *array)
{
    text_scan scan;
    if (array->place != IN_TEXT)
        return read_encoded(r, array);
    ffd_text_begin(&scan, array->text.first, (size_t)(array->text.last - array->text.first), false);
    for (uint64_t i = 0; i < array->count; i++)
        TRY(ffd_next_number(&scan, r->name, &array->values[i], r->error));
    return FFD_OK;
}

ffd_status ffd_lattice_read_vts(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    const char *const first = (const char *)file->data;
    vts_reader r = {
        .name = name, .wish = wish, .scan = {first, first + file->size, name, false}, .error = error};
    ffd_status status;
    *spec = NULL;
    TRY_END(check_start(&r));
    TRY_END(take_tags(&r));
    for (size_t k = 0; k < r.kept_count; k++)
        TRY_END(read_array(&r, &r.kept[k]));
    TRY_END(ffd_grid_arrays_make(&r.arrays, r.size, name, wish, spec, error));
end:
    ffd_grid_arrays_free(&r.arrays);
    return status;
}

/* What a writer shares. */
typedef struct vts_writer {
    byte_buffer text;
    file_output *output;
    ffd_error *error;
} vts_writer;

/* Writes an array of doubles. components: 0: it is one of the grid, of count tuples. */
static ffd_status write_array(vts_writer *w, const char *name, size_t components, const double *values,
                              size_t count)
{
    const size_t line = components ? components : 9;
    ffd_buffer_format(&w->text, "<DataArray type=\"Float64\" Name=\"%s\"", name);
    if (components)
        ffd_buffer_format(&w->text, " NumberOfComponents=\"%zu\"", components);
    else
        ffd_buffer_format(&w->text, " NumberOfTuples=\"%zu\"", count);
    ffd_buffer_text(&w->text, " format=\"ascii\">\n");
    for (size_t i = 0; i < count; i++) {
        ffd_buffer_number(&w->text, values[i]);
        ffd_buffer_text(&w->text, i % line == line - 1 || i + 1 == count ? "\n" : " ");
        if (i % line == line - 1)
            TRY(ffd_text_written(&w->text, false, w->output, w->error));
    }
    ffd_buffer_text(&w->text, "</DataArray>\n");
    return FFD_OK;
}

static void write_three(vts_writer *w, grid_array_kind kind, const int numbers[3])
{
    ffd_buffer_format(&w->text,
                      "<DataArray type=\"Int32\" Name=\"%s\" NumberOfTuples=\"3\" format=\"ascii\">\n%d %d "
                      "%d\n</DataArray>\n",
                      ffd_grid_array_name(kind), numbers[0], numbers[1], numbers[2]);
}

static ffd_status write_grid(vts_writer *w, const ffd_lattice *lattice)
{
    int degree[3], closed[3];
    for (int a = 0; a < 3; a++) {
        degree[a] = lattice->knots[a].degree;
        closed[a] = ffd_knots_closed(&lattice->knots[a]);
    }
    ffd_buffer_text(&w->text, "<FieldData>\n");
    write_three(w, GRID_DEGREE, degree);
    write_three(w, GRID_CLOSED, closed);
    for (int a = 0; a < 3; a++) {
        size_t count;
        const double *const list = ffd_grid_knots(&lattice->knots[a], &count);
        TRY(write_array(w, ffd_grid_array_name((grid_array_kind)(GRID_KNOTS_U + a)), 0, list, count));
    }
    ffd_buffer_text(&w->text, "</FieldData>\n");
    return FFD_OK;
}

static ffd_status write_points(vts_writer *w, const ffd_lattice *lattice)
{
    const size_t count = lattice->count;
    const double *const rest = lattice->rest_weights, *const moved = lattice->deformed_weights;
    ffd_buffer_text(&w->text, "<PointData>\n");
    TRY(write_array(w, ffd_grid_array_name(GRID_OFFSETS), 3, lattice->difference, 3 * count));
    if (rest)
        TRY(write_array(w, ffd_grid_array_name(GRID_WEIGHTS), 1, rest, count));
    if (rest && memcmp(rest, moved, count * sizeof *rest) != 0)
        TRY(write_array(w, ffd_grid_array_name(GRID_MOVED_WEIGHTS), 1, moved, count));
    ffd_buffer_text(&w->text, "</PointData>\n<Points>\n");
    TRY(write_array(w, ffd_grid_array_name(GRID_POINTS), 3, lattice->rest, 3 * count));
    ffd_buffer_text(&w->text, "</Points>\n");
    return FFD_OK;
}

ffd_status ffd_lattice_write_vts(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    vts_writer w = {.output = output, .error = error};
    const size_t *const n = lattice->size;
    ffd_status status;
    ffd_buffer_text(&w.text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"StructuredGrid\" version=\"1.0\" "
                             "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n");
    ffd_buffer_format(&w.text, "<StructuredGrid WholeExtent=\"0 %zu 0 %zu 0 %zu\">\n", n[0] - 1, n[1] - 1,
                      n[2] - 1);
    TRY_END(write_grid(&w, lattice));
    ffd_buffer_format(&w.text, "<Piece Extent=\"0 %zu 0 %zu 0 %zu\">\n", n[0] - 1, n[1] - 1, n[2] - 1);
    TRY_END(write_points(&w, lattice));
    ffd_buffer_text(&w.text, "</Piece>\n</StructuredGrid>\n</VTKFile>\n");
    TRY_END(ffd_text_written(&w.text, true, output, error));
end:
    ffd_buffer_free(&w.text);
    return status;
}
