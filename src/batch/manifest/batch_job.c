#include "batch/manifest/batch_job.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "batch/manifest/job_look.h"
#include "io/format_names.h"
#include "job/input/setting_lists.h"
#include "job/input/settings.h"
#include "mesh/memory_budget.h"
#include "json/json_chars.h"
#include <ffd/version.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A job being made of a description. */
typedef struct job_maker {
    const batch_frame *frame;
    const job_description *description;
    batch_job *job;
} job_maker;

/* Members of a description that are not options of a job: the batch has its own, or a manifest has a member
   of that name. */
static const char *const reserved[] = {"set", "lattice", "morph", "clip", "timeout"};
enum { RESERVED = sizeof reserved / sizeof *reserved };

/* Options of the batch itself. */
static const char *const others[] = {
    "jobs", "shard",      "resume",  "journal",    "stop",      "keep-going", "dry-run",       "in",
    "csv",  "depfile",    "out-dir", "report",     "quiet",     "view",       "report-stable", "verbose",
    "help", "shared-box", "dtype",   "csv-ignore", "positions", "pages"};
enum { OTHERS = sizeof others / sizeof *others };

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

/* Returns a path relative to the current folder that does not look like an option. Freed with ffd_free. */
static char *resolve(const batch_frame *frame, const char *path)
{
    if (ffd_path_is_absolute(path))
        return ffd_text_copy(path);
    if (*frame->folder)
        return ffd_path_join(frame->folder, path);
    return *path == '-' ? ffd_path_join(".", path) : ffd_text_copy(path);
}

/* Returns a path that lives as long as the job; NULL if memory ran out. */
static const char *keep_file(job_maker *maker, const char *path)
{
    batch_job *const job = maker->job;
    char *const resolved = resolve(maker->frame, path);
    if (!resolved)
        ffd_fail_memory(&job->error);
    const bool kept = resolved && !ffd_paths_add(&job->paths, resolved, &job->error);
    ffd_free(resolved);
    return kept ? job->paths.paths[job->paths.count - 1] : NULL;
}

static bool fail_memory(const job_maker *maker)
{
    ffd_fail_memory(&maker->job->error);
    return false;
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

/* Adds a lattice, with the morph target that it makes, unless name is NULL. */
static bool add_lattice(job_maker *maker, const char *name, const char *path)
{
    ffd_deform_desc *const desc = &maker->job->desc;
    const char *const file =
        check_path(maker, path, name ? "morph" : "lattice") ? keep_file(maker, path) : NULL;
    bool is_new = true;
    if (!file)
        return false;
    if (name && !*name)
        return refuse(maker, "\"morph\" has a name that is empty");
    if (name ? !ffd_setting_morph_add(desc, name, file, &is_new) : !ffd_setting_lattice_add(desc, file))
        return fail_memory(maker);
    return is_new || refuse(maker, "two morph targets are named \"%.60s\"", name);
}

static bool add_lattices(job_maker *maker)
{
    const job_description *const description = maker->description;
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        const char *const value = ffd_description_value(description, statement);
        if (is_wrong(description, statement, "lattice"))
            return refuse(maker, "%s", value);
        if (statement->part == JOB_LATTICE && !add_lattice(maker, NULL, value))
            return false;
    }
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
        if (statement->part == JOB_MORPH && !add_lattice(maker, ffd_description_name(description, statement),
                                                         ffd_description_value(description, statement)))
            return false;
    }
    return true;
}

/* Returns a source of weights in which the file that it may name is resolved; NULL if memory ran out. */
static const char *keep_weight(job_maker *maker, const char *text)
{
    const char *const file = ffd_weight_file(text);
    const char *const path = file ? keep_file(maker, file) : text;
    if (!path || !file || file == text)
        return path;
    byte_buffer whole = {0};
    ffd_buffer_format(&whole, "1-%s", path);
    char *const inverted = ffd_buffer_finish(&whole);
    if (!inverted)
        ffd_fail_memory(&maker->job->error);
    const bool kept = inverted && !ffd_paths_add(&maker->job->paths, inverted, &maker->job->error);
    ffd_free(inverted);
    return kept ? maker->job->paths.paths[maker->job->paths.count - 1] : NULL;
}

