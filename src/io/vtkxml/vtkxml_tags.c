/* vtkxml_tags.c - the tags of a VTK file in XML. */
#include "base/memory/memory.h"
#include "io/vtkxml/vtkxml_document.h"
#include <inttypes.h>
#include <string.h>

#define DOCUMENT "VTKFile"

/* The element that arrays belong to. */
typedef enum tag_place { OF_NOTHING, OF_POINTS, OF_CELLS, COORDINATES, CELL_LIST } tag_place;

typedef struct tag_reader {
    vtkxml_document *d;
    xml_scan scan;
    tag_place place;
    vtkxml_list list;  /* with CELL_LIST */
    text_word normals; /* the name of the points' normals, or empty */
    bool is_whole;     /* the end of the document has been seen */
    const char *at;    /* up to here lines are counted: */
    size_t line;
    ffd_error *error;
} tag_reader;

#define REFUSE(r, ...)                                                                                       \
    ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->volume.file.name, line_of(r), __VA_ARGS__)

/* The line of the scan. */
static size_t line_of(tag_reader *r)
{
    for (; r->at < r->scan.at; r->at++)
        r->line += *r->at == '\n';
    return r->line;
}

static ffd_status take_file(tag_reader *r, const xml_tag *tag)
{
    static const char *const grids[] = {[VTKXML_UNSTRUCTURED] = "UnstructuredGrid",
                                        [VTKXML_POLYDATA] = "PolyData",
                                        [VTKXML_STRUCTURED] = "StructuredGrid"};
    vtkxml_document *const d = r->d;
    text_word value;
    ffd_xml_attribute(tag, "type", &value);
    if (!ffd_text_is(value, grids[d->grid]))
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, d->volume.file.name,
                             "is a \"%s\" of VTK; of this ending is a %s", ffd_text_shown(value).text,
                             grids[d->grid]);
    d->is_big = ffd_xml_attribute(tag, "byte_order", &value) && ffd_text_is(value, "BigEndian");
    d->word = ffd_xml_attribute(tag, "header_type", &value) && ffd_text_is(value, "UInt64") ? 8 : 4;
    d->is_compressed = ffd_xml_attribute(tag, "compressor", &value) && value.first < value.last;
    d->volume.content = grids[d->grid];
    return !d->is_compressed || ffd_text_is(value, "vtkZLibDataCompressor")
               ? FFD_OK
               : ffd_fail_file(r->error, FFD_E_UNSUPPORTED, d->volume.file.name,
                               "is compressed by %s: only vtkZLibDataCompressor is supported",
                               ffd_text_shown(value).text);
}

static ffd_status take_whole(tag_reader *r, const xml_tag *tag, const char *name, uint64_t unless,
                             uint64_t *number)
{
    text_word value, word;
    text_scan scan;
    *number = unless;
    if (!ffd_xml_attribute(tag, name, &value))
        return FFD_OK;
    ffd_text_begin(&scan, value.first, (size_t)(value.last - value.first), false);
    return ffd_text_word(&scan, &word) && ffd_text_whole(word, number) && *number < UINT64_C(1) << 48
               ? FFD_OK
               : REFUSE(r, "%s is \"%s\", not a whole number", name, ffd_text_shown(value).text);
}

