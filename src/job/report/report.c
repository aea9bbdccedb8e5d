#include "job/report/report.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "job/report/report_figures.h"
#include "json/json_parse.h"
#include "json/json_text.h"
#include <string.h>

const char *ffd_report_outcome_name(report_outcome outcome)
{
    static const char *const names[] = {
        [REPORT_OK] = "ok", [REPORT_FAILED] = "failed", [REPORT_SKIPPED] = "skipped"};
    return names[outcome];
}

void ffd_report_write_outcome(json_text *json, ffd_status status, const ffd_error *error, bool skipped)
{
    char line[2048];
    const report_outcome outcome = skipped ? REPORT_SKIPPED : status ? REPORT_FAILED : REPORT_OK;
    ffd_json_string(json, "status", ffd_report_outcome_name(outcome));
    ffd_json_count(json, "exit", (uint64_t)ffd_status_exit_code(status));
    if (!status) {
        ffd_json_null(json, "error");
        return;
    }
    ffd_error_format(error, line, sizeof line);
    ffd_json_string(json, "error", line);
}

void ffd_report_begin_single(json_text *json, const char *input, const char *output, ffd_status status,
                             const ffd_error *error)
{
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "input", input);
    ffd_json_string(json, "output", output);
    ffd_json_array(json, "outputs", true);
    if (!status && output && !ffd_output_is_stream(output))
        ffd_json_string(json, NULL, output);
    ffd_json_end(json, ']');
    ffd_report_write_outcome(json, status, error, false);
}

/* Copies the members of a text that ffd_report_figures has made. Returns false if it is not one. */
static bool copy_figures(json_text *json, const char *figures, bool stable)
{
    const json_input input = {.text = figures, .size = strlen(figures), .name = ""};
    json_tree tree;
    if (ffd_json_parse(&input, &tree, NULL))
        return false;
    for (uint32_t v = ffd_json_tree_first(&tree, 0); v != JSON_NONE; v = ffd_json_tree_after(&tree, v)) {
        char *const key = ffd_json_tree_key(&tree, v);
        json->out->failed = json->out->failed || !key;
        if (key && !(stable && strcmp(key, "seconds") == 0))
            ffd_json_raw(json, key, tree.text + tree.values[v].begin,
                         tree.values[v].end - tree.values[v].begin);
        ffd_free(key);
    }
    ffd_json_tree_free(&tree);
    return true;
}

static void write_outputs(json_text *json, const report_entry *entry)
{
    ffd_json_array(json, "outputs", true);
    for (size_t i = 0; entry->outputs && i < entry->outputs->count; i++)
        ffd_json_string(json, NULL, entry->outputs->paths[i]);
    if (!entry->outputs && entry->output && !entry->result->status && !ffd_output_is_stream(entry->output))
        ffd_json_string(json, NULL, entry->output);
    ffd_json_end(json, ']');
}

static void write_entry(json_text *json, const void *context)
{
    const report_entry *const entry = context;
    ffd_json_object(json, NULL, false);
    if (entry->line)
        ffd_json_count(json, "line", entry->line);
    ffd_json_string(json, "input", entry->input);
    ffd_json_string(json, "output", entry->output);
    write_outputs(json, entry);
    if (entry->positions) {
        ffd_json_string(json, "positions", entry->positions);
        ffd_json_count(json, "row", entry->row);
    }
    if (entry->result->picture)
        ffd_json_string(json, "picture", entry->result->picture);
    if (entry->result->page)
        ffd_json_string(json, "page", entry->result->page);
    if (entry->result->own_frame)
        ffd_json_string(json, "own_frame", entry->result->own_frame);
    if (entry->set)
        ffd_json_raw(json, "set", entry->set, strlen(entry->set));
    ffd_report_write_outcome(json, entry->result->status, &entry->result->error, entry->skipped);
    if (entry->planned) {
        ffd_figures_write_unknown(json);
    } else if (!entry->figures || !copy_figures(json, entry->figures, entry->stable)) {
        ffd_figures_write(json, entry->result, entry->stable);
    }
    ffd_json_end(json, '}');
}

void ffd_report_indent_entry(report_entry_writer *write, const void *entry, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, false);
    ffd_json_array(&json, NULL, false);
    const size_t before = whole.size;
    write(&json, entry);
    const char *const start = whole.failed ? NULL : memchr(whole.data + before, '{', whole.size - before);
    if (start)
        ffd_buffer_append(text, start, whole.size - (size_t)(start - whole.data));
    text->failed = text->failed || !start;
    ffd_buffer_free(&whole);
}

void ffd_report_entry_text(const report_entry *entry, byte_buffer *text)
{
    ffd_report_indent_entry(write_entry, entry, text);
}

void ffd_report_figures(const ffd_job_result *result, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, false);
    ffd_figures_write(&json, result, false);
    ffd_json_end(&json, '}');
    if (!whole.failed)
        ffd_json_join_lines(whole.data, whole.size, text);
    text->failed = text->failed || whole.failed;
    ffd_buffer_free(&whole);
}
