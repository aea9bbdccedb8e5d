/* cells_measure.c - measures cells of arrays of points. */
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "cells/cell_measure.h"
#include "points/point_run.h"
#include "points/span.h"
#include <ffd/cells.h>
#include <string.h>

void ffd_cells_desc_init(ffd_cells_desc *desc, size_t size)
{
    const ffd_cells_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

int ffd_cells_kind_points(const char *kind)
{
    const cell_type *const type = ffd_cell_type_named(kind);
    return type ? type->points : -1;
}

typedef struct cells_call {
    ffd_cells_desc desc;
    const cell_type *type;
    cell_rules rules;
    const double *points; /* 3 each */
    double *own_points;   /* or NULL */
} cells_call;

static cell_view view_of(const cells_call *call, size_t cell)
{
    const uint64_t *const offsets = call->desc.offsets;
    const uint64_t first = offsets ? offsets[cell] : (uint64_t)cell * call->type->points;
    return (cell_view){.number = call->type->number,
                       .words = call->desc.cells + first,
                       .count = offsets ? (size_t)(offsets[cell + 1] - first) : call->type->points};
}

static ffd_status check_point(const cells_call *call, size_t cell, uint32_t point, ffd_error *error)
{
    return point < call->desc.points.count
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "cell %zu has point %u, but there are %zu", cell,
                          (unsigned)point, call->desc.points.count);
}

/* Checks the words of a polyhedron. */
static ffd_status check_faces(const cells_call *call, size_t cell, const cell_view *view, ffd_error *error)
{
    size_t at = 1;
    bool fits = view->count > 0;
    for (uint32_t face = 0; fits && face < view->words[0]; face++) {
        fits = at < view->count && view->words[at] <= view->count - at - 1;
        for (uint32_t i = 0; fits && i < view->words[at]; i++)
            TRY(check_point(call, cell, view->words[at + 1 + i], error));
        at += fits ? 1 + (size_t)view->words[at] : 0;
    }
    return fits && at == view->count
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "the faces of cell %zu do not fill its words", cell);
}

static ffd_status check_cell(const cells_call *call, size_t cell, const cell_view *view, ffd_error *error)
{
    if (call->type->family == FAMILY_POLYHEDRON)
        return check_faces(call, cell, view, error);
    for (size_t p = 0; p < view->count; p++)
        TRY(check_point(call, cell, view->words[p], error));
    return FFD_OK;
}

static ffd_status measure_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const cells_call *const call = context;
    const ffd_cells_desc *const desc = &call->desc;
    (void)worker;
    for (size_t c = first; c < first + count; c++) {
        const cell_view view = view_of(call, c);
        TRY(check_cell(call, c, &view, error));
        const cell_measure measure = ffd_cell_measure(&call->rules, &view, call->points, NULL);
        if (desc->inverted)
            desc->inverted[c] = measure.state == JACOBIAN_NEGATIVE || measure.state == JACOBIAN_MIXED;
        if (desc->unknown)
            desc->unknown[c] = measure.state == JACOBIAN_UNKNOWN;
        if (desc->jacobian)
            desc->jacobian[c] = measure.jacobian;
        if (desc->scaled_jacobian)
            desc->scaled_jacobian[c] = measure.scaled;
    }
    return FFD_OK;
}

static ffd_status check_offsets(const ffd_cells_desc *desc, ffd_error *error)
{
    if (desc->count > 0 && !desc->offsets)
        return ffd_fail(error, FFD_E_ARGUMENT, "polyhedra need the offsets of their cells");
    for (size_t c = 0; c < desc->count; c++)
        if (desc->offsets[c + 1] < desc->offsets[c] || desc->offsets[c + 1] > SIZE_MAX)
            return ffd_fail(error, FFD_E_ARGUMENT, "the offset of cell %zu is above the one behind it", c);
    return FFD_OK;
}

static ffd_status check(cells_call *call, ffd_error *error)
{
    ffd_cells_desc *const desc = &call->desc;
    size_t words;
    if (!desc->kind)
        return ffd_fail(error, FFD_E_ARGUMENT, "the kind of the cells is missing");
    call->type = ffd_cell_type_named(desc->kind);
    if (!call->type)
        return ffd_fail(error, FFD_E_ARGUMENT, "\"%.80s\" is not a kind of volume cells that is known here",
                        desc->kind);
    TRY(ffd_span_check(&desc->points, desc->points.count, "points", error));
    if (desc->points.count > UINT32_MAX)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are more than 2^32 - 1 points");
    if (desc->count > 0 && !desc->cells)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no cells");
    if (call->type->family == FAMILY_POLYHEDRON)
        return check_offsets(desc, error);
    desc->offsets = NULL;
    return ffd_multiply_size(desc->count, CELL_MOST_POINTS * sizeof *desc->cells, &words)
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "there are too many cells");
}

/* Makes the points doubles without gaps, where they are not. */
static ffd_status read_points(cells_call *call, ffd_error *error)
{
    const ffd_span *const span = &call->desc.points;
    call->points = ffd_span_doubles(span, 0);
    if (call->points || span->count == 0)
        return FFD_OK;
    call->own_points = ffd_alloc(span->count, 3 * sizeof *call->own_points);
    if (!call->own_points)
        return ffd_fail_memory(error);
    ffd_span_read(span, 0, span->count, call->own_points);
    call->points = call->own_points;
    return FFD_OK;
}

ffd_status ffd_cells_measure(const ffd_cells_desc *desc, const ffd_run_options *options, ffd_error *error)
{
    cells_call call = {.points = NULL};
    point_run run;
    ffd_cells_desc_init(&call.desc, sizeof call.desc);
    if (!desc)
        return ffd_fail(error, FFD_E_ARGUMENT, "the description of the cells is missing");
    TRY(ffd_struct_take(&call.desc, sizeof call.desc, desc, "ffd_cells_desc", error));
    TRY(check(&call, error));
    ffd_status status = ffd_point_run_begin(options, call.desc.count, &run, error);
    if (!status)
        status = read_points(&call, error);
    if (!status)
        status = ffd_cell_rules_add(&call.rules, call.type, error);
    if (!status)
        status = ffd_point_run_tiles(&run, measure_tile, &call, error);
    ffd_cell_rules_free(&call.rules);
    ffd_free(call.own_points);
    ffd_point_run_end(&run);
    return status;
}
