/* ply_rows.c - writes the changed vertices of a PLY file whose rows do not have a fixed size. */
#include "io/ply/ply_save.h"
#include <string.h>

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

static void change_splat(const ply_document *d, size_t number, row_change *row)
{
    const uint8_t marks = d->splat_marks[number];
    memset(row->changed + PLY_ROTATION_SLOT, 0, PLY_SLOT_COUNT - PLY_ROTATION_SLOT);
    for (size_t slot = PLY_ROTATION_SLOT; slot < PLY_REST_SLOT && marks; slot++) {
        splat_ellipsoid before = d->splats[number];
        if (slot == PLY_REST_SLOT - 1 && d->file.part.form.is_flat)
            break;
        row->values[slot] = ply_new_splat_number(d, number, slot);
        row->changed[slot] = differ(ffd_ply_splat_number(&before, slot), &row->values[slot]);
    }
}

/* Returns whether the types cannot hold some harmonics, which then stay. */
static bool change_rests(const ply_document *d, size_t number, row_change *row)
{
    const int degree = d->file.part.form.degree, functions = harmonics_count(degree);
    const splat_turn turn = ffd_ply_turn_of(d, number);
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
            row->values[slot] = ply_round(d->types[slot], after[k][m]);
            row->changed[slot] = differ(&before[k][m], &row->values[slot]);
        }
        all = all && fits;
    }
    return !all;
}

/* Returns whether the types cannot hold some harmonics, which then stay. */
static bool change_row(const ply_document *d, size_t number, row_change *row)
{
    const double *const directions = d->file.new_directions;
    change_vector(d->file.positions + 3 * number, d->file.new_positions + 3 * number, 0, row);
    change_vector(directions ? d->file.directions + 3 * number : NULL,
                  directions ? directions + 3 * number : NULL, PLY_NORMAL_SLOT, row);
    if (!d->splat_marks)
        return false;
    change_splat(d, number, row);
    return d->splat_marks[number] & PLY_SPLAT_TURNS && change_rests(d, number, row);
}

size_t ffd_ply_write_walked(const ply_document *d, file_splice *splice)
{
    ply_walk walk;
    row_change row = {.changed = {false}};
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
        unturned += change_row(d, number, &row);
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
