#include "job/judge/gates.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/chain/coverage.h"
#include "job/judge/warnings.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Says which stored shapes have vertices outside. */
static const char *stored_shapes_text(const pass_totals *totals)
{
    return totals->shapes_outside ? "morph targets move vertices outside the lattice"
                                  : "without the default weights of morph targets vertices are outside the "
                                    "lattice";
}

/* Whether a shape that the file stores, but does not show, has vertices outside. */
static bool stores_outside(const pass_totals *totals)
{
    return totals->shapes_outside || totals->base_outside;
}

/* Says why a vertex may be outside though its stored position is not. */
static const char *as_shown(const pass_totals *totals)
{
    return totals->of_shown && totals->weighted_outside
               ? ", as the default weights of morph targets show the mesh"
               : "";
}

/* --outside error: fails if any vertex is outside, visible or not. */
static ffd_status fail_outside(const char *name, const lattice_chain *chain, const pass_totals *totals,
                               ffd_error *error)
{
    const uint64_t shown = totals->first_outside, other = totals->first_unshown_outside;
    const uint64_t count = totals->outside_all + totals->unshown_outside;
    char coverage[600], places[400] = "", unshown[80] = "";
    ffd_chain_coverage(chain, coverage, sizeof coverage);
    if (count == totals->vertices)
        ffd_chain_places(chain, &totals->before, places, sizeof places);
    if (totals->unshown_outside)
        snprintf(unshown, sizeof unshown, ", %" PRIu64 " of them %s unused or hidden",
                 totals->unshown_outside, ffd_plural(totals->unshown_outside, "is", "are"));
    return ffd_fail_file(error, FFD_E_EMBEDDING, name,
                         "%" PRIu64 " of %" PRIu64
                         " %s %s outside the lattice%s%s, the first is vertex %" PRIu64
                         " (counted from 0)%s%s%s",
                         count, totals->vertices, ffd_plural(totals->vertices, "vertex", "vertices"),
                         ffd_plural(count, "is", "are"), as_shown(totals), unshown,
                         shown < other ? shown : other, *coverage ? "; " : "", coverage, places);
}

/* An embedding may miss its mesh: a forged file can have valid hashes. */
static ffd_status fail_missed(const char *embedding, const pass_totals *totals, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, embedding,
                         "u,v,w of vertex %" PRIu64
                         " (counted from 0) lead to a place %.3g away from it: they "
                         "are not what ffd embed wrote",
                         totals->first_missed, totals->missed_by);
}

ffd_status ffd_policies_judge(const ffd_deform_desc *desc, const char *name, const lattice_chain *chain,
                              const pass_totals *totals, ffd_error *error)
{
    if (totals->first_missed != UINT64_MAX)
        return fail_missed(desc->embedding.path, totals, error);
    /* If a target alone moves what is shown outside, that is the reason. */
    const bool by_target = totals->of_shown && !totals->base_outside && totals->shapes_outside &&
                           totals->outside_all == totals->weighted_outside && !totals->unshown_outside;
    if (desc->outside == FFD_OUTSIDE_ERROR && totals->outside_all + totals->unshown_outside > 0 && !by_target)
        return fail_outside(name, chain, totals, error);
    if (desc->outside == FFD_OUTSIDE_ERROR && stores_outside(totals))
        return ffd_fail_file(
            error, FFD_E_EMBEDDING, name, "%s, the first is vertex %" PRIu64 " (counted from 0)",
            stored_shapes_text(totals),
            totals->shapes_outside ? totals->first_shape_outside : totals->first_base_outside);
    if (totals->first_overflow != UINT64_MAX)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "the deformed position of vertex %" PRIu64
                             " is too large for the file's numbers",
                             totals->first_overflow);
    return FFD_OK;
}

/* A message to which each violated gate adds its part. */
typedef struct complaint {
    char text[500];
    size_t length;
} complaint;

static void add(complaint *line, const char *text, const char *gate)
{
    const size_t space = sizeof line->text - line->length;
    const int length = snprintf(line->text + line->length, space, SPELLED("%s%s ({fail_on=%s})"),
                                line->length ? "; " : "", text, gate);
    line->length += length < 0 ? 0 : (size_t)length < space ? (size_t)length : space - 1;
}

/* one, many: the words for one vertex and for several. */
static void add_count(complaint *line, uint64_t count, const pass_totals *totals, const char *one,
                      const char *many, const char *gate)
{
    char text[200];
    snprintf(text, sizeof text, "%" PRIu64 " of %" PRIu64 " %s %s", count, totals->vertices,
             ffd_plural(totals->vertices, "vertex", "vertices"), ffd_plural(count, one, many));
    if (count)
        add(line, text, gate);
}

