#include "io/ply/ply_header.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <inttypes.h>
#include <string.h>

/* "property list TYPE TYPE NAME", and one more to notice too many. */
#define WORDS 6

typedef struct header_line {
    text_word text; /* without leading and trailing blanks */
    text_word words[WORDS];
    size_t count; /* number of words, at most WORDS */
} header_line;

typedef struct header_reader {
    ply_header *header;
    const char *at, *last;
    char line_end;
    size_t line; /* number of the line read last */
    bool has_format;
    const char *name;
    ffd_error *error;
} header_reader;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static void split_words(header_line *line, const char *first, const char *last)
{
    while (first < last && is_blank(*first))
        first++;
    while (last > first && is_blank(last[-1]))
        last--;
    *line = (header_line){.text = {first, last}};
    while (first < last && line->count < WORDS) {
        text_word *word = &line->words[line->count++];
        word->first = first;
        while (first < last && !is_blank(*first))
            first++;
        word->last = first;
        while (first < last && is_blank(*first))
            first++;
    }
}

/* Reads the next line. Returns false at the end of the file. */
static bool next_line(header_reader *r, header_line *line)
{
    if (r->at == r->last)
        return false;
    const char *end = memchr(r->at, r->line_end, (size_t)(r->last - r->at));
    split_words(line, r->at, end ? end : r->last);
    r->at = end ? end + 1 : r->last;
    r->line++;
    return true;
}

#define FAIL(reader, ...) ffd_fail_line((reader)->error, FFD_E_INVALID, (reader)->name, __VA_ARGS__)

static ffd_status read_magic(header_reader *r)
{
    header_line line = {0};
    const char *first = r->at, *end = first;
    while (end < r->last && *end != '\n' && *end != '\r')
        end++;
    const bool crlf = r->last - end > 1 && end[0] == '\r' && end[1] == '\n';
    r->line_end = end < r->last && *end == '\r' && !crlf ? '\r' : '\n';
    r->header->line_end = crlf ? "CRLF" : r->line_end == '\r' ? "CR" : "LF";
    if (next_line(r, &line) && line.count == 1 && ffd_text_is(line.words[0], "ply") &&
        line.text.first == first)
        return FFD_OK;
    return FAIL(r, 1, "is not a PLY file: the first line is not \"ply\"");
}

static ffd_status read_format(header_reader *r, const header_line *line)
{
    static const char *const names[] = {[PLY_ASCII] = "ascii",
                                        [PLY_LITTLE_ENDIAN] = "binary_little_endian",
                                        [PLY_BIG_ENDIAN] = "binary_big_endian"};
    const text_word version = line->words[2];
    size_t i = 0;
    if (r->has_format)
        return FAIL(r, r->line, "a second format line");
    if (line->count != 3)
        return FAIL(r, r->line, "a format line holds an encoding and a version: \"%.*s\"",
                    ffd_text_display_size(line->text), line->text.first);
    while (i < sizeof names / sizeof *names && !ffd_text_is(line->words[1], names[i]))
        i++;
    if (i == sizeof names / sizeof *names)
        return FAIL(r, r->line, "format \"%.*s\" is not ascii, binary_little_endian or binary_big_endian",
                    ffd_text_display_size(line->words[1]), line->words[1].first);
    if (!ffd_text_is(version, "1.0"))
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, r->line,
                             "version %.*s of the format is not supported: only 1.0 is",
                             ffd_text_display_size(version), version.first);
    r->header->encoding = (ply_encoding)i;
    r->has_format = true;
    return FFD_OK;
}

static bool parse_count(text_word word, uint64_t *count)
{
    *count = 0;
    for (const char *c = word.first; c < word.last; c++) {
        if (*c < '0' || *c > '9')
            return false;
        const uint64_t digit = (uint64_t)(*c - '0');
        if (*count > (UINT64_MAX - digit) / 10)
            return false;
        *count = *count * 10 + digit;
    }
    return word.first < word.last;
}

static ffd_status refuse_too_many(const header_reader *r)
{
    return ffd_fail_line(r->error, FFD_E_LIMIT, r->name, r->line, "more than %d elements or properties",
                         PLY_DECLARATIONS_MAX);
}

