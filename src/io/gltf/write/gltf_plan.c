#include "io/gltf/write/gltf_plan.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_elements.h"

/* Returns the part with the results of a slot; GLTF_NONE: no results. */
static size_t part_of_slot(const gltf_document *d, const gltf_primitive *primitive,
                           const gltf_instance *instance, size_t slot)
{
    const size_t vectors = gltf_vector_slots(primitive);
    if (slot < GLTF_DEFORMED)
        return instance->part[slot];
    if (slot < vectors)
        return d->targets[instance->first_target + slot / GLTF_DEFORMED - 1];
    return instance->first_splat == GLTF_NONE ? GLTF_NONE
                                              : instance->first_splat + (slot - vectors) / GLTF_DEFORMED;
}

size_t ffd_gltf_version_at(const gltf_document *d, const gltf_plan *plan, const gltf_primitive *primitive,
                           size_t slot, size_t use)
{
    if (use == GLTF_NONE)
        return GLTF_NONE;
    const gltf_instance *instance = &ffd_gltf_instances(d, primitive)[use];
    const size_t owner = instance->part[GLTF_POSITION];
    if (!instance->selected && !(owner != GLTF_NONE && d->mesh_parts[owner].carried))
        return GLTF_NONE;
    const size_t part = part_of_slot(d, primitive, instance, slot);
    return part == GLTF_NONE ? GLTF_NONE : plan->part_versions[part * GLTF_DEFORMED + slot % GLTF_DEFORMED];
}

void ffd_gltf_version_encode(const gltf_document *d, const gltf_version *version, size_t i,
                             unsigned char *element)
{
    for (size_t c = 0; c < version->width; c++)
        store_float(element + 4 * c, version->values[version->width * i + c]);
    if (version->width == 0)
        ffd_gltf_encode(&d->model.accessors[version->accessor], version->component,
                        ffd_gltf_element(d, version->accessor, i), version->values + version->components * i,
                        version->components, element);
}

void ffd_gltf_free_plan(gltf_plan *plan)
{
    ffd_free(plan->content_versions);
    ffd_free(plan->versions);
    ffd_free(plan->part_versions);
    ffd_free(plan->base_uses);
    ffd_free(plan->copies);
    ffd_free(plan->changes);
    ffd_free(plan->in_place);
    ffd_free(plan->appended);
    *plan = (gltf_plan){0};
}
