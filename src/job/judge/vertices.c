/* vertices.c - says what became of the vertices of a pass. */
#include "base/spelling.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "job/chain/coverage.h"
#include "job/judge/warnings.h"
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Room for a number of two digits. */
#define ROUNDED 32

static const char *vertices(uint64_t count)
{
    return ffd_plural(count, "vertex", "vertices");
}

static const char *are(uint64_t count)
{
    return ffd_plural(count, "is", "are");
}

static const char *left_alone(uint64_t count)
{
    return ffd_plural(count, "left where it is", "left where they are");
}

/* Writes the kinds, such as "2 moved with the nearest boundary point, 1 left where it is beyond the falloff";
   without numbers if only one kind occurs. */
static void write_kinds(const pass_totals *totals, const chain_outside *outside, char *text, size_t capacity)
{
    const uint64_t count = totals->counts[FFD_VERTEX_OUTSIDE], followed = totals->extended_moved;
    const uint64_t still = totals->extended - followed, beyond = count - totals->extended;
    const struct {
        uint64_t count;
        const char *what, *why;
    } kinds[] = {
        {followed, "moved with the nearest boundary point", ""},
        {still, left_alone(still), ", as the nearest boundary point is"},
        {beyond, left_alone(beyond), outside->extend && outside->falloff > 0 ? " beyond the falloff" : ""}};
    size_t length = 0;
    *text = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (kinds[k].count == 0)
            continue;
        if (kinds[k].count < count)
            length += (size_t)snprintf(text + length, capacity - length, "%s%" PRIu64 " ", length ? ", " : "",
                                       kinds[k].count);
        length += (size_t)snprintf(text + length, capacity - length, "%s%s", kinds[k].what, kinds[k].why);
    }
}

/* Writes a number of two digits that is not below a distance, and at most one step of the second digit above.
 */
static void round_up(double distance, char text[ROUNDED])
{
    double rounded = 0, step = 0;
    snprintf(text, ROUNDED, "%.1e", distance);
    ffd_number_parse(text, text + strlen(text), &rounded);
    if (rounded < distance && distance <= DBL_MAX) {
        char one[ROUNDED];
        const int exponent = atoi(strchr(text, 'e') + 1);
        snprintf(one, sizeof one, "1e%d", exponent - 1);
        ffd_number_parse(one, one + strlen(one), &step);
    }
    snprintf(text, ROUNDED, "%.2g", rounded + step);
}

/* Of a mesh that goes through the border, a few vertices lie next to it by chance: that is worth no word. */
#define WORTH_A_WORD 10

/* Says how near the vertices are that miss the lattice by next to nothing, if they are many. */
static void write_misses(const pass_totals *totals, char *text, size_t capacity)
{
    const near_misses *const misses = &totals->misses;
    const uint64_t outside = totals->counts[FFD_VERTEX_OUTSIDE];
    char who[60] = "it misses", by[ROUNDED];
    *text = 0;
    if (misses->count == 0 || WORTH_A_WORD * misses->count < misses->examined)
        return;
    if (misses->count < outside)
        snprintf(who, sizeof who, "%s%" PRIu64 " of them %s", misses->is_least ? "at least " : "",
                 misses->count, ffd_plural(misses->count, "misses", "miss"));
    else if (outside > 1)
        snprintf(who, sizeof who, "all miss");
    round_up(misses->largest, by);
    snprintf(text, capacity, "; %s the lattice by at most %s, see %s", who, by, SPELLED("{snap}"));
}

/* Describes what happened to the vertices outside. */
static void write_outside(const pass_totals *totals, const chain_outside *outside, bool deformed, char *text,
                          size_t capacity)
{
    char kinds[300] = "no u,v,w", misses[120];
    if (deformed)
        write_kinds(totals, outside, kinds, sizeof kinds);
    write_misses(totals, misses, sizeof misses);
    snprintf(text, capacity, "%" PRIu64 " outside (%s%s)", totals->counts[FFD_VERTEX_OUTSIDE], kinds, misses);
}

/* Says why vertices are singular, unless the search gave up, which has a message of its own. */
static void write_degenerate(const pass_totals *totals, char *text, size_t capacity)
{
    const size_t length = strlen(text);
    if (totals->degenerate && totals->degenerate == totals->counts[FFD_VERTEX_SINGULAR])
        snprintf(text + length, capacity - length, " (where the lattice folds or collapses)");
    else if (totals->degenerate)
        snprintf(text + length, capacity - length, " (%" PRIu64 " where the lattice folds or collapses)",
                 totals->degenerate);
}

/* Lists the number of vertices of each status other than inside, and what happened to them. */
static void write_others(const pass_totals *totals, const chain_outside *outside, bool deformed, char *text,
                         size_t capacity)
{
    *text = 0;
    if (totals->counts[FFD_VERTEX_OUTSIDE])
        write_outside(totals, outside, deformed, text, capacity);
    for (int s = FFD_VERTEX_OUTSIDE + 1; s < FFD_VERTEX_STATUS_COUNT; s++) {
        const size_t length = strlen(text);
        const uint64_t count = totals->counts[s];
        const bool invalid = s == FFD_VERTEX_INVALID, stay = deformed && invalid;
        if (count)
            snprintf(text + length, capacity - length, "%s%" PRIu64 " %s%s%s%s%s", length ? ", " : "", count,
                     ffd_vertex_status_name((ffd_vertex_status)s), invalid ? " (not finite" : "",
                     stay ? "; " : "", stay ? left_alone(count) : "", invalid ? ")" : "");
        if (s == FFD_VERTEX_SINGULAR)
            write_degenerate(totals, text, capacity);
    }
}

