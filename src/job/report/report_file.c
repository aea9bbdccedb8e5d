#include "job/report/report_file.h"
#include "base/file/growing.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "job/report/output_set.h"
#include "job/report/replace.h"
#include "job/report/report.h"
#include "job/report/report_animation.h"
#include "job/report/report_fit.h"
#include "job/report/report_refine.h"
#include "json/json_text.h"
#include <string.h>

/* The position of an entry in the file; size 0: none. */
typedef struct entry_place {
    uint64_t begin, size;
} entry_place;

struct ffd_report {
    bool stable, lines;
    char *path;
    file_output *stream; /* begun when the report is created; else NULL: */
    growing_file *file;
    uint64_t end;        /* of the last entry in the file */
    entry_place *places; /* by job number */
    size_t place_count, place_capacity;
    uint64_t count;     /* of entries */
    bool is_mixed;      /* entries are not in the order of the jobs */
    byte_buffer buffer; /* next bytes to write */
};

/* The text */

bool ffd_report_has_lines(const char *path)
{
    return ffd_path_has_ending(path, ".jsonl");
}

void ffd_report_begin_text(bool lines, byte_buffer *text)
{
    if (!lines)
        ffd_buffer_text(text, "{\n  \"format\": \"ffd-report\",\n  \"version\": 1,\n  \"jobs\": [");
}

void ffd_report_put_entry(bool lines, bool is_first, const char *entry, size_t size, byte_buffer *text)
{
    if (lines) {
        ffd_json_join_lines(entry, size, text);
        ffd_buffer_text(text, "\n");
        return;
    }
    ffd_buffer_text(text, is_first ? "\n    " : ",\n    ");
    ffd_buffer_append(text, entry, size);
}

void ffd_report_end_text(bool lines, bool is_empty, byte_buffer *text)
{
    if (!lines)
        ffd_buffer_text(text, is_empty ? "]\n}\n" : "\n  ]\n}\n");
}

/* What may be replaced */

static bool contains(const char *text, size_t size, const char *word)
{
    const size_t length = strlen(word);
    for (size_t i = 0; i + length <= size; i++)
        if (memcmp(text + i, word, length) == 0)
            return true;
    return false;
}

static bool is_report(const file_input *old)
{
    return contains((const char *)old->data, old->size < 76 ? old->size : 76, "\"ffd-report\"");
}

/* Decided by the first line. */
static bool is_report_of_lines(const file_input *old)
{
    static const char *const members[] = {"\"input\":", "\"output\":", "\"status\":", "\"exit\":"};
    const char *const text = (const char *)old->data, *const end = memchr(text, '\n', old->size);
    if (!end || *text != '{')
        return false;
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        if (!contains(text, (size_t)(end - text), members[i]))
            return false;
    return true;
}

/* Writing */

/* The callback that gets a report; function NULL: none. */
typedef struct report_sink {
    ffd_sink_function function;
    void *user;
} report_sink;

static ffd_status open_file(ffd_report *report, ffd_output_set *output_set, const report_sink *sink,
                            ffd_error *error)
{
    byte_buffer *const head = &report->buffer;
    ffd_report_begin_text(report->lines, head);
    report->end = head->size;
    if (sink->function || !ffd_growing_can(report->path)) {
        TRY(ffd_output_create(&report->stream, error));
        ffd_output_record(report->stream, ffd_output_set_list(output_set));
        ffd_output_redirect(report->stream, sink->function, sink->user);
        TRY(ffd_output_begin(report->stream, report->path, true, error));
        if (head->failed)
            return ffd_fail_memory(error);
        TRY(ffd_output_write(report->stream, head->data, head->size, error));
        /* A device that is full is told before the first job. A stream gets nothing before it has an entry.
         */
        return ffd_output_is_stream(report->path) ? FFD_OK : ffd_output_flush(report->stream, error);
    }
    ffd_report_end_text(report->lines, true, head);
    return head->failed ? ffd_fail_memory(error)
                        : ffd_growing_create(report->path, head->data, head->size,
                                             ffd_output_set_list(output_set), &report->file, error);
}

static ffd_status create(const char *path, bool stable, ffd_output_set *output_set, report_sink sink,
                         ffd_report **report, ffd_error *error)
{
    ffd_report *made = ffd_alloc_zero(1, sizeof *made);
    if (!made || !(made->path = ffd_text_copy(path))) {
        ffd_free(made);
        return ffd_fail_memory(error);
    }
    made->stable = stable;
    made->lines = ffd_report_has_lines(path);
    const ffd_status status = open_file(made, output_set, &sink, error);
    if (status)
        ffd_report_destroy(&made);
    *report = made;
    return status;
}

static ffd_status check_kind(const char *path, ffd_error *error)
{
    return ffd_replace_check(path, ffd_report_has_lines(path) ? is_report_of_lines : is_report, "report",
                             error);
}

