#include "batch/manifest/manifest.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "json/json_parse.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Turns a line into a description. An invalid member becomes a statement JOB_WRONG, so that earlier members
   still take effect. */
typedef struct line_parser {
    const json_tree *tree;
    job_description description;
} line_parser;

static const char *const members[] = {"in", "out", "lattice", "morph", "clip", "options", "set"};
enum { MEMBERS = sizeof members / sizeof *members };

/* Records what is wrong with a member. */
static void refuse(line_parser *parser, const char *member, const char *format, ...) FFD_PRINTF(3, 4);

static void refuse(line_parser *parser, const char *member, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ffd_description_add(&parser->description, JOB_WRONG, member, text);
}

static bool is_kind(const line_parser *parser, uint32_t value, json_kind kind)
{
    return parser->tree->values[value].kind == kind;
}

/* Adds a statement whose value is this string. */
static void add_string(line_parser *parser, job_part part, const char *name, uint32_t value)
{
    char *const text = ffd_json_tree_string(parser->tree, value, NULL);
    if (text)
        ffd_description_add(&parser->description, part, name, text);
    else
        parser->description.texts.failed = true;
    ffd_free(text);
}

static void read_path(line_parser *parser, job_part part, const char *key, uint32_t value)
{
    if (is_kind(parser, value, JSON_STRING))
        add_string(parser, part, NULL, value);
    else
        refuse(parser, key, "\"%s\" is not the name of a file", key);
}

static void read_lattices(line_parser *parser, uint32_t value)
{
    if (!is_kind(parser, value, JSON_ARRAY))
        read_path(parser, JOB_LATTICE, "lattice", value);
    else if (parser->tree->values[value].count == 0)
        refuse(parser, "lattice", "\"lattice\" is an empty list");
    else
        for (uint32_t v = ffd_json_tree_first(parser->tree, value); v != JSON_NONE;
             v = ffd_json_tree_after(parser->tree, v))
            read_path(parser, JOB_LATTICE, "lattice", v);
}

static void read_morph(line_parser *parser, const char *name, uint32_t value)
{
    if (is_kind(parser, value, JSON_STRING))
        add_string(parser, JOB_MORPH, name, value);
    else
        refuse(parser, "morph", "\"morph\": \"%.60s\" is not the name of a lattice file", name);
}

static void read_clip(line_parser *parser, uint32_t value)
{
    if (is_kind(parser, value, JSON_STRING))
        add_string(parser, JOB_CLIP, NULL, value);
    else
        refuse(parser, "clip", "\"clip\" is not a text or a list of texts");
}

static void read_clips(line_parser *parser, uint32_t value)
{
    if (!is_kind(parser, value, JSON_ARRAY))
        read_clip(parser, value);
    for (uint32_t v = is_kind(parser, value, JSON_ARRAY) ? ffd_json_tree_first(parser->tree, value)
                                                         : JSON_NONE;
         v != JSON_NONE; v = ffd_json_tree_after(parser->tree, v))
        read_clip(parser, v);
}

/* A whole number keeps its text, which can be more exact than a double. */
static void add_number(line_parser *parser, const char *name, uint32_t value)
{
    const json_value *const v = &parser->tree->values[value];
    const char *const first = parser->tree->text + v->begin;
    const size_t size = v->end - v->begin;
    byte_buffer text = {0};
    double number;
    ffd_json_tree_number(parser->tree, value, &number);
    if (memchr(first, '.', size) || memchr(first, 'e', size) || memchr(first, 'E', size))
        ffd_buffer_number(&text, number);
    else if (size == 2 && memcmp(first, "-0", size) == 0)
        ffd_buffer_text(&text, "0");
    else
        ffd_buffer_append(&text, first, size);
    char *const written = ffd_buffer_finish(&text);
    if (written)
        ffd_description_add(&parser->description, JOB_OPTION, name, written);
    else
        parser->description.texts.failed = true;
    ffd_free(written);
    ffd_buffer_free(&text);
}

/* Reads a string or a number. */
static void read_option_value(line_parser *parser, const char *name, uint32_t value)
{
    if (is_kind(parser, value, JSON_STRING))
        add_string(parser, JOB_OPTION, name, value);
    else if (is_kind(parser, value, JSON_NUMBER))
        add_number(parser, name, value);
    else {
        ffd_description_add(&parser->description, JOB_UNSET, name, NULL);
        refuse(parser, "options",
               "option \"%s\" must be a string, a number, true, false or a list of strings and numbers",
               name);
    }
}

/* Appends a string or a number; an array of them is joined as the program has it: "1600x900", "1,0.5,2".
   Returns false for other values. */
static bool append_look(const line_parser *parser, const char *name, uint32_t value, byte_buffer *text)
{
    const json_value *const v = &parser->tree->values[value];
    if (v->kind == JSON_ARRAY) {
        bool is_right = v->count > 0;
        for (uint32_t at = ffd_json_tree_first(parser->tree, value); at != JSON_NONE && is_right;
             at = ffd_json_tree_after(parser->tree, at)) {
            if (text->size > 0)
                ffd_buffer_text(text, strcmp(name, "size") == 0 ? "x" : ",");
            is_right = is_kind(parser, at, JSON_NUMBER) && append_look(parser, name, at, text);
        }
        return is_right;
    }
    if (v->kind != JSON_STRING) {
        ffd_buffer_append(text, parser->tree->text + v->begin, v->end - v->begin);
        return v->kind == JSON_NUMBER || v->kind == JSON_TRUE || v->kind == JSON_FALSE;
    }
    char *const string = ffd_json_tree_string(parser->tree, value, NULL);
    if (string)
        ffd_buffer_text(text, string);
    text->failed = text->failed || !string;
    ffd_free(string);
    return true;
}

