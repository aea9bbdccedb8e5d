/* pass_shapes.c - morph targets in a pass. With D the displacement in the file's own space, a vertex at p
   with the offset m gets m' = m + D(p + m) - D(p); its normals' offset is n'(p + m, n + dn) - n'(p, n),
   tangents likewise (src/maths.md 9.3). */
#include "job/pass/pass_shapes.h"
#include "base/vector/vec.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

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

/* The target's offsets to a stream; zeros where it has none. */
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

/* Lists the vertices that the target moves, with their positions in the lattice's space. */
static void place_moved(const shape_work *work)
{
    shape_scratch *s = work->scratch;
    s->moved_count = 0;
    for (size_t i = 0; i < work->count; i++) {
        const double *m = s->offsets + 3 * i;
        double *x = s->position + 3 * s->moved_count;
        s->gradients[i] = work->tile->gradient + 9 * i;
        if (!ffd_part_selects(work->part->part, work->first + i) || (m[0] == 0 && m[1] == 0 && m[2] == 0))
            continue;
        const vertex_transform transform = ffd_vertex_transform_of(&work->tile->transforms, i);
        for (size_t a = 0; a < 3; a++)
            x[a] = s->base[3 * i + a] + m[a];
        ffd_vertex_transform_point(&transform, x);
        if (!vec_is_finite(x))
            note_first(&work->totals->first_shape_invalid, number_of(work, i));
        s->moved[s->moved_count++] = i;
    }
}

/* The base's gradients are there where it has normals; they then are in the file's own space, and so are
   these. */
static ffd_status send_moved(const shape_work *work, bool gradients, ffd_error *error)
{
    shape_scratch *s = work->scratch;
    const mesh_pass *pass = work->part->pass;
    chain_run run = {.x = s->position,
                     .count = s->moved_count,
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
        if (gradients)
            ffd_gradient_to_file(&transform, s->moved_gradient + 9 * k);
        s->gradients[i] = s->moved_gradient + 9 * k;
        if (s->moved_outcomes[k].outside) {
            work->totals->shapes_outside++;
            note_first(&work->totals->first_shape_outside, number_of(work, i));
        }
    }
    return status;
}

/* Takes value for a coordinate of an offset; one that it equals keeps its bits. */
static void take(double value, double *offset, uint8_t *changed)
{
    if (value < *offset || value > *offset) {
        *offset = value;
        *changed = 1;
    }
}

/* Whether the file's numbers can hold an offset. */
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

/* offset: what a direction got; before and after: the base's direction, as it was and deformed; with: the
   direction with the offset, deformed. */
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

/* Leaves the normals with the target in scratch. */
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
        if (!ffd_part_selects(work->part->part, work->first + i))
            continue;
        ffd_deform_normal(s->gradients[i], n, n, NULL);
        take_direction(s->base + 3 * i, work->tile->normals + 3 * i, n, s->offsets + 3 * i, &s->changed[i]);
    }
    if (has(work, MESH_NORMALS))
        write_offsets(work, MESH_NORMALS);
}

/* After the normals. */
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
        if (!ffd_part_selects(work->part->part, work->first + i))
            continue;
        const double *n = work->part->part->normal_count ? s->normals + 3 * i : NULL;
        ffd_deform_tangent(s->gradients[i], t, n, t, NULL);
        take_direction(base, work->tile->tangents + 4 * i, t, s->offsets + 3 * i, &s->changed[i]);
    }
    write_offsets(work, MESH_TANGENTS);
}

static ffd_status deform_shape(const shape_work *work, ffd_error *error)
{
    shape_scratch *s = work->scratch;
    const mesh_part *part = work->part->part;
    const mesh_document *document = work->part->pass->document;
    /* As for the base: what cannot be carried out and back stays. */
    const bool attributes = work->part->pass->attributes && !part->singular;
    const bool normals =
        attributes && part->normal_count > 0 && (has(work, MESH_NORMALS) || has(work, MESH_TANGENTS));
    const bool tangents = attributes && part->has_tangents && has(work, MESH_TANGENTS);
    read_offsets(work, MESH_POSITIONS);
    document->format->read_positions(document, work->part->part_number, work->first, work->count, s->base);
    place_moved(work);
    const ffd_status status = send_moved(work, normals || tangents, error);
    if (status)
        return status;
    deform_positions(work);
    if (normals)
        deform_normals(work);
    if (tangents)
        deform_tangents(work);
    return FFD_OK;
}

void ffd_tile_shapes(part_work *part, tile_scratch *scratch, size_t first, size_t count, pass_totals *totals)
{
    for (size_t k = 0; k < part->part->shape_count && !scratch->status; k++) {
        const shape_work work = {part, scratch, scratch->shape, k, first, count, totals};
        scratch->status = deform_shape(&work, &scratch->error);
    }
    if (scratch->status)
        atomic_store(&part->stopped, true);
}
