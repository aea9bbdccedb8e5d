/* still.c - says why moves move nothing. */
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/judge/warnings.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAMED 3 /* lattices that are named */

/* Lattices with something in common. */
typedef struct lattice_group {
    size_t count, moves;
    char names[NAMED * 102 + 40]; /* "a.json, b.json and 2 more" */
} lattice_group;

static void add_lattice(const chain_link *link, lattice_group *group)
{
    char name[100];
    group->moves += link->lattice->spec->move_count;
    if (group->count++ >= NAMED)
        return;
    ffd_name_shown(link->lattice->spec->name, name, sizeof name);
    const size_t used = strlen(group->names);
    snprintf(group->names + used, sizeof group->names - used, "%s%s", used ? ", " : "", name);
}

static void end_group(lattice_group *group)
{
    const size_t used = strlen(group->names);
    if (group->count > NAMED)
        snprintf(group->names + used, sizeof group->names - used, " and %zu more", group->count - NAMED);
}

static uint64_t count_moved(const ffd_lattice *lattice)
{
    uint64_t count = 0;
    for (size_t i = 0; i < lattice->count; i++)
        count += (lattice->moved[i] & POINT_MOVED) != 0;
    return count;
}

/* Warns of deformed weights that are those at rest times a factor, for those who expect a stronger pull. */
static void warn_of_factor(const lattice_chain *chain, const mesh_log *log)
{
    for (size_t l = 0; l < chain->count; l++) {
        const ffd_lattice *const lattice = chain->links[l].lattice;
        const double *const rest = lattice->rest_weights, *const deformed = lattice->deformed_weights;
        char name[100];
        if (lattice->edited || !lattice->spec->deformed_weights || !rest || lattice->weights_moved ||
            deformed[0] == rest[0])
            continue;
        ffd_name_shown(lattice->spec->name, name, sizeof name);
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the deformed weights of %s are those at rest times %g: a common factor moves nothing",
                     name, deformed[0] / rest[0]);
    }
}

/* Writes where the mesh lies, for those who took its places for others; "" if it has no finite vertex. */
static void write_bounds(const ffd_bounds *box, char *text, size_t capacity)
{
    *text = 0;
    if (box->min[0] <= box->max[0])
        snprintf(text, capacity, " (the mesh lies from %g %g %g to %g %g %g)", box->min[0], box->min[1],
                 box->min[2], box->max[0], box->max[1], box->max[2]);
}

/* Whether other messages say why vertices stay: they are outside, or their matrix has no inverse. */
static bool is_explained(const pass_totals *totals)
{
    return totals->located + totals->extended == 0 || totals->transforms_singular > 0;
}

void ffd_still_warn(const pass_totals *totals, const lattice_chain *chain, const ffd_weight_figures *weights,
                    const ffd_bounds *box, bool is_target, bool is_written, const mesh_log *log)
{
    const bool still = totals->moved == 0;
    /* Saving warns of a morph target whose offsets are zero; the reason is given here. */
    const bool is_logged = is_target && is_written;
    const bool is_held = still && weights->zero == totals->vertices;
    char where[200] = "";
    lattice_group idle = {0}, active = {0};
    uint64_t points = 0;
    if (totals->vertices == 0)
        return;
    warn_of_factor(chain, log);
    for (size_t l = 0; l < chain->count; l++) {
        const chain_link *const link = &chain->links[l];
        const uint64_t moved = count_moved(ffd_link_mover(link));
        if (moved > 0)
            add_lattice(link, &active);
        else if (!link->sealed && link->lattice->spec->move_count > 0 && !link->lattice->edited)
            add_lattice(link, &idle);
        points += moved;
    }
    end_group(&idle);
    end_group(&active);
    if (still || !totals->is_visible)
        write_bounds(box, where, sizeof where);
    if (idle.count > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%s%s of %s %s no control point%s",
                     still && active.count == 0 && !is_logged ? "no vertex moves: " : "",
                     ffd_plural(idle.moves, "the move", "the moves"), idle.names,
                     ffd_plural(idle.moves, "moves", "move"), active.count == 0 ? where : "");
    if (is_held && active.count > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%s%s",
                     is_logged ? "" : "no vertex moves: ", SPELLED("all weights are 0 ({weight})"));
    else if (still && !is_logged && active.count > 0 && !is_explained(totals))
        ffd_log_line(log, FFD_LOG_WARNING, "no vertex moves, though %s %s %" PRIu64 " control %s%s",
                     active.names, ffd_plural(active.count, "moves", "move"), points,
                     ffd_plural(points, "point", "points"), where);
    if (!still && !is_target && !totals->is_visible)
        ffd_log_line(
            log, FFD_LOG_WARNING,
            "no vertex moves in the output: its numbers are too coarse for displacements of %g at most%s",
            sqrt(totals->displacement_square_max), where);
}
