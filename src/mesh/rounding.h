/* rounding.h - what a stored coordinate stands for: every number that the file would have stored likewise,
   its rounding cell. Positions that a file holds as text or as doubles stand for themselves. */
#ifndef FFD_MESH_ROUNDING_H
#define FFD_MESH_ROUNDING_H

#include <stdbool.h>

/* How x, y, z are stored. All zeros: as doubles. */
typedef struct mesh_rounding {
    bool is_float[3]; /* as float32 */
    double
        step[3]; /* as multiples of this length from some start (integers, quantization); 0: they are not */
} mesh_rounding;

/* Whether every coordinate stands for itself. */
static inline bool ffd_rounding_is_none(const mesh_rounding *rounding)
{
    bool none = true;
    for (int a = 0; a < 3; a++)
        none = none && !rounding->is_float[a] && !(rounding->step[a] > 0);
    return none;
}

/* Finds how far the cell of a stored position reaches along x, y, z: half an ulp of a float, half a step, the
   greater of both. */
void ffd_rounding_cell(const mesh_rounding *rounding, const double position[3], double half[3]);

/* Takes half a cell from the file's space to that of the lattice, where the cell's bounds are wanted:
   |linear| half. In place. */
void ffd_rounding_transform(const double linear[9], double half[3]);

#endif