/* "0 3 0 3 0 3": the first and last point along each axis. */
static ffd_status take_extent(tag_reader *r, const xml_tag *tag, vtkxml_piece *piece)
{
    text_word value, word;
    text_scan scan;
    double ends[6];
    ffd_xml_attribute(tag, "Extent", &value);
    ffd_text_begin(&scan, value.first, (size_t)(value.last - value.first), false);
    for (int e = 0; e < 6; e++)
        if (!ffd_text_find(&scan) || !ffd_text_word(&scan, &word) || !ffd_text_number(word, &ends[e]) ||
            !(ends[e] > -1e9 && ends[e] < 1e9) || ends[e] != (double)(int64_t)ends[e])
            return REFUSE(r, "the Extent of a piece is \"%s\", not six whole numbers",
                          ffd_text_shown(value).text);
    piece->points = 1;
    for (int a = 0; a < 3; a++) {
        piece->size[a] = ends[2 * a + 1] < ends[2 * a] ? 0 : (uint64_t)(ends[2 * a + 1] - ends[2 * a]) + 1;
        if (piece->size[a] > VOLUME_VERTICES_MAX ||
            (piece->size[a] && piece->points > VOLUME_VERTICES_MAX / piece->size[a]))
            return ffd_fail_line(r->error, FFD_E_LIMIT, r->d->volume.file.name, line_of(r),
                                 "the Extent \"%s\" has more than %" PRIu64 " points",
                                 ffd_text_shown(value).text, (uint64_t)VOLUME_VERTICES_MAX);
        piece->points *= piece->size[a];
    }
    return FFD_OK;
}

static ffd_status take_piece(tag_reader *r, const xml_tag *tag)
{
    static const char *const counts[VTKXML_LISTS] = {"NumberOfVerts", "NumberOfLines", "NumberOfPolys",
                                                     "NumberOfStrips"};
    vtkxml_document *const d = r->d;
    vtkxml_piece piece = {.line = line_of(r)};
    if (d->grid == VTKXML_STRUCTURED)
        TRY(take_extent(r, tag, &piece));
    else
        TRY(take_whole(r, tag, "NumberOfPoints", 0, &piece.points));
    for (int l = 0; l < VTKXML_LISTS && d->grid == VTKXML_POLYDATA; l++)
        TRY(take_whole(r, tag, counts[l], 0, &piece.lists[l].count));
    if (d->grid == VTKXML_UNSTRUCTURED)
        TRY(take_whole(r, tag, "NumberOfCells", 0, &piece.lists[0].count));
    if (!ffd_grow((void **)&d->pieces, &d->piece_capacity, d->piece_count + 1, sizeof *d->pieces))
        return ffd_fail_memory(r->error);
    d->pieces[d->piece_count++] = piece;
    return FFD_OK;
}

static void find_type(const xml_tag *tag, vtkxml_array *array)
{
    static const char *const names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                        "uint32", "int64", "uint64", "float32", "float64"};
    text_word value;
    ffd_xml_attribute(tag, "type", &value);
    for (size_t t = 0; t < sizeof names / sizeof *names; t++)
        if (ffd_text_is_any_case(value, names[t])) {
            array->type = (number_type)t;
            array->is_number = true;
        }
}

static ffd_status find_place(tag_reader *r, const xml_tag *tag, vtkxml_array *array)
{
    text_word value;
    const char *const end =
        tag->is_empty ? r->scan.at : memchr(r->scan.at, '<', (size_t)(r->scan.last - r->scan.at));
    array->text = (text_word){r->scan.at, end ? end : r->scan.last};
    ffd_xml_attribute(tag, "format", &value);
    if (ffd_text_is(value, "appended")) {
        array->place = VTKXML_APPENDED;
        ffd_xml_attribute(tag, "offset", &array->offset_text);
        TRY(take_whole(r, tag, "offset", 0, &array->offset));
    } else if (ffd_text_is(value, "binary"))
        array->place = VTKXML_BASE64;
    else if (!ffd_text_is(value, "ascii") && value.first < value.last)
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->volume.file.name, line_of(r),
                             "an array has the format \"%s\"", ffd_text_shown(value).text);
    return FFD_OK;
}

/* Notes what of the file tells how its data are encoded: the points. */
static void note_encoding(vtkxml_document *d, const vtkxml_array *array)
{
    static const char *const names[2][2] = {{"base64", "base64 zlib"},
                                            {"appended base64", "appended base64 zlib"}};
    d->volume.encoding =
        array->place == VTKXML_TEXT ? "ascii" : names[array->place == VTKXML_APPENDED][d->is_compressed];
}

