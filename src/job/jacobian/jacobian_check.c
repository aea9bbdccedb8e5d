/* jacobian_check.c - compares rows of the derivative with central differences. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/buffer.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "job/chain/chain_apply.h"
#include "job/chain/chain_load.h"
#include "job/chain/seals.h"
#include "job/jacobian/jacobian.h"
#include "points/embedding.h"
#include <ffd/author.h>
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* The step of a central difference relative to the size: the cube root of 2.2e-16, where rounding and the
   third derivative weigh the same. */
#define STEP 6.036810736797686e-06

#define VERTICES 16

/* State of a check. */
typedef struct check_work {
    const jacobian *j;
    jacobian_rows rows;
    chain_scratch *scratch;
    double worst;
} check_work;

/* Evaluates the displacement of a vertex by a lattice, at the embedding's u,v,w or border point. */
static void displace_by(const ffd_embedding *embedding, const ffd_lattice *lattice, size_t vertex,
                        double delta[3])
{
    memset(delta, 0, 3 * sizeof *delta);
    if (ffd_embedding_has(embedding, vertex)) {
        ffd_displacement(lattice, embedding->uvw + 3 * vertex, delta, NULL);
        return;
    }
    const size_t e = ffd_embedding_first_extended(embedding, vertex);
    if (e < embedding->extended_count && embedding->extended[e].point == vertex)
        ffd_extension_displacement(lattice, &embedding->extended[e].nearest, embedding->falloff, delta, NULL);
}

/* The same by a link whose lattice has other control points, before its faces are held. */
static ffd_status displace(const jacobian *j, const jacobian_link *link, const ffd_lattice *lattice,
                           size_t vertex, double delta[3], ffd_error *error)
{
    const lattice_chain *const chain = &j->job.chain;
    ffd_lattice *sealed = NULL;
    if (link->seal.sealed)
        TRY(ffd_lattice_seal(lattice, chain->seal.layers - 1, chain->links[link->index].held, &sealed,
                             error));
    displace_by(link->embedding, sealed ? sealed : lattice, vertex, delta);
    ffd_lattice_destroy(&sealed);
    return ffd_deadline_check(error);
}

/* Sends a position through the links from number `from` on. */
static ffd_status send(check_work *work, const lattice_chain *chain, size_t from, double x[3],
                       ffd_error *error)
{
    lattice_chain later = *chain;
    double delta[3];
    point_outcome outcome;
    chain_run run = {.x = x, .count = 1, .scratch = work->scratch, .delta = delta, .outcomes = &outcome};
    later.links += from;
    later.count -= from;
    later.seam_count = 0;
    later.cache = NULL;
    ffd_displacement_scratch_clear(&work->scratch->displacement);
    return later.count == 0 ? FFD_OK : ffd_chain_apply(&later, later.count, &run, error);
}

/* Compares the derivatives of x, y, z by one number with differences. scale: of the relative error. NaN on
   either side counts as an infinite error. */
static void compare(check_work *work, const double found[3], const double difference[3], double scale)
{
    for (int a = 0; a < 3; a++) {
        const double off = fabs(found[a] - difference[a]) / maximum_number(scale, 1e-3);
        work->worst = maximum_number(work->worst, isnan(off) ? HUGE_VAL : off);
    }
}

static double largest_of(const check_work *work)
{
    double largest = 0;
    for (int a = 0; a < 3; a++)
        for (size_t e = 0; e < work->rows.counts[a]; e++)
            largest = maximum_number(largest, fabs(work->rows.entries[a][e].value));
    return largest;
}

/* Returns the value of a row at a column; 0 if it is not stored. */
static double number_at(const check_work *work, int row, uint64_t column)
{
    for (size_t e = 0; e < work->rows.counts[row]; e++)
        if (work->rows.entries[row][e].column == column)
            return work->rows.entries[row][e].value;
    return 0;
}

/* Transforms a difference of positions from the scene to the file's space by M^-1. */
static void to_file(const jacobian *j, size_t vertex, double difference[3])
{
    if (j->inverses)
        mat_apply(j->inverses + 9 * vertex, difference, difference);
}

/* Central difference by one coordinate of a control point: the deformed position for +h minus that for -h,
   over 2 h. */
static ffd_status differ_point(check_work *work, ffd_lattice *lattice, const double base[3], size_t vertex,
                               size_t point, int coordinate, double h, double difference[3], ffd_error *error)
{
    const jacobian_link *const link = &work->j->links[0];
    double offset[3], at[2][3];
    memcpy(offset, ffd_lattice_get_offsets(lattice) + 3 * point, sizeof offset);
    const double kept = offset[coordinate];
    ffd_status status = FFD_OK;
    for (int side = 0; side < 2; side++) {
        offset[coordinate] = side ? kept + h : kept - h;
        TRY_END(ffd_lattice_set_offsets(lattice, &point, 1, offset, error));
        TRY_END(displace(work->j, link, lattice, vertex, at[side], error));
        for (int c = 0; c < 3; c++)
            at[side][c] += base[c];
        TRY_END(send(work, &work->j->job.chain, link->index + 1, at[side], error));
    }
    for (int c = 0; c < 3; c++)
        difference[c] = ffd_jacobian_weight(work->j, vertex) * (at[1][c] - at[0][c]) / (2 * h);
end:
    to_file(work->j, vertex, difference);
    offset[coordinate] = kept;
    return status ? status : ffd_lattice_set_offsets(lattice, &point, 1, offset, error);
}

