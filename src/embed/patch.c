#include "embed/patch.h"
#include "base/memory.h"
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

/* What a half has of the whole but its points and bounds. */
static void inherit(const face_patch *whole, face_patch *half)
{
    half->rational = whole->rational;
    half->face = whole->face;
    memcpy(half->order, whole->order, sizeof half->order);
    memcpy(half->cell, whole->cell, sizeof half->cell);
    memcpy(half->lo, whole->lo, sizeof half->lo);
    memcpy(half->hi, whole->hi, sizeof half->hi);
}

/* De Casteljau's scheme at 1/2 (as in ffd_bezier_halve): the upper half arises in place. */
void ffd_patch_halve(const face_patch *whole, int f, face_patch *lower, face_patch *upper)
{
    const size_t stride = N * (f == 0 ? 1 : (size_t)whole->order[0]);
    const size_t next_line = N * (f == 0 ? (size_t)whole->order[0] : 1);
    const int order = whole->order[f], lines = whole->order[1 - f];
    const double middle = 0.5 * (whole->lo[f] + whole->hi[f]);
    inherit(whole, lower);
    inherit(whole, upper);
    memcpy(upper->points, whole->points,
           (size_t)whole->order[0] * (size_t)whole->order[1] * N * sizeof(double));
    for (int line = 0; line < lines; line++)
        for (int c = 0; c < N; c++) {
            double *high = upper->points + next_line * (size_t)line + c;
            double *low = lower->points + next_line * (size_t)line + c;
            for (int k = 0; k < order; k++) {
                low[(size_t)k * stride] = high[0];
                for (int i = 0; i + 1 < order - k; i++)
                    high[(size_t)i * stride] =
                        0.5 * high[(size_t)i * stride] + 0.5 * high[(size_t)(i + 1) * stride];
            }
        }
    lower->hi[f] = upper->lo[f] = middle;
    ffd_patch_measure(lower);
    ffd_patch_measure(upper);
}