/* Sets a member to what an option of the job says. text: NULL if it has no value. */
static bool read_member(job_maker *maker, const ffd_member *member, const char *text)
{
    ffd_error error;
    const bool is_flag = member->kind == FFD_MEMBER_FLAG;
    if (is_flag && text) {
        char name[64];
        ffd_spelling()(member->name, NULL, name, sizeof name);
        return refuse(maker, "%s takes no value: true or false is wanted", name);
    }
    const bool is_weight = text && member->kind == FFD_MEMBER_WEIGHT;
    const char *const value = is_weight                                     ? keep_weight(maker, text)
                              : text && member->traits & FFD_MEMBER_IS_PATH ? keep_file(maker, text)
                                                                            : text;
    if (text && !value)
        return false;
    const ffd_status status = ffd_member_read(member, &maker->job->desc, value, &error);
    return !status || (status == FFD_E_MEMORY ? fail_memory(maker) : refuse(maker, "%s", error.message));
}

static bool add_clips(job_maker *maker)
{
    const job_description *const description = maker->description;
    const char *const wrong = ffd_description_wrong(description, "clip");
    if (wrong)
        return refuse(maker, "%s", wrong);
    for (size_t i = 0; i < description->count; i++)
        if (description->statements[i].part == JOB_CLIP &&
            !read_member(maker, ffd_deform_member_of("clip"),
                         ffd_description_value(description, &description->statements[i])))
            return false;
    return true;
}

static bool is_option(const job_statement *statement)
{
    return statement->part == JOB_OPTION || statement->part == JOB_FLAG || statement->part == JOB_UNSET;
}

/* The option that is most similar to an unknown one; NULL: none is. */
static const char *nearest_option(const char *name)
{
    nearest_word nearest = {.word = name, .length = strlen(name)};
    const ffd_member *member;
    for (size_t i = 0; (member = ffd_deform_member(i)) != NULL; i++)
        if (member->option && !ffd_word_is_known(member->option, reserved, RESERVED))
            ffd_nearest_offer(&nearest, member->option);
    ffd_nearest_offer(&nearest, "view");
    return ffd_nearest_meant(&nearest);
}

static bool check_option_name(const job_maker *maker, const char *name)
{
    if (!*name || strchr(name, '='))
        return refuse(maker, "\"%.60s\" is not the name of an option", name);
    if (ffd_word_is_known(name, reserved, RESERVED) || ffd_word_is_known(name, others, OTHERS))
        return refuse(maker, "\"%s\" is not an option of a job", name);
    if (ffd_job_look_has(name))
        return refuse(maker, "\"%s\" is an option of \"view\": {\"view\": {\"%s\": ..}}", name, name);
    const char *const meant = nearest_option(name);
    return ffd_deform_member_of(name) ||
           refuse(maker, "unknown option %.60s%s%s%s", name, meant ? " (nearest: " : "", meant ? meant : "",
                  meant ? ")" : "");
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
        if ((statement->part == JOB_FLAG || statement->part == JOB_OPTION) &&
            !read_member(maker, ffd_deform_member_of(name), statement->part == JOB_FLAG ? NULL : value))
            return false;
    }
    return true;
}

/* Whether the job has a value of a placeholder. */
static bool has_setting(const job_description *description, const char *name)
{
    size_t i = 0;
    while (i < description->count &&
           !(description->statements[i].part == JOB_SETTING &&
             strcmp(ffd_description_name(description, &description->statements[i]), name) == 0))
        i++;
    return i < description->count;
}

static bool add_setting(job_maker *maker, const char *name, const char *value)
{
    ffd_setting *const setting = ffd_setting_list_add(ffd_deform_member_of("set"), &maker->job->desc);
    if (!setting)
        return fail_memory(maker);
    *setting = (ffd_setting){name, value};
    return true;
}

/* Adds the values of placeholders: of the batch, unless the job has its own, and those of the job. */
static bool add_settings(job_maker *maker)
{
    const job_description *const description = maker->description;
    const ffd_deform_desc *const defaults = maker->frame->defaults;
    bool added = true;
    if (ffd_description_wrong(description, "set"))
        return refuse(maker, "%s", ffd_description_wrong(description, "set"));
    for (size_t i = 0; defaults && i < defaults->set_count && added; i++)
        if (!has_setting(description, defaults->set[i].name))
            added = add_setting(maker, defaults->set[i].name, defaults->set[i].value);
    for (size_t i = 0; i < description->count && added; i++) {
        const job_statement *const statement = &description->statements[i];
        if (statement->part == JOB_SETTING)
            added = add_setting(maker, ffd_description_name(description, statement),
                                ffd_description_value(description, statement));
    }
    return added;
}

