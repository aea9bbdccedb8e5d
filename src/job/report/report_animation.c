#include "job/report/report_animation.h"
#include "base/file/output.h"
#include "job/report/report.h"
#include "json/json_text.h"

typedef struct animation_entry {
    const char *input, *output;
    const ffd_animate_result *result;
    bool stable;
} animation_entry;

static void write_counts(json_text *json, const ffd_animate_result *r)
{
    const json_count counts[] = {{"vertices", r->vertices}, {"inside", r->inside},
                                 {"outside", r->outside},   {"multiple", r->multiple},
                                 {"singular", r->singular}, {"invalid", r->invalid}};
    ffd_json_counts(json, counts, sizeof counts / sizeof *counts);
}

static void write_animation(json_text *json, const ffd_animate_result *r)
{
    ffd_json_object(json, "animation", false);
    ffd_json_string(json, "name", r->name);
    ffd_json_count(json, "targets", r->targets);
    ffd_json_count(json, "keys", r->keys);
    ffd_json_count(json, "samples", r->samples);
    ffd_json_number(json, "tolerance", r->tolerance);
    ffd_json_number(json, "bound", r->bound);
    ffd_json_number(json, "largest_weight", r->largest_weight);
    ffd_json_count(json, "bytes", r->bytes);
    ffd_json_end(json, '}');
}

static void write_entry(json_text *json, const void *context)
{
    const animation_entry *const entry = context;
    const ffd_animate_result *const result = entry->result;
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "input", entry->input);
    ffd_json_string(json, "output", entry->output);
    ffd_json_array(json, "outputs", true);
    for (size_t i = 0; result->outputs && i < ffd_output_list_count(result->outputs); i++)
        ffd_json_string(json, NULL, ffd_output_list_name(result->outputs, i));
    ffd_json_end(json, ']');
    ffd_report_write_outcome(json, result->status, &result->error, false);
    write_counts(json, result);
    if (result->status)
        ffd_json_null(json, "animation");
    else
        write_animation(json, result);
    if (!entry->stable) {
        ffd_json_object(json, "seconds", true);
        ffd_json_number(json, "read", result->seconds.read);
        ffd_json_number(json, "plan", result->seconds.plan);
        ffd_json_number(json, "deform", result->seconds.deform);
        ffd_json_number(json, "write", result->seconds.write);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
}

void ffd_report_animation_text(const char *input, const char *output, const ffd_animate_result *result,
                               bool stable, byte_buffer *text)
{
    const animation_entry entry = {input, output, result, stable};
    ffd_report_indent_entry(write_entry, &entry, text);
}
