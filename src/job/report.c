/* report.c - the JSON report of interface 4. */
#include "base/json_text.h"
#include "base/memory.h"
#include "base/path.h"
#include "job/replace.h"
#include "job/written.h"
#include "mesh/mesh.h"
#include <string.h>

typedef struct report_entry {
    char *input, *output; /* output may be NULL */
    ffd_job_result result;
} report_entry;

struct ffd_report {
    bool stable;
    file_output *output; /* begun when the report is created */
    report_entry *entries;
    size_t count, capacity;
};

static bool is_report(const file_input *old)
{
    static const char mark[] = "\"ffd-report\"";
    for (size_t i = 0; i + sizeof mark <= old->size && i < 64; i++)
        if (memcmp(old->data + i, mark, sizeof mark - 1) == 0)
            return true;
    return false;
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
    *report = made;
    return status;
}

void ffd_report_destroy(ffd_report **report)
{
    if (!report || !*report)
        return;
    for (size_t i = 0; i < (*report)->count; i++) {
        ffd_free((*report)->entries[i].input);
        ffd_free((*report)->entries[i].output);
    }
    ffd_output_destroy(&(*report)->output);
    ffd_free((*report)->entries);
    ffd_free(*report);
    *report = NULL;
}

ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                          const ffd_job_result *result, ffd_error *error)
{
    if (!ffd_grow((void **)&report->entries, &report->capacity, report->count + 1, sizeof *report->entries))
        return ffd_fail_memory(error);
    report_entry *entry = &report->entries[report->count];
    entry->result = *result;
    entry->input = ffd_text_copy(input);
    entry->output = output ? ffd_text_copy(output) : NULL;
    if (!entry->input || (output && !entry->output)) {
        ffd_free(entry->input);
        ffd_free(entry->output);
        return ffd_fail_memory(error);
    }
    report->count++;
    return FFD_OK;
}

static void write_error(json_text *json, const ffd_job_result *result)
{
    char line[2048];
    if (!result->status) {
        ffd_json_null(json, "error");
        return;
    }
    ffd_error_format(&result->error, line, sizeof line);
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

static void write_entry(json_text *json, const report_entry *entry, bool stable)
{
    const ffd_job_result *result = &entry->result;
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "input", entry->input);
    ffd_json_string(json, "output", entry->output);
    ffd_json_string(json, "status", result->status ? "failed" : "ok");
    ffd_json_count(json, "exit", (uint64_t)ffd_status_exit_code(result->status));
    write_error(json, result);
    write_figures(json, result);
    if (!stable) {
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

ffd_status ffd_report_write(ffd_report *report, ffd_error *error)
{
    byte_buffer text = {0};
    json_text json;
    ffd_json_begin(&json, &text);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "format", "ffd-report");
    ffd_json_count(&json, "version", 1);
    ffd_json_array(&json, "jobs", false);
    for (size_t i = 0; i < report->count; i++)
        write_entry(&json, &report->entries[i], report->stable);
    ffd_json_end(&json, ']');
    ffd_json_end(&json, '}');

    ffd_status status = text.failed ? ffd_fail_memory(error) : FFD_OK;
    if (!status)
        status = ffd_output_write(report->output, text.data, text.size, error);
    if (!status)
        status = ffd_output_commit(report->output, error);
    ffd_buffer_free(&text);
    return status;
}
