/* pass_shapes.c - morph targets in a pass. With D the displacement in the file's own space, a vertex at p
   with the offset m gets m' = m + D(p + m) - D(p); its normals' offset is n'(p + m, n + dn) - n'(p, n),
   tangents likewise (src/maths.md 9.3). */
#include "job/pass/pass_shapes.h"
#include "base/vector/vec.h"
#include "job/chain/chain_apply.h"
#include "job/pass/vertex_rounding.h"
#include "mesh/bounds.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* In place of a target's number: the shape with the default weights of all targets. */
#define SHOWN SIZE_MAX

typedef struct shape_work {
    part_work *part;
    tile_scratch *tile;
    shape_scratch *scratch;
    size_t shape, first, count;
    pass_totals *totals;
} shape_work;

static bool has(const shape_work *work, mesh_stream stream)
{
    return work->part->part->shapes[work->shape].has[stream];
}

static uint64_t number_of(const shape_work *work, size_t i)
{
    return work->part->first_vertex + work->first + i;
}

static void note_first(uint64_t *first, uint64_t number)
{
    *first = number < *first ? number : *first;
}

/* Reads a target's offsets of a stream; zeros if it has none. */
static void read_offsets(const shape_work *work, mesh_stream stream)
{
    const mesh_document *document = work->part->pass->document;
    if (has(work, stream))
        document->format->read_offsets(document, work->part->part_number, work->shape, stream, work->first,
                                       work->count, work->scratch->offsets);
    else
        memset(work->scratch->offsets, 0, 3 * work->count * sizeof *work->scratch->offsets);
}

static void write_offsets(const shape_work *work, mesh_stream stream)
{
    mesh_document *document = work->part->pass->document;
    document->format->write_offsets(document, work->part->part_number, work->shape, stream, work->first,
                                    work->count, work->scratch->offsets, work->scratch->changed);
}

/* Reads the position offsets of the target, or, for SHOWN, their weighted sum. */
static void read_position_offsets(const shape_work *work)
{
    const mesh_part *const part = work->part->part;
    double *const sum = work->scratch->offsets, *const one = work->scratch->normals;
    if (work->shape != SHOWN) {
        read_offsets(work, MESH_POSITIONS);
        return;
    }
    const mesh_document *const document = work->part->pass->document;
    memset(sum, 0, 3 * work->count * sizeof *sum);
    for (size_t k = 0; k < part->shape_count; k++) {
        const double weight = part->shapes[k].weight;
        if (weight == 0 || !part->shapes[k].has[MESH_POSITIONS])
            continue;
        document->format->read_offsets(document, work->part->part_number, k, MESH_POSITIONS, work->first,
                                       work->count, one);
        for (size_t i = 0; i < 3 * work->count; i++)
            sum[i] += weight * one[i];
    }
}

/* Whether a vertex is processed. An unselected one is if its node or skin moves. */
static bool takes_part(const shape_work *work, size_t i)
{
    return work->part->part->carried || ffd_part_selects(work->part->part, work->first + i);
}

/* Lists the vertices that the target moves, with their positions in the lattice's space. */
static void place_moved(const shape_work *work)
{
    shape_scratch *s = work->scratch;
    s->moved_count = 0;
    for (size_t i = 0; i < work->count; i++) {
        const double *m = s->offsets + 3 * i;
        double *x = s->position + 3 * s->moved_count;
        s->gradients[i] = work->tile->gradient + 9 * i;
        if (!takes_part(work, i) || (m[0] == 0 && m[1] == 0 && m[2] == 0))
            continue;
        const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
        for (size_t a = 0; a < 3; a++)
            x[a] = s->base[3 * i + a] + m[a];
        ffd_vertex_transform_point(&transform, x);
        if (work->shape != SHOWN && !vec_is_finite(x))
            work->totals->shapes_invalid += vec_is_finite(s->base + 3 * i);
        s->moved[s->moved_count++] = i;
    }
}

/* Adds the rounding cell of the offset of moved vertex i; for SHOWN, the weighted cells of all targets. */
static void add_offset_rounding(const shape_work *work, size_t i, double half[3])
{
    const mesh_part *const part = work->part->part;
    const bool shown = work->shape == SHOWN;
    for (size_t k = shown ? 0 : work->shape; k < (shown ? part->shape_count : work->shape + 1); k++) {
        const double weight = shown ? fabs(part->shapes[k].weight) : 1;
        double of_offset[3];
        ffd_rounding_cell(&part->shapes[k].rounding, work->scratch->offsets + 3 * i, of_offset);
        for (int a = 0; a < 3; a++)
            half[a] += weight * of_offset[a];
    }
}

/* The rounding cell of a vertex in a target is the sum of those of its position and its offset. */
static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const shape_work *work = context;
    const shape_scratch *s = work->scratch;
    const size_t i = s->moved[point];
    const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
    double position[3];
    memcpy(position, s->base + 3 * i, sizeof position);
    if (!is_first)
        ffd_vertex_in_file(&transform, x, position);
    ffd_rounding_cell(&work->part->part->rounding, position, half);
    add_offset_rounding(work, i, half);
    ffd_vertex_rounding_place(&transform, half);
}

