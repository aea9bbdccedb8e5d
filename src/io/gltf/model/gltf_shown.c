#include "io/gltf/model/gltf_shown.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_shapes.h"
#include "io/gltf/read/gltf_read.h"

/* Vectors read at a time. */
#define BLOCK ((size_t)64)

/* Adds offsets of up to four components to values of `stride` numbers each. */
static void add_offsets(const gltf_document *d, size_t accessor, double weight, size_t first, size_t count,
                        size_t components, size_t stride, double *values)
{
    double offsets[4 * BLOCK];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        ffd_gltf_read(d, accessor, first + at, size, components, offsets);
        for (size_t i = 0; i < size; i++)
            for (size_t c = 0; c < components; c++)
                values[stride * (at + i) + c] += weight * offsets[components * i + c];
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
        add_offsets(d, target->streams[semantic].accessor, shown->shapes[s].weight, first, count, 3,
                    components, values);
    }
    if (any && semantic != GLTF_POSITION)
        make_units(count, components, values);
}

/* Returns the accessor of a morph target's attribute; GLTF_NONE if it is absent or does not fit. */
static size_t find_offsets(const gltf_document *d, uint32_t target, const char *name, size_t count,
                           size_t components)
{
    double number;
    if (!ffd_json_span_number(&d->tree, ffd_json_span_member(&d->tree, target, name), &number) ||
        !(number >= 0) || !(number < (double)d->model.accessor_count))
        return GLTF_NONE;
    const size_t a = (size_t)number;
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const bool fits = accessor->columns == 1 && (size_t)accessor->rows >= components &&
                      accessor->count >= count && d->layouts[a].readable;
    return fits ? a : GLTF_NONE;
}

bool ffd_gltf_add_shapes(const gltf_document *d, size_t m, size_t p, size_t node, const char *name,
                         size_t count, size_t components, size_t stride, double *values)
{
    const uint32_t targets = ffd_json_span_member(&d->tree, ffd_gltf_primitive_value(d, m, p), "targets");
    uint32_t weight = d->base.shown ? ffd_gltf_first_weight(d, m, node) : JSON_NONE;
    bool any = false;
    for (uint32_t target = ffd_json_span_first(&d->tree, targets); target != JSON_NONE && weight != JSON_NONE;
         target = ffd_json_span_after(&d->tree, target), weight = ffd_json_span_after(&d->tree, weight)) {
        const size_t a = find_offsets(d, target, name, count, components);
        double number;
        if (a == GLTF_NONE || !ffd_gltf_weight(d, weight, &number) || number == 0)
            continue;
        any = true;
        if (values)
            add_offsets(d, a, number, 0, count, components, stride, values);
    }
    return any;
}
