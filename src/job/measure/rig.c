#include "job/measure/rig.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/chain/chain_apply.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Context of a run of places through the chain. */
typedef struct place_run {
    chain_scratch chain;
    double points[3 * CHAIN_RUN], delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
} place_run;

static void note_move(const mesh_place *place, const place_run *run, size_t i, mesh_place_move *move)
{
    const point_outcome *const outcome = &run->outcomes[i];
    *move = (mesh_place_move){.moves = outcome->moved, .singular = outcome->status == FFD_VERTEX_SINGULAR};
    for (int a = 0; a < 3; a++) {
        move->became[a] = place->at[a];
        move->to[a] = place->at[a] + (outcome->moved ? run->delta[3 * i + (size_t)a] : 0);
    }
    if (outcome->moved && !move->singular)
        memcpy(move->gradient, run->gradient + 9 * i, sizeof move->gradient);
}

static ffd_status send(const lattice_chain *chain, const rig_places *rig, place_run *run, ffd_error *error)
{
    ffd_displacement_scratch_clear(&run->chain.displacement);
    run->chain.displacement.kept.threads = 1;
    for (size_t first = 0; first < rig->places.count; first += CHAIN_RUN) {
        const mesh_place *const list = rig->places.list + first;
        const size_t left = rig->places.count - first, count = left < CHAIN_RUN ? left : CHAIN_RUN;
        chain_run sent = {.x = run->points,
                          .count = count,
                          .scratch = &run->chain,
                          .delta = run->delta,
                          .gradient = run->gradient,
                          .outcomes = run->outcomes};
        for (size_t i = 0; i < count; i++)
            memcpy(run->points + 3 * i, list[i].at, sizeof list[i].at);
        TRY(ffd_chain_apply(chain, chain->count, &sent, error));
        for (size_t i = 0; i < count; i++)
            note_move(&list[i], run, i, &rig->moves[first + i]);
    }
    return FFD_OK;
}

ffd_status ffd_rig_places_find(const mesh_document *document, const lattice_chain *chain, bool all,
                               rig_places *rig, ffd_error *error)
{
    *rig = (rig_places){0};
    if (!document->format->places)
        return FFD_OK;
    TRY(document->format->places->list(document, all, &rig->places, error));
    if (rig->places.count == 0)
        return FFD_OK;
    rig->moves = ffd_alloc_zero(rig->places.count, sizeof *rig->moves);
    place_run *const run = ffd_alloc(1, sizeof *run);
    ffd_status status = rig->moves && run ? send(chain, rig, run, error) : ffd_fail_memory(error);
    ffd_free(run);
    return status;
}

void ffd_rig_places_free(rig_places *rig)
{
    ffd_free(rig->places.list);
    ffd_free(rig->moves);
    *rig = (rig_places){0};
}

/* Lags relative to the scene's diagonal: worth a warning, and rounding. */
#define LAG_SAID 1e-3
#define LAG_ROUNDING 1e-12

double ffd_rig_diagonal(const ffd_bounds *box)
{
    double sides[3];
    for (int a = 0; a < 3; a++) {
        sides[a] = box->max[a] - box->min[a];
        if (!(sides[a] >= 0))
            return 0;
    }
    return vec_length(sides);
}

double ffd_rig_lag(const mesh_place_move *move, double diagonal)
{
    double off[3];
    for (int a = 0; a < 3; a++)
        off[a] = move->to[a] - move->became[a];
    /* Far from the origin the places themselves are rounded more than a small scene is. */
    const double scale = larger_of(diagonal, larger_of(vec_greatest(move->to), vec_greatest(move->became)));
    const double lag = vec_length(off);
    return lag > LAG_ROUNDING * scale ? lag : 0;
}

static ffd_status name_worst(const mesh_document *document, size_t index, ffd_rig_figures *figures,
                             ffd_error *error)
{
    char *name = document->format->places->name(document, index);
    if (!name)
        return ffd_fail_memory(error);
    ffd_name_shown(name, figures->worst, sizeof figures->worst);
    ffd_free(name);
    return FFD_OK;
}

/* Marks the joints that lag. Returns the first place with the largest lag; SIZE_MAX: none lags. */
static size_t measure(const rig_places *rig, unsigned counted, double diagonal, ffd_rig_figures *figures,
                      uint8_t *lagging)
{
    size_t worst = SIZE_MAX;
    for (size_t i = 0; i < rig->places.count; i++) {
        const unsigned kinds = rig->places.list[i].kinds & counted;
        const double lag = kinds ? ffd_rig_lag(&rig->moves[i], diagonal) : 0;
        const bool is_joint = kinds & PLACE_BIT(FFD_BEHIND_JOINT);
        figures->is_there = figures->is_there || kinds;
        figures->joints += is_joint;
        figures->lagging_pivots += lag > 0 && kinds & PLACE_BIT(FFD_BEHIND_PIVOT);
        figures->lagging_sockets += lag > 0 && kinds & PLACE_BIT(FFD_BEHIND_SOCKET);
        lagging[i] = is_joint && lag > 0;
        if (lag > figures->largest_lag) {
            figures->largest_lag = lag;
            worst = i;
        }
    }
    return worst;
}

