#include "embed/boundary/patch.h"
#include "base/memory/memory.h"
#include "embed/frame/bezier_box.h"
#include <string.h>

enum { N = PATCH_COMPONENTS };

face_patch *ffd_patch_create(const int order[2], bool rational)
{
    const size_t count = (size_t)order[0] * (size_t)order[1];
    face_patch *made = ffd_alloc(1, sizeof *made + count * N * sizeof(double));
    if (!made)
        return NULL;
    memset(made, 0, sizeof *made);
    memcpy(made->order, order, sizeof made->order);
    made->rational = rational;
    made->hi[0] = made->hi[1] = 1;
    return made;
}

/* Copies the members that a half has in common with the whole patch: all except points and bounds. */
static void inherit(const face_patch *whole, face_patch *half)
{
    half->rational = whole->rational;
    half->face = whole->face;
    memcpy(half->order, whole->order, sizeof half->order);
    memcpy(half->cell, whole->cell, sizeof half->cell);
    memcpy(half->lo, whole->lo, sizeof half->lo);
    memcpy(half->hi, whole->hi, sizeof half->hi);
}

void ffd_patch_split(const face_patch *whole, int f, face_patch *lower, face_patch *upper)
{
    const size_t order = (size_t)whole->order[f], inner = N * (f == 0 ? 1 : (size_t)whole->order[0]),
                 size = N * (size_t)whole->order[0] * (size_t)whole->order[1];
    const double middle = 0.5 * (whole->lo[f] + whole->hi[f]);
    inherit(whole, lower);
    inherit(whole, upper);
    memcpy(upper->points, whole->points, size * sizeof(double));
    for (size_t slab = 0; slab < size; slab += order * inner)
        ffd_bezier_halve_lines(order, inner, lower->points + slab, upper->points + slab);
    lower->hi[f] = upper->lo[f] = middle;
}

void ffd_patch_halve(const face_patch *whole, int f, face_patch *lower, face_patch *upper)
{
    ffd_patch_split(whole, f, lower, upper);
    ffd_patch_measure(lower);
    ffd_patch_measure(upper);
}
