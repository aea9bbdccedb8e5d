/* rounding.h - the rounding cell of a stored coordinate: all numbers that would be stored as the same value.
   Positions that a file stores as text or doubles have no rounding cell. */
#ifndef FFD_MESH_ROUNDING_H
#define FFD_MESH_ROUNDING_H

#include <stdbool.h>

/* How x, y, z are stored. All zeros: as doubles. */
typedef struct mesh_rounding {
    bool is_float[3]; /* as float32 */
    double step[3]; /* stored as multiples of this length from some origin (integers, quantization); 0: not */
} mesh_rounding;

/* Returns whether no coordinate has a rounding cell. */
static inline bool ffd_rounding_is_none(const mesh_rounding *rounding)
{
    bool none = true;
    for (int a = 0; a < 3; a++)
        none = none && !rounding->is_float[a] && !(rounding->step[a] > 0);
    return none;
}

/* How a format stores x, y, z: what results are rounded to. */
typedef enum rounding_kind {
    ROUNDED_TO_DOUBLES, /* or text */
    ROUNDED_TO_FLOATS,
    ROUNDED_TO_STEPS, /* integers */
    ROUNDED_EACH      /* not all three alike */
} rounding_kind;

static inline rounding_kind ffd_rounding_kind(const mesh_rounding *rounding)
{
    int floats = 0, steps = 0;
    for (int a = 0; a < 3; a++) {
        floats += rounding->is_float[a];
        steps += !rounding->is_float[a] && rounding->step[a] > 0;
    }
    return floats == 3           ? ROUNDED_TO_FLOATS
           : steps == 3          ? ROUNDED_TO_STEPS
           : floats + steps == 0 ? ROUNDED_TO_DOUBLES
                                 : ROUNDED_EACH;
}

/* Computes the half sides of the rounding cell of a stored position along x, y, z: half an ulp of a float or
   half a step, whichever is greater. */
void ffd_rounding_cell(const mesh_rounding *rounding, const double position[3], double half[3]);

/* Transforms the half sides of a cell from the file's space to the bounds of the cell in the space of the
   lattice, in place: |linear| half. */
void ffd_rounding_transform(const double linear[9], double half[3]);

#endif
