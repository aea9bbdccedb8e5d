#include "job/report/report.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "job/report/output_set.h"
#include "job/report/replace.h"
#include "mesh/mesh.h"
#include <string.h>

struct ffd_report {
    bool stable;
    file_output *output; /* begun when the report is created */
    byte_buffer text;    /* what has not gone there yet */
    json_text json;      /* writes into it */
};

static bool is_report(const file_input *old)
{
    static const char mark[] = "\"ffd-report\"";
    for (size_t i = 0; i + sizeof mark <= old->size && i < 64; i++)
        if (memcmp(old->data + i, mark, sizeof mark - 1) == 0)
            return true;
    return false;
}

static void begin_text(ffd_report *report)
{
    ffd_json_begin(&report->json, &report->text);
    ffd_json_object(&report->json, NULL, false);
    ffd_json_string(&report->json, "format", "ffd-report");
    ffd_json_count(&report->json, "version", 1);
    ffd_json_array(&report->json, "jobs", false);
}

ffd_status ffd_report_create(const char *path, bool stable, ffd_written *written, ffd_report **report,
                             ffd_error *error)
{
    *report = NULL;
    ffd_status status = ffd_replace_check(path, is_report, "report", error);
    if (status)
        return status;
    ffd_report *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    made->stable = stable;
    status = ffd_output_create(&made->output, error);
    if (!status) {
        ffd_output_record(made->output, ffd_written_list(written));
        status = ffd_output_begin(made->output, path, true, error);
    }
    if (status)
        ffd_report_destroy(&made);
    else
        begin_text(made);
    *report = made;
    return status;
}

void ffd_report_destroy(ffd_report **report)
{
    if (!report || !*report)
        return;
    ffd_output_destroy(&(*report)->output);
    ffd_buffer_free(&(*report)->text);
    ffd_free(*report);
    *report = NULL;
}

static void write_outcome(json_text *json, const report_entry *entry)
{
    const ffd_status status = entry->result->status;
    char line[2048];
    ffd_json_string(json, "status", entry->skipped ? "skipped" : status ? "failed" : "ok");
    ffd_json_count(json, "exit", (uint64_t)ffd_status_exit_code(status));
    if (!status) {
        ffd_json_null(json, "error");
        return;
    }
    ffd_error_format(&entry->result->error, line, sizeof line);
    ffd_json_string(json, "error", line);
}

static void write_bounds(json_text *json, const char *key, const ffd_bounds *box)
{
    ffd_json_object(json, key, true);
    if (box->min[0] <= box->max[0]) {
        ffd_json_vector(json, "min", box->min, 3);
        ffd_json_vector(json, "max", box->max, 3);
    } else {
        ffd_json_null(json, "min");
        ffd_json_null(json, "max");
    }
    ffd_json_end(json, '}');
}

static void write_witness(json_text *json, const ffd_job_result *result)
{
    const ffd_folds *folds = &result->folds;
    if (!folds->has_witness) {
        ffd_json_null(json, "witness");
        return;
    }
    ffd_json_object(json, "witness", true);
    ffd_json_count(json, "lattice", result->folds_lattice);
    ffd_json_vector(json, "uvw", folds->witness_uvw, 3);
    ffd_json_vector(json, "xyz", folds->witness_xyz, 3);
    ffd_json_vector(json, "rest", folds->witness_rest, 3);
    ffd_json_number(json, "det", folds->witness_det);
    ffd_json_end(json, '}');
}

static void write_folds(json_text *json, const ffd_job_result *result)
{
    static const char *const verdicts[] = {"none", "some", "unknown"};
    const ffd_folds *folds = &result->folds;
    if (!result->has_folds) {
        ffd_json_null(json, "folds");
        return;
    }
    ffd_json_object(json, "folds", false);
    ffd_json_string(json, "verdict", verdicts[folds->verdict]);
    ffd_json_count(json, "cells", folds->cells);
    ffd_json_number(json, "min_det", folds->min_det);
    ffd_json_count(json, "folded_cells", folds->folded_cells);
    ffd_json_count(json, "unknown_cells", folds->unknown_cells);
    write_witness(json, result);
    ffd_json_end(json, '}');
}

