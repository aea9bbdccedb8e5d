#include "job/report/report_refine.h"
#include "job/report/report.h"
#include "json/json_text.h"

typedef struct refine_entry {
    const char *input, *output;
    const ffd_refine_result *result;
    bool stable;
} refine_entry;

static void write_three(json_text *json, const char *name, const uint64_t numbers[3])
{
    ffd_json_array(json, name, true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, numbers[a]);
    ffd_json_end(json, ']');
}

static void write_change(json_text *json, const char *name, const uint64_t before[3], const uint64_t after[3])
{
    ffd_json_object(json, name, true);
    write_three(json, "before", before);
    write_three(json, "after", after);
    ffd_json_end(json, '}');
}

static void write_refine(json_text *json, const ffd_refine_result *r)
{
    uint64_t size[2][3], degree[2][3];
    for (int a = 0; a < 3; a++) {
        size[0][a] = r->size_before[a];
        size[1][a] = r->size[a];
        degree[0][a] = (uint64_t)r->degree_before[a];
        degree[1][a] = (uint64_t)r->degree[a];
    }
    ffd_json_object(json, "refine", false);
    write_change(json, "size", size[0], size[1]);
    write_change(json, "degree", degree[0], degree[1]);
    if (r->largest_difference >= 0)
        ffd_json_number(json, "largest_difference", r->largest_difference);
    else
        ffd_json_null(json, "largest_difference");
    ffd_json_end(json, '}');
}

static void write_entry(json_text *json, const void *context)
{
    const refine_entry *const entry = context;
    const ffd_refine_result *const result = entry->result;
    ffd_report_begin_single(json, entry->input, entry->output, result->status, &result->error);
    if (result->status)
        ffd_json_null(json, "refine");
    else
        write_refine(json, result);
    if (!entry->stable) {
        ffd_json_object(json, "seconds", true);
        ffd_json_number(json, "read", result->seconds.read);
        ffd_json_number(json, "refine", result->seconds.refine);
        ffd_json_number(json, "write", result->seconds.write);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
}

void ffd_report_refine_text(const char *input, const char *output, const ffd_refine_result *result,
                            bool stable, byte_buffer *text)
{
    const refine_entry entry = {input, output, result, stable};
    ffd_report_indent_entry(write_entry, &entry, text);
}
