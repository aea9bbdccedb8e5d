/* sheet.h - the triangles of a sheet of squares. */
#ifndef FFD_TESTS_SHEET_H
#define FFD_TESTS_SHEET_H

#include <stdint.h>
#include <string.h>

/* Fills the triangles of side * side points in rows: 2 * (side - 1) * (side - 1) triangles of 3 corners. */
static inline void sheet_triangles(uint32_t side, uint32_t *triangles)
{
    for (uint32_t y = 0; y + 1 < side; y++)
        for (uint32_t x = 0; x + 1 < side; x++) {
            const uint32_t i = y * side + x;
            const uint32_t square[6] = {i, i + 1, i + side, i + 1, i + side + 1, i + side};
            memcpy(triangles, square, sizeof square);
            triangles += 6;
        }
}

#endif
