/* compare_json.c - a comparison for programs. */
#include "base/fail.h"
#include "json/json_text.h"
#include <ffd/job.h>

static void write_difference(json_text *json, const char *key, const ffd_difference *difference)
{
    if (!difference->text[0]) {
        ffd_json_null(json, key);
        return;
    }
    ffd_json_object(json, key, false);
    ffd_json_string(json, "kind", ffd_difference_kind_name(difference->kind));
    ffd_json_string(json, "message", difference->text);
    if (difference->measured) {
        ffd_json_number(json, "a", difference->a);
        ffd_json_number(json, "b", difference->b);
        ffd_json_number(json, "difference", difference->amount);
    }
    ffd_json_end(json, '}');
}

static void write_comparison(json_text *json, const ffd_comparison *comparison, const char *a, const char *b)
{
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "format", "ffd-comparison");
    ffd_json_count(json, "version", 1);
    ffd_json_string(json, "a", a);
    ffd_json_string(json, "b", b);
    ffd_json_bool(json, "equal", comparison->equal);
    ffd_json_bool(json, "complete", comparison->complete);
    ffd_json_number(json, "tolerance", comparison->tolerance);
    ffd_json_number(json, "normal_tolerance", comparison->direction_tolerance);
    ffd_json_count(json, "positions_compared", comparison->positions_compared);
    ffd_json_object(json, "largest", true);
    ffd_json_number(json, "position", comparison->position_difference_max);
    ffd_json_number(json, "normal", comparison->direction_difference_max);
    ffd_json_end(json, '}');
    ffd_json_object(json, "differences", true);
    ffd_json_count(json, "total", comparison->differences);
    for (int kind = 0; kind < FFD_DIFFERENCE_KIND_COUNT; kind++)
        ffd_json_count(json, ffd_difference_kind_name((ffd_difference_kind)kind), comparison->counts[kind]);
    ffd_json_end(json, '}');
    write_difference(json, "first", &comparison->first);
    write_difference(json, "worst", &comparison->worst);
    ffd_json_end(json, '}');
}

ffd_status ffd_comparison_json(const ffd_comparison *comparison, const char *a, const char *b, char **text,
                               ffd_error *error)
{
    byte_buffer buffer = {0};
    json_text json;
    ffd_json_begin(&json, &buffer);
    write_comparison(&json, comparison, a, b);
    *text = ffd_buffer_finish(&buffer);
    ffd_buffer_free(&buffer);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
