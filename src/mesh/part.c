#include "base/vec.h"
#include "mesh/mesh.h"

void ffd_part_place(const mesh_part *part, double *points, size_t count)
{
    if (part->identity)
        return;
    for (size_t i = 0; i < count; i++) {
        mat_apply(part->linear, points + 3 * i, points + 3 * i);
        for (int a = 0; a < 3; a++)
            points[3 * i + (size_t)a] += part->offset[a];
    }
}
