#include "splat/harmonics.h"

typedef double number;
#include "splat/harmonics_turn.h"

void ffd_harmonics_values(int degree, const double direction[3], double values[7])
{
    find_values(degree, direction, values);
}

/* Reverses directions, which changes the sign of odd degrees. */
static void reverse(int first, int count, harmonics_block c)
{
    for (int k = 0; k < HARMONICS_CHANNELS; k++)
        for (int m = first; m < first + count; m++)
            c[k][m] = -c[k][m];
}

static void mirror(const splat_turn *turn, int degree, harmonics_block c)
{
    if (turn->is_mirrored && degree >= 1)
        reverse(0, 3, c);
    if (turn->is_mirrored && degree >= 3)
        reverse(8, 7, c);
}

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = ffd_harmonics_kernel_##set,
static harmonics_kernel *const kernels[] = {[FFD_ISA_SCALAR] = NULL, FOR_EACH_SIMD(ROW)};

/* Number of splats in a run. */
#define RUN ((size_t)16)

void ffd_harmonics_turn(ffd_isa isa, const splat_turn *turns, int degree, size_t count, harmonics_block *c)
{
    harmonics_kernel *const kernel = kernels[ffd_isa_resolve(isa)];
    double rotations[RUN][9];
    for (size_t first = 0; first < count; first += RUN) {
        const size_t some = count - first < RUN ? count - first : RUN;
        for (size_t i = 0; i < some; i++)
            ffd_splat_matrix(turns[first + i].quaternion, rotations[i]);
        for (size_t i = kernel ? kernel(rotations, degree, some, c + first) : 0; i < some; i++)
            turn_degrees(rotations[i], degree, c[first + i]);
        for (size_t i = 0; i < some; i++)
            mirror(&turns[first + i], degree, c[first + i]);
    }
}
