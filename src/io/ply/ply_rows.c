/* ply_rows.c - writes the rows of the vertices of a PLY file. Of a binary one with rows of a fixed size,
   threads change copies; of another one, each changed value is written in the place of the old one. */
#include "base/inline.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/ply/ply_save.h"
#include <stdatomic.h>
#include <string.h>

typedef struct row_writer {
    const ply_document *document;
    file_splice *splice;
    byte_buffer *texts; /* of the tiles that are not written yet */
    atomic_bool is_over;
    atomic_size_t unturned;
} row_writer;

#define ROW_TILE ((size_t)1024)

/* Splats whose coefficients are turned together. */
#define TURNED ((size_t)16)

static void store(const ply_document *d, size_t slot, double value, char *row)
{
    ply_store_binary(d->header.encoding, d->types[slot], value, row + d->offsets[slot]);
}

/* Stores only numbers whose bits differ: storing a NaN again could change its bytes. */
static void store_vector(const ply_document *d, const double *before, const double *after, size_t slot,
                         char *row)
{
    for (size_t a = 0; a < 3; a++)
        if (memcmp(before + a, after + a, sizeof *after) != 0)
            store(d, slot + a, after[a], row);
}

static void store_splat(const ply_document *d, size_t vertex, char *row)
{
    const size_t last = d->file.part.form.is_flat ? PLY_REST_SLOT - 1 : PLY_REST_SLOT;
    for (size_t slot = PLY_ROTATION_SLOT; slot < last; slot++)
        store(d, slot, ply_new_splat_number(d, vertex, slot), row);
}

static ALWAYS_INLINE void widen(const unsigned char *floats, int count, double *c)
{
    for (int m = 0; m < count; m++)
        c[m] = load_float(floats + (size_t)m * sizeof(float));
}

static ALWAYS_INLINE void narrow(const double *c, int count, unsigned char *floats)
{
    for (int m = 0; m < count; m++)
        store_float(floats + (size_t)m * sizeof(float), (float)c[m]);
}

/* For the count of most files, a constant that the compiler knows halves the time. */
static void load_floats(const unsigned char *floats, int count, double *c)
{
    if (count == HARMONICS_MOST)
        widen(floats, HARMONICS_MOST, c);
    else
        widen(floats, count, c);
}

static void store_floats(const double *c, int count, unsigned char *floats)
{
    if (count == HARMONICS_MOST)
        narrow(c, HARMONICS_MOST, floats);
    else
        narrow(c, count, floats);
}

static void load_rests(const ply_document *d, const char *row, harmonics_block c)
{
    const int functions = harmonics_count(d->file.part.form.degree);
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const size_t slot = ply_rest_slot(d, k, 0);
        if (d->has_plain_rests)
            load_floats((const unsigned char *)row + d->offsets[slot], functions, c[k]);
        else
            for (int m = 0; m < functions; m++)
                c[k][m] = ply_load_binary(d->header.encoding, d->types[slot + (size_t)m],
                                          row + d->offsets[slot + (size_t)m]);
    }
}

/* Returns whether their types cannot hold some coefficients, which then stay. */
static bool store_rests(const ply_document *d, const harmonics_block c, char *row)
{
    const int functions = harmonics_count(d->file.part.form.degree);
    bool all = true;
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const size_t slot = ply_rest_slot(d, k, 0);
        const bool fits = ffd_ply_rests_fit(d, c[k], k);
        all = all && fits;
        if (fits && d->has_plain_rests)
            store_floats(c[k], functions, (unsigned char *)row + d->offsets[slot]);
        else
            for (int m = 0; m < functions && fits; m++)
                store(d, slot + (size_t)m, c[k][m], row);
    }
    return !all;
}

/* Stores a row, except for turned harmonics. */
static void store_row(const ply_document *d, size_t vertex, char *row)
{
    const double *const directions = d->file.new_directions;
    memcpy(row, ply_row(d, vertex), d->vertex->least);
    store_vector(d, d->file.positions + 3 * vertex, d->file.new_positions + 3 * vertex, 0, row);
    if (directions)
        store_vector(d, d->file.directions + 3 * vertex, directions + 3 * vertex, PLY_NORMAL_SLOT, row);
    if (d->splat_marks && d->splat_marks[vertex])
        store_splat(d, vertex, row);
}

/* Stores at most TURNED rows. Returns the number of vertices with harmonics that stay because their types
   cannot hold the results. */