static ffd_status read_element(header_reader *r, const header_line *line)
{
    ply_header *h = r->header;
    ply_element element = {.name = line->words[1], .line = r->line};
    const int shown = ffd_text_display_size(element.name);
    if (line->count != 3)
        return FAIL(r, r->line, "an element line holds a name and a count: \"%.*s\"",
                    ffd_text_display_size(line->text), line->text.first);
    if (!parse_count(line->words[2], &element.count))
        return FAIL(r, r->line, "\"%.*s\" is not a count of element %.*s",
                    ffd_text_display_size(line->words[2]), line->words[2].first, shown, element.name.first);
    for (size_t i = 0; i < h->element_count; i++)
        if (ffd_text_same(h->elements[i].name, element.name))
            return FAIL(r, r->line, "a second element %.*s: the first is on line %zu", shown,
                        element.name.first, h->elements[i].line);
    if (h->element_count == PLY_DECLARATIONS_MAX)
        return refuse_too_many(r);
    if (!ffd_grow((void **)&h->elements, &h->element_capacity, h->element_count + 1, sizeof *h->elements))
        return ffd_fail_memory(r->error);
    h->elements[h->element_count++] = element;
    return FFD_OK;
}

/* Adds a property to the last element. */
static ffd_status add_property(header_reader *r, const ply_property *property)
{
    ply_header *h = r->header;
    ply_element *element = &h->elements[h->element_count - 1];
    for (size_t i = h->property_count - element->property_count; i < h->property_count; i++)
        if (ffd_text_same(h->properties[i].name, property->name))
            return FAIL(r, r->line, "a second property %.*s of element %.*s: the first is on line %zu",
                        ffd_text_display_size(property->name), property->name.first,
                        ffd_text_display_size(element->name), element->name.first, h->properties[i].line);
    if (h->property_count == PLY_DECLARATIONS_MAX)
        return refuse_too_many(r);
    if (!ffd_grow((void **)&h->properties, &h->property_capacity, h->property_count + 1,
                  sizeof *h->properties))
        return ffd_fail_memory(r->error);
    h->properties[h->property_count++] = *property;
    element->property_count++;
    element->has_lists = element->has_lists || property->is_list;
    return FFD_OK;
}

static ffd_status read_type(const header_reader *r, text_word word, number_type *type)
{
    if (ffd_ply_type_of(word, type))
        return FFD_OK;
    return FAIL(r, r->line,
                "\"%.*s\" is not a PLY type (char, uchar, short, ushort, int, uint, float, double)",
                ffd_text_display_size(word), word.first);
}

static ffd_status read_property(header_reader *r, const header_line *line)
{
    ply_property property = {.line = r->line, .slot = PLY_NO_SLOT};
    property.is_list = line->count > 1 && ffd_text_is(line->words[1], "list");
    const size_t type = property.is_list ? 3 : 1;
    if (r->header->element_count == 0)
        return FAIL(r, r->line, "a property comes before any element");
    if (line->count != type + 2)
        return FAIL(r, r->line, "a property line holds %s and a name: \"%.*s\"",
                    property.is_list ? "two types" : "a type", ffd_text_display_size(line->text),
                    line->text.first);
    property.name = line->words[type + 1];
    if (property.is_list)
        TRY(read_type(r, line->words[2], &property.count_type));
    if (property.is_list && number_is_real(property.count_type))
        return FAIL(r, r->line, "the count of list %.*s is a %s: it must be a whole number",
                    ffd_text_display_size(property.name), property.name.first,
                    ffd_ply_type_name(property.count_type));
    TRY(read_type(r, line->words[type], &property.type));
    return add_property(r, &property);
}

static ffd_status add_note(header_reader *r, const header_line *line)
{
    ply_header *h = r->header;
    if (!ffd_grow((void **)&h->notes, &h->note_capacity, h->note_count + 1, sizeof *h->notes))
        return ffd_fail_memory(r->error);
    h->notes[h->note_count++] = line->text;
    return FFD_OK;
}