/* Warns about vertices on common faces of lattices. */
static void warn_of_faces(const pass_totals *totals, const mesh_log *log)
{
    if (totals->moved_twice)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " %s on a face common to two lattices %s moved by both: see {blocks}",
                     totals->moved_twice, vertices(totals->moved_twice), are(totals->moved_twice));
}

static void warn_of_unshown(const pass_totals *totals, const mesh_log *log)
{
    if (totals->unused)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " %s that no face, line or point uses %s not inside: no gate counts %s",
                     totals->unused, vertices(totals->unused), are(totals->unused),
                     ffd_plural(totals->unused, "it", "them"));
    if (totals->hidden)
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s of hidden nodes %s not inside: no gate counts %s",
                     totals->hidden, vertices(totals->hidden), are(totals->hidden),
                     ffd_plural(totals->hidden, "it", "them"));
}

static const char *how_outside(const lattice_chain *chain, uint64_t count)
{
    return !chain->outside.extend ? left_alone(count)
                                  : ffd_plural(count, "it goes with the nearest boundary point",
                                               "they go with the nearest boundary point");
}

/* Warns about the stored shapes: the base, if default weights show another shape, and morph targets. */
static void warn_of_shapes(const pass_totals *totals, const lattice_chain *chain, const mesh_log *log)
{
    if (totals->shapes_outside)
        ffd_log_line(log, FFD_LOG_WARNING, "morph targets move %" PRIu64 " %s outside the lattice (%s)",
                     totals->shapes_outside, vertices(totals->shapes_outside),
                     how_outside(chain, totals->shapes_outside));
    if (totals->base_outside > totals->weighted_outside) /* else the warning is of the shape shown */
        ffd_log_line(log, FFD_LOG_WARNING,
                     "without the default weights of morph targets %" PRIu64
                     " %s %s outside the lattice (%s)",
                     totals->base_outside, vertices(totals->base_outside), are(totals->base_outside),
                     how_outside(chain, totals->base_outside));
    if (totals->shapes_invalid)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "morph targets move %" PRIu64 " %s to coordinates that are not finite (left as %s)",
                     totals->shapes_invalid, vertices(totals->shapes_invalid),
                     ffd_plural(totals->shapes_invalid, "it is", "they are"));
}

static void warn_of_splats(const pass_totals *totals, const mesh_log *log)
{
    const uint64_t flattened = totals->splats_flattened, broken = totals->splats_broken;
    if (flattened)
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " Gaussian %s flattened: the deformation collapses %s",
                     flattened, ffd_plural(flattened, "splat is", "splats are"),
                     ffd_plural(flattened, "it", "them"));
    if (broken)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " Gaussian %s without %s rotation and scales, which are not numbers or 0",
                     broken, ffd_plural(broken, "splat moves", "splats move"),
                     ffd_plural(broken, "its", "their"));
}

void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log)
{
    const uint64_t others =
        totals->vertices - totals->counts[FFD_VERTEX_INSIDE] - totals->unused - totals->hidden;
    ffd_coverage_warn(chain, log);
    if (others) {
        char list[600], coverage[600] = "", places[400] = "";
        write_others(totals, &chain->outside, deformed, list, sizeof list);
        if (totals->outside_all)
            ffd_chain_coverage(chain, coverage, sizeof coverage);
        if (totals->outside_all == totals->vertices)
            ffd_chain_places(chain, &totals->before, places, sizeof places);
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " of %" PRIu64 " %s %s not inside: %s%s%s%s", others,
                     totals->vertices, vertices(totals->vertices), are(others), list, *coverage ? "; " : "",
                     coverage, places);
    }
    warn_of_faces(totals, log);
    warn_of_unshown(totals, log);
    warn_of_shapes(totals, chain, log);
    if (totals->unresolved)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "for %" PRIu64
                     " %s the search ended at its limits: there may be u,v,w that it did not find",
                     totals->unresolved, vertices(totals->unresolved));
    if (totals->transforms_singular)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " %s not move: the matrix of %s node or skin has no inverse",
                     totals->transforms_singular,
                     ffd_plural(totals->transforms_singular, "vertex does", "vertices do"),
                     ffd_plural(totals->transforms_singular, "its", "their"));
    if (totals->normals_carried)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " %s no face with an area to be computed from: %s the deformation",
                     totals->normals_carried,
                     ffd_plural(totals->normals_carried, "normal has", "normals have"),
                     ffd_plural(totals->normals_carried, "it follows", "they follow"));
    if (totals->normals_collapsed)
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s kept: the deformation collapses %s",
                     totals->normals_collapsed,
                     ffd_plural(totals->normals_collapsed, "normal is", "normals are"),
                     ffd_plural(totals->normals_collapsed, "it", "them"));
    warn_of_splats(totals, log);
    if (totals->lost.side > 0 && totals->lost.of_steps)
        ffd_log_line(
            log, FFD_LOG_WARNING,
            "positions are rounded to the steps in which the file has them quantized: off by up to %g, in a "
            "shape of %g",
            totals->lost.error, totals->lost.side);
    else if (totals->lost.side > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%s cannot hold: the precision of coordinates that far from the origin (off by up to "
                     "%g, in a shape of %g)",
                     totals->lost.of_doubles ? "doubles" : "floats", totals->lost.error, totals->lost.side);
}