ffd_status ffd_rig_figures_find(const mesh_document *document, const rig_places *rig,
                                const mesh_following *following, unsigned kinds, double diagonal,
                                ffd_rig_figures *figures, ffd_error *error)
{
    *figures = (ffd_rig_figures){0};
    if (rig->places.count == 0)
        return FFD_OK;
    uint8_t *const lagging = ffd_alloc(rig->places.count, sizeof *lagging);
    if (!lagging)
        return ffd_fail_memory(error);
    const size_t worst = measure(rig, kinds, diagonal, figures, lagging);
    figures->moved = following->written;
    figures->sheared = following->sheared;
    figures->singular = following->singular;
    figures->partial = following->partial;
    figures->unscaled = following->unscaled;
    figures->unselected = following->unselected;
    figures->unselected_by = following->unselected_by;
    figures->is_there =
        figures->is_there || figures->moved || figures->sheared || figures->singular || figures->partial;
    ffd_status status = FFD_OK;
    if (worst != SIZE_MAX) {
        TRY_END(name_worst(document, rig->places.list[worst].index, figures, error));
        TRY_END(document->format->places->count_skins(
            document, &rig->places, lagging, &figures->lagging_skins, &figures->lagging_joints, error));
    }
end:
    ffd_free(lagging);
    return status;
}

/* Writes a list, such as "the joints of 1 skin, 2 animated pivots and 1 socket". */
static void write_lagging(const ffd_rig_figures *figures, char *text, size_t capacity)
{
    const struct {
        uint64_t count;
        const char *before, *one, *many;
    } kinds[] = {{figures->lagging_skins, "the joints of ", "skin", "skins"},
                 {figures->lagging_joints, "", "joint of a skin that is not used",
                  "joints of skins that are not used"},
                 {figures->lagging_pivots, "", "animated pivot", "animated pivots"},
                 {figures->lagging_sockets, "", "socket", "sockets"}};
    size_t length = 0, left = 0;
    *text = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        left += kinds[k].count > 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (kinds[k].count == 0)
            continue;
        left--;
        length += (size_t)snprintf(text + length, capacity - length, "%s%" PRIu64 " %s%s", kinds[k].before,
                                   kinds[k].count, ffd_plural(kinds[k].count, kinds[k].one, kinds[k].many),
                                   left > 1    ? ", "
                                   : left == 1 ? " and "
                                               : "");
    }
}

static void warn_of_lag(const ffd_rig_figures *figures, bool morphed, const mesh_log *log)
{
    char lagging[300];
    const uint64_t things = figures->lagging_joints + figures->lagging_pivots + figures->lagging_sockets;
    const bool animates = figures->lagging_skins + figures->lagging_pivots > 0;
    write_lagging(figures, lagging, sizeof lagging);
    ffd_log_line(log, FFD_LOG_WARNING, "%s %s up to %g off the %s (%s)%s%s", lagging,
                 figures->lagging_skins == 0 && things == 1 ? "lies" : "lie", figures->largest_lag,
                 morphed ? "mesh that the morph target shows" : "deformed mesh", figures->worst,
                 animates ? "; animations will turn it about the old places" : "",
                 morphed ? "" : SPELLED(": see {rig}"));
}

void ffd_rig_warn(const ffd_rig_figures *figures, rig_change change, double diagonal, const mesh_log *log)
{
    if (change != RIG_FOLLOWED && figures->largest_lag > LAG_SAID * diagonal)
        warn_of_lag(figures, change == RIG_MORPHED, log);
    if (figures->sheared)
        ffd_log_line(
            log, FFD_LOG_WARNING, "%" PRIu64 " %s: a parent is scaled unevenly, and would shear %s",
            figures->sheared,
            ffd_plural(figures->sheared, "node turns as its parent does", "nodes turn as their parents do"),
            ffd_plural(figures->sheared, "it", "them"));
    if (figures->singular)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " %s: the matrix of %s, or of a node above, has no inverse",
                     figures->singular,
                     ffd_plural(figures->singular, "node does not follow the deformation",
                                "nodes do not follow the deformation"),
                     ffd_plural(figures->singular, "it", "them"));
    if (figures->partial)
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s: {only} selects a part of %s", figures->partial,
                     ffd_plural(figures->partial, "node stays where it is", "nodes stay where they are"),
                     ffd_plural(figures->partial, "its mesh", "their meshes"));
}