/* Returns the last statement of the job about an option; NULL: there is none, and that of the batch holds. */
static const job_statement *find_statement(const job_description *description, const char *option)
{
    const job_statement *found = NULL;
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        if (statement->part == JOB_CLIP
                ? strcmp("clip", option) == 0
                : is_option(statement) && strcmp(ffd_description_name(description, statement), option) == 0)
            found = statement;
    }
    return found;
}

/* Copies a member of the defaults. Lists are of texts here. */
static bool copy_default(job_maker *maker, const ffd_member *member)
{
    const ffd_deform_desc *const defaults = maker->frame->defaults;
    const char *const *texts;
    size_t count;
    if (!ffd_member_is_list(member)) {
        ffd_member_copy(member, defaults, &maker->job->desc);
        return true;
    }
    memcpy(&texts, (const char *)defaults + member->offset, sizeof texts);
    memcpy(&count, (const char *)defaults + member->second, sizeof count);
    for (size_t i = 0; i < count; i++) {
        const char **const text = ffd_setting_list_add(member, &maker->job->desc);
        if (!text)
            return fail_memory(maker);
        *text = texts[i];
    }
    return true;
}

/* Takes the settings of the batch that the job does not override. */
static bool add_defaults(job_maker *maker)
{
    const ffd_deform_desc *const defaults = maker->frame->defaults;
    const ffd_member *member;
    for (size_t i = 0; defaults && (member = ffd_deform_member(i)) != NULL; i++) {
        const bool is_own = !member->option || member->kind == FFD_MEMBER_VALUES ||
                            member->kind == FFD_MEMBER_LATTICES || member->kind == FFD_MEMBER_MORPHS ||
                            member->kind == FFD_MEMBER_TIME;
        if (!is_own && !find_statement(maker->description, member->option) &&
            ffd_member_is_set(defaults, member) && !copy_default(maker, member))
            return false;
    }
    return true;
}

/* Whether the mesh is overwritten, by the job or else by the batch. */
static bool is_in_place(const job_maker *maker)
{
    const job_statement *const own = find_statement(maker->description, "in-place");
    return own ? own->part == JOB_FLAG : maker->frame->defaults && maker->frame->defaults->in_place;
}

/* Returns the ending that outputs get, by the job or else by the batch; NULL: their own. */
static const char *ending_of(const job_maker *maker)
{
    const job_statement *const own = find_statement(maker->description, "output-format");
    if (!own)
        return maker->frame->ending;
    return own->part == JOB_OPTION ? ffd_description_value(maker->description, own) : NULL;
}

/* Returns the name of an output: with the ending of --output-format if it has that of another mesh format.
   Freed with ffd_free. */
