#include "lattice/tangent/tangents.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "base/vector/trig.h"
#include "lattice/build.h"
#include "lattice/move_exact.h"
#include "lattice/tangent/move_tangent.h"
#include <stdio.h>
#include <string.h>

/* The derivatives while the moves of a lattice are applied again. */
typedef struct tangent_work {
    const lattice_spec *spec;
    lattice_tangents *tangents;
    size_t count;         /* control points */
    lattice_move *seeded; /* one for each column: the derivatives of the numbers of the current move */
    dual_move *moves;     /* one for each column; kept for the mirror image of a move */
    dual *parts, *halves; /* one for each layer of an exact bend */
} tangent_work;

size_t ffd_spec_column_count(const lattice_spec *spec)
{
    size_t columns = 0;
    for (size_t i = 0; i < spec->variable_count; i++)
        columns += spec->variables[i].size;
    return columns;
}

size_t ffd_lattice_get_column_count(const ffd_lattice *lattice)
{
    return lattice->spec ? ffd_spec_column_count(lattice->spec) : 0;
}

ffd_status ffd_lattice_get_column(const ffd_lattice *lattice, size_t column, char **name, ffd_error *error)
{
    const size_t count = ffd_lattice_get_column_count(lattice);
    size_t component = column, v = 0;
    *name = NULL;
    if (column >= count)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no column %zu: the lattice has %zu", column, count);
    while (component >= lattice->spec->variables[v].size)
        component -= lattice->spec->variables[v++].size;
    *name = ffd_spec_column_name(&lattice->spec->variables[v], component);
    return *name ? FFD_OK : ffd_fail_memory(error);
}

char *ffd_spec_column_name(const spec_variable *variable, size_t component)
{
    char number[32] = "";
    byte_buffer name = {0};
    if (variable->is_array)
        snprintf(number, sizeof number, "[%zu]", component);
    ffd_buffer_text(&name, variable->name);
    ffd_buffer_text(&name, number);
    return ffd_buffer_finish(&name);
}

static size_t first_column(const lattice_spec *spec, size_t variable)
{
    size_t column = 0;
    for (size_t i = 0; i < variable; i++)
        column += spec->variables[i].size;
    return column;
}

/* Sets the derivatives of the numbers of a move for each column. */
static void seed_move(tangent_work *work, size_t index)
{
    memset(work->seeded, 0, work->tangents->columns * sizeof *work->seeded);
    for (size_t i = 0; i < work->spec->seed_count; i++) {
        const spec_seed *const seed = &work->spec->seeds[i];
        if (seed->is_dragged || seed->move != index)
            continue;
        const size_t column = first_column(work->spec, seed->variable) + seed->component;
        double value;
        char *const at = (char *)&work->seeded[column] + seed->offset;
        memcpy(&value, at, sizeof value);
        value += seed->factor;
        memcpy(at, &value, sizeof value);
    }
}

static double *points_of(const tangent_work *work, size_t column)
{
    return work->tangents->points + column * 3 * work->count;
}

/* Finds the positions of the layers of an exact bend as fractions of the whole angle. */
static void find_parts(const tangent_work *work, const dual_move *move, const exact_layers *layers,
                       size_t column)
{
    const double *const points = points_of(work, column);
    for (size_t layer = layers->first; layer <= layers->last; layer++) {
        const size_t point = layer * layers->step;
        work->parts[layer] = dual_div(
            dual_sub(ffd_dual_move_along(move, point, points + 3 * point), move->first), move->length);
    }
    for (size_t layer = layers->first + 1; layer < layers->last; layer += 2) {
        const dual before = work->parts[layer - 1], after = work->parts[layer + 1];
        work->halves[layer] = dual_scale(dual_sub(after, before), 0.5);
        work->parts[layer] = dual_add(before, work->halves[layer]);
    }
}

/* Multiplies the weight of a point between joints by cos h, with h half the angle of its arc. */
static void bend_weight(const tangent_work *work, const dual_move *move, size_t point, dual half,
                        size_t column)
{
    const double *const weights = move->step->lattice->deformed_weights;
    const double radians = 3.14159265358979323846 / 180;
    double *const d = work->tangents->weights + column * work->count + point;
    const dual degrees = dual_mul(move->amount, half);
    double sine_of_half, cosine_of_half;
    ffd_sincos_degrees(degrees.v, &sine_of_half, &cosine_of_half);
    const dual cosine = {cosine_of_half, -sine_of_half * radians * degrees.d};
    *d = dual_mul((dual){weights ? weights[point] : 1, *d}, cosine).d;
}

static void bend_exactly(const tangent_work *work, const dual_move *move, size_t column)
{
    const move_step *const step = move->step;
    const exact_bend bend = {step->lattice, step->selected, step->ready, step->plane, ""};
    const exact_layers layers = ffd_move_exact_layers(&bend);
    const size_t size = step->lattice->size[layers.direction];
    if (!(move->length.v > 0))
        return;
    find_parts(work, move, &layers, column);
    for (size_t i = 0; i < work->count; i++) {
        const size_t layer = i / layers.step % size;
        const bool between = (layer - layers.first) % 2 == 1;
        if (!step->selected[i])
            continue;
        ffd_dual_move_point(move, i, &work->parts[layer], between ? &work->halves[layer] : NULL,
                            points_of(work, column) + 3 * i);
        if (between)
            bend_weight(work, move, i, work->halves[layer], column);
    }
}