/* The array of cells of this name; NULL: it is of another one. */
static vtkxml_array *cell_array(vtkxml_cells *cells, text_word name)
{
    static const char *const names[VTKXML_CELL_ARRAYS] = {
        "connectivity",      "offsets",           "types",        "faces",
        "faceoffsets",       "face_connectivity", "face_offsets", "polyhedron_to_faces",
        "polyhedron_offsets"};
    for (int a = 0; a < VTKXML_CELL_ARRAYS; a++)
        if (ffd_text_is(name, names[a]))
            return &cells->arrays[a];
    return NULL;
}

/* Adds an array of points or cells. */
static ffd_status add_values(tag_reader *r, vtkxml_piece *piece, const vtkxml_array *array)
{
    vtkxml_document *const d = r->d;
    const bool is_points = r->place == OF_POINTS;
    number_run run = {.width = array->width, .line = array->line};
    if (is_points && array->is_number && number_is_real(array->type) && array->width == 3 &&
        r->normals.first < r->normals.last && ffd_text_same(r->normals, array->name)) {
        piece->normals = *array;
        return FFD_OK;
    }
    if (is_points) {
        if (!ffd_grow((void **)&d->values, &d->value_capacity, d->value_count + 1, sizeof *d->values))
            return ffd_fail_memory(r->error);
        d->values[d->value_count++] = (vtkxml_values){d->piece_count - 1, *array};
    }
    for (size_t i = 0; i < d->volume.array_count; i++)
        if (ffd_text_same(d->volume.arrays[i].name, array->name) &&
            d->volume.arrays[i].of_cells == !is_points)
            return FFD_OK; /* that of an earlier piece */
    return ffd_volume_add_array(&d->volume, array->name, &run, !is_points, r->error);
}

