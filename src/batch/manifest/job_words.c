#include "batch/manifest/job_words.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "json/json_chars.h"
#include <ffd/job.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A job being turned from a description into words. */
typedef struct job_maker {
    const batch_frame *frame;
    const job_description *description;
    batch_job *job;
} job_maker;

/* Options of `ffd deform` that belong to the batch, or have members of their own in a manifest. */
static const char *const reserved[] = {
    "jobs",          "shard", "resume",  "journal",   "timeout", "stop",       "keep-going",
    "dry-run",       "in",    "csv",     "lattice",   "depfile", "out-dir",    "report",
    "report-stable", "quiet", "verbose", "help",      "set",     "shared-box", "csv-ignore",
    "view",          "morph", "clip",    "positions", "dtype"};
enum { RESERVED = sizeof reserved / sizeof *reserved };

/* Options whose values are paths, relative to the manifest's folder. */
static const char *const files[] = {"embedding"};
enum { FILES = sizeof files / sizeof *files };

/* Options that never change a byte of the output. */
static const char *const idle[] = {"threads", "isa", "memory", "force", "if-changed"};
enum { IDLE = sizeof idle / sizeof *idle };

/* Fails the job; returns false. */
static bool refuse(const job_maker *maker, const char *format, ...) FFD_PRINTF(2, 3);

static bool refuse(const job_maker *maker, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, SPELLED(format), arguments);
    va_end(arguments);
    ffd_fail_line(&maker->job->error, FFD_E_INVALID, maker->frame->name, (size_t)maker->job->line, "%s",
                  text);
    return false;
}

/* Appends a word with its terminating 0. */
static void add_word(byte_buffer *words, const char *word)
{
    ffd_buffer_append(words, word, strlen(word) + 1);
}

/* Appends an option. value: NULL if it takes none. */
static void add_option(byte_buffer *words, const char *name, const char *value)
{
    ffd_buffer_text(words, "--");
    ffd_buffer_text(words, name);
    ffd_buffer_text(words, value ? "=" : "");
    add_word(words, value ? value : "");
}

/* Adds an option to the arguments and, if it can change the output, to the content. */
static void add_argument(batch_job *job, const char *name, const char *value)
{
    add_option(&job->words, name, value);
    job->word_count++;
    if (!ffd_word_is_known(name, idle, IDLE))
        add_option(&job->content, name, value);
}

/* Returns a path relative to the current folder that does not look like an option. Freed with ffd_free. */
static char *resolve(const batch_frame *frame, const char *path)
{
    if (ffd_path_is_absolute(path))
        return ffd_text_copy(path);
    if (*frame->folder)
        return ffd_path_join(frame->folder, path);
    return *path == '-' ? ffd_path_join(".", path) : ffd_text_copy(path);
}

/* Adds a path as an argument, as the value of an option or (option NULL) alone. */
static bool add_file(job_maker *maker, const char *option, const char *path)
{
    batch_job *const job = maker->job;
    char *const resolved = resolve(maker->frame, path);
    if (!resolved)
        ffd_fail_memory(&job->error);
    else if (option)
        add_option(&job->words, option, resolved);
    else
        add_word(&job->words, resolved);
    job->word_count++;
    ffd_free(resolved);
    return resolved;
}

/* Checks that a member's value can be a path. */
static bool check_path(const job_maker *maker, const char *path, const char *key)
{
    if (!*path)
        return refuse(maker, "\"%s\" is empty", key);
    if (strcmp(path, "-") == 0)
        return refuse(maker, "\"%s\" is \"-\": jobs of a batch have no standard streams", key);
    if (!ffd_utf8_is_valid(path, strlen(path)))
        return refuse(maker, "\"%s\" is not a name in UTF-8", key);
    return true;
}

static bool is_wrong(const job_description *description, const job_statement *statement, const char *member)
{
    return statement->part == JOB_WRONG && strcmp(ffd_description_name(description, statement), member) == 0;
}

static bool add_lattices(job_maker *maker)
{
    const job_description *const description = maker->description;
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        const char *const value = ffd_description_value(description, statement);
        if (is_wrong(description, statement, "lattice"))
            return refuse(maker, "%s", value);
        if (statement->part == JOB_LATTICE &&
            !(check_path(maker, value, "lattice") && add_file(maker, "lattice", value)))
            return false;
    }
    return true;
}