ffd_status ffd_report_check(const char *path, ffd_error *error)
{
    TRY(check_kind(path, error));
    return ffd_output_check_with_folder(path, true, error);
}

ffd_status ffd_report_create(const char *path, bool stable, ffd_output_set *output_set, ffd_report **report,
                             ffd_error *error)
{
    *report = NULL;
    TRY(check_kind(path, error));
    return create(path, stable, output_set, (report_sink){0}, report, error);
}

ffd_status ffd_report_create_sink(const char *name, bool stable, ffd_sink_function sink, void *user,
                                  ffd_report **report, ffd_error *error)
{
    *report = NULL;
    if (!name || !sink)
        return ffd_fail(error, FFD_E_ARGUMENT, "a report in memory needs a name and a sink");
    TRY(ffd_file_check_name(name, error));
    return create(name, stable, NULL, (report_sink){sink, user}, report, error);
}

void ffd_report_destroy(ffd_report **report)
{
    if (!report || !*report)
        return;
    ffd_output_destroy(&(*report)->stream);
    ffd_growing_close(&(*report)->file);
    ffd_buffer_free(&(*report)->buffer);
    ffd_free((*report)->places);
    ffd_free((*report)->path);
    ffd_free(*report);
    *report = NULL;
}

bool ffd_report_is_ordered(const ffd_report *report)
{
    return report->stream;
}

/* Records the position of the next entry. */
static ffd_status note_place(ffd_report *report, uint64_t index, uint64_t begin, uint64_t size,
                             ffd_error *error)
{
    report->is_mixed = report->is_mixed || index < report->place_count;
    if (index >= report->place_count) {
        if (!ffd_grow((void **)&report->places, &report->place_capacity, (size_t)index + 1,
                      sizeof *report->places))
            return ffd_fail_memory(error);
        memset(report->places + report->place_count, 0,
               ((size_t)index - report->place_count) * sizeof *report->places);
        report->place_count = (size_t)index + 1;
    }
    report->places[index] = (entry_place){begin, size};
    return FFD_OK;
}

/* Overwrites the end of the text by the entry in the buffer and a new end. On failure the old state is
   restored. */
static ffd_status grow_file(ffd_report *report, ffd_error *error)
{
    byte_buffer *const text = &report->buffer;
    const uint64_t size = text->size;
    ffd_report_end_text(report->lines, false, text);
    if (text->failed)
        return ffd_fail_memory(error);
    const ffd_status status = ffd_growing_write(report->file, report->end, text->data, text->size, error);
    if (!status) {
        report->end += size;
        return FFD_OK;
    }
    text->size = 0;
    ffd_report_end_text(report->lines, report->count == 0, text);
    if (!text->failed)
        ffd_growing_write(report->file, report->end, text->data, text->size, NULL);
    return status;
}

/* Adds the entry in the buffer, which begins there after a lead. */
static ffd_status add_to_file(ffd_report *report, uint64_t index, size_t lead, ffd_error *error)
{
    ffd_status status;
    TRY_END(note_place(report, index, report->end + lead, report->buffer.size - lead, error));
    TRY_END(grow_file(report, error));
end:
    if (status && index < report->place_count)
        report->places[index].size = 0;
    return status;
}

ffd_status ffd_report_add_text(ffd_report *report, uint64_t index, const char *text, size_t size,
                               ffd_error *error)
{
    byte_buffer *const buffer = &report->buffer;
    buffer->size = 0;
    ffd_report_put_entry(report->lines, report->count == 0, text, size, buffer);
    if (buffer->failed)
        return ffd_fail_memory(error);
    TRY(report->stream ? ffd_output_write(report->stream, buffer->data, buffer->size, error)
                       : add_to_file(report, index, report->lines ? 0 : buffer->size - size, error));
    report->count++;
    return FFD_OK;
}

/* Adds the text of an entry behind the others, and frees it. */
static ffd_status add_last(ffd_report *report, byte_buffer *text, ffd_error *error)
{
    const ffd_status status = text->failed
                                  ? ffd_fail_memory(error)
                                  : ffd_report_add_text(report, report->count, text->data, text->size, error);
    ffd_buffer_free(text);
    return status;
}

ffd_status ffd_report_add_refine(ffd_report *report, const char *input, const char *output,
                                 const ffd_refine_result *callers, ffd_error *error)
{
    ffd_refine_result result = {.struct_size = sizeof result};
    byte_buffer text = {0};
    TRY(ffd_struct_take(&result, sizeof result, callers, "ffd_refine_result", error));
    ffd_report_refine_text(input, output, &result, report->stable, &text);
    return add_last(report, &text, error);
}

