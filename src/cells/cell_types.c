#include "cells/cell_types.h"
#include "cells/cell_view.h"
#include <string.h>

/* The corners first; of quadratic cells the middles of edges, then of faces, then the centre. */
static const uint8_t tetra[][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0},
                                   {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
static const uint8_t hexahedron[][3] = {
    {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0},
    {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1},
    {2, 2, 1}, {0, 2, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}};
static const uint8_t wedge[][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {0, 2, 2},
                                   {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2},
                                   {0, 0, 1}, {2, 0, 1}, {0, 2, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
/* The third coordinate is the height; the others are those of the base, seen from the apex. */
static const uint8_t pyramid[][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 2},
                                     {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {0, 0, 1},
                                     {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {1, 1, 0}};
static const uint8_t voxel[] = {0, 1, 3, 2, 4, 5, 7, 6};

/* Of Lagrange's cells, which have any order, the pyramid that Gmsh has of order 2. */
static const cell_type types[CELL_TYPES] = {
    {"tetra", 10, 4, FAMILY_TETRA, NULL, NULL},
    {"voxel", 11, 8, FAMILY_HEXAHEDRON, voxel, NULL},
    {"hexahedron", 12, 8, FAMILY_HEXAHEDRON, NULL, NULL},
    {"wedge", 13, 6, FAMILY_WEDGE, NULL, wedge},
    {"pyramid", 14, 5, FAMILY_PYRAMID, NULL, pyramid},
    {"penta_prism", 15, 10, FAMILY_PRISM, NULL, NULL},
    {"hexa_prism", 16, 12, FAMILY_PRISM, NULL, NULL},
    {"tetra10", 24, 10, FAMILY_TETRA, NULL, tetra},
    {"hexahedron20", 25, 20, FAMILY_HEXAHEDRON, NULL, hexahedron},
    {"wedge15", 26, 15, FAMILY_WEDGE, NULL, wedge},
    {"pyramid13", 27, 13, FAMILY_PYRAMID, NULL, pyramid},
    {"hexahedron27", 29, 27, FAMILY_HEXAHEDRON, NULL, hexahedron},
    {"wedge12", 31, 12, FAMILY_WEDGE, NULL, wedge},
    {"wedge18", 32, 18, FAMILY_WEDGE, NULL, wedge},
    {"hexahedron24", 33, 24, FAMILY_HEXAHEDRON, NULL, hexahedron},
    {"polyhedron", VTK_POLYHEDRON, 0, FAMILY_POLYHEDRON, NULL, NULL},
    {"pyramid14", 74, 14, FAMILY_PYRAMID, NULL, pyramid},
};

const cell_type *ffd_cell_type(uint8_t number, size_t points)
{
    for (size_t t = 0; t < CELL_TYPES; t++)
        if (types[t].number == number && (types[t].points == 0 || types[t].points == points))
            return &types[t];
    return NULL;
}

const cell_type *ffd_cell_type_named(const char *name)
{
    static const char polyhedron[] = "polyhedron";
    const size_t length = sizeof polyhedron - 1;
    for (size_t t = 0; t < CELL_TYPES; t++)
        if (strcmp(types[t].name, name) == 0)
            return &types[t];
    if (strncmp(name, polyhedron, length) == 0 && name[length + strspn(name + length, "0123456789")] == '\0')
        return ffd_cell_type_named(polyhedron);
    return NULL;
}

size_t ffd_cell_type_corners(const cell_type *type)
{
    static const uint8_t corners[] = {
        [FAMILY_TETRA] = 4, [FAMILY_PYRAMID] = 5, [FAMILY_WEDGE] = 6, [FAMILY_HEXAHEDRON] = 8};
    return type->family == FAMILY_PRISM ? type->points : corners[type->family];
}

size_t ffd_cell_type_index(const cell_type *type)
{
    return (size_t)(type - types);
}