/* An unselected vertex stays where the target puts it. */
static void hold(const shape_work *work, size_t k, bool gradients)
{
    shape_scratch *s = work->scratch;
    const size_t i = s->moved[k];
    const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
    for (size_t a = 0; a < 3; a++)
        s->position[3 * k + a] = s->base[3 * i + a] + s->offsets[3 * i + a];
    ffd_vertex_transform_point(&transform, s->position + 3 * k);
    memset(s->moved_delta + 3 * k, 0, 3 * sizeof *s->moved_delta);
    if (gradients)
        memset(s->moved_gradient + 9 * k, 0, 9 * sizeof *s->moved_gradient);
    s->moved_outcomes[k] = (point_outcome){0};
}

/* Adjusts displacements as for the base (pass.c): an offset is the difference of two positions that are
   carried alike. */
static void carry(const shape_work *work, size_t k, bool gradients)
{
    shape_scratch *s = work->scratch;
    if (!vec_is_finite(s->position + 3 * k))
        return;
    ffd_part_carry(work->part->part, s->position + 3 * k, s->moved_delta + 3 * k);
    if (gradients)
        ffd_part_carry_gradient(work->part->part, s->moved_gradient + 9 * k);
}

/* Sends the moved vertices through the chain. gradients: the base's are in tile->gradient, in the file's
   space; those of moved vertices are brought to it too. */
static ffd_status send_moved(const shape_work *work, bool gradients, ffd_error *error)
{
    shape_scratch *s = work->scratch;
    const mesh_pass *pass = work->part->pass;
    const chain_rounding rounding = {find_rounding, work};
    chain_run run = {.x = s->position,
                     .count = s->moved_count,
                     .rounding = &rounding,
                     .scratch = &work->tile->chain,
                     .delta = s->moved_delta,
                     .gradient = gradients ? s->moved_gradient : NULL,
                     .outcomes = s->moved_outcomes};
    const ffd_status status = ffd_chain_apply(pass->chain, pass->links, &run, error);
    work->totals->embed_seconds += run.embed_seconds;
    work->totals->deform_seconds += run.deform_seconds;
    for (size_t k = 0; k < s->moved_count && !status; k++) {
        const size_t i = s->moved[k];
        const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
        if (work->part->part->carried && !ffd_part_selects(work->part->part, work->first + i))
            hold(work, k, gradients);
        if (work->part->part->carried)
            carry(work, k, gradients);
        if (gradients)
            ffd_gradient_to_file(&transform, s->moved_gradient + 9 * k);
        s->gradients[i] = s->moved_gradient + 9 * k;
        if (work->shape != SHOWN && s->moved_outcomes[k].outside &&
            ffd_part_shows(work->part->part, work->first + i)) {
            work->totals->shapes_outside++;
            note_first(&work->totals->first_shape_outside, number_of(work, i));
        }
    }
    return status;
}

/* Replaces a coordinate of an offset, and marks it as changed, if it differs; an equal one keeps its bits. */
static void take(double value, double *offset, uint8_t *changed)
{
    if (value < *offset || value > *offset) {
        *offset = value;
        *changed = 1;
    }
}

/* Whether the file's number type can hold an offset. */
static bool fits(const double m[3], double largest)
{
    return fabs(m[0]) <= largest && fabs(m[1]) <= largest && fabs(m[2]) <= largest;
}

static void deform_positions(const shape_work *work)
{
    shape_scratch *s = work->scratch;
    const double largest = ffd_largest_coordinate(work->part->pass->document);
    memset(s->changed, 0, work->count);
    for (size_t k = 0; k < s->moved_count; k++) {
        const size_t i = s->moved[k];
        if (s->moved_outcomes[k].status == FFD_POINT_INVALID) /* stays, like a vertex that is not finite */
            continue;
        const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
        const double *const base = work->tile->delta + 3 * i;
        double *const moved = s->moved_delta + 3 * k, *const m = s->offsets + 3 * i;
        ffd_displacement_to_file(&transform, moved);
        for (int a = 0; a < 3; a++)
            take(m[a] + (moved[a] - base[a]), &m[a], &s->changed[i]);
        if (s->changed[i] && !fits(m, largest))
            note_first(&work->totals->first_overflow, number_of(work, i));
    }
    if (has(work, MESH_POSITIONS))
        write_offsets(work, MESH_POSITIONS);
}

/* Sets the offset of a normal or tangent. before, after: the base's direction, original and deformed. with:
   base plus offset, deformed. */
static void take_direction(const double before[3], const double after[3], const double with[3],
                           double offset[3], uint8_t *changed)
{
    for (int a = 0; a < 3; a++) {
        const bool still = !(after[a] < before[a]) && !(after[a] > before[a]) &&
                           !(with[a] < before[a] + offset[a]) && !(with[a] > before[a] + offset[a]);
        if (!still)
            take(with[a] - after[a], &offset[a], changed);
    }
}