static ffd_status take_array(tag_reader *r, const xml_tag *tag)
{
    vtkxml_document *const d = r->d;
    vtkxml_array array = {.is_there = true, .line = line_of(r)};
    uint64_t width;
    vtkxml_array *kept = NULL;
    TRY(take_whole(r, tag, "NumberOfComponents", 1, &width));
    ffd_xml_attribute(tag, "Name", &array.name);
    ffd_xml_attribute(tag, "RangeMin", &array.range_min);
    ffd_xml_attribute(tag, "RangeMax", &array.range_max);
    array.width = width > RUN_WIDTH_MAX ? RUN_WIDTH_MAX : (size_t)width;
    find_type(tag, &array);
    TRY(find_place(r, tag, &array));
    if (array.place == VTKXML_APPENDED) {
        if (!ffd_grow((void **)&d->placed, &d->placed_capacity, d->placed_count + 1, sizeof *d->placed))
            return ffd_fail_memory(r->error);
        d->placed[d->placed_count++] = array;
    }
    if (r->place == OF_NOTHING)
        return FFD_OK;
    if (d->piece_count == 0)
        return REFUSE(r, "an array of points or cells stands outside of a Piece");
    vtkxml_piece *const piece = &d->pieces[d->piece_count - 1];
    if (r->place == OF_POINTS || r->place == OF_CELLS)
        return width == array.width ? add_values(r, piece, &array) : FFD_OK;
    kept = r->place == COORDINATES ? &piece->points_array : cell_array(&piece->lists[r->list], array.name);
    if (kept && kept->is_there)
        return REFUSE(r, "an array of a piece is there twice");
    if (kept)
        *kept = array;
    if (r->place == COORDINATES)
        note_encoding(d, &array);
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
static ffd_status take_appended(tag_reader *r, const xml_tag *tag)
{
    text_word value;
    const char *const mark = memchr(r->scan.at, '_', (size_t)(r->scan.last - r->scan.at));
    ffd_xml_attribute(tag, "encoding", &value);
    r->d->is_raw = ffd_text_is(value, "raw");
    if (!mark || (!r->d->is_raw && !ffd_text_is(value, "base64")))
        return REFUSE(r, "the appended data have the encoding \"%s\", or no _ in front",
                      ffd_text_shown(value).text);
    if (r->d->is_raw && strncmp(r->d->volume.encoding, "appended", 8) == 0)
        r->d->volume.encoding = r->d->is_compressed ? "appended raw zlib" : "appended raw";
    const char *const end = find_last(mark + 1, r->scan.last, "</" DOCUMENT ">");
    r->is_whole = end;
    r->d->appended = (text_word){mark + 1, end ? end : r->scan.last};
    r->scan.at = r->scan.last;
    return FFD_OK;
}

/* Enters or leaves an element that has arrays. Returns whether it is one. */
static bool take_place(tag_reader *r, const xml_tag *tag)
{
    static const struct {
        const char *name;
        tag_place place;
        vtkxml_list list;
    } places[] = {{"PointData", OF_POINTS, 0},        {"CellData", OF_CELLS, 0},
                  {"Points", COORDINATES, 0},         {"Cells", CELL_LIST, 0},
                  {"Verts", CELL_LIST, VTKXML_VERTS}, {"Lines", CELL_LIST, VTKXML_LINES},
                  {"Polys", CELL_LIST, VTKXML_POLYS}, {"Strips", CELL_LIST, VTKXML_STRIPS}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        if (!ffd_text_is(tag->name, places[i].name))
            continue;
        r->place = tag->is_end || tag->is_empty ? OF_NOTHING : places[i].place;
        r->list = places[i].list;
        if (r->place == OF_POINTS)
            ffd_xml_attribute(tag, "Normals", &r->normals);
        return true;
    }
    return false;
}

static ffd_status take_tag(tag_reader *r, const xml_tag *tag)
{
    if (take_place(r, tag))
        return FFD_OK;
    if (tag->is_end) {
        r->is_whole = r->is_whole || ffd_text_is(tag->name, DOCUMENT);
        return FFD_OK;
    }
    if (ffd_text_is(tag->name, DOCUMENT))
        return take_file(r, tag);
    if (!r->d->word)
        return REFUSE(r, "does not begin with <" DOCUMENT ">");
    if (ffd_text_is(tag->name, "Piece"))
        return take_piece(r, tag);
    if (ffd_text_is(tag->name, "DataArray") || ffd_text_is(tag->name, "Array"))
        return take_array(r, tag);
    if (ffd_text_is(tag->name, "AppendedData"))
        return take_appended(r, tag);
    return FFD_OK;
}

/* A document begins with its first tag, behind an optional mark of its encoding. */
static ffd_status check_start(tag_reader *r)
{
    text_scan scan;
    ffd_text_begin(&scan, r->scan.at, (size_t)(r->scan.last - r->scan.at), false);
    return ffd_text_find(&scan) && *scan.at == '<' ? FFD_OK : REFUSE(r, "does not begin with a tag of XML");
}

ffd_status ffd_vtkxml_tags(vtkxml_document *d, ffd_error *error)
{
    const char *const first = (const char *)d->volume.file.input.data;
    const char *const last = first + d->volume.file.input.size;
    tag_reader r = {.d = d,
                    .scan = {first, last, d->volume.file.name, true},
                    .normals = {first, first},
                    .at = first,
                    .line = 1,
                    .error = error};
    bool found = true;
    d->volume.encoding = "ascii";
    TRY(check_start(&r));
    while (found) {
        xml_tag tag;
        TRY(ffd_xml_next(&r.scan, &tag, &found, error));
        if (found)
            TRY(take_tag(&r, &tag));
    }
    if (d->piece_count == 0)
        return ffd_fail_file(error, FFD_E_INVALID, d->volume.file.name, "has no Piece");
    return r.is_whole
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_INVALID, d->volume.file.name, "ends before </" DOCUMENT ">");
}