/* Quotes a morph target's name for the command line. */
static void quote_name(const char *name, byte_buffer *text)
{
    ffd_buffer_text(text, "'");
    for (const char *c = name; *c; c++) {
        ffd_buffer_append(text, c, 1);
        if (*c == '\'')
            ffd_buffer_append(text, c, 1);
    }
    ffd_buffer_text(text, "'");
}

/* Adds "--morph='NAME'=PATH". The path is not part of the content. */
static bool add_morph(job_maker *maker, const char *name, const char *path)
{
    byte_buffer *const words = &maker->job->words, *const content = &maker->job->content;
    char *const resolved = resolve(maker->frame, path);
    if (!resolved) {
        ffd_fail_memory(&maker->job->error);
        return false;
    }
    ffd_buffer_text(words, "--morph=");
    quote_name(name, words);
    ffd_buffer_text(words, "=");
    add_word(words, resolved);
    maker->job->word_count++;
    ffd_buffer_text(content, "--morph=");
    quote_name(name, content);
    add_word(content, "");
    ffd_free(resolved);
    return true;
}

/* Adds the lattices that make a morph target each, if there are any. */
static bool add_morphs(job_maker *maker)
{
    const job_description *const description = maker->description;
    const char *const wrong = ffd_description_wrong(description, "morph");
    if (wrong)
        return refuse(maker, "%s", wrong);
    if (!ffd_description_find(description, JOB_MORPH))
        return true;
    if (ffd_description_find(description, JOB_LATTICE))
        return refuse(maker, "\"lattice\" and \"morph\" cannot be used together");
    if (maker->frame->pictures)
        return refuse(maker, "\"morph\" cannot be used with {view}: a picture shows one deformation");
    if (maker->frame->positions)
        return refuse(maker, "\"morph\" cannot be used with {positions}: a row is of one deformation");
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        const char *const path = ffd_description_value(description, statement);
        if (statement->part == JOB_MORPH &&
            !(check_path(maker, path, "morph") &&
              add_morph(maker, ffd_description_name(description, statement), path)))
            return false;
    }
    return true;
}

static bool add_clips(job_maker *maker)
{
    const job_description *const description = maker->description;
    const char *const wrong = ffd_description_wrong(description, "clip");
    if (wrong)
        return refuse(maker, "%s", wrong);
    for (size_t i = 0; i < description->count; i++)
        if (description->statements[i].part == JOB_CLIP)
            add_argument(maker->job, "clip", ffd_description_value(description, &description->statements[i]));
    return true;
}

static bool is_option(const job_statement *statement)
{
    return statement->part == JOB_OPTION || statement->part == JOB_FLAG || statement->part == JOB_UNSET;
}

static bool check_option_name(const job_maker *maker, const char *name)
{
    if (!*name || strchr(name, '='))
        return refuse(maker, "\"%.60s\" is not the name of an option", name);
    return !ffd_word_is_known(name, reserved, RESERVED) ||
           refuse(maker, "\"%s\" is not an option of a job", name);
}

static bool add_options(job_maker *maker)
{
    const job_description *const description = maker->description;
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        const char *const name = ffd_description_name(description, statement);
        const char *const value = ffd_description_value(description, statement);
        if (is_wrong(description, statement, "options"))
            return refuse(maker, "%s", value);
        if (is_option(statement) && !check_option_name(maker, name))
            return false;
        if (statement->part == JOB_FLAG)
            add_argument(maker->job, name, NULL);
        else if (statement->part == JOB_OPTION && !ffd_word_is_known(name, files, FILES))
            add_argument(maker->job, name, value);
        else if (statement->part == JOB_OPTION && !add_file(maker, name, value))
            return false;
        else if (statement->part == JOB_OPTION)
            add_option(&maker->job->content, name, value);
    }
    return true;
}

/* Appends "--set=NAME=value". */
static void add_setting(byte_buffer *words, const char *name, const char *value)
{
    ffd_buffer_text(words, "--set=");
    ffd_buffer_text(words, name);
    ffd_buffer_text(words, "=");
    add_word(words, value);
}

