#include "io/gltf/read/gltf_rounding.h"
#include "mesh/meshopt/meshopt_view.h"
#include <math.h>

/* The distance between neighbouring numbers of an integer type (glTF 2.0, 3.11: c / 127 and so on). */
static double integer_step(const gltf_accessor *accessor)
{
    if (!accessor->normalized)
        return 1;
    switch (accessor->component) {
    case GLTF_I8:
        return 1.0 / 127;
    case GLTF_U8:
        return 1.0 / 255;
    case GLTF_I16:
        return 1.0 / 32767;
    case GLTF_U16:
        return 1.0 / 65535;
    default:
        return 1.0 / 4294967295.0;
    }
}

/* The steps of floats that meshopt's filter EXPONENTIAL has quantized. */
static void filter_steps(const gltf_document *d, size_t a, double step[3])
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const int8_t *exponents = accessor->view >= 0 ? d->view_exponents[accessor->view] : NULL;
    const size_t column = (size_t)(accessor->offset % d->layouts[a].stride) / 4;
    for (size_t c = 0; exponents && !accessor->sparse.present && c < 3 && column + c < MESHOPT_COLUMNS; c++)
        step[c] = ldexp(1, exponents[column + c]);
}

mesh_rounding ffd_gltf_rounding(const gltf_document *d, size_t a)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    mesh_rounding rounding = {{false, false, false}, {0, 0, 0}};
    const bool is_float = accessor->component == GLTF_FLOAT;
    for (int c = 0; c < 3; c++) {
        rounding.is_float[c] = is_float;
        rounding.step[c] = is_float ? d->unpacked[a].step : integer_step(accessor);
    }
    if (is_float && d->layouts[a].packing == GLTF_MESHOPT)
        filter_steps(d, a, rounding.step);
    return rounding;
}
