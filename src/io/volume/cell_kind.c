#include "io/volume/cell_kind.h"

/* clang-format off */
static const cell_kind kinds[CELL_KINDS] = {
    [CELL_VERTEX] = {"vertex", 0, 0, false, 1},
    [CELL_POLY_VERTEX] = {"poly vertex", 0, 0, false, 0},
    [CELL_LINE] = {"line", 1, 0, false, 2},
    [CELL_POLYLINE] = {"poly line", 1, 0, false, 0},
    [CELL_TRIANGLE] = {"triangle", 2, 3, false, 3},
    [CELL_STRIP] = {"triangle strip", 2, 0, false, 0},
    [CELL_POLYGON] = {"polygon", 2, 0, false, 0},
    [CELL_PIXEL] = {"pixel", 2, 4, false, 4},
    [CELL_QUAD] = {"quad", 2, 4, false, 4},
    [CELL_TETRA] = {"tetra", 3, 3, true, 4},
    [CELL_VOXEL] = {"voxel", 3, 4, false, 8},
    [CELL_HEXAHEDRON] = {"hexahedron", 3, 4, false, 8},
    [CELL_WEDGE] = {"wedge", 3, 3, false, 6},
    [CELL_PYRAMID] = {"pyramid", 3, 4, true, 5},
    [15] = {"pentagonal prism", 3, 5, false, 10},
    [16] = {"hexagonal prism", 3, 6, false, 12},
    [21] = {"quadratic line", 1, 0, false, 3},
    [22] = {"quadratic triangle", 2, 3, false, 6},
    [23] = {"quadratic quad", 2, 4, false, 8},
    [24] = {"quadratic tetra", 3, 3, true, 10},
    [25] = {"quadratic hexahedron", 3, 4, false, 20},
    [26] = {"quadratic wedge", 3, 3, false, 15},
    [27] = {"quadratic pyramid", 3, 4, true, 13},
    [28] = {"biquadratic quad", 2, 4, false, 9},
    [29] = {"triquadratic hexahedron", 3, 4, false, 27},
    [30] = {"quadratic linear quad", 2, 4, false, 6},
    [31] = {"quadratic linear wedge", 3, 3, false, 12},
    [32] = {"biquadratic quadratic wedge", 3, 3, false, 18},
    [33] = {"biquadratic quadratic hexahedron", 3, 4, false, 24},
    [34] = {"biquadratic triangle", 2, 3, false, 7},
    [35] = {"cubic line", 1, 0, false, 4},
    [CELL_QUADRATIC_POLYGON] = {"quadratic polygon", 2, 0, false, 0},
    [37] = {"triquadratic pyramid", 3, 4, true, 19},
    [CELL_POLYHEDRON] = {"polyhedron", 3, 0, false, 0},
    [68] = {"Lagrange curve", 1, 0, false, 0},
    [69] = {"Lagrange triangle", 2, 3, false, 0},
    [70] = {"Lagrange quad", 2, 4, false, 0},
    [71] = {"Lagrange tetra", 3, 3, true, 0},
    [72] = {"Lagrange hexahedron", 3, 4, false, 0},
    [73] = {"Lagrange wedge", 3, 3, false, 0},
    [74] = {"Lagrange pyramid", 3, 4, true, 0},
    [75] = {"Bezier curve", 1, 0, false, 0},
    [76] = {"Bezier triangle", 2, 3, false, 0},
    [77] = {"Bezier quad", 2, 4, false, 0},
    [78] = {"Bezier tetra", 3, 3, true, 0},
    [79] = {"Bezier hexahedron", 3, 4, false, 0},
    [80] = {"Bezier wedge", 3, 3, false, 0},
    [81] = {"Bezier pyramid", 3, 4, true, 0},
};
/* clang-format on */

const cell_kind *ffd_cell_kind(uint64_t number)
{
    return number < CELL_KINDS && kinds[number].name ? &kinds[number] : NULL;
}
