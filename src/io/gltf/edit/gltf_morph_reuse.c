#include "io/gltf/edit/gltf_morph_reuse.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_accessor_users.h"

static void add_user(unsigned char *users, int accessor)
{
    if (accessor >= 0 && users[accessor] < 2)
        users[accessor]++;
}

static void count_primitive(const gltf_primitive *primitive, unsigned char *users)
{
    const size_t slots = gltf_slot_count(primitive);
    for (size_t slot = 0; slot < slots; slot++)
        add_user(users, gltf_slot_accessor(primitive, slot));
}

unsigned char *ffd_gltf_count_users(const gltf_document *d, const gltf_values *but)
{
    const size_t count = d->model.accessor_count;
    unsigned char *const users = ffd_alloc_zero(count, sizeof *users);
    bool *const others = ffd_alloc_zero(count, sizeof *others);
    if (!users || !others) {
        ffd_free(users);
        ffd_free(others);
        return NULL;
    }
    ffd_gltf_mark_other_users(d, others);
    ffd_gltf_mark_rig_users(d, but, others);
    for (size_t a = 0; a < count; a++)
        users[a] = others[a] ? 2 : 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++)
            count_primitive(&d->model.meshes[m].primitives[p], users);
    ffd_free(others);
    return users;
}

/* Whether every selected use of the primitive has results. Where a use has none the old offsets stay, which
   is right only for a use that is not selected. */
static bool has_results(const gltf_document *d, const gltf_morph *morph, const morph_place *place)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, place->mesh, place->primitive);
    const size_t uses = d->mesh_uses[place->mesh].node_count;
    for (size_t n = 0; n < uses; n++) {
        const size_t part = instances[n].part[place->semantic];
        if (instances[n].selected &&
            (part == GLTF_NONE || !ffd_gltf_morph_result(morph, part, place->semantic)))
            return false;
    }
    return uses > 0;
}

bool ffd_gltf_is_partly_selected(const gltf_document *d, size_t mesh, size_t primitive)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, mesh, primitive);
    for (size_t n = 0; n < d->mesh_uses[mesh].node_count; n++)
        if (!instances[n].selected)
            return true;
    return false;
}

bool ffd_gltf_can_reuse(const gltf_document *d, const unsigned char *users, const morph_place *place,
                        const gltf_document *source, const gltf_morph *morph)
{
    const gltf_primitive *const primitive = &d->model.meshes[place->mesh].primitives[place->primitive];
    const int number = primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    if (number < 0)
        return false;
    const gltf_accessor *const accessor = &d->model.accessors[number];
    const gltf_layout *const layout = &d->layouts[number];
    const bool is_own =
        users[number] == 1 && !accessor->sparse.present && accessor->view >= 0 && layout->data;
    return accessor->component == GLTF_FLOAT && accessor->columns == 1 && accessor->rows == 3 &&
           (is_own || ffd_gltf_is_partly_selected(source, place->mesh, place->primitive)) &&
           accessor->count == d->model.accessors[primitive->accessor[place->semantic]].count &&
           layout->readable && layout->packing == GLTF_PLAIN && has_results(source, morph, place);
}