static bool add_settings(job_maker *maker)
{
    const job_description *const description = maker->description;
    if (ffd_description_wrong(description, "set"))
        return refuse(maker, "%s", ffd_description_wrong(description, "set"));
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        if (statement->part != JOB_SETTING)
            continue;
        const char *const name = ffd_description_name(description, statement);
        const char *const value = ffd_description_value(description, statement);
        add_setting(&maker->job->words, name, value);
        maker->job->word_count++;
        add_setting(&maker->job->content, name, value);
    }
    return true;
}

/* Whether a statement of the job overrides an option of the batch. Settings are compared by their names. */
static bool overrides(const job_description *description, const job_statement *statement,
                      const batch_default *option)
{
    const char *const name = ffd_description_name(description, statement);
    if (is_option(statement))
        return strcmp(name, option->name) == 0;
    if (statement->part == JOB_CLIP)
        return strcmp("clip", option->name) == 0;
    if (statement->part != JOB_SETTING || strcmp(option->name, "set") != 0)
        return false;
    const size_t length = strlen(name);
    return strncmp(option->value, name, length) == 0 && option->value[length] == '=';
}

/* Adds the options of the batch that the job does not override. */
static void add_defaults(job_maker *maker)
{
    const job_description *const description = maker->description;
    for (size_t i = 0; i < maker->frame->default_count; i++) {
        const batch_default *const option = &maker->frame->defaults[i];
        size_t k = 0;
        while (k < description->count && !overrides(description, &description->statements[k], option))
            k++;
        if (k == description->count)
            add_argument(maker->job, option->name, option->value);
    }
}

/* Whether an option without value is set, by the job or else by the batch. */
static bool has_flag(const job_maker *maker, const char *name)
{
    const job_description *const description = maker->description;
    for (size_t i = 0; i < description->count; i++)
        if (is_option(&description->statements[i]) &&
            strcmp(ffd_description_name(description, &description->statements[i]), name) == 0)
            return description->statements[i].part == JOB_FLAG;
    for (size_t i = 0; i < maker->frame->default_count; i++)
        if (strcmp(maker->frame->defaults[i].name, name) == 0)
            return true;
    return false;
}

/* Returns the value of an option, of the job or else of the batch; NULL: it is not set. */
static const char *find_option(const job_maker *maker, const char *name)
{
    const job_description *const description = maker->description;
    const char *value = NULL;
    bool is_set = false;
    for (size_t i = 0; i < description->count; i++)
        if (is_option(&description->statements[i]) &&
            strcmp(ffd_description_name(description, &description->statements[i]), name) == 0) {
            value = description->statements[i].part == JOB_OPTION
                        ? ffd_description_value(description, &description->statements[i])
                        : NULL;
            is_set = true;
        }
    for (size_t i = 0; i < maker->frame->default_count && !is_set; i++)
        if (strcmp(maker->frame->defaults[i].name, name) == 0)
            value = maker->frame->defaults[i].value;
    return value;
}

/* Returns the name of an output: with the ending of --output-format if it has that of another mesh format.
   Freed with ffd_free. */
static char *name_output(const job_maker *maker, const char *output)
{
    const char *const ending = find_option(maker, "output-format");
    char *const named = ending ? ffd_path_with_ending(output, ending) : NULL;
    const bool changes = named && ffd_format_from_name(named) != FFD_FORMAT_AUTO &&
                         ffd_format_from_name(output) != FFD_FORMAT_AUTO &&
                         !ffd_path_has_ending(output, ffd_path_ending(named));
    if (changes || (ending && !named))
        return named;
    ffd_free(named);
    return ffd_text_copy(output);
}

static bool keep_name(job_maker *maker, const char *path, char **name)
{
    *name = ffd_text_copy(path);
    if (!*name)
        ffd_fail_memory(&maker->job->error);
    return *name;
}

/* Adds the mesh and the output, if there is one, as words and as content. */
static bool add_meshes(job_maker *maker, const char *input, const char *output, bool in_place)
{
    batch_job *const job = maker->job;
    if (!add_file(maker, NULL, input) || (output && !add_file(maker, NULL, output)))
        return false;
    if (output || in_place) {
        job->target = resolve(maker->frame, output ? output : input);
        job->words.failed = job->words.failed || !job->target;
    }
    add_word(&job->content, input);
    add_word(&job->content, output ? output : "");
    return true;
}

