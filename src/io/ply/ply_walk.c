#include "io/ply/ply_walk.h"
#include "base/system/deadline.h"
#include <inttypes.h>
#include <string.h>

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

/* Whether c belongs to a word. Tested for > ' ' first, which nearly all characters of words are. */
static bool is_of_word(char c)
{
    return (unsigned char)c > ' ' || (!ffd_text_is_blank(c) && !is_line_end(c));
}

static void skip_blanks(ply_walk *walk)
{
    while (walk->at < walk->last && ffd_text_is_blank(*walk->at))
        walk->at++;
}

bool ffd_ply_walk_row(ply_walk *walk)
{
    if (walk->header->encoding != PLY_ASCII)
        return true;
    for (;; walk->at++) {
        skip_blanks(walk);
        if (walk->at == walk->last)
            return false;
        if (!is_line_end(*walk->at))
            return true;
        /* The CR of a CRLF is counted with its LF. */
        walk->line += *walk->at == '\n' || walk->last - walk->at == 1 || walk->at[1] != '\n';
    }
}

static bool take_bytes(ply_walk *walk, number_type type, text_word *word)
{
    const size_t size = ffd_type_size(type);
    const bool there = (size_t)(walk->last - walk->at) >= size;
    word->first = walk->at;
    walk->at += there ? size : 0;
    word->last = walk->at;
    return there;
}

bool ffd_ply_walk_value(ply_walk *walk, number_type type, text_word *word)
{
    if (walk->header->encoding != PLY_ASCII)
        return take_bytes(walk, type, word);
    const char *at = walk->at;
    while (at < walk->last && ffd_text_is_blank(*at))
        at++;
    word->first = at;
    while (at < walk->last && is_of_word(*at))
        at++;
    word->last = walk->at = at;
    return word->first < word->last;
}

bool ffd_ply_walk_count(ply_walk *walk, number_type type, text_word *word, size_t *count)
{
    text_scan scan = {.at = walk->at, .last = walk->last};
    uint64_t whole;
    if (walk->header->encoding == PLY_ASCII && !number_is_real(type) &&
        ffd_text_short_whole(&scan, word, &whole)) {
        *count = (size_t)whole;
        walk->at = scan.at;
        return *count == whole;
    }
    return ffd_ply_walk_value(walk, type, word) &&
           ffd_ply_load_count(walk->header->encoding, type, *word, count);
}

bool ffd_ply_walk_list(ply_walk *walk, const ply_property *list, text_word *word, size_t *count)
{
    if (ffd_ply_walk_count(walk, list->count_type, word, count)) {
        const size_t least = walk->header->encoding == PLY_ASCII ? 1 : ffd_type_size(list->type);
        if (*count <= (size_t)(walk->last - walk->at) / least)
            return true;
    }
    *count = 0;
    return false;
}

/* Moves past `count` values. */
static bool skip_values(ply_walk *walk, number_type type, size_t count)
{
    text_word word;
    if (walk->header->encoding != PLY_ASCII) {
        const size_t size = ffd_type_size(type);
        if (count > (size_t)(walk->last - walk->at) / size)
            return false;
        walk->at += count * size;
        return true;
    }
    for (size_t i = 0; i < count; i++)
        if (!ffd_ply_walk_value(walk, type, &word))
            return false;
    return true;
}

bool ffd_ply_walk_skip(ply_walk *walk, const ply_property *property)
{
    text_word word;
    size_t count = 1;
    if (property->is_list && !ffd_ply_walk_list(walk, property, &word, &count))
        return false;
    return skip_values(walk, property->type, count);
}

typedef struct row_checker {
    ply_walk walk;
    const ply_element *element;
    uint64_t row;
    const char *name;
    ffd_error *error;
} row_checker;

