/* tears.c - says what torn edges a deformation makes. */
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/judge/warnings.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* What the lattices do where both ends of the edge move, and the remedy. */
static const struct {
    const char *text, *remedy;
} causes[] = {
    [FFD_TEAR_LATTICES] = {"the lattices move the two ends of edges differently",
                           "see {blocks} for lattices side by side, {outside=extend}, {falloff}"},
    [FFD_TEAR_BLOCKS] = {"neighbouring blocks move their common faces differently",
                         "their control points there have to move alike"},
    [FFD_TEAR_SEAM] = {"the two faces of a lattice's seam are moved apart",
                       "their control points there have to move alike"},
    [FFD_TEAR_AXIS] = {"control points at one place on a lattice's axis are moved apart",
                       "they have to move alike"},
    [FFD_TEAR_BORDER] = {"outside the lattice the nearest part of its border changes along edges",
                         "see {falloff}, a larger lattice"},
    [FFD_TEAR_WEIGHTS] = {"vertices at one position have different weights", "see {weight}"},
    [FFD_TEAR_RIGID] = {"a rigid part leaves vertices that were at its positions", "see {rigid}"},
    [FFD_TEAR_OVERLAP] = {"edges lead from one part of a lattice that overlaps itself to another",
                          "two parts have one place at rest"},
};

/* The last vertex of a text about the step of an edge whose ends move. */
static void describe_moving(const ffd_job_result *result, const char *name, char *text, size_t capacity)
{
    const char *what = causes[result->tear.cause].text;
    char faces[100];
    if (result->tear.cause == FFD_TEAR_BLOCKS && result->shared_faces.disagreeing) {
        snprintf(faces, sizeof faces, "blocks move %" PRIu64 " %s on their faces differently",
                 result->shared_faces.disagreeing,
                 ffd_plural(result->shared_faces.disagreeing, "vertex", "vertices"));
        what = faces;
    }
    snprintf(text, capacity,
             "%s; the largest step to a neighbour is %g, at vertex %" PRIu64 "%s%s (%" PRIu64 " torn %s)",
             what, result->tear.largest, result->tear.vertex, *name ? " of " : "", name, result->tear.edges,
             ffd_plural(result->tear.edges, "edge", "edges"));
}

void ffd_tears_describe(const ffd_job_result *result, char *text, size_t capacity)
{
    const char *const colon = strchr(result->tear.part, ':');
    char name[201] = "";
    if (colon)
        ffd_name_shown(colon + 1, name, sizeof name);
    if (result->tear.cause > FFD_TEAR_UNSELECTED) {
        describe_moving(result, name, text, capacity);
        return;
    }
    snprintf(text, capacity, "%" PRIu64 " %s%s%s %s; the largest step to a neighbour is %g",
             result->tear.stays, ffd_plural(result->tear.stays, "vertex", "vertices"), colon ? " of " : "",
             name, ffd_plural(result->tear.stays, "stays", "stay"), result->tear.largest);
}

void ffd_tears_warn(const ffd_job_result *result, bool selects, const mesh_log *log)
{
    char text[400];
    const char *const remedy = result->tear.cause > FFD_TEAR_UNSELECTED ? causes[result->tear.cause].remedy
                               : result->tear.cause != FFD_TEAR_UNSELECTED
                                   ? "see {outside=extend}, {falloff}, a larger lattice"
                               : selects ? "{only} does not select them"
                                         : "the matrix of their node or skin has no inverse";
    if (result->tear.edges == 0)
        return;
    ffd_tears_describe(result, text, sizeof text);
    ffd_log_line(log, FFD_LOG_WARNING, "%s (%s)", text, SPELLED(remedy));
}
