#include "io/text/content.h"
#include "io/text/text_scan.h"
#include <string.h>

/* Magic numbers at the start of a file. */
static const struct {
    const char *bytes;
    size_t size;
    content_kind kind;
} magic_numbers[] = {
    {"glTF", 4, {"a GLB file", FFD_FORMAT_GLB, true}},
    {"\x1f\x8b", 2, {"a gzip file", FFD_FORMAT_AUTO, true}},
    {"BZh", 3, {"a bzip2 file", FFD_FORMAT_AUTO, true}},
    {"\3757zXZ", 5, {"an xz file", FFD_FORMAT_AUTO, true}},
    {"\x28\xb5\x2f\xfd", 4, {"a zstd file", FFD_FORMAT_AUTO, true}},
    {"7z\xbc\xaf\x27\x1c", 6, {"a 7z archive", FFD_FORMAT_AUTO, true}},
    {"PK\3\4", 4, {"a ZIP archive", FFD_FORMAT_AUTO, true}},
    {"Rar!\x1a", 5, {"a RAR archive", FFD_FORMAT_AUTO, true}},
    {"\x89PNG", 4, {"a PNG image", FFD_FORMAT_AUTO, true}},
    {"\xff\xd8\xff", 3, {"a JPEG image", FFD_FORMAT_AUTO, true}},
    {"%PDF", 4, {"a PDF file", FFD_FORMAT_AUTO, true}},
    {"BLENDER", 7, {"a Blender file", FFD_FORMAT_AUTO, true}},
    {"Kaydara FBX Binary", 18, {"an FBX file", FFD_FORMAT_AUTO, true}},
    {"\x93NUMPY", 6, {"a NumPy array", FFD_FORMAT_AUTO, true}},
    {"SQLite format 3", 15, {"an SQLite database", FFD_FORMAT_AUTO, true}},
    {"\177ELF", 4, {"a program", FFD_FORMAT_AUTO, true}},
    {"\xff\xfe", 2, {"UTF-16 text", FFD_FORMAT_AUTO, true}},
    {"\xfe\xff", 2, {"UTF-16 text", FFD_FORMAT_AUTO, true}},
};

/* First words, in lower case. A word that ends with a star matches all words with that beginning. */
static const struct {
    const char *first, *second;
    content_kind kind;
} first_words[] = {
    {"version",
     "https://git-lfs*",
     {"a Git LFS pointer: the file itself is not there", FFD_FORMAT_AUTO, false}},
    {"<!doctype*", NULL, {"an HTML page", FFD_FORMAT_AUTO, false}},
    {"<html*", NULL, {"an HTML page", FFD_FORMAT_AUTO, false}},
    {"<head*", NULL, {"an HTML page", FFD_FORMAT_AUTO, false}},
    {"<?xml*", NULL, {"an XML file", FFD_FORMAT_AUTO, false}},
    {"{*", NULL, {"JSON text", FFD_FORMAT_GLTF, false}},
    {"ply", NULL, {"a PLY file", FFD_FORMAT_PLY, false}},
    {"solid", NULL, {"an STL file", FFD_FORMAT_STL, false}},
    {"off", NULL, {"an OFF file", FFD_FORMAT_OFF, false}},
    {"v", NULL, {"an OBJ file", FFD_FORMAT_OBJ, false}},
    {"mtllib", NULL, {"an OBJ file", FFD_FORMAT_OBJ, false}},
    {"newmtl", NULL, {"an MTL file", FFD_FORMAT_AUTO, false}},
};

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
    text_scan scan;
    text_word first = {"", ""}, second = {"", ""};
    ffd_text_begin(&scan, data, size, true);
    if (ffd_text_find(&scan)) {
        ffd_text_word(&scan, &first);
        ffd_text_word(&scan, &second);
    }
    for (size_t i = 0; i < sizeof first_words / sizeof *first_words; i++)
        if (matches(first, first_words[i].first) &&
            (!first_words[i].second || matches(second, first_words[i].second)))
            return &first_words[i].kind;
    return NULL;
}

const content_kind *ffd_content_kind(const void *data, size_t size)
{
    for (size_t i = 0; i < sizeof magic_numbers / sizeof *magic_numbers; i++)
        if (size >= magic_numbers[i].size && memcmp(data, magic_numbers[i].bytes, magic_numbers[i].size) == 0)
            return &magic_numbers[i].kind;
    return kind_of_words(data, size);
}
