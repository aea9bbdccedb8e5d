/* jitter.c - ffd_lattice_jitter: seeded noise on the control points. */
#include "author/made.h"
#include "lattice/noise.h"
#include <ffd/author.h>
#include <math.h>

ffd_status ffd_lattice_jitter(const ffd_lattice *lattice, const double sigma[3], uint64_t seed,
                              ffd_lattice **result, ffd_error *error)
{
    made_lattice made = {0};
    ffd_status status = FFD_OK;
    *result = NULL;
    for (int c = 0; c < 3; c++)
        if (!(sigma[c] >= 0) || !isfinite(sigma[c]))
            return ffd_fail(error, FFD_E_ARGUMENT, "sigma %g is not a finite number from 0 on", sigma[c]);
    if (seed > NOISE_MOST_SEED)
        return ffd_fail(error, FFD_E_ARGUMENT, "the seed is above %llu", (unsigned long long)NOISE_MOST_SEED);
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    for (size_t i = 0; i < lattice->count; i++)
        for (int c = 0; c < 3; c++)
            made.offsets[3 * i + (size_t)c] += sigma[c] * noise_at(seed, i, c);
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}