static ffd_status read_line(header_reader *r, const header_line *line)
{
    const text_word keyword = line->words[0];
    if (line->count == 0)
        return FFD_OK;
    if (ffd_text_is(keyword, "comment"))
        return line->count > 1 && ffd_text_is(line->words[1], "TextureFile") ? add_note(r, line) : FFD_OK;
    if (ffd_text_is(keyword, "obj_info"))
        return add_note(r, line);
    if (ffd_text_is(keyword, "format"))
        return read_format(r, line);
    if (ffd_text_is(keyword, "element"))
        return read_element(r, line);
    if (ffd_text_is(keyword, "property"))
        return read_property(r, line);
    return FAIL(r, r->line, "\"%.*s\" is not a keyword of a PLY header", ffd_text_display_size(keyword),
                keyword.first);
}

static ffd_status read_lines(header_reader *r)
{
    header_line line = {0};
    while (true) {
        if (!next_line(r, &line))
            return FAIL(r, r->line, "the header has no end: \"end_header\" is missing");
        if (line.count == 1 && ffd_text_is(line.words[0], "end_header"))
            break;
        TRY(read_line(r, &line));
    }
    if (!r->has_format)
        return FAIL(r, r->line, "the header has no format line");
    return FFD_OK;
}

static void measure_row(const ply_header *h, ply_element *element)
{
    for (size_t i = 0; i < element->property_count; i++) {
        const ply_property *p = &element->properties[i];
        element->least += h->encoding == PLY_ASCII ? 2 : ffd_type_size(p->is_list ? p->count_type : p->type);
    }
}

/* Checks that the counts fit the bytes after the header. The last line of a text may lack its line end. */
static ffd_status check_sizes(const header_reader *r)
{
    const ply_header *h = r->header;
    const size_t there = (size_t)(r->last - r->at);
    size_t left = there + (h->encoding == PLY_ASCII);
    for (size_t i = 0; i < h->element_count; i++) {
        const ply_element *e = &h->elements[i];
        if (e->least > 0 && e->count > left / e->least)
            return FAIL(r, e->line,
                        "element %.*s: %" PRIu64 " %s of %zu %s or more do not fit in the %zu %s after the "
                        "header",
                        ffd_text_display_size(e->name), e->name.first, e->count,
                        ffd_plural(e->count, "row", "rows"), e->least, ffd_plural(e->least, "byte", "bytes"),
                        there, ffd_plural(there, "byte", "bytes"));
        left -= e->least * (size_t)(e->least > 0 ? e->count : 0);
    }
    return FFD_OK;
}

ffd_status ffd_ply_header_read(const file_input *input, const char *name, ply_header *header,
                               ffd_error *error)
{
    const char *first = (const char *)input->data;
    header_reader r = {
        .header = header, .at = first, .last = first + input->size, .name = name, .error = error};
    *header = (ply_header){0};
    if (ffd_text_has_mark(input->data, input->size))
        r.at += TEXT_MARK_SIZE;
    TRY(read_magic(&r));
    TRY(read_lines(&r));
    header->body = (size_t)(r.at - first);
    header->body_line = r.line + 1;
    header->end = header->encoding == PLY_ASCII ? ffd_text_size(input->data, input->size) : input->size;
    size_t first_property = 0;
    for (size_t i = 0; i < header->element_count; i++) {
        ply_element *element = &header->elements[i];
        element->properties = header->properties ? header->properties + first_property : NULL;
        first_property += element->property_count;
        measure_row(header, element);
    }
    return check_sizes(&r);
}

void ffd_ply_header_free(ply_header *header)
{
    ffd_free(header->elements);
    ffd_free(header->properties);
    ffd_free(header->notes);
    *header = (ply_header){0};
}

const ply_element *ffd_ply_find_element(const ply_header *header, const char *name)
{
    for (size_t i = 0; i < header->element_count; i++)
        if (ffd_text_is(header->elements[i].name, name))
            return &header->elements[i];
    return NULL;
}

const ply_property *ffd_ply_find_property(const ply_element *element, const char *name)
{
    for (size_t i = 0; i < element->property_count; i++)
        if (ffd_text_is(element->properties[i].name, name))
            return &element->properties[i];
    return NULL;
}