/* Finds the output of a job. *named: freed by the caller; NULL: it has none. */
static bool find_output(job_maker *maker, bool in_place, char **named)
{
    const char *const output = ffd_description_find(maker->description, JOB_OUTPUT);
    const char *const wrong = ffd_description_wrong(maker->description, "out");
    const bool has_output = output || wrong, has_row = maker->frame->positions;
    *named = NULL;
    if (!has_output && !in_place && !has_row)
        return refuse(maker, "\"out\" is missing");
    if (in_place && has_row)
        return refuse(maker, "\"in-place\" cannot be used with {positions}");
    if (has_output && in_place)
        return refuse(maker, "\"out\" cannot be used with the option \"in-place\"");
    if (in_place && maker->frame->resume)
        return refuse(maker,
                      "\"in-place\" cannot be used with {resume}: a finished mesh would be deformed again");
    if (in_place && maker->frame->pictures)
        return refuse(maker, "\"in-place\" cannot be used with {view}: a picture is named after \"out\"");
    if (wrong)
        return refuse(maker, "%s", wrong);
    if (!output)
        return true;
    if (!check_path(maker, output, "out"))
        return false;
    *named = name_output(maker, output);
    if (!*named)
        ffd_fail_memory(&maker->job->error);
    return *named && keep_name(maker, *named, &maker->job->output);
}

static bool has_lattice(const job_description *description)
{
    return ffd_description_find(description, JOB_LATTICE) || ffd_description_find(description, JOB_MORPH) ||
           ffd_description_wrong(description, "lattice") || ffd_description_wrong(description, "morph");
}

static bool add_files(job_maker *maker)
{
    const char *const input = ffd_description_find(maker->description, JOB_INPUT);
    const char *const wrong = ffd_description_wrong(maker->description, "in");
    const bool in_place = has_flag(maker, "in-place");
    char *output = NULL;
    if (!input)
        return refuse(maker, "%s", wrong ? wrong : "\"in\" is missing");
    if (!check_path(maker, input, "in") || !keep_name(maker, input, &maker->job->input))
        return false;
    bool added = find_output(maker, in_place, &output);
    if (added && !has_lattice(maker->description))
        added = refuse(maker, "\"lattice\" is missing");
    added = added && add_meshes(maker, input, output, in_place);
    ffd_free(output);
    return added && add_lattices(maker) && add_morphs(maker) && add_clips(maker);
}

static bool make_words(job_maker *maker)
{
    const char *const wrong = ffd_description_wrong(maker->description, "");
    if (wrong)
        return refuse(maker, "%s", wrong);
    if (!add_files(maker))
        return false;
    add_defaults(maker);
    return add_options(maker) && add_settings(maker);
}

ffd_status ffd_job_make(const batch_frame *frame, const job_description *description, batch_job *job)
{
    job_maker maker = {frame, description, job};
    const bool made = !description->texts.failed && make_words(&maker);
    const bool failed = job->words.failed || job->content.failed || job->error.status == FFD_E_MEMORY;
    if (failed || (!made && !job->error.status))
        return ffd_fail_memory(&job->error);
    return FFD_OK;
}

const char *ffd_job_output_name(const batch_job *job)
{
    return job->output ? job->output : job->target ? job->input : NULL;
}

const char *ffd_job_option(const batch_job *job, const char *name)
{
    const size_t length = strlen(name);
    const char *word = job->words.data, *value = NULL; /* the last one wins */
    for (size_t i = 0; i < job->word_count; i++, word += strlen(word) + 1)
        if (strncmp(word, "--", 2) == 0 && strncmp(word + 2, name, length) == 0 && word[2 + length] == '=')
            value = word + 2 + length + 1;
    return value;
}

/* In "--morph='NAME'=PATH" a quote of the name is doubled. */
const char *ffd_word_lattice(const char *word)
{
    static const char lattice[] = "--lattice=", morph[] = "--morph='";
    if (strncmp(word, lattice, sizeof lattice - 1) == 0)
        return word + sizeof lattice - 1;
    if (strncmp(word, morph, sizeof morph - 1) != 0)
        return NULL;
    const char *quote = strchr(word + sizeof morph - 1, '\'');
    while (quote && quote[1] == '\'')
        quote = strchr(quote + 2, '\'');
    return quote && quote[1] == '=' ? quote + 2 : NULL;
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
