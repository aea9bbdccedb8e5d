/* pass_shapes.c - morph targets in a pass. With D the displacement in the file's own space, a vertex at p
   with the offset m gets m' = m + D(p + m) - D(p); its normals' offset is n'(p + m, n + dn) - n'(p, n),
   tangents likewise (src/maths.md 9.3). */
#include "base/vector/vec.h"
#include "deform/attribute.h"
#include "job/pass/tile.h"
#include "mesh/morphs.h"
#include <math.h>
#include <string.h>

static bool has(const shape_scratch *s, mesh_stream stream)
{
    return s->moved.tile->part->shapes[s->moved.shape].has[stream];
}

/* Reads a target's offsets of a stream; zeros if it has none. */
static void read_offsets(shape_scratch *s, mesh_stream stream)
{
    const pass_tile *const tile = s->moved.tile;
    const mesh_document *document = tile->pass->document;
    if (has(s, stream))
        document->format->morphs->read_offsets(document, tile->part_index, s->moved.shape, stream,
                                               tile->first, tile->count, s->offsets);
    else
        memset(s->offsets, 0, 3 * tile->count * sizeof *s->offsets);
}

static void write_offsets(shape_scratch *s, mesh_stream stream)
{
    const pass_tile *const tile = s->moved.tile;
    mesh_document *document = tile->pass->document;
    document->format->morphs->write_offsets(document, tile->part_index, s->moved.shape, stream, tile->first,
                                            tile->count, s->offsets, s->changed);
}

/* Reads the position offsets of the target, or, for SHAPE_SHOWN, their weighted sum. */
static void read_position_offsets(shape_scratch *s)
{
    const pass_tile *const tile = s->moved.tile;
    double *const sum = s->offsets, *const one = s->normals;
    if (s->moved.shape != SHAPE_SHOWN) {
        read_offsets(s, MESH_POSITIONS);
        return;
    }
    const mesh_document *const document = tile->pass->document;
    memset(sum, 0, 3 * tile->count * sizeof *sum);
    for (size_t k = 0; k < tile->part->shape_count; k++) {
        const double weight = tile->part->shapes[k].weight;
        if (weight == 0 || !tile->part->shapes[k].has[MESH_POSITIONS])
            continue;
        document->format->morphs->read_offsets(document, tile->part_index, k, MESH_POSITIONS, tile->first,
                                               tile->count, one);
        for (size_t i = 0; i < 3 * tile->count; i++)
            sum[i] += weight * one[i];
    }
}

/* Adds the selected vertices that the target moves, or those that are not selected, with their positions in
   the lattice's space. The latter stay where the target puts them. */
static void list_moved(shape_scratch *s, bool selected)
{
    const pass_tile *const tile = s->moved.tile;
    tile_points *const moved = &s->moved;
    for (size_t v = 0; v < tile->count; v++) {
        const double *const m = s->offsets + 3 * v, *const x = moved->position + 3 * moved->count;
        if ((m[0] == 0 && m[1] == 0 && m[2] == 0) ||
            ffd_part_selects(tile->part, tile->first + v) != selected)
            continue;
        (selected ? ffd_tile_place : ffd_tile_hold)(moved, moved->count, v);
        if (moved->shape != SHAPE_SHOWN && !vec_is_finite(x))
            tile->totals->shapes_invalid += vec_is_finite(moved->stored + 3 * v);
        moved->which[moved->count++] = (uint32_t)v;
    }
}

static void count_outside(const tile_points *moved)
{
    const pass_tile *const tile = moved->tile;
    for (size_t i = 0; i < moved->count; i++) {
        const size_t v = ffd_tile_vertex(moved, i);
        if (!moved->outcomes[i].outside || !ffd_part_shows(tile->part, tile->first + v))
            continue;
        tile->totals->shapes_outside++;
        ffd_note_first(&tile->totals->first_shape_outside, tile->first_index + v);
    }
}

