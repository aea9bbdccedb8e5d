#include "batch/job_words.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A job on its way from JSON to words. */
typedef struct job_reader {
    const batch_frame *frame;
    batch_job *job;
    const json_t *options, *settings; /* its own; NULL: none */
} job_reader;

static const char *const members[] = {"in", "out", "lattice", "options", "set"};
enum { MEMBERS = sizeof members / sizeof *members };

/* Options of `ffd deform` that are the batch's own business, or have a member of their own. */
static const char *const reserved[] = {"jobs",    "shard",      "resume",  "journal", "timeout",
                                       "stop",    "keep-going", "dry-run", "in",      "csv",
                                       "lattice", "depfile",    "out-dir", "report",  "report-stable",
                                       "quiet",   "verbose",    "help",    "set"};
enum { RESERVED = sizeof reserved / sizeof *reserved };

/* Options whose values are files, which stand where the manifest says. */
static const char *const files[] = {"embedding"};
enum { FILES = sizeof files / sizeof *files };

/* Options that never change a byte of the output. */
static const char *const idle[] = {"threads", "isa", "memory", "force", "if-changed"};
enum { IDLE = sizeof idle / sizeof *idle };

static bool is_one_of(const char *word, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(word, words[i]) == 0)
            return true;
    return false;
}

/* Fails the job; returns false. */
static bool refuse(const job_reader *reader, const char *format, ...) FFD_PRINTF(2, 3);

static bool refuse(const job_reader *reader, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ffd_fail_line(&reader->job->error, FFD_E_INVALID, reader->frame->name, (size_t)reader->job->line, "%s",
                  text);
    return false;
}

/* A word with its end. */
static void add_word(byte_buffer *words, const char *before, const char *word)
{
    ffd_buffer_text(words, before);
    ffd_buffer_append(words, word, strlen(word) + 1);
}

static void add_argument(batch_job *job, const char *before, const char *word)
{
    add_word(&job->words, before, word);
    job->word_count++;
}

/* From the manifest's folder, and so that it is no option; free with ffd_free. */
static char *resolve(const batch_frame *frame, const char *path)
{
    if (ffd_path_is_absolute(path))
        return ffd_text_copy(path);
    if (*frame->folder)
        return ffd_path_join(frame->folder, path);
    return *path == '-' ? ffd_path_join(".", path) : ffd_text_copy(path);
}

static bool add_file(job_reader *reader, const char *before, const char *path)
{
    char *const resolved = resolve(reader->frame, path);
    if (resolved)
        add_argument(reader->job, before, resolved);
    else
        ffd_fail_memory(&reader->job->error);
    ffd_free(resolved);
    return resolved;
}

/* The path that a member gives, or NULL. */
static const char *read_path(job_reader *reader, const json_t *value, const char *key)
{
    const char *const path = json_string_value(value);
    if (!path)
        refuse(reader, "\"%s\" is not the name of a file", key);
    else if (!*path)
        refuse(reader, "\"%s\" is empty", key);
    else if (strcmp(path, "-") == 0)
        refuse(reader, "\"%s\" is \"-\": jobs of a batch have no standard streams", key);
    else
        return path;
    return NULL;
}

static bool read_lattices(job_reader *reader, const json_t *value)
{
    const size_t count = json_is_array(value) ? json_array_size(value) : 1;
    if (count == 0)
        return refuse(reader, "\"lattice\" is an empty list");
    for (size_t i = 0; i < count; i++) {
        const json_t *const one = json_is_array(value) ? json_array_get(value, i) : value;
        const char *const path = read_path(reader, one, "lattice");
        if (!path || !add_file(reader, "--lattice=", path))
            return false;
    }
    return true;
}

