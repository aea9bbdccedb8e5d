/* ply_rows.c - writes the vertices of a PLY file with what has changed of them. */
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/ply/ply_save.h"
#include "splat/harmonics.h"
#include <stdatomic.h>
#include <string.h>

/* What a row has by slot: where its numbers are (of a walk), what they become, and whether that is something
 * else. */
typedef struct row_change {
    text_word words[PLY_SLOT_COUNT];
    double values[PLY_SLOT_COUNT];
    bool changed[PLY_SLOT_COUNT];
    bool turns; /* its harmonics are to be turned */
} row_change;

/* Whether the bits of two numbers differ. */
static bool differ(const double *a, const double *b)
{
    return memcmp(a, b, sizeof *a) != 0;
}

static void change_vector(const double *before, const double *after, size_t first, row_change *row)
{
    for (size_t a = 0; a < 3; a++) {
        row->changed[first + a] = after && differ(before + a, after + a);
        if (row->changed[first + a])
            row->values[first + a] = after[a];
    }
}

static void change_splat(const ply_document *d, size_t number, row_change *row)
{
    const ply_splat *const result = &d->new_splats[number];
    memset(row->changed + PLY_ROTATION_SLOT, 0, PLY_SLOT_COUNT - PLY_ROTATION_SLOT);
    if (!result->is_changed)
        return;
    for (size_t slot = PLY_ROTATION_SLOT; slot < PLY_REST_SLOT; slot++) {
        splat_ellipsoid before = d->splats[number], after = result->splat;
        if (slot == PLY_REST_SLOT - 1 && d->file.part.form.is_flat)
            break;
        row->values[slot] = ply_round(d->types[slot], *ffd_ply_splat_number(&after, slot));
        row->changed[slot] = differ(ffd_ply_splat_number(&before, slot), &row->values[slot]);
    }
    row->turns = result->turn.is_turn;
}

/* All but harmonics. */
static void change_row(const ply_document *d, size_t number, row_change *row)
{
    const double *const directions = d->file.new_directions;
    row->turns = false;
    change_vector(d->file.positions + 3 * number, d->file.new_positions + 3 * number, 0, row);
    change_vector(directions ? d->file.directions + 3 * number : NULL,
                  directions ? directions + 3 * number : NULL, PLY_NORMAL_SLOT, row);
    if (d->new_splats)
        change_splat(d, number, row);
}

static void load_rests(const ply_document *d, size_t number, const row_change *row, double *values)
{
    const size_t count = HARMONICS_CHANNELS * (size_t)harmonics_count(d->file.part.form.degree);
    for (size_t i = 0; i < count; i++) {
        const size_t slot = PLY_REST_SLOT + i;
        if (d->has_fixed_rows)
            values[i] =
                ply_load_binary(d->header.encoding, d->types[slot], ply_row(d, number) + d->offsets[slot]);
        else
            ffd_ply_load(d->header.encoding, d->types[slot], row->words[slot], &values[i]);
    }
}

/* Changes PLY_ROWS rows at most, from a number on. Returns how many have harmonics that are not numbers. */
static size_t change_rows(const ply_document *d, size_t first, size_t count, row_change *rows)
{
    const size_t rests = HARMONICS_CHANNELS * (size_t)harmonics_count(d->file.part.form.degree);
    double before[PLY_ROWS][PLY_RESTS], after[PLY_ROWS][PLY_RESTS];
    splat_turn turns[PLY_ROWS];
    size_t turned[PLY_ROWS], open = 0;
    for (size_t i = 0; i < count; i++) {
        change_row(d, first + i, &rows[i]);
        if (!rows[i].turns || rests == 0)
            continue;
        load_rests(d, first + i, &rows[i], before[open]);
        memcpy(after[open], before[open], sizeof after[open]);
        turns[open] = d->new_splats[first + i].turn;
        turned[open++] = i;
    }
    if (open == 0)
        return 0;
    const size_t unturned = ffd_ply_turn_rests(d, turns, open, after);
    for (size_t k = 0; k < open; k++)
        for (size_t i = 0; i < rests; i++) {
            rows[turned[k]].values[PLY_REST_SLOT + i] = after[k][i];
            rows[turned[k]].changed[PLY_REST_SLOT + i] = differ(&before[k][i], &after[k][i]);
        }
    return unturned;
}