/* Sends the vertices that the shape moves through the chain, and counts them. */
static ffd_status send_moved(shape_scratch *s, bool gradients, ffd_error *error)
{
    tile_points *const moved = &s->moved;
    const pass_tile *const tile = moved->tile;
    const mesh_document *const document = tile->pass->document;
    read_position_offsets(s);
    document->format->read(document, tile->part_index, MESH_POSITIONS, MESH_STORED, tile->first, tile->count,
                           moved->stored);
    moved->are_all = false;
    moved->count = 0;
    list_moved(s, true);
    chain_run run = ffd_tile_run(moved, gradients);
    const ffd_status status = ffd_tile_send(moved, &run, error);
    ffd_tile_add_times(tile, &run);
    TRY(status);
    if (moved->shape != SHAPE_SHOWN)
        count_outside(moved);
    if (tile->part->carried)
        list_moved(s, false);
    ffd_tile_carry(moved, gradients);
    if (tile->pass->bounds_shapes)
        ffd_tile_widen(moved, &tile->totals->shapes);
    return FFD_OK;
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

static void deform_positions(shape_scratch *s)
{
    const pass_tile *const tile = s->moved.tile;
    const double largest = ffd_largest_coordinate(tile->pass->document);
    ffd_tile_bring_back(&s->moved);
    memset(s->changed, 0, tile->count);
    for (size_t i = 0; i < s->moved.count; i++) {
        const size_t v = ffd_tile_vertex(&s->moved, i);
        const double *const base = tile->scratch->base.delta + 3 * v, *const moved = s->moved.delta + 3 * i;
        double *const m = s->offsets + 3 * v;
        if (s->moved.outcomes[i].status == FFD_VERTEX_INVALID) /* stays, like a vertex that is not finite */
            continue;
        for (int a = 0; a < 3; a++)
            take(m[a] + (moved[a] - base[a]), &m[a], &s->changed[v]);
        if (s->changed[v] && !fits(m, largest))
            ffd_note_first(&tile->totals->first_overflow, tile->first_index + v);
    }
    if (has(s, MESH_POSITIONS))
        write_offsets(s, MESH_POSITIONS);
}

/* Exchanges the gradients of the moved vertices for those of the base in the tile. */
static void swap_gradients(shape_scratch *s)
{
    tile_points *const moved = &s->moved;
    for (size_t i = 0; i < moved->count; i++) {
        double *const own = moved->gradient + 9 * i;
        double *const base = s->moved.tile->scratch->base.gradient + 9 * ffd_tile_vertex(moved, i);
        double kept[9];
        memcpy(kept, base, sizeof kept);
        memcpy(base, own, sizeof kept);
        memcpy(own, kept, sizeof kept);
    }
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
static void deform_normals(shape_scratch *s)
{
    const pass_tile *const tile = s->moved.tile;
    const mesh_document *const document = tile->pass->document;
    const attribute_batch batch = {.gradients = tile->scratch->base.gradient,
                                   .count = tile->count,
                                   .directions = s->normals,
                                   .step = 3,
                                   .outcomes = tile->scratch->outcomes};
    read_offsets(s, MESH_NORMALS);
    document->format->read(document, tile->part_index, MESH_NORMALS, MESH_STORED, tile->first, tile->count,
                           s->before);
    memset(s->changed, 0, tile->count);
    for (size_t k = 0; k < 3 * tile->count; k++)
        s->normals[k] = s->before[k] + s->offsets[k];
    ffd_deform_normals(tile->pass->chain->isa, &batch);
    for (size_t v = 0; v < tile->count; v++)
        take_direction(s->before + 3 * v, tile->scratch->normals + 3 * v, s->normals + 3 * v,
                       s->offsets + 3 * v, &s->changed[v]);
    if (has(s, MESH_NORMALS))
        write_offsets(s, MESH_NORMALS);
}

/* Call it after deform_normals. */
static void deform_tangents(shape_scratch *s)
{
    const pass_tile *const tile = s->moved.tile;
    const mesh_document *const document = tile->pass->document;
    double *const tangents = s->before; /* with the target */
    const attribute_batch batch = {.gradients = tile->scratch->base.gradient,
                                   .count = tile->count,
                                   .directions = tangents,
                                   .step = 3,
                                   .normals = tile->part->normal_count ? s->normals : NULL,
                                   .outcomes = tile->scratch->outcomes};
    read_offsets(s, MESH_TANGENTS);
    document->format->read(document, tile->part_index, MESH_TANGENTS, MESH_STORED, tile->first, tile->count,
                           s->tangents);
    memset(s->changed, 0, tile->count);
    for (size_t v = 0; v < tile->count; v++)
        for (size_t a = 0; a < 3; a++)
            tangents[3 * v + a] = s->tangents[4 * v + a] + s->offsets[3 * v + a];
    ffd_deform_tangents(tile->pass->chain->isa, &batch);
    for (size_t v = 0; v < tile->count; v++)
        take_direction(s->tangents + 4 * v, tile->scratch->tangents + 4 * v, tangents + 3 * v,
                       s->offsets + 3 * v, &s->changed[v]);
    write_offsets(s, MESH_TANGENTS);
}

/* Deforms a target, or only places it, if nothing is written. */
static ffd_status deform_shape(shape_scratch *s, ffd_error *error)
{
    const mesh_pass *const pass = s->moved.tile->pass;
    const mesh_part *const part = s->moved.tile->part;
    if (!pass->write || s->moved.shape == SHAPE_SHOWN)
        return send_moved(s, false, error);
    /* As for the base: if a transform is singular, normals and tangents stay. */
    const bool attributes = pass->attributes && !part->singular;
    const bool normals =
        attributes && part->normal_count > 0 && (has(s, MESH_NORMALS) || has(s, MESH_TANGENTS));
    const bool tangents = attributes && part->has_tangents && has(s, MESH_TANGENTS);
    TRY(send_moved(s, normals || tangents, error));
    deform_positions(s);
    if (!normals && !tangents)
        return FFD_OK;
    ffd_tile_bring_gradients_back(&s->moved);
    swap_gradients(s);
    if (normals)
        deform_normals(s);
    if (tangents)
        deform_tangents(s);
    swap_gradients(s);
    return FFD_OK;
}

/* Whether default weights show something else than the base and the targets. Only boxes have to go round it:
   figures of it come from a pass of its own (mesh_pass.state). */
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

ffd_status ffd_tile_shapes(const pass_tile *tile, ffd_error *error)
{
    shape_scratch *const s = tile->scratch->shape;
    for (size_t k = 0; k < tile->part->shape_count; k++) {
        ffd_tile_points_begin(tile, s->offsets, k, &s->moved);
        TRY(deform_shape(s, error));
    }
    if (!wants_shown(tile->pass, tile->part))
        return FFD_OK;
    ffd_tile_points_begin(tile, s->offsets, SHAPE_SHOWN, &s->moved);
    return deform_shape(s, error);
}