static void write_determinants(json_text *json, const ffd_job_result *result)
{
    if (!(result->det_min <= result->det_max)) {
        ffd_json_null(json, "det");
        return;
    }
    ffd_json_object(json, "det", true);
    ffd_json_number(json, "min", result->det_min);
    ffd_json_number(json, "max", result->det_max);
    ffd_json_end(json, '}');
}

static void write_edges(json_text *json, const ffd_job_result *result)
{
    if (!result->has_edges) {
        ffd_json_null(json, "edges");
        return;
    }
    ffd_json_object(json, "edges", false);
    ffd_json_count(json, "count", result->edges);
    ffd_json_object(json, "deviation", true);
    ffd_json_number(json, "max", result->deviation_max);
    ffd_json_number(json, "mean", result->deviation_mean);
    ffd_json_end(json, '}');
    ffd_json_end(json, '}');
}

static void write_figures(json_text *json, const ffd_job_result *result)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    ffd_json_count(json, "vertices", result->vertices);
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        ffd_json_count(json, names[s], result->counts[s]);
    ffd_json_count(json, "moved", result->moved);
    ffd_json_object(json, "residual", true);
    ffd_json_number(json, "max", result->residual_max);
    ffd_json_number(json, "rms", result->residual_rms);
    ffd_json_end(json, '}');
    ffd_json_object(json, "iterations", true);
    ffd_json_number(json, "mean", result->evaluations_mean);
    ffd_json_count(json, "max", result->evaluations_max);
    ffd_json_end(json, '}');
    write_folds(json, result);
    if (result->has_flipped)
        ffd_json_count(json, "flipped_faces", result->flipped_faces);
    else
        ffd_json_null(json, "flipped_faces");
    write_determinants(json, result);
    write_edges(json, result);
    ffd_json_object(json, "bounds", false);
    write_bounds(json, "before", &result->before);
    write_bounds(json, "after", &result->after);
    ffd_json_end(json, '}');
    ffd_json_object(json, "displacement", true);
    ffd_json_number(json, "max", result->displacement_max);
    ffd_json_number(json, "rms", result->displacement_rms);
    ffd_json_end(json, '}');
}

static void write_entry(json_text *json, const report_entry *entry)
{
    const ffd_job_result *result = entry->result;
    ffd_json_object(json, NULL, false);
    if (entry->line)
        ffd_json_count(json, "line", entry->line);
    ffd_json_string(json, "input", entry->input);
    ffd_json_string(json, "output", entry->output);
    write_outcome(json, entry);
    write_figures(json, result);
    if (!entry->stable) {
        ffd_json_object(json, "seconds", true);
        ffd_json_number(json, "read", result->seconds_read);
        ffd_json_number(json, "embed", result->seconds_embed);
        ffd_json_number(json, "deform", result->seconds_deform);
        ffd_json_number(json, "judge", result->seconds_judge);
        ffd_json_number(json, "write", result->seconds_write);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
}

/* Hands over what is there. */
static ffd_status flush(ffd_report *report, ffd_error *error)
{
    if (report->text.failed)
        return ffd_fail_memory(error);
    const ffd_status status = ffd_output_write(report->output, report->text.data, report->text.size, error);
    report->text.size = 0;
    return status;
}

ffd_status ffd_report_add_text(ffd_report *report, const char *text, size_t size, ffd_error *error)
{
    ffd_json_raw(&report->json, NULL, text, size);
    return flush(report, error);
}

ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                          const ffd_job_result *result, ffd_error *error)
{
    const report_entry entry = {.input = input, .output = output, .result = result, .stable = report->stable};
    write_entry(&report->json, &entry);
    return flush(report, error);
}

void ffd_report_entry_text(const report_entry *entry, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, false);
    ffd_json_array(&json, NULL, false);
    const size_t before = whole.size; /* it has the depth of a report's entry */
    write_entry(&json, entry);
    const char *const start = whole.failed ? NULL : memchr(whole.data + before, '{', whole.size - before);
    if (start)
        ffd_buffer_append(text, start, whole.size - (size_t)(start - whole.data));
    text->failed = text->failed || !start;
    ffd_buffer_free(&whole);
}

ffd_status ffd_report_write(ffd_report *report, ffd_error *error)
{
    ffd_json_end(&report->json, ']');
    ffd_json_end(&report->json, '}');
    const ffd_status status = flush(report, error);
    return status ? status : ffd_output_commit(report->output, error);
}
