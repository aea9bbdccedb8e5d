#include "json/json_parse.h"
#include "base/memory/memory.h"
#include "base/text/content.h"
#include "base/text/number.h"
#include "json/json_chars.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Offsets have 32 bits, which limits the size of a text. */
#define LARGEST_TEXT ((size_t)UINT32_MAX - 1)

/* A number without exponent of at most SAFE_FOR_DOUBLE characters cannot overflow a double; an integer of at
   most SAFE_FOR_INTEGER characters fits in 64 bits. The longest integer of 64 bits has 20 characters. */
#define SAFE_FOR_DOUBLE 300
#define SAFE_FOR_INTEGER 18
#define INTEGER_CAPACITY 24

typedef struct scanner {
    const json_input *input;
    json_tree *tree;
    const char *at, *last;
    ffd_error *error;
} scanner;

/* The position after a byte order mark, if there is one. */
static const char *skip_mark(const char *text, const char *last)
{
    return last - text >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text;
}

/* Reports an error at a position, with its line and its column in characters. */
static ffd_status refuse(const scanner *s, const char *at, const char *format, ...) FFD_PRINTF(3, 4);

static ffd_status refuse(const scanner *s, const char *at, const char *format, ...)
{
    char what[256];
    size_t line = s->input->line ? s->input->line : 1, column = 1;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    for (const char *c = skip_mark(s->input->whole ? s->input->whole : s->input->text, at); c < at; c++) {
        column = *c == '\n' ? 1 : column + (((unsigned char)*c & 0xc0) != 0x80);
        line += *c == '\n';
    }
    return ffd_fail_line(s->error, FFD_E_INVALID, s->input->name, line, "not valid JSON: %s (column %zu)",
                         what, column);
}

static bool is_comment(const scanner *s, const char *at)
{
    return at < s->last && (*at == '#' || (*at == '/' && at + 1 < s->last && (at[1] == '/' || at[1] == '*')));
}

/* Reports that something was expected, and what was found instead. */
static ffd_status expect(const scanner *s, const char *at, const char *what)
{
    char found[32] = "the end of the text";
    if (is_comment(s, at))
        return refuse(s, at, "JSON has no comments%s",
                      s->input->rules & JSON_HAS_COMMENT ? "; a lattice has the member \"comment\" for them"
                                                         : "");
    if (at < s->last && *at == '\'')
        return refuse(s, at, "JSON has texts in double quotes only");
    if (at < s->last && *at >= 0x20 && *at < 0x7f)
        snprintf(found, sizeof found, "'%c'", *at);
    else if (at < s->last)
        snprintf(found, sizeof found, "byte 0x%02x", (unsigned)(unsigned char)*at);
    return refuse(s, at, "%s, found %s", what, found);
}

/* Whether a text begins with a word, whatever its capitals. word: in small letters. */
static bool begins(const char *at, const char *last, const char *word)
{
    while (at < last && *word && (*at >= 'A' && *at <= 'Z' ? *at - 'A' + 'a' : *at) == *word) {
        at++;
        word++;
    }
    return !*word;
}