static char *name_output(const job_maker *maker, const char *output)
{
    const char *const ending = ending_of(maker);
    char *const named = ending ? ffd_format_rename(output, ending) : NULL;
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

/* Describes the mesh and the output, if there is one. */
static bool add_meshes(job_maker *maker, const char *input, const char *output, bool in_place)
{
    batch_job *const job = maker->job;
    ffd_deform_desc *const desc = &job->desc;
    desc->input.path = keep_file(maker, input);
    desc->output = output && desc->input.path ? keep_file(maker, output) : NULL;
    job->target = in_place ? desc->input.path : desc->output;
    return desc->input.path && (desc->output || !output);
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
    const bool in_place = is_in_place(maker);
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

/* Whether a mesh without a format that is given has none by its ending either. */
static bool lacks_format(ffd_format given, const char *path)
{
    return path && given == FFD_FORMAT_AUTO && ffd_format_from_name(path) == FFD_FORMAT_AUTO;
}

/* Checks what can be checked without a look at any file. A job that could never write its output claims no
   file: other jobs go on. */
static bool check_settings(const job_maker *maker)
{
    const ffd_deform_desc *const desc = &maker->job->desc;
    char what[sizeof maker->job->error.message];
    ffd_error error;
    ffd_status status;
    TRY_END(ffd_deform_desc_check(desc, &error));
    if (lacks_format(desc->input.format, desc->input.path))
        TRY_END(ffd_format_refuse_name(desc->input.path, &error));
    if (lacks_format(desc->output_format, desc->output))
        TRY_END(ffd_format_refuse_name(desc->output, &error));
    if (desc->output)
        TRY_END(ffd_format_check_output(desc->output_format ? desc->output_format
                                                            : ffd_format_from_name(desc->output),
                                        desc->output, &error));
    return true;
end:
    ffd_error_format(&error, what, sizeof what);
    return refuse(maker, "%s", what);
}

/* Sets how the picture is drawn, also where none is: the line is wrong with and without pictures. */
static bool add_look(job_maker *maker)
{
    const job_description *const description = maker->description;
    job_look look;
    ffd_error error;
    ffd_job_look_begin(&look, maker->frame->look);
    for (size_t i = 0; i < description->count; i++) {
        const job_statement *const statement = &description->statements[i];
        if (statement->part == JOB_LOOK &&
            ffd_job_look_read(&look, ffd_description_name(description, statement),
                              ffd_description_value(description, statement), &error))
            return refuse(maker, "%s", error.message);
    }
    ffd_job_look_end(&look);
    maker->job->look = look.view;
    return true;
}

static bool make_job(job_maker *maker)
{
    const char *const wrong = ffd_description_wrong(maker->description, "");
    if (wrong)
        return refuse(maker, "%s", wrong);
    return add_files(maker) && add_settings(maker) && add_defaults(maker) && add_options(maker) &&
           add_look(maker) && check_settings(maker);
}

/* Hashes what determines the output, except the bytes of files. */
static bool hash_content(batch_job *job)
{
    const char *const version = ffd_version_build(), *const output = job->output ? job->output : "";
    byte_buffer bytes = {0};
    ffd_settings_write(&job->desc, SETTINGS_CONTENT, &bytes);
    const hash_block blocks[] = {{version, strlen(version) + 1},
                                 {job->input, strlen(job->input) + 1},
                                 {output, strlen(output) + 1},
                                 {bytes.data, bytes.size}};
    const bool hashed = !bytes.failed;
    if (hashed)
        job->content = ffd_hash_blocks(blocks, sizeof blocks / sizeof *blocks);
    ffd_buffer_free(&bytes);
    return hashed;
}

ffd_status ffd_job_make(const batch_frame *frame, job_description *description, batch_job *job)
{
    job_maker maker = {frame, description, job};
    ffd_deform_desc_init(&job->desc, sizeof job->desc);
    const bool made = !description->texts.failed && make_job(&maker) && hash_content(job);
    job->texts = description->texts;
    description->texts = (byte_buffer){0};
    if (job->error.status == FFD_E_MEMORY || (!made && !job->error.status))
        return ffd_fail_memory(&job->error);
    return FFD_OK;
}

const char *ffd_job_output_name(const batch_job *job)
{
    return job->output ? job->output : job->target ? job->input : NULL;
}

const char *ffd_format_ending(ffd_format format)
{
    size_t index = 0;
    while (ffd_deform_member(index)->kind != FFD_MEMBER_FORMAT)
        index++;
    return format == FFD_FORMAT_AUTO ? NULL : ffd_deform_member(index)->words[format];
}

static void count_file(const char *path, memory_budget *budget)
{
    file_stamp stamp;
    if (ffd_file_stamp(path, &stamp))
        ffd_budget_add_file(budget, stamp.size, 0);
}

uint64_t ffd_job_memory(const batch_job *job, bool draws)
{
    const uint64_t asked = job->desc.input.memory;
    memory_budget budget = ffd_budget_make(draws && asked == 0 ? LEAST_VIEW_MEMORY : asked);
    count_file(job->desc.input.path, &budget);
    for (size_t i = 0; i < job->desc.lattice_count; i++)
        count_file(job->desc.lattices[i].path, &budget);
    return ffd_budget_most(&budget);
}

void ffd_job_free(batch_job *job)
{
    ffd_setting_lists_free(&job->desc);
    ffd_free(job->input);
    ffd_free(job->output);
    ffd_buffer_free(&job->texts);
    ffd_paths_free(&job->paths);
    *job = (batch_job){0};
}
