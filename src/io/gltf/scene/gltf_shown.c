#include "io/gltf/scene/gltf_shown.h"
#include "base/vector/vec.h"
#include "io/gltf/decode/gltf_read.h"

/* Vectors read at a time. */
#define BLOCK ((size_t)64)

static void add_offsets(const gltf_document *d, size_t accessor, double weight, size_t first, size_t count,
                        size_t components, double *values)
{
    double offsets[3 * BLOCK];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        ffd_gltf_read(d, accessor, first + at, size, 3, offsets);
        for (size_t i = 0; i < size; i++)
            for (size_t c = 0; c < 3; c++)
                values[components * (at + i) + c] += weight * offsets[3 * i + c];
    }
}

static void make_units(size_t count, size_t components, double *values)
{
    for (size_t i = 0; i < count; i++, values += components) {
        const double length = vec_length(values);
        for (int c = 0; c < 3 && length > 0; c++)
            values[c] /= length;
    }
}

void ffd_gltf_read_shown(const gltf_document *d, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, size_t components, double *values)
{
    const mesh_part *const shown = &d->mesh_parts[part];
    bool any = false;
    ffd_gltf_read(d, d->parts[part].streams[semantic].accessor, first, count, components, values);
    if (!d->base.shown || !shown->shows_shapes)
        return;
    for (size_t s = 0; s < shown->shape_count; s++) {
        const gltf_part *const target = &d->parts[d->base.part_count + d->parts[part].first_shape + s];
        if (!shown->shapes[s].has[semantic] || shown->shapes[s].weight == 0)
            continue;
        any = true;
        add_offsets(d, target->streams[semantic].accessor, shown->shapes[s].weight, first, count, components,
                    values);
    }
    if (any && semantic != GLTF_POSITION)
        make_units(count, components, values);
}
