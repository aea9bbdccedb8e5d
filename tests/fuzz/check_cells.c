/* check_cells.c - what holds for the cells of any volume mesh that opens. */
#include "check_cells.h"
#include "cells/cell_measure.h"
#include "mesh/cell_list.h"
#include "promise.h"
#include <inttypes.h>
#include <math.h>

/* Tetrahedra that are no corner of a cube have more than 1: sqrt(2) at most. */
#define MOST_SCALED 1.5

static void check_cell(uint64_t cell, const cell_measure *measure)
{
    const double jacobian = measure->jacobian, scaled = measure->scaled;
    PROMISE(isnan(scaled) || fabs(scaled) <= MOST_SCALED, "the scaled Jacobian of cell %" PRIu64 " is %g",
            cell, scaled);
    PROMISE(measure->state != JACOBIAN_POSITIVE || jacobian > 0, "cell %" PRIu64 " is positive, with %g",
            cell, jacobian);
    PROMISE(measure->state != JACOBIAN_NEGATIVE || jacobian < 0, "cell %" PRIu64 " is negative, with %g",
            cell, jacobian);
    PROMISE(measure->state != JACOBIAN_MIXED || jacobian <= 0, "cell %" PRIu64 " is inverted, with %g", cell,
            jacobian);
}

void check_cells(const mesh_document *document)
{
    const mesh_cell_calls *const calls = document->format->cells;
    cell_rules rules = {0};
    uint64_t volumes = 0;
    if (!calls)
        return;
    const double *const points = calls->positions(document, false);
    for (uint64_t c = 0; c < calls->count(document); c++) {
        const cell_view view = calls->get(document, c);
        const cell_type *const type = view.words ? ffd_cell_type(view.number, view.count) : NULL;
        volumes += view.words != NULL;
        if (type)
            PROMISE(ffd_cell_rules_add(&rules, type, NULL) == FFD_OK, "no memory for a rule");
        if (view.words) {
            const cell_measure alone = ffd_cell_measure(&rules, &view, points, NULL);
            const cell_measure at_rest = ffd_cell_measure(&rules, &view, points, points);
            check_cell(c, &alone);
            check_cell(c, &at_rest);
        }
    }
    PROMISE(volumes == calls->volumes(document), "%" PRIu64 " volume cells", volumes);
    ffd_cell_rules_free(&rules);
}
