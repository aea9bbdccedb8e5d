#include "io/write/glb_origin.h"
#include "base/vector/vec.h"
#include <float.h>
#include <math.h>

/* Relative to the diagonal. */
#define STEP_TOLERANCE 1e-6

/* Finds the bounds of the written vertices. */
static void find_bounds(const glb_plan *plan, double least[3], double largest[3])
{
    for (size_t i = 0; i < plan->vertex_count; i++) {
        const double *position = plan->model->positions + 3 * (size_t)plan->vertices[i].position;
        for (int a = 0; a < 3; a++) {
            least[a] = i == 0 ? position[a] : lesser_of(least[a], position[a]);
            largest[a] = i == 0 ? position[a] : larger_of(largest[a], position[a]);
        }
    }
}

/* Returns the exponent of the smallest power of two greater than size. */
static int exponent_above(double size)
{
    int exponent;
    frexp(size, &exponent);
    return exponent;
}

bool ffd_glb_origin(const glb_plan *plan, double origin[3])
{
    double least[3] = {0, 0, 0}, largest[3] = {0, 0, 0}, sides[3], farthest = 0;
    find_bounds(plan, least, largest);
    for (int a = 0; a < 3; a++) {
        origin[a] = 0;
        sides[a] = largest[a] - least[a];
        farthest = larger_of(farthest, larger_of(-least[a], largest[a]));
    }
    const double diagonal = vec_length(sides);
    const int far = exponent_above(farthest);
    if (!(diagonal > 0) || ldexp(1, far - FLT_MANT_DIG) <= STEP_TOLERANCE * diagonal)
        return false;
    /* Multiples smaller than a double's step cannot be distinguished. */
    const int step = far - DBL_MANT_DIG, above = exponent_above(diagonal);
    const double unit = ldexp(1, above > step ? above : step);
    for (int a = 0; a < 3; a++)
        origin[a] = unit * floor((least[a] / 2 + largest[a] / 2) / unit + 0.5) + 0.0; /* + 0.0: no -0 */
    return true;
}
