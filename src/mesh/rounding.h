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

/* Computes the half sides of the rounding cell of a stored position along x, y, z: half an ulp of a float or
   half a step, whichever is greater. */
void ffd_rounding_cell(const mesh_rounding *rounding, const double position[3], double half[3]);

/* Transforms the half sides of a cell from the file's space to the bounds of the cell in the space of the
   lattice, in place: |linear| half. */
void ffd_rounding_transform(const double linear[9], double half[3]);

#endif
