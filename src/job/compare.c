/* compare.c - the job of `ffd compare`, and its result as JSON. */
#include "job/compare.h"
#include "base/file/mapping.h"
#include "base/struct_size.h"
#include "job/input/in_memory.h"
#include "job/input/source.h"
#include "mesh/bounds.h"
#include "mesh/difference.h"
#include "json/json_text.h"
#include <float.h>
#include <math.h>
#include <string.h>

void ffd_compare_desc_init(ffd_compare_desc *desc, size_t size)
{
    const ffd_compare_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static ffd_status open_source(const ffd_source *given, mesh_document **document, ffd_error *error)
{
    ffd_source source = *given;
    source.only_positions = false;
    return ffd_source_open(&source, 0, document, error);
}

/* Returns the diagonal of the mesh's box, clamped to the largest double. */
static double find_diagonal(const mesh_document *document)
{
    ffd_bounds box = ffd_bounds_empty();
    double half[3];
    for (size_t i = 0; i < document->part_count; i++)
        if (!document->parts[i].repeats_positions)
            ffd_source_widen(document, MESH_STORED, i, &box);
    if (box.min[0] > box.max[0])
        return 0;
    for (int c = 0; c < 3; c++)
        half[c] = box.max[c] / 2 - box.min[c] / 2;
    return minimum_number(2 * vec_length(half), DBL_MAX);
}

static ffd_status compare(const ffd_compare_desc *desc, const mesh_document *a, const mesh_document *b,
                          ffd_comparison *comparison, ffd_error *error)
{
    const double diagonal = desc->relative ? find_diagonal(a) : 0;
    const double tolerance = desc->relative ? desc->tolerance * diagonal : desc->tolerance;
    /* Clamp to the largest double: then every finite difference is within the tolerance, and an infinite one
       is not. */
    ffd_difference_begin(comparison, minimum_number(tolerance, DBL_MAX),
                         minimum_number(desc->direction_tolerance, DBL_MAX));
    comparison->diagonal = diagonal;
    if (a->format == b->format)
        return a->format->compare(a, b, comparison, error);
    ffd_difference_stop(comparison, FFD_DIFFERENCE_OTHER, "formats: %s and %s", a->format->name,
                        b->format->name);
    return FFD_OK;
}

ffd_status ffd_compare_check(const ffd_compare_desc *desc, ffd_error *error)
{
    return !(desc->tolerance >= 0) || !(desc->direction_tolerance >= 0)
               ? ffd_fail(error, FFD_E_ARGUMENT, "a tolerance must not be negative")
               : FFD_OK;
}

static ffd_status open_and_compare(const ffd_compare_desc *desc, ffd_comparison *comparison, ffd_error *error)
{
    const mesh_log log = {desc->log, desc->log_user};
    mesh_document *first = NULL, *second = NULL;
    if (!desc->a.path || !desc->b.path)
        return ffd_fail(error, FFD_E_ARGUMENT, "the description of the comparison is not complete");
    TRY(ffd_compare_check(desc, error));
    const unsigned losses = ffd_mapping_losses();
    ffd_status status;
    TRY_END(open_source(&desc->a, &first, error));
    TRY_END(open_source(&desc->b, &second, error));
    TRY_END(compare(desc, first, second, comparison, error));
end:
    status = ffd_mapping_judge(losses, status, error);
    if (!status) {
        ffd_flaws_warn(&first->flaws, ffd_source_name(&desc->a), &log);
        ffd_flaws_warn(&second->flaws, ffd_source_name(&desc->b), &log);
    }
    ffd_source_close(&second);
    ffd_source_close(&first);
    return status;
}

ffd_status ffd_compare_run(const ffd_compare_desc *callers, ffd_comparison *comparison, ffd_error *error)
{
    ffd_compare_desc desc;
    ffd_comparison own = {.struct_size = sizeof own};
    ffd_compare_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_compare_desc", error));
    TRY(ffd_struct_check(sizeof own, comparison, "ffd_comparison", error));
    job_memory memory = {0};
    ffd_status status;
    TRY_END(ffd_in_memory_source(&memory, &desc.a, error));
    TRY_END(ffd_in_memory_source(&memory, &desc.b, error));
    TRY_END(open_and_compare(&desc, &own, error));
end:
    status = ffd_in_memory_end(&memory, status, error);
    ffd_struct_give(&own, sizeof own, comparison, comparison->struct_size);
    return status;
}

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

void ffd_comparison_begin(json_text *json, const char *a, const char *b)
{
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "format", "ffd-comparison");
    ffd_json_count(json, "version", 1);
    ffd_json_string(json, "a", a);
    ffd_json_string(json, "b", b);
}

void ffd_comparison_write(json_text *json, const ffd_comparison *comparison)
{
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
}

ffd_status ffd_comparison_json(const ffd_comparison *callers, const char *a, const char *b, char **text,
                               ffd_error *error)
{
    ffd_comparison own = {.struct_size = sizeof own};
    TRY(ffd_struct_take(&own, sizeof own, callers, "ffd_comparison", error));
    byte_buffer buffer = {0};
    json_text json;
    ffd_json_begin(&json, &buffer);
    ffd_comparison_begin(&json, a, b);
    ffd_comparison_write(&json, &own);
    ffd_json_end(&json, '}');
    *text = ffd_buffer_finish(&buffer);
    ffd_buffer_free(&buffer);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