/* Fills drags with the derivatives of the numbers of a drag's places for a column. */
static void seed_drags(const tangent_work *work, const lattice_move *move, size_t column, spec_drag *drags)
{
    const size_t first = (size_t)(move->drags - work->spec->drags);
    memset(drags, 0, move->drag_count * sizeof *drags);
    for (size_t i = 0; i < work->spec->seed_count; i++) {
        const spec_seed *const seed = &work->spec->seeds[i];
        if (!seed->is_dragged || seed->move < first || seed->move - first >= move->drag_count ||
            first_column(work->spec, seed->variable) + seed->component != column)
            continue;
        drags[seed->move - first].by[(seed->offset - offsetof(spec_drag, by)) / sizeof(double)] +=
            seed->factor;
    }
}

/* Returns whether deformed weights, on which the changes of a drag depend, have a derivative. */
static bool weights_vary(const lattice_tangents *tangents, size_t count)
{
    for (size_t i = 0; tangents->weights && i < tangents->columns * count; i++)
        if (tangents->weights[i] != 0)
            return true;
    return false;
}

/* The changes of a drag are linear in what it asks for, and depend on nothing else. */
static ffd_status see_drag(const tangent_work *work, const move_step *step, ffd_error *error)
{
    drag_solver *const solver = step->drag;
    const lattice_move *const move = step->move;
    spec_drag *const drags = ffd_alloc(move->drag_count, sizeof *drags);
    double *const by = ffd_alloc(solver->places, 3 * sizeof *by);
    double *const change = ffd_alloc(solver->columns, 3 * sizeof *change);
    ffd_status status;
    TRY_END(drags && by && change ? FFD_OK : ffd_fail_memory(error));
    if (weights_vary(work->tangents, work->count))
        TRY_END(ffd_fail_at(error, FFD_E_INVALID, work->spec->name, move->line, move->pointer,
                            "there are no derivatives of a drag after an exact bend that depends on a "
                            "placeholder"));
    for (size_t column = 0; column < work->tangents->columns; column++) {
        double *const points = points_of(work, column);
        seed_drags(work, move, column, drags);
        ffd_drag_targets(step, drags, by);
        ffd_drag_solve(solver, by, change);
        for (size_t i = 0; i < 3 * solver->columns; i++)
            points[3 * solver->point[i / 3] + i % 3] += change[i];
    }
end:
    ffd_free(drags);
    ffd_free(by);
    ffd_free(change);
    return status;
}

static ffd_status see(void *context, const move_step *step, ffd_error *error)
{
    tangent_work *const work = context;
    if (step->drag)
        return see_drag(work, step, error);
    if (!step->plane)
        seed_move(work, step->index);
    for (size_t column = 0; column < work->tangents->columns; column++) {
        dual_move *const move = &work->moves[column];
        double *const points = points_of(work, column);
        if (!step->plane)
            ffd_dual_move_make(step, &work->seeded[column], points, move);
        move->step = step;
        if (step->move->exact) {
            bend_exactly(work, move, column);
            continue;
        }
        for (size_t i = 0; i < work->count; i++)
            if (step->selected[i])
                ffd_dual_move_point(move, i, NULL, NULL, points + 3 * i);
    }
    return FFD_OK;
}

static ffd_status make(const ffd_lattice *lattice, tangent_work *work, ffd_error *error)
{
    lattice_tangents *const tangents = work->tangents;
    size_t count, layers = 0;
    for (int a = 0; a < 3; a++)
        layers = lattice->size[a] > layers ? lattice->size[a] : layers;
    if (!ffd_multiply_size(tangents->columns, 3 * work->count, &count))
        return ffd_fail_memory(error);
    tangents->points = ffd_alloc_zero(count, sizeof *tangents->points);
    tangents->weights =
        ffd_spec_has_exact(work->spec) ? ffd_alloc_zero(count / 3, sizeof *tangents->weights) : NULL;
    work->seeded = ffd_alloc(tangents->columns, sizeof *work->seeded);
    work->moves = ffd_alloc(tangents->columns, sizeof *work->moves);
    work->parts = ffd_alloc(layers, sizeof *work->parts);
    work->halves = ffd_alloc(layers, sizeof *work->halves);
    return tangents->points && (tangents->weights || !ffd_spec_has_exact(work->spec)) && work->seeded &&
                   work->moves && work->parts && work->halves
               ? FFD_OK
               : ffd_fail_memory(error);
}

ffd_status ffd_lattice_tangents_find(const ffd_lattice *lattice, lattice_tangents *tangents, ffd_error *error)
{
    tangent_work work = {.spec = lattice->spec, .tangents = tangents, .count = lattice->count};
    *tangents = (lattice_tangents){.columns = ffd_spec_column_count(lattice->spec)};
    ffd_status status;
    TRY_END(make(lattice, &work, error));
    TRY_END(ffd_lattice_replay(lattice, &(move_observer){see, &work}, error));
end:
    ffd_free(work.seeded);
    ffd_free(work.moves);
    ffd_free(work.parts);
    ffd_free(work.halves);
    return status;
}

void ffd_lattice_tangents_free(lattice_tangents *tangents)
{
    ffd_free(tangents->points);
    ffd_free(tangents->weights);
    *tangents = (lattice_tangents){0};
}