/* Fails with "row 17 of element face: ...", with the line in ascii. */
static ffd_status refuse(const row_checker *c, const char *what, const ply_property *property, text_word word)
{
    const bool text = c->walk.header->encoding == PLY_ASCII;
    const text_shown shown = ffd_text_shown(word);
    return ffd_fail_line(c->error, FFD_E_INVALID, c->name, text ? c->walk.line : 0,
                         "row %" PRIu64 " (counted from 0) of element %.*s: %s%s%.*s%s%s%s", c->row,
                         ffd_text_display_size(c->element->name), c->element->name.first, what,
                         property ? " " : "", property ? ffd_text_display_size(property->name) : 0,
                         property ? property->name.first : "", shown.text[0] ? ": \"" : "", shown.text,
                         shown.text[0] ? "\"" : "");
}

static ffd_status refuse_count(const row_checker *c, const ply_property *property, text_word word)
{
    double value = 0;
    number_text number;
    if (c->walk.header->encoding != PLY_ASCII) {
        ffd_ply_load(c->walk.header->encoding, property->count_type, word, &value);
        number = ffd_number_text(value);
        word = (text_word){number.text, number.text + strlen(number.text)};
    }
    return refuse(c, "not the count of list", property, word);
}

static ffd_status check_property(row_checker *c, const ply_property *property)
{
    const ply_encoding encoding = c->walk.header->encoding;
    const char *missing = encoding == PLY_ASCII ? "the line ends before" : "the file ends before or in";
    text_word word = {"", ""};
    size_t count;
    if (!property->is_list)
        return ffd_ply_walk_value(&c->walk, property->type, &word) ? FFD_OK
                                                                   : refuse(c, missing, property, word);
    if (!ffd_ply_walk_value(&c->walk, property->count_type, &word))
        return refuse(c, missing, property, word);
    if (!ffd_ply_load_count(encoding, property->count_type, word, &count))
        return refuse_count(c, property, word);
    return skip_values(&c->walk, property->type, count) ? FFD_OK
                                                        : refuse(c, missing, property, (text_word){"", ""});
}

static ffd_status check_row(row_checker *c)
{
    text_word word = {"", ""};
    if (!ffd_ply_walk_row(&c->walk))
        return refuse(c, "the file ends before it", NULL, word);
    for (size_t i = 0; i < c->element->property_count; i++)
        TRY(check_property(c, &c->element->properties[i]));
    if (c->walk.header->encoding != PLY_ASCII)
        return FFD_OK;
    return ffd_ply_walk_value(&c->walk, NUMBER_INT32, &word)
               ? refuse(c, "the line goes on after its last value", NULL, word)
               : FFD_OK;
}

/* Whether all rows of an element can be skipped at once: they have a fixed size and fit the file. The
   header's check ensures that only if no lists precede them. */
static bool is_fixed(const row_checker *c)
{
    const size_t left = (size_t)(c->walk.last - c->walk.at);
    return c->walk.header->encoding != PLY_ASCII && !c->element->has_lists &&
           c->element->count <= left / c->element->least;
}

static ffd_status check_rows(row_checker *c)
{
    if (c->element->property_count == 0)
        return FFD_OK;
    if (is_fixed(c)) {
        c->walk.at += c->element->count * c->element->least;
        return FFD_OK;
    }
    for (c->row = 0; c->row < c->element->count; c->row++) {
        TRY(ffd_deadline_check_at((size_t)c->row, c->error));
        TRY(check_row(c));
    }
    return FFD_OK;
}

ffd_status ffd_ply_walk_check(ply_header *header, const file_input *input, const char *name, size_t *behind,
                              ffd_error *error)
{
    const char *const first = (const char *)input->data;
    row_checker c = {.name = name, .error = error};
    c.walk = (ply_walk){
        .header = header, .at = first + header->body, .last = first + header->end, .line = header->body_line};
    for (size_t i = 0; i < header->element_count; i++) {
        c.element = &header->elements[i];
        header->elements[i].begin = (size_t)(c.walk.at - first);
        header->elements[i].begin_line = c.walk.line;
        TRY(check_rows(&c));
    }
    ffd_ply_walk_row(&c.walk); /* so that empty lines do not count as bytes after the last row */
    *behind = (size_t)(c.walk.at - first);
    return FFD_OK;
}