/* Rows whose numbers must be looked for one after the other. */
static size_t write_walked(const ply_document *d, file_splice *splice)
{
    ply_walk walk;
    row_change row = {.turns = false};
    size_t unturned = 0;
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (size_t number = 0; splice->status == FFD_OK && number < d->file.part.vertex_count; number++) {
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *property = &d->vertex->properties[i];
            if (property->slot == PLY_NO_SLOT)
                ffd_ply_walk_skip(&walk, property);
            else
                ffd_ply_walk_value(&walk, property->type, &row.words[property->slot]);
        }
        unturned += change_rows(d, number, 1, &row);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *property = &d->vertex->properties[i];
            char bytes[FFD_NUMBER_CAPACITY];
            if (property->slot == PLY_NO_SLOT || !row.changed[property->slot])
                continue;
            const size_t size =
                ffd_ply_store(d->header.encoding, property->type, row.values[property->slot], bytes);
            ffd_splice_replace(splice, row.words[property->slot], bytes, size);
        }
    }
    return unturned;
}

/* Rows of one size: threads change copies of them. */
typedef struct row_writer {
    const ply_document *document;
    file_splice *splice;
    byte_buffer *texts; /* of tiles that are not written yet */
    atomic_bool is_over;
    atomic_size_t unturned;
} row_writer;

#define ROW_TILE ((size_t)1024)

static void store_row(const ply_document *d, size_t number, const row_change *row, char *at)
{
    memcpy(at, ply_row(d, number), d->vertex->least);
    for (size_t slot = 0; slot < PLY_SLOT_COUNT; slot++)
        if (row->changed[slot])
            ply_store_binary(d->header.encoding, d->types[slot], row->values[slot], at + d->offsets[slot]);
}

/* Returns how many have harmonics that are not numbers. */
static size_t store_rows(const ply_document *d, size_t first, size_t last, char *at)
{
    row_change rows[PLY_ROWS];
    size_t unturned = 0;
    memset(rows, 0, sizeof rows);
    for (size_t number = first; number < last; number += PLY_ROWS) {
        const size_t count = last - number < PLY_ROWS ? last - number : PLY_ROWS;
        unturned += change_rows(d, number, count, rows);
        for (size_t i = 0; i < count; i++)
            store_row(d, number + i, &rows[i], at + (number + i - first) * d->vertex->least);
    }
    return unturned;
}

static void make_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    row_writer *const w = context;
    const ply_document *const d = w->document;
    const size_t size = (last - first) * d->vertex->least;
    byte_buffer text = w->texts[worker]; /* a local copy: entries of the list share cache lines */
    (void)tile;
    text.size = 0;
    if (atomic_load(&w->is_over))
        return;
    char *const at = ffd_buffer_reserve(&text, size);
    ffd_file_prefault(ply_row(d, first), size);
    if (at)
        atomic_fetch_add(&w->unturned, store_rows(d, first, last, at));
    text.size = at ? size : 0;
    w->texts[worker] = text;
}

static void write_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    row_writer *const w = context;
    (void)tile;
    if (atomic_load(&w->is_over))
        return;
    if (w->texts[worker].failed)
        w->splice->status = ffd_fail_memory(w->splice->error);
    ffd_splice_part(w->splice, ply_row(w->document, first), ply_row(w->document, last), &w->texts[worker]);
    if (w->splice->status)
        atomic_store(&w->is_over, true);
}

static size_t write_fixed(const ply_document *d, file_splice *splice)
{
    const int slots = ffd_ordered_slots(d->threads);
    row_writer w = {.document = d, .splice = splice, .texts = ffd_alloc_zero((size_t)slots, sizeof *w.texts)};
    atomic_init(&w.is_over, false);
    atomic_init(&w.unturned, 0);
    if (!w.texts ||
        !ffd_parallel_in_order(d->file.part.vertex_count, ROW_TILE, d->threads, make_tile, write_tile, &w))
        splice->status = ffd_fail_memory(splice->error);
    for (int i = 0; w.texts && i < slots; i++)
        ffd_buffer_free(&w.texts[i]);
    ffd_free(w.texts);
    return atomic_load(&w.unturned);
}

size_t ffd_ply_write_vertices(const ply_document *d, file_splice *splice)
{
    return d->has_fixed_rows ? write_fixed(d, splice) : write_walked(d, splice);
}