/* "--name=value" of a text or number. */
static bool add_option(job_reader *reader, const char *name, const json_t *value)
{
    byte_buffer before = {0}, text = {0};
    ffd_buffer_format(&before, "--%s=", name);
    if (json_is_string(value))
        ffd_buffer_text(&text, json_string_value(value));
    else if (json_is_integer(value))
        ffd_buffer_format(&text, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_real(value))
        ffd_buffer_number(&text, json_real_value(value));
    else
        refuse(reader, "option \"%s\" is neither a text, a number, true, false nor a list of these", name);
    char *const start = ffd_buffer_finish(&before), *const end = ffd_buffer_finish(&text);
    bool added = start && end && !reader->job->error.status;
    if (added && is_one_of(name, files, FILES))
        added = add_file(reader, start, end);
    else if (added)
        add_argument(reader->job, start, end);
    if (!start || !end)
        ffd_fail_memory(&reader->job->error);
    else if (added && !is_one_of(name, idle, IDLE))
        add_word(&reader->job->content, start, end);
    ffd_free(start);
    ffd_free(end);
    return added;
}

static bool read_option(job_reader *reader, const char *name, const json_t *value)
{
    if (!*name || strchr(name, '='))
        return refuse(reader, "\"%.60s\" is not the name of an option", name);
    if (is_one_of(name, reserved, RESERVED))
        return refuse(reader, "\"%s\" is not an option of a job", name);
    if (json_is_true(value)) {
        add_argument(reader->job, "--", name);
        if (!is_one_of(name, idle, IDLE))
            add_word(&reader->job->content, "--", name);
        return true;
    }
    if (json_is_false(value))
        return true;
    if (!json_is_array(value))
        return add_option(reader, name, value);
    for (size_t i = 0; i < json_array_size(value); i++)
        if (!add_option(reader, name, json_array_get(value, i)))
            return false;
    return true;
}

static bool read_options(job_reader *reader, const json_t *value)
{
    const char *name;
    json_t *option;
    if (!json_is_object(value))
        return refuse(reader, "\"options\" is not an object");
    json_object_foreach((json_t *)(uintptr_t)value, name, option)
    {
        if (!read_option(reader, name, option))
            return false;
    }
    return true;
}