static ffd_status check_points(check_work *work, size_t vertex, const double base[3], ffd_error *error)
{
    const jacobian *const j = work->j;
    const jacobian_link *const link = &j->links[0];
    const ffd_lattice *const of = j->job.chain.links[link->index].lattice;
    const double h = STEP * of->diagonal, scale = largest_of(work);
    ffd_lattice *lattice;
    size_t next = ffd_embedding_first_extended(link->embedding, vertex);
    TRY(ffd_lattice_copy(of, &lattice, error));
    ffd_basis_row(link->embedding, ffd_jacobian_weights(j, link), ffd_jacobian_seal(link), BASIS_BY_U, vertex,
                  &next, &work->rows.basis);
    ffd_status status = FFD_OK;
    for (size_t e = 0; e < work->rows.basis.count; e++)
        for (int b = 0; b < 3; b++) {
            const uint64_t column = work->rows.basis.columns[e];
            double found[3] = {0, 0, 0}, difference[3];
            for (int a = 0; a < 3; a++)
                found[a] = j->blocks ? number_at(work, a, 3 * column + (uint64_t)b)
                           : a == b  ? number_at(work, 0, column)
                                     : 0;
            TRY_END(differ_point(work, lattice, base, vertex, (size_t)column, b, h, difference, error));
            compare(work, found, difference, scale);
        }
end:
    ffd_lattice_destroy(&lattice);
    return status;
}

/* Returns a placeholder's value as JSON, with one number increased by `by`. */
static char *value_text(const spec_variable *variable, size_t component, double by)
{
    byte_buffer text = {0};
    ffd_buffer_text(&text, variable->is_array ? "[" : "");
    for (size_t i = 0; i < variable->size; i++) {
        ffd_buffer_text(&text, i ? "," : "");
        ffd_buffer_number(&text, variable->numbers[i] + (i == component ? by : 0));
    }
    ffd_buffer_text(&text, variable->is_array ? "]" : "");
    return ffd_buffer_finish(&text);
}

/* Finds the placeholder, and the component of its value, that a column belongs to. */
static const spec_variable *variable_of(const jacobian *j, size_t column, size_t *component)
{
    for (size_t l = 0; l < j->link_count; l++) {
        const jacobian_link *const link = &j->links[l];
        const lattice_spec *const spec = j->job.chain.links[link->index].lattice->spec;
        size_t own = 0;
        for (size_t v = 0; v < spec->variable_count; v++)
            for (*component = 0; *component < spec->variables[v].size; ++*component)
                if (link->columns[own++] == column)
                    return &spec->variables[v];
    }
    return NULL;
}

/* Loads all lattices with a changed placeholder, fits them to the same boxes as the job's, and holds the same
   faces. */
static ffd_status load_changed(const jacobian *j, const spec_variable *variable, const char *text,
                               lattice_chain *chain, ffd_error *error)
{
    const ffd_deform_desc *const desc = j->job.desc;
    ffd_setting *const set = ffd_alloc(desc->set_count + 1, sizeof *set);
    size_t count = 0;
    if (!set)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < desc->set_count; i++)
        if (strcmp(desc->set[i].name, variable->name) != 0)
            set[count++] = desc->set[i];
    set[count++] = (ffd_setting){variable->name, text};
    const chain_files files = {.lattices = desc->lattices,
                               .count = desc->lattice_count,
                               .set = set,
                               .set_count = count,
                               .time = desc->has_time ? &desc->time : NULL,
                               .mesh = &desc->input};
    ffd_status status;
    TRY_END(ffd_chain_load(&files, &j->job.chain.outside, desc->isa, NULL, chain, error));
    chain->seal = j->job.chain.seal;
    for (size_t l = 0; l < chain->count; l++) {
        const chain_link *const like = &j->job.chain.links[l];
        if (!chain->links[l].locator) {
            TRY_END(ffd_lattice_fit_extent(chain->links[l].lattice, &like->lattice->fitted, error));
            TRY_END(ffd_chain_prepare(chain, l, error));
        }
        TRY_END(ffd_seal_link(chain, l, like->held, error));
    }
end:
    ffd_free(set);
    return status;
}