static size_t store_some(const ply_document *d, size_t first, size_t count, char *at)
{
    const int degree = d->file.part.form.degree;
    const size_t size = d->vertex->least;
    harmonics_block c[TURNED];
    splat_turn turns[TURNED];
    size_t turned[TURNED], open = 0, unturned = 0;
    for (size_t i = 0; i < count; i++) {
        store_row(d, first + i, at + i * size);
        if (!d->splat_marks || !(d->splat_marks[first + i] & PLY_SPLAT_TURNS))
            continue;
        load_rests(d, at + i * size, c[open]);
        turns[open] = ffd_ply_turn_of(d, first + i);
        turned[open++] = i;
    }
    ffd_harmonics_turn(FFD_ISA_AUTO, turns, degree, open, c);
    for (size_t k = 0; k < open; k++)
        unturned += store_rests(d, (const double(*)[HARMONICS_MOST])c[k], at + turned[k] * size);
    return unturned;
}

/* Returns the number of vertices with harmonics that stay, as above. */
static size_t store_rows(const ply_document *d, size_t first, size_t last, char *at)
{
    size_t unturned = 0;
    for (size_t vertex = first; vertex < last; vertex += TURNED) {
        const size_t count = last - vertex < TURNED ? last - vertex : TURNED;
        unturned += store_some(d, vertex, count, at + (vertex - first) * d->vertex->least);
    }
    return unturned;
}

static void make_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    row_writer *const w = context;
    const ply_document *const d = w->document;
    const size_t size = (last - first) * d->vertex->least;
    /* a local copy, because the entries of the array share cache lines. */
    byte_buffer text = w->texts[worker];
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

size_t ffd_ply_write_fixed(const ply_document *d, file_splice *splice)
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

/* Per slot of a row: the word of its number, the new number, and whether that differs. */
typedef struct row_change {
    text_word words[PLY_SLOT_COUNT];
    double values[PLY_SLOT_COUNT];
    bool changed[PLY_SLOT_COUNT];
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

static void change_splat(const ply_document *d, size_t index, row_change *row)
{
    const uint8_t marks = d->splat_marks[index];
    memset(row->changed + PLY_ROTATION_SLOT, 0, PLY_SLOT_COUNT - PLY_ROTATION_SLOT);
    for (size_t slot = PLY_ROTATION_SLOT; slot < PLY_REST_SLOT && marks; slot++) {
        splat_ellipsoid before = d->splats[index];
        if (slot == PLY_REST_SLOT - 1 && d->file.part.form.is_flat)
            break;
        row->values[slot] = ply_new_splat_number(d, index, slot);
        row->changed[slot] = differ(ffd_ply_splat_number(&before, slot), &row->values[slot]);
    }
}

/* Returns whether the types cannot hold some harmonics, which then stay. */
static bool change_rests(const ply_document *d, size_t index, row_change *row)
{
    const int degree = d->file.part.form.degree, functions = harmonics_count(degree);
    const splat_turn turn = ffd_ply_turn_of(d, index);
    harmonics_block before, after;
    bool all = true;
    for (int k = 0; k < HARMONICS_CHANNELS; k++)
        for (int m = 0; m < functions; m++) {
            const size_t slot = ply_rest_slot(d, k, m);
            ffd_ply_load(d->header.encoding, d->types[slot], row->words[slot], &before[k][m]);
            after[k][m] = before[k][m];
        }
    ffd_harmonics_turn(FFD_ISA_AUTO, &turn, degree, 1, &after);
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const bool fits = ffd_ply_rests_fit(d, after[k], k);
        for (int m = 0; m < functions && fits; m++) {
            const size_t slot = ply_rest_slot(d, k, m);
            row->values[slot] = number_round(d->types[slot], after[k][m]);
            row->changed[slot] = differ(&before[k][m], &row->values[slot]);
        }
        all = all && fits;
    }
    return !all;
}

/* Returns whether the types cannot hold some harmonics, which then stay. */
static bool change_row(const ply_document *d, size_t index, row_change *row)
{
    const double *const directions = d->file.new_directions;
    change_vector(d->file.positions + 3 * index, d->file.new_positions + 3 * index, 0, row);
    change_vector(directions ? d->file.directions + 3 * index : NULL,
                  directions ? directions + 3 * index : NULL, PLY_NORMAL_SLOT, row);
    if (!d->splat_marks)
        return false;
    change_splat(d, index, row);
    return d->splat_marks[index] & PLY_SPLAT_TURNS && change_rests(d, index, row);
}

size_t ffd_ply_write_walked(const ply_document *d, file_splice *splice)
{
    ply_walk walk;
    row_change row = {.changed = {false}};
    size_t unturned = 0;
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (size_t index = 0; splice->status == FFD_OK && index < d->file.part.vertex_count; index++) {
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *property = &d->vertex->properties[i];
            if (property->slot == PLY_NO_SLOT)
                ffd_ply_walk_skip(&walk, property);
            else
                ffd_ply_walk_value(&walk, property->type, &row.words[property->slot]);
        }
        unturned += change_row(d, index, &row);
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
