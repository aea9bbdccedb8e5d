#include "io/write/glb_origin.h"
#include "base/memory/memory.h"
#include "mesh/precision.h"
#include <string.h>

/* Of the step of floats, relative to the diagonal of all. */
#define STEP_TOLERANCE 1e-6

/* Returns the exponent of the smallest power of two greater than size. */
static int exponent_above(double size)
{
    int exponent;
    frexp(size, &exponent);
    return exponent;
}

static double farthest_from(const ffd_bounds *box, const double from[3])
{
    double farthest = 0;
    for (int a = 0; a < 3; a++)
        farthest = larger_of(farthest, larger_of(from[a] - box->min[a], box->max[a] - from[a]));
    return farthest;
}

/* Fills the translation of what lies in a box: `common` if the step of floats at the largest coordinate
   relative to it is at most tolerance times the diagonal, else one of its own. */
static void choose(const ffd_bounds *box, const double common[3], double tolerance, double origin[3])
{
    static const double zero[3] = {0, 0, 0};
    double sides[3];
    for (int a = 0; a < 3; a++)
        sides[a] = box->max[a] - box->min[a];
    memcpy(origin, common, 3 * sizeof *origin);
    const double diagonal = vec_length(sides);
    if (!(diagonal > 0) || !(box->min[0] <= box->max[0]) ||
        ldexp(1, exponent_above(farthest_from(box, common)) - FLT_MANT_DIG) <= tolerance * diagonal)
        return;
    /* Multiples smaller than a double's step cannot be distinguished. */
    const int step = exponent_above(farthest_from(box, zero)) - DBL_MANT_DIG,
              above = exponent_above(diagonal);
    const double unit = ldexp(1, above > step ? above : step);
    for (int a = 0; a < 3; a++)
        origin[a] = unit * floor((box->min[a] / 2 + box->max[a] / 2) / unit + 0.5) + 0.0; /* + 0.0: no -0 */
}

/* Extends the bounds by the written vertices of a primitive. */
static void widen(const glb_plan *plan, const glb_primitive *primitive, ffd_bounds *box)
{
    for (size_t i = 0; i < primitive->vertex_count; i++)
        ffd_bounds_widen(box, plan->model->positions +
                                  3 * (size_t)plan->vertices[primitive->first_vertex + i].position);
}

ffd_status ffd_glb_origins(const glb_plan *plan, double **origins, ffd_error *error)
{
    static const double zero[3] = {0, 0, 0};
    const size_t count = plan->meshes.count;
    double common[3];
    ffd_bounds all = ffd_bounds_empty();
    ffd_bounds *const boxes = ffd_alloc(count, sizeof *boxes);
    *origins = ffd_alloc(3 * count, sizeof **origins);
    if (!boxes || !*origins) {
        ffd_free(boxes);
        return ffd_fail_memory(error);
    }
    for (size_t m = 0; m < count; m++)
        boxes[m] = ffd_bounds_empty();
    for (size_t i = 0; i < plan->primitive_count; i++)
        widen(plan, &plan->primitives[i], &boxes[plan->primitives[i].mesh]);
    for (size_t m = 0; m < count; m++)
        ffd_bounds_join(&all, &boxes[m]);
    choose(&all, zero, STEP_TOLERANCE, common);
    for (size_t m = 0; m < count; m++)
        choose(&boxes[m], common, 2 * PART_TOLERANCE, *origins + 3 * m);
    ffd_free(boxes);
    return FFD_OK;
}