/* Deforms the vertices with one number of a placeholder changed. */
static ffd_status move_changed(check_work *work, const spec_variable *variable, size_t component, double by,
                               size_t count, const double *rest, double *to, ffd_error *error)
{
    lattice_chain chain = {.links = NULL};
    char *const text = value_text(variable, component, by);
    ffd_status status;
    TRY_END(text ? load_changed(work->j, variable, text, &chain, error) : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++) {
        memcpy(to + 3 * i, rest + 3 * i, 3 * sizeof *to);
        TRY_END(send(work, &chain, 0, to + 3 * i, error));
    }
end:
    ffd_chain_free(&chain);
    ffd_free(text);
    return status;
}

static ffd_status check_parameter(check_work *work, size_t column, const size_t *vertices, size_t count,
                                  const double *rest, ffd_error *error)
{
    size_t component;
    const spec_variable *const variable = variable_of(work->j, column, &component);
    const double h = STEP * maximum_number(fabs(variable->numbers[component]), 1);
    double at[2][3 * VERTICES];
    TRY(move_changed(work, variable, component, -h, count, rest, at[0], error));
    TRY(move_changed(work, variable, component, h, count, rest, at[1], error));
    for (size_t i = 0; i < count; i++) {
        double found[3], difference[3];
        ffd_jacobian_rows_begin(work->j, vertices[i], &work->rows);
        ffd_jacobian_rows_fill(work->j, vertices[i], &work->rows);
        for (int a = 0; a < 3; a++) {
            found[a] = number_at(work, a, column);
            difference[a] = ffd_jacobian_weight(work->j, vertices[i]) *
                            (at[1][3 * i + (size_t)a] - at[0][3 * i + (size_t)a]) / (2 * h);
        }
        to_file(work->j, vertices[i], difference);
        compare(work, found, difference, largest_of(work));
    }
    return FFD_OK;
}

/* Chooses moving vertices, evenly from the first to the last. */
static size_t choose(check_work *work, size_t vertices[VERTICES])
{
    const size_t count = work->j->count;
    size_t chosen = 0, last = SIZE_MAX;
    for (size_t k = 0; k < VERTICES; k++) {
        size_t vertex = (size_t)((double)count * ((double)k + 0.5) / VERTICES);
        for (size_t tried = 0; tried < count; tried++, vertex = vertex + 1 < count ? vertex + 1 : 0) {
            ffd_jacobian_rows_begin(work->j, vertex, &work->rows);
            ffd_jacobian_rows_fill(work->j, vertex, &work->rows);
            if (work->rows.counts[0] + work->rows.counts[1] + work->rows.counts[2] > 0)
                break;
        }
        if (vertex < count && vertex != last &&
            work->rows.counts[0] + work->rows.counts[1] + work->rows.counts[2] > 0)
            vertices[chosen++] = last = vertex;
    }
    return chosen;
}

/* Finds the positions before the first link that matters: at rest, or after the earlier links. */
static ffd_status find_base(const jacobian *j, const size_t *vertices, size_t count, double *base,
                            ffd_error *error)
{
    double *const all = ffd_alloc(j->count, 3 * sizeof *all);
    if (!all)
        return ffd_fail_memory(error);
    const size_t links = j->desc->by == FFD_BY_POINTS ? j->links[0].index : 0;
    ffd_status status;
    TRY_END(ffd_jacobian_positions(j, links, all, error));
    for (size_t i = 0; i < count; i++)
        memcpy(base + 3 * i, all + 3 * vertices[i], 3 * sizeof *base);
end:
    ffd_free(all);
    return status;
}

static ffd_status check_sample(check_work *work, ffd_error *error)
{
    const jacobian *const j = work->j;
    size_t vertices[VERTICES];
    double base[3 * VERTICES];
    const size_t count = choose(work, vertices);
    TRY(find_base(j, vertices, count, base, error));
    for (size_t i = 0; i < count && j->desc->by == FFD_BY_POINTS; i++) {
        ffd_jacobian_rows_begin(j, vertices[i], &work->rows);
        ffd_jacobian_rows_fill(j, vertices[i], &work->rows);
        TRY(check_points(work, vertices[i], base + 3 * i, error));
    }
    for (size_t c = 0; c < j->columns && j->desc->by == FFD_BY_PARAMETERS; c++)
        TRY(check_parameter(work, c, vertices, count, base, error));
    return FFD_OK;
}

ffd_status ffd_jacobian_check(const jacobian *j, double *worst, ffd_error *error)
{
    check_work work = {.j = j, .scratch = ffd_alloc_zero(1, sizeof *work.scratch)};
    ffd_status status;
    TRY_END(ffd_jacobian_rows_make(j, &work.rows, error));
    if (!work.scratch)
        TRY_END(ffd_fail_memory(error));
    TRY_END(check_sample(&work, error));
end:
    *worst = work.worst;
    ffd_jacobian_rows_free(&work.rows);
    ffd_free(work.scratch);
    return status;
}