static void read_look(line_parser *parser, const char *name, uint32_t value)
{
    byte_buffer text = {0};
    const bool is_right = append_look(parser, name, value, &text);
    char *const written = ffd_buffer_finish(&text);
    if (!is_right)
        refuse(parser, "options",
               "\"view\": %.60s must be a string, a number, true, false or a list of numbers", name);
    else if (written)
        ffd_description_add(&parser->description, JOB_LOOK, name, written);
    else
        parser->description.texts.failed = true;
    ffd_free(written);
    ffd_buffer_free(&text);
}

/* Calls read for each member of an object. */
static void read_members(line_parser *parser, uint32_t object,
                         void (*read)(line_parser *parser, const char *name, uint32_t value))
{
    for (uint32_t v = ffd_json_tree_first(parser->tree, object); v != JSON_NONE;
         v = ffd_json_tree_after(parser->tree, v)) {
        char *const name = ffd_json_tree_key(parser->tree, v);
        if (name)
            read(parser, name, v);
        else
            parser->description.texts.failed = true;
        ffd_free(name);
    }
}

/* The options of a job's picture are an object among those of the job. */
static void read_looks(line_parser *parser, uint32_t value)
{
    if (is_kind(parser, value, JSON_OBJECT))
        read_members(parser, value, read_look);
    else
        refuse(parser, "options",
               "option \"view\" is not an object, as {\"camera\": \"front\"}, of how the job is drawn");
}

static void read_option(line_parser *parser, const char *name, uint32_t value)
{
    if (strcmp(name, "view") == 0) {
        read_looks(parser, value);
        return;
    }
    const uint32_t first =
        is_kind(parser, value, JSON_ARRAY) ? ffd_json_tree_first(parser->tree, value) : value;
    if (is_kind(parser, value, JSON_TRUE))
        ffd_description_add(&parser->description, JOB_FLAG, name, NULL);
    else if (is_kind(parser, value, JSON_FALSE) || first == JSON_NONE)
        ffd_description_add(&parser->description, JOB_UNSET, name, NULL);
    else if (first == value)
        read_option_value(parser, name, value);
    else
        for (uint32_t v = first; v != JSON_NONE; v = ffd_json_tree_after(parser->tree, v))
            read_option_value(parser, name, v);
}

static void read_setting(line_parser *parser, const char *name, uint32_t value)
{
    ffd_description_set(&parser->description, name, parser->tree, value);
}

static void refuse_key(line_parser *parser, const char *name)
{
    const char *const meant = ffd_word_meant(name, members, MEMBERS);
    if (meant)
        refuse(parser, "", "unknown key \"%.60s\" (nearest: \"%s\")", name, meant);
    else
        refuse(parser, "", "unknown key \"%.60s\" (known: in, out, lattice, morph, clip, options, set)",
               name);
}

static void read_member(line_parser *parser, const char *name, uint32_t value)
{
    if (strcmp(name, "in") == 0)
        read_path(parser, JOB_INPUT, name, value);
    else if (strcmp(name, "out") == 0)
        read_path(parser, JOB_OUTPUT, name, value);
    else if (strcmp(name, "lattice") == 0)
        read_lattices(parser, value);
    else if (strcmp(name, "clip") == 0)
        read_clips(parser, value);
    else if (!ffd_word_is_known(name, members, MEMBERS))
        refuse_key(parser, name);
    else if (!is_kind(parser, value, JSON_OBJECT))
        refuse(parser, strcmp(name, "options") == 0 ? "" : name, "\"%s\" is not an object", name);
    else if (strcmp(name, "morph") == 0 && parser->tree->values[value].count == 0)
        refuse(parser, name, "\"morph\" is an empty object");
    else
        read_members(parser, value,
                     strcmp(name, "set") == 0     ? read_setting
                     : strcmp(name, "morph") == 0 ? read_morph
                                                  : read_option);
}

ffd_status ffd_job_parse(const batch_frame *frame, const char *text, size_t size, batch_job *job)
{
    const json_input input = {.text = text,
                              .size = size,
                              .name = frame->name,
                              .line = (size_t)job->line,
                              .rules = JSON_NO_NUL | JSON_DOUBLES | JSON_INTEGERS};
    json_tree tree;
    ffd_status status = ffd_json_parse(&input, &tree, &job->error);
    if (status)
        return status == FFD_E_MEMORY ? status : FFD_OK;
    line_parser parser = {.tree = &tree};
    if (is_kind(&parser, 0, JSON_OBJECT))
        read_members(&parser, 0, read_member);
    else
        refuse(&parser, "", "a job is an object: {\"in\": ..., \"lattice\": ..., \"out\": ...}");
    status = ffd_job_make(frame, &parser.description, job);
    ffd_description_free(&parser.description);
    ffd_json_tree_free(&tree);
    return status;
}
