#include "base/text/content.h"
#include "base/little_endian.h"
#include "base/text/stand_in.h"
#include "base/text/text_scan.h"
#include <stdio.h>
#include <string.h>

#define STL_START 84
#define STL_FACET 50

/* Bytes of JSON text that are looked at. */
#define TEXT_SEEN 512

/* The most bytes that pad a text to a multiple of four. */
#define MOST_PADDING 3

/* Code units of UTF-16 that are looked at. */
#define UTF16_SEEN 8

/* Kinds that need a further look. */
static const char json[] = "JSON text", utf16[] = "UTF-16 text";

/* Magic numbers at the start of a file. */
static const struct {
    const char *bytes;
    size_t size;
    content_kind kind;
    /* The range of the byte behind, where the magic number alone is too short to be sure. */
    unsigned char least, largest;
} magic_numbers[] = {
    {"glTF", 4, {"a GLB file", FFD_FORMAT_GLB, true, false}, 0, 255},
    {"\x1f\x8b\x08", 3, {"a gzip file", FFD_FORMAT_AUTO, true, false}, 0, 31},
    {"BZh", 3, {"a bzip2 file", FFD_FORMAT_AUTO, true, false}, '1', '9'},
    {"\3757zXZ", 5, {"an xz file", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\x28\xb5\x2f\xfd", 4, {"a zstd file", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"7z\xbc\xaf\x27\x1c", 6, {"a 7z archive", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"PK\3\4", 4, {"a ZIP archive", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"Rar!\x1a", 5, {"a RAR archive", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\x89PNG", 4, {"a PNG image", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\xff\xd8\xff", 3, {"a JPEG image", FFD_FORMAT_AUTO, true, false}, 0xc0, 0xfe},
    {"GIF8", 4, {"a GIF image", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"RIFF", 4, {"a RIFF file, such as a WebP image", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\xabKTX ", 5, {"a KTX image", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"%PDF", 4, {"a PDF file", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"BLENDER", 7, {"a Blender file", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"Kaydara FBX Binary", 18, {"an FBX file", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\x93NUMPY", 6, {"a NumPy array", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"SQLite format 3", 15, {"an SQLite database", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\177ELF", 4, {"a program", FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\xff\xfe", 2, {utf16, FFD_FORMAT_AUTO, true, false}, 0, 255},
    {"\xfe\xff", 2, {utf16, FFD_FORMAT_AUTO, true, false}, 0, 255},
};

/* First words, in lower case. A word that ends with a star matches all words with that beginning. */
static const struct {
    const char *first;
    content_kind kind;
} first_words[] = {
    {"<?xml*", {CONTENT_XML, FFD_FORMAT_AUTO, false, false}},
    {"<vtkfile", {CONTENT_XML, FFD_FORMAT_AUTO, false, false}},
    {"$meshformat", {"a mesh of Gmsh", FFD_FORMAT_MSH, false, false}},
    {"ndime=*", {"a mesh of SU2", FFD_FORMAT_SU2, false, false}},
    {"{*", {json, FFD_FORMAT_GLTF, false, false}},
    {"[*", {json, FFD_FORMAT_GLTF, false, false}},
    {"<svg*", {"an SVG image", FFD_FORMAT_AUTO, false, false}},
    {"ply", {"a PLY file", FFD_FORMAT_PLY, false, false}},
    {"solid", {"an STL file", FFD_FORMAT_STL, false, false}},
    {"off", {"an OFF file", FFD_FORMAT_OFF, false, false}},
    {"v", {"an OBJ file", FFD_FORMAT_OBJ, false, false}},
    {"mtllib", {"an OBJ file", FFD_FORMAT_OBJ, false, false}},
    {"usemtl", {"an OBJ file", FFD_FORMAT_OBJ, false, false}},
    {"o", {"an OBJ file", FFD_FORMAT_OBJ, false, false}},
    {"g", {"an OBJ file", FFD_FORMAT_OBJ, false, false}},
    {"newmtl", {"an MTL file", FFD_FORMAT_AUTO, false, false}},
};

static const content_kind stand_ins[] = {{STAND_IN_LFS, FFD_FORMAT_AUTO, false, true},
                                         {STAND_IN_ANNEX, FFD_FORMAT_AUTO, false, true},
                                         {STAND_IN_HTML, FFD_FORMAT_AUTO, false, true}};

/* White space of JSON. */
static bool is_blank(unsigned char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r';
}

static bool matches(text_word word, const char *pattern)
{
    const size_t size = strlen(pattern);
    if (size == 0 || pattern[size - 1] != '*')
        return ffd_text_is_any_case(word, pattern);
    if ((size_t)(word.last - word.first) < size - 1)
        return false;
    char start[32];
    memcpy(start, pattern, size - 1);
    start[size - 1] = '\0';
    return ffd_text_is_any_case((text_word){word.first, word.first + size - 1}, start);
}

static const content_kind *kind_of_words(const void *data, size_t size)
{
    const char *const stand_in = ffd_stand_in(data, size);
    for (size_t i = 0; stand_in && i < sizeof stand_ins / sizeof *stand_ins; i++)
        if (strcmp(stand_in, stand_ins[i].name) == 0)
            return &stand_ins[i];
    text_scan scan;
    text_word first = {"", ""};
    ffd_text_begin(&scan, data, size, true);
    if (ffd_text_find(&scan))
        ffd_text_word(&scan, &first);
    for (size_t i = 0; i < sizeof first_words / sizeof *first_words; i++)
        if (matches(first, first_words[i].first))
            return &first_words[i].kind;
    return NULL;
}

/* Returns the index of the magic number at the start; SIZE_MAX if there is none. */
static size_t find_magic(const unsigned char *data, size_t size)
{
    for (size_t i = 0; i < sizeof magic_numbers / sizeof *magic_numbers; i++)
        if (size >= magic_numbers[i].size && memcmp(data, magic_numbers[i].bytes, magic_numbers[i].size) == 0)
            return i;
    return SIZE_MAX;
}

/* The header of a binary STL file, and each of its facets, have a fixed size. */
static bool is_binary_stl(const unsigned char *data, size_t size)
{
    return size >= STL_START && STL_START + (uint64_t)load_u32(data + STL_START - 4) * STL_FACET == size;
}

const content_kind *ffd_content_kind(const void *data, size_t size)
{
    static const content_kind binary_stl = {"a binary STL file", FFD_FORMAT_STL, true, false};
    const size_t found = find_magic(data, size);
    if (found == SIZE_MAX && is_binary_stl(data, size))
        return &binary_stl;
    return found != SIZE_MAX ? &magic_numbers[found].kind : kind_of_words(data, size);
}

/* Whether the first bytes are those of UTF-8 text, as far as single bytes tell. Zeros at the end pad it. The
   end of a long file is not touched: each page of a mapped one takes memory. */
static bool is_text(const unsigned char *data, size_t size)
{
    size_t seen = size < TEXT_SEEN ? size : TEXT_SEEN;
    for (size_t padding = 0; padding < MOST_PADDING && seen == size && size > 0 && data[size - 1] == 0;
         padding++)
        seen = --size;
    for (size_t i = 0; i < seen; i++)
        if (data[i] < ' ' && data[i] != '\t' && data[i] != '\n' && data[i] != '\r')
            return false;
    return true;
}

/* Whether JSON text begins with an object, or with an array of objects: a quote or the end of the object
   follows its brace. */
static bool is_objects(const unsigned char *data, size_t size)
{
    const unsigned char *at = data + (ffd_text_has_mark(data, size) ? TEXT_MARK_SIZE : 0), *const end =
                                                                                               data + size;
    for (bool in_array = false; at < end && (is_blank(*at) || (*at == '[' && !in_array)); at++)
        in_array = in_array || *at == '[';
    if (at == end || *at != '{')
        return false;
    do
        at++;
    while (at < end && is_blank(*at));
    return at < end && (*at == '"' || *at == '}');
}

/* Whether two bytes are a character of ASCII in UTF-16. */
static bool is_unit(const unsigned char *bytes, size_t low)
{
    const unsigned char byte = bytes[low];
    return bytes[1 - low] == 0 && byte < 127 && (byte >= ' ' || is_blank(byte));
}

bool ffd_content_is_utf16(const void *data, size_t size)
{
    const unsigned char *const bytes = data;
    if (size < 2)
        return false;
    if ((bytes[0] == 0xff && bytes[1] == 0xfe) || (bytes[0] == 0xfe && bytes[1] == 0xff))
        return true;
    const size_t low = bytes[0] == 0;
    return is_unit(bytes, low) && (size < 4 || is_unit(bytes + 2, low));
}

void ffd_content_mention(const content_kind *kind, ffd_error *error)
{
    const size_t length = strlen(error->message);
    if (kind && !(kind->name == utf16 && strstr(error->message, "UTF-16")))
        snprintf(error->message + length, sizeof error->message - length, "; it seems to be %s", kind->name);
}

/* Whether text in UTF-16 follows the mark: letters of ASCII, more than numbers have by chance. */
static bool is_utf16(const unsigned char *data, size_t size)
{
    const size_t low = data[0] == 0xff ? 0 : 1;
    bool is_text = size >= 2 + 2 * UTF16_SEEN;
    for (size_t i = 2; i < 2 + 2 * UTF16_SEEN && is_text; i += 2)
        is_text = is_unit(data + i, low);
    return is_text;
}

const content_kind *ffd_content_sure_kind(const void *data, size_t size)
{
    const unsigned char *const bytes = data;
    const size_t found = find_magic(bytes, size);
    if (found != SIZE_MAX) {
        const size_t behind = magic_numbers[found].size;
        const unsigned char next = behind < size ? bytes[behind] : 0;
        if (magic_numbers[found].kind.name == utf16)
            return is_utf16(bytes, size) ? &magic_numbers[found].kind : NULL;
        return next >= magic_numbers[found].least && next <= magic_numbers[found].largest
                   ? &magic_numbers[found].kind
                   : NULL;
    }
    if (!is_text(bytes, size))
        return NULL;
    const content_kind *const kind = kind_of_words(bytes, size);
    if (!kind || kind->is_stand_in)
        return kind;
    if (kind->name == json)
        return is_objects(bytes, size) ? kind : NULL;
    return kind->format == FFD_FORMAT_AUTO ? kind : NULL;
}