/* Reports that a value is expected, and what other notations have here. */
static ffd_status expect_value(const scanner *s, const char *at)
{
    static const struct {
        const char *word, *why;
    } others[] = {{"nan", "JSON has no NaN"},
                  {"inf", "JSON has no Infinity"},
                  {"+", "JSON has no + before a number"},
                  {"true", "JSON has true in small letters"},
                  {"false", "JSON has false in small letters"},
                  {"null", "JSON has null in small letters"},
                  {"none", "JSON has null in place of None"}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (begins(at, s->last, others[i].word))
            return refuse(s, at, "%s", others[i].why);
    return expect(s, at, "a value is expected");
}

static void skip_space(scanner *s)
{
    while (s->at < s->last && (*s->at == ' ' || *s->at == '\t' || *s->at == '\n' || *s->at == '\r'))
        s->at++;
}

static bool is_digit(const scanner *s, const char *c)
{
    return c < s->last && *c >= '0' && *c <= '9';
}

static ffd_status refuse_character(const scanner *s, const char *c)
{
    if (*c == '\\')
        return expect(s, c, "an escape in a string is not valid");
    if ((unsigned char)*c < 0x20)
        return expect(s, c, "a control character in a string must be escaped");
    return expect(s, c, "a string is not valid UTF-8");
}

/* what: name of what is expected, for messages. */
static ffd_status scan_string(scanner *s, const char *what)
{
    if (s->at == s->last || *s->at != '"')
        return expect(s, s->at, what);
    const char *const opened = s->at;
    const char *c = ffd_json_pass_plain(opened + 1, s->last);
    while (c < s->last && *c != '"') {
        uint32_t code;
        const char *next = ffd_json_char(c, s->last, &code);
        if (!next)
            return refuse_character(s, c);
        if (code == 0 && s->input->rules & JSON_NO_NUL)
            return refuse(s, c, "a string must not hold the character \\u0000");
        c = ffd_json_pass_plain(next, s->last);
    }
    if (c == s->last)
        return refuse(s, opened, "this string has no closing quote");
    s->at = c + 1;
    return FFD_OK;
}

/* Checks a number that is valid JSON, from `first` to the current position, against the reader's rules. */
static ffd_status check_range(const scanner *s, const char *first, bool fraction, bool exponent)
{
    const size_t length = (size_t)(s->at - first);
    const int shown = length < 40 ? (int)length : 40;
    double number;
    if ((exponent || length > SAFE_FOR_DOUBLE) && s->input->rules & JSON_DOUBLES &&
        ffd_number_parse(first, s->at, &number) && isinf(number))
        return refuse(s, first, "the number %.*s is too large", shown, first);
    if (!exponent && !fraction && length > SAFE_FOR_INTEGER && s->input->rules & JSON_INTEGERS) {
        char text[INTEGER_CAPACITY];
        snprintf(text, sizeof text, "%.*s", shown, first);
        errno = 0;
        strtoll(text, NULL, 10);
        if (errno || length >= sizeof text)
            return refuse(s, first, "the whole number %.*s does not fit 64 bits", shown, first);
    }
    return FFD_OK;
}

/* The grammar of RFC 8259, 6. */
static ffd_status scan_number(scanner *s)
{
    const char *const first = s->at, *c = first;
    bool fraction = false, exponent = false;
    if (*c == '-')
        c++;
    if (!is_digit(s, c))
        return c < s->last && (*c == 'i' || *c == 'I' || *c == 'n' || *c == 'N')
                   ? expect_value(s, c)
                   : expect(s, c, "a digit is expected");
    if (*c == '0' && is_digit(s, c + 1))
        return expect(s, c, "a number must not start with 0");
    while (is_digit(s, c))
        c++;
    if (c < s->last && *c == '.') {
        fraction = true;
        c++;
        if (!is_digit(s, c))
            return expect(s, c, "a digit is expected");
        while (is_digit(s, c))
            c++;
    }
    if (c < s->last && (*c == 'e' || *c == 'E')) {
        exponent = true;
        c++;
        if (c < s->last && (*c == '+' || *c == '-'))
            c++;
        if (!is_digit(s, c))
            return expect(s, c, "a digit is expected");
        while (is_digit(s, c))
            c++;
    }
    s->at = c;
    return check_range(s, first, fraction, exponent);
}

static bool scan_word(scanner *s, const char *word)
{
    const size_t length = strlen(word);
    if ((size_t)(s->last - s->at) < length || memcmp(s->at, word, length) != 0)
        return false;
    s->at += length;
    return true;
}

static ffd_status scan_scalar(scanner *s, json_value *value)
{
    if (s->at == s->last)
        return expect_value(s, s->at);
    ffd_status status = FFD_OK;
    if (*s->at == '"') {
        value->kind = JSON_STRING;
        status = scan_string(s, "a value is expected");
    } else if (*s->at == '-' || is_digit(s, s->at)) {
        value->kind = JSON_NUMBER;
        status = scan_number(s);
    } else if (scan_word(s, "true")) {
        value->kind = JSON_TRUE;
    } else if (scan_word(s, "false")) {
        value->kind = JSON_FALSE;
    } else if (scan_word(s, "null")) {
        value->kind = JSON_NULL;
    } else {
        return expect_value(s, s->at);
    }
    value->end = (uint32_t)(s->at - s->tree->text);
    return status;
}

static uint32_t offset(const scanner *s)
{
    return (uint32_t)(s->at - s->tree->text);
}

/* Appends a value to the tree, as a member of parent. */
static json_value *add_value(scanner *s, uint32_t parent)
{
    json_tree *tree = s->tree;
    if (!ffd_grow((void **)&tree->values, &tree->capacity, tree->count + 1, sizeof *tree->values)) {
        ffd_fail_memory(s->error);
        return NULL;
    }
    json_value *value = &tree->values[tree->count++];
    *value = (json_value){.parent = parent, .next = (uint32_t)tree->count};
    if (parent != JSON_NONE)
        tree->values[parent].count++;
    return value;
}

static ffd_status scan_key(scanner *s, json_value *value)
{
    value->key_begin = offset(s);
    TRY(scan_string(s, "a key in double quotes is expected"));
    value->key_end = offset(s);
    skip_space(s);
    if (s->at == s->last || *s->at != ':')
        return expect(s, s->at, "':' is expected");
    s->at++;
    skip_space(s);
    return FFD_OK;
}

#define FEW_MEMBERS 64
/* The most bytes of a key that a message shows. */
#define KEY_SHOWN 80

/* Reports two equal keys, at the later one. */
static ffd_status refuse_key(const scanner *s, uint32_t a, uint32_t b)
{
    const json_value *const value = &s->tree->values[a > b ? a : b];
    const uint32_t length = value->key_end - value->key_begin;
    const ffd_status status =
        refuse(s, s->tree->text + value->key_begin, "duplicate key %.*s in an object",
               (int)(length < KEY_SHOWN ? length : KEY_SHOWN), s->tree->text + value->key_begin);
    if (s->error)
        ffd_json_tree_pointer(s->tree, a > b ? a : b, s->error->pointer, sizeof s->error->pointer);
    return status;
}

/* In objects of up to so many members each is compared with each, of which most differ in the first
 * character. */
#define PAIRED_MEMBERS 8

static ffd_status refuse_equal_pairs(const scanner *s, uint32_t object)
{
    const json_tree *const tree = s->tree;
    uint32_t earlier[PAIRED_MEMBERS];
    size_t count = 0;
    for (uint32_t v = ffd_json_tree_first(tree, object); v != JSON_NONE; v = ffd_json_tree_after(tree, v)) {
        const char first = tree->text[tree->values[v].key_begin + 1];
        for (size_t i = 0; i < count; i++) {
            const char other = tree->text[tree->values[earlier[i]].key_begin + 1];
            if ((first == other || first == '\\' || other == '\\') &&
                ffd_json_tree_compare_keys(tree, earlier[i], tree, v) == 0)
                return refuse_key(s, earlier[i], v);
        }
        earlier[count++] = v;
    }
    return FFD_OK;
}

/* Equal keys are refused, because readers differ in which one they use: the value that is checked here must
   be the value that others use. */
static ffd_status refuse_equal_keys(const scanner *s, uint32_t object)
{
    const json_tree *tree = s->tree;
    const size_t count = tree->values[object].count;
    json_member few[FEW_MEMBERS];
    json_member *members = few;
    if (count <= PAIRED_MEMBERS)
        return refuse_equal_pairs(s, object);
    if (count > FEW_MEMBERS && !(members = ffd_alloc(count, sizeof *members)))
        return ffd_fail_memory(s->error);
    ffd_json_tree_sort(tree, object, members);
    ffd_status status = FFD_OK;
    for (size_t i = 1; i < count; i++)
        if (ffd_json_tree_compare_keys(tree, members[i - 1].value, tree, members[i].value) == 0)
            TRY_END(refuse_key(s, members[i - 1].value, members[i].value));
end:
    if (members != few)
        ffd_free(members);
    return status;
}

static ffd_status close_container(scanner *s, uint32_t *container)
{
    json_tree *tree = s->tree;
    const uint32_t closed = *container;
    s->at++;
    tree->values[closed].end = offset(s);
    tree->values[closed].next = (uint32_t)tree->count;
    *container = tree->values[closed].parent;
    return tree->values[closed].kind == JSON_OBJECT ? refuse_equal_keys(s, closed) : FFD_OK;
}

/* Reads a value in *container; if it is an object or array, it becomes *container. */
static ffd_status scan_value(scanner *s, uint32_t *container, int *depth)
{
    json_tree *tree = s->tree;
    json_value *value = add_value(s, *container);
    if (!value)
        return FFD_E_MEMORY;
    if (*container != JSON_NONE && tree->values[*container].kind == JSON_OBJECT)
        TRY(scan_key(s, value));
    value->begin = offset(s);
    if (s->at == s->last || (*s->at != '{' && *s->at != '['))
        return scan_scalar(s, value);
    if (++*depth > JSON_TREE_DEPTH)
        return expect(s, s->at, "values are nested more than 256 deep");
    value->kind = *s->at == '{' ? JSON_OBJECT : JSON_ARRAY;
    *container = (uint32_t)(tree->count - 1);
    s->at++;
    return FFD_OK;
}

/* Reads the end of a container, or its next member with the comma before it. */
static ffd_status scan_member(scanner *s, uint32_t *container, int *depth)
{
    const json_value *in = &s->tree->values[*container];
    const bool object = in->kind == JSON_OBJECT;
    const char *comma = NULL;
    if (s->at < s->last && *s->at == (object ? '}' : ']')) {
        --*depth;
        return close_container(s, container);
    }
    if (in->count > 0) {
        if (s->at == s->last || *s->at != ',')
            return expect(s, s->at, object ? "',' or '}' is expected" : "',' or ']' is expected");
        comma = s->at++;
        skip_space(s);
    }
    if (s->at < s->last && (*s->at == ',' || (comma && (*s->at == '}' || *s->at == ']'))))
        return refuse(s, comma ? comma : s->at, "one comma too many");
    return scan_value(s, container, depth);
}

static ffd_status scan_text(scanner *s)
{
    if (s->input->rules & JSON_ALLOW_MARK)
        s->at = skip_mark(s->at, s->last);
    skip_space(s);
    uint32_t container = JSON_NONE;
    int depth = 0;
    TRY(scan_value(s, &container, &depth));
    while (container != JSON_NONE) {
        skip_space(s);
        TRY(scan_member(s, &container, &depth));
    }
    skip_space(s);
    return s->at < s->last ? expect(s, s->at, "nothing may follow the value") : FFD_OK;
}

ffd_status ffd_json_parse(const json_input *input, json_tree *tree, ffd_error *error)
{
    *tree = (json_tree){.text = input->text,
                        .size = input->size,
                        .whole = input->whole ? input->whole : input->text,
                        .line = input->rules & JSON_NO_LINES ? 0
                                : input->line                ? input->line
                                                             : 1};
    if (input->size > LARGEST_TEXT)
        return ffd_fail_file(error, FFD_E_LIMIT, input->name, "its JSON has %zu bytes, more than %zu",
                             input->size, LARGEST_TEXT);
    if (ffd_content_is_utf16(input->text, input->size))
        return ffd_fail_line(error, FFD_E_INVALID, input->name, input->line ? input->line : 1,
                             "is text in UTF-16: it must be UTF-8");
    scanner s = {
        .input = input, .tree = tree, .at = input->text, .last = input->text + input->size, .error = error};
    const ffd_status status = scan_text(&s);
    if (status)
        ffd_json_tree_free(tree);
    return status;
}
