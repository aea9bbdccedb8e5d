#include "io/off/off_header.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <inttypes.h>
#include <string.h>

#define COLOUR_MAX 4
#define TEXCOORD 2
/* The shortest face is "0" and a line end. */
#define FACE_BYTES 2

typedef struct header_reader {
    const char *name;
    off_header *header;
    text_scan scan;
    ffd_error *error;
} header_reader;

size_t ffd_off_header_rest_min(const off_header *header)
{
    const size_t colour = !header->has_colours ? 0 : header->free_layout ? COLOUR_MAX : 1;
    return colour + (header->has_texcoords ? TEXCOORD : 0);
}

size_t ffd_off_header_rest_max(const off_header *header)
{
    if (header->free_layout)
        return ffd_off_header_rest_min(header);
    return COLOUR_MAX + (header->has_texcoords ? TEXCOORD : 0);
}

static ffd_status refuse(header_reader *r, ffd_status status, const char *what, text_word word)
{
    return ffd_fail_line(r->error, status, r->name, r->scan.line, "%s \"%s\"", what,
                         ffd_text_shown(word).text);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Takes one of the letters before OFF. Returns false for any other letter, or a second time. */
static bool take_letter(const char **at, const char *end, off_header *header, bool *unsupported)
{
    bool ignored = false;
    bool *flag = **at == 'C' ? &header->has_colours : **at == 'N' ? &header->has_normals : NULL;
    if (end - *at >= 2 && memcmp(*at, "ST", 2) == 0) {
        flag = &header->has_texcoords;
        (*at)++;
    } else if (**at == '4' || **at == 'n') {
        *unsupported = true;
        flag = &ignored;
    }
    if (!flag || *flag)
        return false;
    *flag = true;
    (*at)++;
    return true;
}

/* Reads a keyword: "CNOFF", or "OFF8", of which *rest becomes "8". Returns false if the word is not a
   keyword. */
static bool take_keyword(off_header *header, text_word word, text_word *rest, bool *unsupported)
{
    const char *at = word.first, *end = word.last;
    while (end > at && is_digit(end[-1]))
        end--;
    if (end - at < 3 || memcmp(end - 3, "OFF", 3) != 0)
        return false;
    *rest = (text_word){end, word.last};
    header->keyword = (text_word){at, end};
    while (at < end - 3)
        if (!take_letter(&at, end - 3, header, unsupported))
            return false;
    return true;
}

static ffd_status read_keyword(header_reader *r, text_word *rest)
{
    text_word word, next;
    bool unsupported = false;
    uint64_t count;
    if (!ffd_text_find(&r->scan))
        return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan.line, "the file has no content");
    ffd_text_word(&r->scan, &word);
    *rest = word;
    if (ffd_text_whole(word, &count))
        return FFD_OK;
    if (!take_keyword(r->header, word, rest, &unsupported))
        return refuse(r, FFD_E_INVALID, "the file does not begin with OFF (COFF, NOFF, STOFF ..) but with",
                      word);
    if (unsupported)
        return refuse(
            r, FFD_E_UNSUPPORTED,
            "vertices with more or less than three coordinates are not supported:", r->header->keyword);
    text_scan ahead = r->scan;
    if (rest->first == rest->last && ffd_text_word(&ahead, &next) && ffd_text_is_any_case(next, "binary"))
        return refuse(r, FFD_E_UNSUPPORTED, "the binary form of OFF is not supported:", next);
    return FFD_OK;
}

/* Reads a count from the word or, if that is empty, from the next word. */
static ffd_status read_count(header_reader *r, const char *what, text_word word, uint64_t *count)
{
    if (word.first == word.last) {
        if (!ffd_text_find(&r->scan))
            return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan.line,
                                 "the file ends before the number of %s", what);
        ffd_text_word(&r->scan, &word);
    }
    if (ffd_text_whole(word, count))
        return FFD_OK;
    return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan.line,
                         "the number of %s is not a whole number: \"%s\"", what, ffd_text_shown(word).text);
}