static void add_outside(complaint *line, const pass_totals *totals)
{
    char one[120], many[120];
    snprintf(one, sizeof one, "is outside the lattice%s", as_shown(totals));
    snprintf(many, sizeof many, "are outside the lattice%s", as_shown(totals));
    add_count(line, totals->outside_all, totals, one, many, "outside");
    if (stores_outside(totals))
        add(line, stored_shapes_text(totals), "outside");
}

/* A figure that exceeds the limit by at most this relative amount passes: the limit may come from another
   machine's report, or have been computed by hand. */
#define KEEPS_LIMIT 1e-12

static bool is_above(double figure, double limit)
{
    return figure > limit + KEEPS_LIMIT * limit;
}

/* Adds the gates with a limit. */
static void add_values(complaint *line, const ffd_deform_desc *desc, const ffd_job_result *result)
{
    char text[400];
    const double step = result->tear.largest;
    if (desc->fail_on & FFD_GATE_TEAR && result->tear.edges && is_above(step, desc->tear_most)) {
        ffd_tears_describe(result, text, sizeof text);
        add(line, text, "tear");
    }
    snprintf(text, sizeof text, "%" PRIu64 " of %" PRIu64 " %s %s flipped", result->flipped_faces,
             result->faces, ffd_plural(result->faces, "face", "faces"),
             ffd_plural(result->flipped_faces, "is", "are"));
    if (desc->fail_on & FFD_GATE_FLIPPED && result->flipped_faces > desc->flipped_most)
        add(line, text, "flipped");
    snprintf(text, sizeof text, "straight edges lie as far as %g from the deformed surface",
             result->edges.deviation.max);
    if (desc->fail_on & FFD_GATE_EDGES && is_above(result->edges.deviation.max, desc->edges_most))
        add(line, text, "edges");
}

/* Adds the gates of cells. */
static void add_cells(complaint *line, const ffd_deform_desc *desc, const ffd_cell_figures *cells)
{
    const double least = cells->scaled_jacobian.after;
    char text[300];
    ffd_cells_describe(cells, text, sizeof text);
    if (desc->fail_on & FFD_GATE_INVERTED && cells->by_deformation + cells->unknown > desc->inverted_most)
        add(line, text, "inverted");
    if (!(desc->fail_on & FFD_GATE_QUALITY))
        return;
    if (cells->unknown) {
        snprintf(text, sizeof text, "%" PRIu64 " %s not be decided", cells->unknown,
                 ffd_plural(cells->unknown, "cell could", "cells could"));
        add(line, text, "quality");
    }
    snprintf(text, sizeof text, "the scaled Jacobian of cell %" PRIu64 " is %g, below %g", cells->worst,
             least, desc->quality_least);
    if (!cells->has_worst)
        add(line, "no cell has a scaled Jacobian", "quality");
    else if (least < desc->quality_least - KEEPS_LIMIT * fabs(desc->quality_least))
        add(line, text, "quality");
}

ffd_status ffd_gates_judge(const ffd_deform_desc *desc, const char *name, const pass_totals *totals,
                           const ffd_job_result *result, ffd_error *error)
{
    complaint line = {"", 0};
    if (desc->fail_on & FFD_GATE_FOLDS && result->folds.verdict != FFD_FOLDS_NONE) {
        char text[400] = "the deformed volume ";
        const size_t begun = strlen(text);
        ffd_folds_describe(result, desc->lattices, text + begun, sizeof text - begun);
        add(&line, text, "folds");
    }
    if (desc->fail_on & FFD_GATE_FOLDS && result->det.outside <= 0) {
        char text[200];
        snprintf(text, sizeof text, "outside the lattice det F falls to %g, at vertex %" PRIu64,
                 result->det.outside, result->det.outside_vertex);
        add(&line, text, "folds");
    }
    if (desc->fail_on & FFD_GATE_OUTSIDE && totals->vertices == 0)
        add(&line, "there are no vertices", "outside");
    if (desc->fail_on & FFD_GATE_OUTSIDE)
        add_outside(&line, totals);
    if (desc->fail_on & FFD_GATE_MULTIPLE)
        add_count(&line, totals->multiple_any, totals, "has several u,v,w", "have several u,v,w", "multiple");
    if (desc->fail_on & FFD_GATE_SINGULAR)
        add_count(&line, totals->counts[FFD_VERTEX_SINGULAR], totals, "is where the lattice has no inverse",
                  "are where the lattice has no inverse", "singular");
    if (desc->fail_on & FFD_GATE_INVALID)
        add_count(&line, totals->counts[FFD_VERTEX_INVALID], totals, "has a coordinate that is not finite",
                  "have a coordinate that is not finite", "invalid");
    if (desc->fail_on & FFD_GATE_INVALID && totals->shapes_invalid)
        add(&line, "morph targets move vertices to coordinates that are not finite", "invalid");
    add_values(&line, desc, result);
    add_cells(&line, desc, &result->cells);
    return line.length ? ffd_fail_file(error, FFD_E_GATE, name, "%s", line.text) : FFD_OK;
}
