#include "io/gltf/read/gltf_drawing.h"
#include <math.h>
#include <stdio.h>

ffd_status ffd_gltf_drop_drawing(gltf_document *d, size_t m, size_t p, uint32_t value, ffd_error *error,
                                 const char *format, ...)
{
    gltf_primitive *const primitive = &d->model.meshes[m].primitives[p];
    char message[sizeof error->message];
    va_list arguments;
    va_start(arguments, format);
    ffd_status status = FFD_OK;
    if (ffd_gltf_has_extension(d, ffd_gltf_primitive_value(d, m, p), "KHR_draco_mesh_compression")) {
        vsnprintf(message, sizeof message, format, arguments);
        status = ffd_json_span_fail(&d->tree, value, d->name, FFD_E_INVALID, error, "%s", message);
    } else {
        status = ffd_gltf_note_flaw(d, value, error, format, arguments);
    }
    va_end(arguments);
    d->base.unknown_drawings++;
    primitive->mode = MODE_UNKNOWN;
    primitive->indices = -1;
    return status;
}

static ffd_status read_drawing(gltf_document *d, size_t m, size_t p, ffd_error *error)
{
    gltf_primitive *const primitive = &d->model.meshes[m].primitives[p];
    const uint32_t value = ffd_gltf_primitive_value(d, m, p);
    const uint32_t mode = ffd_json_span_member(&d->tree, value, "mode");
    double number;
    if (ffd_json_span_number(&d->tree, ffd_json_span_member(&d->tree, value, "indices"), &number))
        primitive->indices = (int)number;
    primitive->mode = MODE_TRIANGLES;
    if (!ffd_json_span_number(&d->tree, mode, &number))
        return FFD_OK;
    if (number >= MODE_POINTS && number <= MODE_FAN && floor(number) == number) {
        primitive->mode = (int)number;
        return FFD_OK;
    }
    return ffd_gltf_drop_drawing(
        d, m, p, mode, error, "a mode is from 0 to 6, not %g: what the primitive draws is not known", number);
}

ffd_status ffd_gltf_read_drawings(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && status == FFD_OK; p++)
            status = read_drawing(d, m, p, error);
    return status;
}
