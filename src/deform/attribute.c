/* attribute.c - normals and tangents under the deformation gradient F = I + gradient (src/maths.md 9.1). */
#include "deform/attribute.h"
#include "base/vector/vec.h"
#include <float.h>
#include <string.h>

static bool is_zero(const double gradient[9])
{
    for (int i = 0; i < 9; i++)
        if (gradient[i] != 0)
            return false;
    return true;
}

/* Files contain normals that are 0 or not finite. They stay as they are, and do not count as collapsed. */
static bool has_direction(const double v[3])
{
    return vec_is_finite(v) && (v[0] != 0 || v[1] != 0 || v[2] != 0);
}

/* Copies v to result. */
static ffd_direction_outcome keep(const double v[3], double result[3], ffd_direction_outcome why)
{
    memmove(result, v, 3 * sizeof *result);
    return why;
}

/* Normalises `carried` into result. Keeps `before` if the length is not more than the rounding of the summed
   terms, whose magnitude is `scale`. */
static ffd_direction_outcome normalise(const double carried[3], double scale, const double before[3],
                                       double result[3])
{
    const double length = vec_length(carried);
    if (!(length > 16 * DBL_EPSILON * scale) || length > DBL_MAX)
        return keep(before, result, FFD_DIRECTION_COLLAPSED);
    for (int a = 0; a < 3; a++)
        result[a] = carried[a] / length;
    return FFD_DIRECTION_CARRIED;
}

ffd_direction_outcome ffd_deform_normal(const double gradient[9], const double normal[3], double result[3])
{
    double f[9], cofactor[9], carried[3];
    if (is_zero(gradient) || !has_direction(normal))
        return keep(normal, result, FFD_DIRECTION_KEPT);
    mat_add_identity(gradient, f);
    mat_cofactor(f, cofactor);
    mat_apply(cofactor, normal, carried);
    const double largest = mat_largest_entry(f);
    return normalise(carried, largest * largest * vec_length(normal), normal, result);
}

/* Transforms a tangent: F t, made perpendicular to normal unless that is NULL. */
static ffd_direction_outcome carry_tangent(const double gradient[9], const double tangent[3],
                                           const double *normal, double result[3])
{
    double f[9], carried[3];
    mat_add_identity(gradient, f);
    mat_apply(f, tangent, carried);
    if (normal) {
        const double along = vec_dot(carried, normal);
        for (int a = 0; a < 3; a++)
            carried[a] -= along * normal[a];
    }
    return normalise(carried, mat_largest_entry(f) * vec_length(tangent), tangent, result);
}

ffd_direction_outcome ffd_deform_tangent(const double gradient[9], const double tangent[3],
                                         const double normal[3], double result[3])
{
    if (is_zero(gradient) || !has_direction(tangent))
        return keep(tangent, result, FFD_DIRECTION_KEPT);
    return carry_tangent(gradient, tangent, normal, result);
}

ffd_direction_outcome ffd_tangent_of_normal(const double gradient[9], const double tangent[3],
                                            const double normal[3], double result[3])
{
    return carry_tangent(gradient, tangent, normal, result);
}

/* The kernels of an instruction set; NULL: use the functions for single directions. */
typedef struct attribute_way {
    attribute_kernel *normals, *tangents;
} attribute_way;

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = {ffd_normal_kernel_##set, ffd_tangent_kernel_##set},
static const attribute_way ways[] = {[FFD_ISA_SCALAR] = {NULL, NULL}, FOR_EACH_SIMD(ROW)};

static void try_kernel(attribute_kernel *kernel, const attribute_batch *batch)
{
    if (kernel)
        kernel(batch);
    else
        memset(batch->outcomes, DIRECTION_OPEN, batch->count);
}

void ffd_deform_normals(ffd_isa isa, const attribute_batch *batch)
{
    try_kernel(ways[ffd_isa_resolve(isa)].normals, batch);
    for (size_t i = 0; i < batch->count; i++) {
        double *const n = batch->directions + i * batch->step;
        if (batch->outcomes[i] != DIRECTION_OPEN)
            continue;
        batch->outcomes[i] = (uint8_t)ffd_deform_normal(attribute_gradient(batch, i), n, n);
    }
}

void ffd_deform_tangents(ffd_isa isa, const attribute_batch *batch)
{
    try_kernel(ways[ffd_isa_resolve(isa)].tangents, batch);
    for (size_t i = 0; i < batch->count; i++) {
        double *const t = batch->directions + i * batch->step;
        const double *const normal = batch->normals ? batch->normals + 3 * i : NULL;
        if (batch->outcomes[i] != DIRECTION_OPEN)
            continue;
        batch->outcomes[i] = (uint8_t)ffd_deform_tangent(attribute_gradient(batch, i), t, normal, t);
    }
}
