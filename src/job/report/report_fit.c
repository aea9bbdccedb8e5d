#include "job/report/report_fit.h"
#include "job/report/report.h"
#include "job/report/report_figures.h"
#include <math.h>

typedef struct fit_entry {
    const char *input, *output;
    const ffd_fit_job_result *result;
    bool stable;
} fit_entry;

/* A number that is not known is null. */
static void write_number(json_text *json, const char *name, double number)
{
    if (isfinite(number))
        ffd_json_number(json, name, number);
    else
        ffd_json_null(json, name);
}

static void write_counts(json_text *json, const ffd_fit_result *r)
{
    const json_count counts[] = {
        {"pairs", r->pairs},       {"used", r->used},   {"outside", r->outside},    {"multiple", r->multiple},
        {"singular", r->singular}, {"exact", r->exact}, {"dependent", r->dependent}};
    ffd_json_counts(json, counts, sizeof counts / sizeof *counts);
}

static void write_affine(json_text *json, const double affine[12])
{
    ffd_json_array(json, "affine", true);
    for (int row = 0; row < 4; row++)
        ffd_json_vector(json, NULL, affine + 3 * row, 3);
    ffd_json_end(json, ']');
}

static void write_residual(json_text *json, const ffd_fit_result *r)
{
    ffd_json_object(json, "residual", true);
    ffd_json_number(json, "max", r->residual_max);
    ffd_json_number(json, "rms", r->residual_rms);
    ffd_json_number(json, "p95", r->residual_p95);
    ffd_json_count(json, "worst", r->worst);
    ffd_json_end(json, '}');
}

void ffd_report_write_fit(json_text *json, const char *key, const ffd_fit_job_result *result)
{
    const ffd_fit_result *const r = &result->fit;
    ffd_json_object(json, key, false);
    write_counts(json, r);
    ffd_json_number(json, "smooth", r->smooth);
    ffd_json_string(json, "smooth_chosen_by", ffd_fit_choice_name(r->smooth_chosen_by));
    write_number(json, "gcv", r->gcv);
    write_affine(json, r->affine);
    write_residual(json, r);
    write_number(json, "residual_exact", r->residual_exact);
    ffd_json_number(json, "largest_offset", r->largest_offset);
    ffd_json_count(json, "points_without_data", r->points_without_data);
    ffd_figures_write_folds(json, &r->folds);
    if (result->robust)
        ffd_json_count(json, "downweighted", r->downweighted);
    else
        ffd_json_null(json, "downweighted");
    ffd_json_object(json, "spread", true);
    ffd_json_count(json, "positions", r->spread_positions);
    ffd_json_number(json, "largest", r->spread_largest);
    ffd_json_end(json, '}');
    ffd_json_count(json, "flops", r->flops);
    ffd_json_end(json, '}');
}

static void write_entry(json_text *json, const void *context)
{
    const fit_entry *const entry = context;
    const ffd_fit_job_result *const result = entry->result;
    ffd_report_begin_single(json, entry->input, entry->output, result->status, &result->error);
    if (result->is_fitted)
        ffd_report_write_fit(json, "fit", result);
    else
        ffd_json_null(json, "fit");
    if (!entry->stable) {
        ffd_json_object(json, "seconds", true);
        ffd_json_number(json, "read", result->seconds.read);
        ffd_json_number(json, "fit", result->seconds.fit);
        ffd_json_number(json, "write", result->seconds.write);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
}

void ffd_report_fit_text(const char *input, const char *output, const ffd_fit_job_result *result, bool stable,
                         byte_buffer *text)
{
    const fit_entry entry = {input, output, result, stable};
    ffd_report_indent_entry(write_entry, &entry, text);
}