/* Skips the number of edges: the next word of the line, or a line with this word only. */
static void pass_edges(header_reader *r)
{
    text_word word;
    text_scan ahead = r->scan;
    if (ffd_text_word(&ahead, &word)) {
        r->scan = ahead;
        return;
    }
    if (!ffd_text_find(&ahead))
        return;
    ffd_text_word(&ahead, &word);
    const text_scan behind = ahead;
    if (!ffd_text_word(&ahead, &word))
        r->scan = behind;
}

/* Returns a * b + c * d; SIZE_MAX if that overflows. */
static size_t least_bytes(size_t a, size_t b, size_t c, size_t d)
{
    size_t first, second, sum;
    if (ffd_multiply_size(a, b, &first) && ffd_multiply_size(c, d, &second) &&
        ffd_add_size(first, second, &sum))
        return sum;
    return SIZE_MAX;
}

/* Every word takes at least two bytes with its separator, except that the last one may have none. */
static ffd_status check_size(header_reader *r, uint64_t vertices, uint64_t faces)
{
    off_header *header = r->header;
    const size_t left = (size_t)(r->scan.last - r->scan.at);
    const size_t needed =
        vertices > SIZE_MAX || faces > SIZE_MAX
            ? SIZE_MAX
            : least_bytes((size_t)vertices, 2 * off_vertex_width(header), (size_t)faces, FACE_BYTES);
    if (needed > left + 1)
        return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan.line,
                             "%" PRIu64 " %s and %" PRIu64 " %s are stated, more than the %zu %s can hold",
                             vertices, ffd_plural(vertices, "vertex", "vertices"), faces,
                             ffd_plural(faces, "face", "faces"), left,
                             ffd_plural(left, "byte that follows", "bytes that follow"));
    if (vertices > OFF_VERTICES_MAX)
        return ffd_fail_line(r->error, FFD_E_LIMIT, r->name, r->scan.line,
                             "%" PRIu64 " vertices are more than the limit of %" PRIu32, vertices,
                             OFF_VERTICES_MAX);
    header->vertices = (size_t)vertices;
    header->faces = (size_t)faces;
    return FFD_OK;
}

static bool has_lines(text_scan scan, size_t count)
{
    for (; count > 0; count--) {
        if (!ffd_text_find(&scan))
            return false;
        ffd_text_next_line(&scan);
    }
    return true;
}

/* Whether the number of words in the next nonempty line is one that a vertex may have. */
static bool has_vertex_line(const off_header *header, text_scan scan)
{
    const size_t width = off_vertex_width(header);
    size_t count = 0;
    text_word word;
    ffd_text_find(&scan);
    while (ffd_text_word(&scan, &word))
        count++;
    return count >= width + ffd_off_header_rest_min(header) &&
           count <= width + ffd_off_header_rest_max(header);
}

static ffd_status find_layout(header_reader *r)
{
    text_word word;
    text_scan line = r->scan;
    off_header *header = r->header;
    header->body = r->scan;
    const bool in_header_line = ffd_text_word(&line, &word);
    if (has_lines(r->scan, header->vertices + header->faces)) {
        if (in_header_line)
            return refuse(r, FFD_E_INVALID, "the numbers of vertices, faces and edges are followed by", word);
        return FFD_OK;
    }
    header->free_layout = in_header_line || !has_vertex_line(header, r->scan);
    return FFD_OK;
}

ffd_status ffd_off_header_read(const file_input *input, const char *name, off_header *header,
                               ffd_error *error)
{
    header_reader r = {.name = name, .header = header, .error = error};
    text_word first = {0};
    uint64_t vertices = 0, faces = 0;
    *header = (off_header){0};
    ffd_text_begin(&r.scan, input->data, ffd_text_size(input->data, input->size), true);
    TRY(read_keyword(&r, &first));
    TRY(read_count(&r, "vertices", first, &vertices));
    TRY(read_count(&r, "faces", (text_word){0}, &faces));
    pass_edges(&r);
    TRY(check_size(&r, vertices, faces));
    return find_layout(&r);
}