ffd_status ffd_report_add_fit(ffd_report *report, const char *input, const char *output,
                              const ffd_fit_job_result *callers, ffd_error *error)
{
    ffd_fit_job_result result = {.struct_size = sizeof result};
    byte_buffer text = {0};
    TRY(ffd_struct_take(&result, sizeof result, callers, "ffd_fit_job_result", error));
    ffd_report_fit_text(input, output, &result, report->stable, &text);
    return add_last(report, &text, error);
}

ffd_status ffd_report_add_animation(ffd_report *report, const char *input, const char *output,
                                    const ffd_animate_result *callers, ffd_error *error)
{
    ffd_animate_result result = {.struct_size = sizeof result};
    byte_buffer text = {0};
    TRY(ffd_struct_take(&result, sizeof result, callers, "ffd_animate_result", error));
    ffd_report_animation_text(input, output, &result, report->stable, &text);
    return add_last(report, &text, error);
}

/* Copies a caller's result, and its array of results of morph targets. *morphs is freed by the caller. */
static ffd_status take_result(const ffd_job_result *callers, ffd_job_result *result, ffd_job_result **morphs,
                              ffd_error *error)
{
    *morphs = NULL;
    TRY(ffd_struct_take(result, sizeof *result, callers, "ffd_job_result", error));
    if (!result->morphs.results)
        return FFD_OK;
    *morphs = ffd_alloc_zero(result->morphs.count, sizeof **morphs);
    if (!*morphs)
        return ffd_fail_memory(error);
    const char *const first = (const char *)result->morphs.results;
    for (size_t k = 0; k < result->morphs.count; k++)
        TRY(ffd_struct_take(&(*morphs)[k], sizeof **morphs, first + k * callers->struct_size,
                            "ffd_job_result", error));
    result->morphs.results = *morphs;
    return FFD_OK;
}

static ffd_status add_entry(ffd_report *report, const char *input, const char *output,
                            const ffd_job_result *result, ffd_error *error)
{
    const report_entry entry = {.input = input,
                                .output = output,
                                .outputs = result->outputs ? &result->outputs->names : NULL,
                                .result = result,
                                .stable = report->stable};
    byte_buffer text = {0};
    ffd_report_entry_text(&entry, &text);
    return add_last(report, &text, error);
}

ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                          const ffd_job_result *callers, ffd_error *error)
{
    ffd_job_result result = {.struct_size = sizeof result}, *morphs;
    ffd_status status;
    TRY_END(take_result(callers, &result, &morphs, error));
    TRY_END(add_entry(report, input, output, &result, error));
end:
    ffd_free(morphs);
    return status;
}

/* The end */

/* Copies the entries in the order of their jobs. */
static ffd_status copy_entries(ffd_report *report, file_output *output, ffd_error *error)
{
    byte_buffer *const text = &report->buffer, entry = {0};
    bool is_first = true;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < report->place_count; i++) {
        const entry_place place = report->places[i];
        entry.size = text->size = 0;
        if (place.size == 0)
            continue;
        char *const bytes = ffd_buffer_reserve(&entry, (size_t)place.size);
        TRY_END(bytes ? ffd_growing_read(report->file, place.begin, bytes, (size_t)place.size, error)
                      : ffd_fail_memory(error));
        /* The line break belongs to the entry of JSON Lines. */
        ffd_report_put_entry(report->lines, is_first, bytes, (size_t)place.size - report->lines, text);
        is_first = false;
        TRY_END(text->failed ? ffd_fail_memory(error)
                             : ffd_output_write(output, text->data, text->size, error));
    }
end:
    ffd_buffer_free(&entry);
    return status;
}

/* Rewrites the file with the entries in order. */
static ffd_status put_in_order(ffd_report *report, ffd_error *error)
{
    byte_buffer *const text = &report->buffer;
    file_output *output;
    TRY(ffd_output_create(&output, error));
    text->size = 0;
    ffd_report_begin_text(report->lines, text);
    ffd_status status;
    TRY_END(ffd_output_begin(output, report->path, true, error));
    if (!text->failed)
        TRY_END(ffd_output_write(output, text->data, text->size, error));
    TRY_END(copy_entries(report, output, error));
    ffd_growing_close(&report->file); /* Windows does not replace a file that is open */
    text->size = 0;
    ffd_report_end_text(report->lines, false, text);
    TRY_END(text->failed ? ffd_fail_memory(error) : ffd_output_write(output, text->data, text->size, error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}

ffd_status ffd_report_write(ffd_report *report, ffd_error *error)
{
    byte_buffer *const text = &report->buffer;
    if (report->file) {
        const bool keeps_order = report->lines && !report->stable;
        return report->is_mixed && !keeps_order ? put_in_order(report, error) : FFD_OK;
    }
    text->size = 0;
    ffd_report_end_text(report->lines, report->count == 0, text);
    if (text->failed)
        return ffd_fail_memory(error);
    TRY(ffd_output_write(report->stream, text->data, text->size, error));
    return ffd_output_commit(report->stream, error);
}