/* Leaves the deformed normals of base plus offset in scratch->normals, for the tangents. */
static void deform_normals(const shape_work *work)
{
    shape_scratch *s = work->scratch;
    const mesh_document *document = work->part->pass->document;
    read_offsets(work, MESH_NORMALS);
    document->format->read_normals(document, work->part->part_number, work->first, work->count, s->base);
    memset(s->changed, 0, work->count);
    for (size_t i = 0; i < work->count; i++) {
        double *n = s->normals + 3 * i;
        for (size_t a = 0; a < 3; a++)
            n[a] = s->base[3 * i + a] + s->offsets[3 * i + a];
        if (!takes_part(work, i))
            continue;
        ffd_deform_normal(s->gradients[i], n, n);
        take_direction(s->base + 3 * i, work->tile->normals + 3 * i, n, s->offsets + 3 * i, &s->changed[i]);
    }
    if (has(work, MESH_NORMALS))
        write_offsets(work, MESH_NORMALS);
}

/* Call it after deform_normals. */
static void deform_tangents(const shape_work *work)
{
    shape_scratch *s = work->scratch;
    const mesh_document *document = work->part->pass->document;
    read_offsets(work, MESH_TANGENTS);
    document->format->read_tangents(document, work->part->part_number, work->first, work->count, s->tangents);
    memset(s->changed, 0, work->count);
    for (size_t i = 0; i < work->count; i++) {
        const double *base = s->tangents + 4 * i;
        double t[3];
        for (size_t a = 0; a < 3; a++)
            t[a] = base[a] + s->offsets[3 * i + a];
        if (!takes_part(work, i))
            continue;
        const double *n = work->part->part->normal_count ? s->normals + 3 * i : NULL;
        ffd_deform_tangent(s->gradients[i], t, n, t);
        take_direction(base, work->tile->tangents + 4 * i, t, s->offsets + 3 * i, &s->changed[i]);
    }
    write_offsets(work, MESH_TANGENTS);
}

/* Widens the box of shapes by the moved vertices that count for bounds. */
static void widen_shapes(const shape_work *work)
{
    const shape_scratch *const s = work->scratch;
    const mesh_part *const part = work->part->part;
    const pass_bounds of = work->part->pass->bounds_of;
    for (size_t k = 0; k < s->moved_count; k++)
        if (vec_is_finite(s->position + 3 * k) &&
            (of == PASS_BOUNDS_ALL || ffd_part_shows(part, work->first + s->moved[k])))
            ffd_bounds_widen(&work->totals->shapes, s->position + 3 * k);
}

/* Sends the vertices that the shape moves through the chain, and counts them. */
static ffd_status place_shape(const shape_work *work, bool gradients, ffd_error *error)
{
    const mesh_pass *const pass = work->part->pass;
    const mesh_document *document = pass->document;
    read_position_offsets(work);
    document->format->read_positions(document, work->part->part_number, work->first, work->count,
                                     work->scratch->base);
    place_moved(work);
    const ffd_status status = send_moved(work, gradients, error);
    if (!status && pass->bounds_shapes)
        widen_shapes(work);
    return status;
}

static ffd_status deform_shape(const shape_work *work, ffd_error *error)
{
    const mesh_part *part = work->part->part;
    if (!work->part->pass->write || work->shape == SHOWN)
        return place_shape(work, false, error);
    /* As for the base: if a transform is singular, normals and tangents stay. */
    const bool attributes = work->part->pass->attributes && !part->singular;
    const bool normals =
        attributes && part->normal_count > 0 && (has(work, MESH_NORMALS) || has(work, MESH_TANGENTS));
    const bool tangents = attributes && part->has_tangents && has(work, MESH_TANGENTS);
    const ffd_status status = place_shape(work, normals || tangents, error);
    if (status)
        return status;
    deform_positions(work);
    if (normals)
        deform_normals(work);
    if (tangents)
        deform_tangents(work);
    return FFD_OK;
}

/* Whether default weights show something else than the base and the targets. Only boxes have to go round it:
   figures of it come from a pass of its own (mesh_document.shown). */
static bool wants_shown(const mesh_pass *pass, const mesh_part *part)
{
    size_t shown = 0, last = 0;
    for (size_t k = 0; k < part->shape_count; k++)
        if (part->shapes[k].weight != 0) {
            shown++;
            last = k;
        }
    return pass->bounds_shapes && part->shows_shapes && !(shown == 1 && part->shapes[last].weight == 1);
}

void ffd_tile_shapes(part_work *part, tile_scratch *scratch, size_t first, size_t count, pass_totals *totals)
{
    shape_work work = {part, scratch, scratch->shape, 0, first, count, totals};
    for (; work.shape < part->part->shape_count && !scratch->status; work.shape++)
        scratch->status = deform_shape(&work, &scratch->error);
    if (!scratch->status && wants_shown(part->pass, part->part)) {
        work.shape = SHOWN;
        scratch->status = deform_shape(&work, &scratch->error);
    }
    if (scratch->status)
        atomic_store(&part->stopped, true);
}