/* "--set=NAME=value", the value as JSON. */
static bool read_settings(job_reader *reader, const json_t *value)
{
    const char *name;
    json_t *setting;
    if (!json_is_object(value))
        return refuse(reader, "\"set\" is not an object");
    json_object_foreach((json_t *)(uintptr_t)value, name, setting)
    {
        char *const text = json_dumps(setting, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
        byte_buffer before = {0};
        ffd_buffer_format(&before, "--set=%s=", name);
        char *const start = ffd_buffer_finish(&before);
        if (text && start) {
            add_argument(reader->job, start, text);
            add_word(&reader->job->content, start, text);
        } else {
            ffd_fail_memory(&reader->job->error);
        }
        ffd_free(start);
        free(text);
        if (reader->job->error.status)
            return false;
    }
    return true;
}

/* Whether the job says itself what an option of the batch says: of settings, by their names. */
static bool overrides(const job_reader *reader, const batch_default *option)
{
    const char *name;
    json_t *setting;
    if (reader->options && json_object_get(reader->options, option->name))
        return true;
    if (strcmp(option->name, "set") != 0 || !reader->settings)
        return false;
    json_object_foreach((json_t *)(uintptr_t)reader->settings, name, setting)
    {
        const size_t length = strlen(name);
        if (strncmp(option->value, name, length) == 0 && option->value[length] == '=')
            return true;
    }
    return false;
}

/* Those of the batch that the job does not have. */
static void add_defaults(job_reader *reader)
{
    for (size_t i = 0; i < reader->frame->default_count; i++) {
        const batch_default *const option = &reader->frame->defaults[i];
        byte_buffer before = {0};
        if (overrides(reader, option))
            continue;
        ffd_buffer_format(&before, option->value ? "--%s=" : "--%s", option->name);
        char *const start = ffd_buffer_finish(&before);
        const char *const value = option->value ? option->value : "";
        if (start)
            add_argument(reader->job, start, value);
        if (start && !is_one_of(option->name, idle, IDLE))
            add_word(&reader->job->content, start, value);
        reader->job->words.failed = reader->job->words.failed || !start;
        ffd_free(start);
    }
}

static bool keep_name(job_reader *reader, const char *path, char **name)
{
    *name = ffd_text_copy(path);
    if (!*name)
        ffd_fail_memory(&reader->job->error);
    return *name;
}

static bool has_option(const job_reader *reader, const char *name)
{
    if (reader->options && json_object_get(reader->options, name))
        return json_is_true(json_object_get(reader->options, name));
    for (size_t i = 0; i < reader->frame->default_count; i++)
        if (strcmp(reader->frame->defaults[i].name, name) == 0)
            return true;
    return false;
}

static bool read_files(job_reader *reader, const json_t *value)
{
    const json_t *const in = json_object_get(value, "in"), *const out = json_object_get(value, "out");
    const json_t *const lattice = json_object_get(value, "lattice");
    if (!in)
        return refuse(reader, "\"in\" is missing");
    const char *const input = read_path(reader, in, "in");
    if (!input || !keep_name(reader, input, &reader->job->input))
        return false;
    const bool in_place = has_option(reader, "in-place");
    if (!out && !in_place)
        return refuse(reader, "\"out\" is missing");
    if (out && in_place)
        return refuse(reader, "\"out\" has no meaning with the option \"in-place\"");
    if (in_place && reader->frame->resume)
        return refuse(reader,
                      "\"in-place\" has no meaning with --resume: what is done would be done once more");
    const char *const output = out ? read_path(reader, out, "out") : NULL;
    if (out && (!output || !keep_name(reader, output, &reader->job->output)))
        return false;
    if (!lattice)
        return refuse(reader, "\"lattice\" is missing");
    if (!add_file(reader, "", input) || (output && !add_file(reader, "", output)))
        return false;
    reader->job->target = resolve(reader->frame, output ? output : input);
    add_word(&reader->job->content, "", input);
    add_word(&reader->job->content, "", output ? output : "");
    return read_lattices(reader, lattice);
}

static bool know_members(job_reader *reader, const json_t *value)
{
    const char *name;
    json_t *member;
    if (!json_is_object(value))
        return refuse(reader, "a job is an object: {\"in\": ..., \"lattice\": ..., \"out\": ...}");
    json_object_foreach((json_t *)(uintptr_t)value, name, member)
    {
        if (!is_one_of(name, members, MEMBERS))
            return refuse(reader, "unknown key \"%.60s\" (nearest: \"%s\")", name,
                          ffd_nearest_word(name, members, MEMBERS));
    }
    return true;
}

ffd_status ffd_job_read(const batch_frame *frame, const json_t *value, batch_job *job)
{
    job_reader reader = {frame, job, json_object_get(value, "options"), json_object_get(value, "set")};
    if (know_members(&reader, value) &&
        (!reader.options || json_is_object(reader.options) ||
         refuse(&reader, "\"options\" is not an object")) &&
        read_files(&reader, value)) {
        add_defaults(&reader);
        if ((!reader.options || read_options(&reader, reader.options)) && reader.settings)
            read_settings(&reader, reader.settings);
    }
    if (job->words.failed || job->content.failed || job->error.status == FFD_E_MEMORY)
        return ffd_fail_memory(&job->error);
    return FFD_OK;
}

/* jansson's words, where they do not speak of itself. */
static const char *describe_syntax(const json_error_t *problem)
{
    switch (json_error_code(problem)) {
    case json_error_null_character:
    case json_error_null_byte_in_key:
        return "a text with a \\u0000 in it";
    case json_error_end_of_input_expected:
        return "something follows the job on its line";
    default:
        return problem->text;
    }
}

ffd_status ffd_job_parse(const batch_frame *frame, const char *text, size_t size, batch_job *job)
{
    json_error_t problem;
    json_t *const value = json_loadb(text, size, JSON_REJECT_DUPLICATES, &problem);
    if (!value) {
        ffd_fail_line(&job->error, FFD_E_INVALID, frame->name, (size_t)job->line, "not valid JSON: %s",
                      describe_syntax(&problem));
        return FFD_OK;
    }
    const ffd_status status = ffd_job_read(frame, value, job);
    json_decref(value);
    return status;
}

const char *ffd_job_output_name(const batch_job *job)
{
    return job->output ? job->output : job->target ? job->input : NULL;
}

void ffd_job_free(batch_job *job)
{
    ffd_free(job->input);
    ffd_free(job->output);
    ffd_free(job->target);
    ffd_buffer_free(&job->words);
    ffd_buffer_free(&job->content);
    *job = (batch_job){0};
}
