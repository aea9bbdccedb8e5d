#include "base/memory.h"
#include "io/gltf/gltf_document.h"
#include <string.h>

/* The first 3 components of each element, bit for bit. */
static void copy_original(const gltf_layout *layout, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++) {
        const unsigned char *at = layout->data + i * layout->stride;
        for (size_t c = 0; c < 3; c++) {
            const uint32_t bits = ffd_glb_read_u32(at + 4 * c);
            memcpy(to + 3 * i + c, &bits, sizeof bits);
        }
    }
}

static ffd_status make_result(gltf_document *d, size_t part, gltf_semantic semantic, ffd_error *error)
{
    gltf_stream *stream = &d->parts[part].streams[semantic];
    const size_t count = d->mesh_parts[part].vertex_count;
    if (stream->accessor == GLTF_NONE || stream->result)
        return FFD_OK;
    stream->result = ffd_alloc(count, 3 * sizeof *stream->result);
    if (!stream->result)
        return ffd_fail_memory(error);
    copy_original(&d->layouts[stream->accessor], count, stream->result);
    return FFD_OK;
}

ffd_status ffd_gltf_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    const bool wanted[GLTF_DEFORMED] = {true, normals, tangents};
    ffd_status status = ffd_gltf_refuse_read(d, error);
    if (status == FFD_OK)
        status = ffd_gltf_refuse_store(d, normals, tangents, error);
    for (size_t i = 0; i < d->base.part_count; i++)
        for (int s = 0; s < GLTF_DEFORMED && status == FFD_OK; s++)
            if (wanted[s] && !d->mesh_parts[i].skipped &&
                !(s == GLTF_POSITION && d->mesh_parts[i].repeats_positions))
                status = make_result(d, i, (gltf_semantic)s, error);
    return status;
}

static void write_result(mesh_document *document, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, const double *values, size_t components, const uint8_t *changed)
{
    float *result = ((gltf_document *)document)->parts[part].streams[semantic].result;
    if (!result)
        return;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3 && changed[i]; c++)
            result[3 * (first + i) + c] = (float)values[components * i + c];
}

void ffd_gltf_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                              const double *xyz, const uint8_t *changed)
{
    write_result(document, part, GLTF_POSITION, first, count, xyz, 3, changed);
}

void ffd_gltf_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                            const double *xyz, const uint8_t *changed)
{
    write_result(document, part, GLTF_NORMAL, first, count, xyz, 3, changed);
}

void ffd_gltf_write_tangents(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyzw, const uint8_t *changed)
{
    write_result(document, part, GLTF_TANGENT, first, count, xyzw, 4, changed);
}
