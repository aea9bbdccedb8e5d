#include "io/gltf/read/gltf_users.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_index_table.h"

static void mark_number(const gltf_document *d, uint32_t value, bool *used)
{
    double number;
    if (ffd_json_tree_number(&d->tree, value, &number) && number >= 0 &&
        number < (double)d->model.accessor_count)
        used[(size_t)number] = true;
}

void ffd_gltf_mark_animation(const gltf_document *d, uint32_t animation, bool *used)
{
    const json_tree *tree = &d->tree;
    const uint32_t samplers = ffd_json_tree_member(tree, animation, "samplers");
    for (uint32_t s = ffd_json_tree_first(tree, samplers); s != JSON_NONE; s = ffd_json_tree_after(tree, s)) {
        mark_number(d, ffd_json_tree_member(tree, s, "input"), used);
        mark_number(d, ffd_json_tree_member(tree, s, "output"), used);
    }
}

static void mark_skins(const gltf_document *d, bool *used)
{
    const uint32_t skins = ffd_json_tree_member(&d->tree, 0, "skins");
    for (uint32_t s = ffd_json_tree_first(&d->tree, skins); s != JSON_NONE;
         s = ffd_json_tree_after(&d->tree, s))
        mark_number(d, ffd_json_tree_member(&d->tree, s, "inverseBindMatrices"), used);
}

/* Where the accessors that extensions name are marked. */
typedef struct marks {
    const gltf_document *document;
    bool *used;
} marks;

static void mark_extension(void *context, const gltf_index_place *place)
{
    const marks *m = context;
    const gltf_document *d = m->document;
    const size_t accessor = ffd_gltf_index(d, place->value, d->model.accessor_count);
    const bool follows = place->kind == GLTF_INDEX_SHAPE && ffd_gltf_mesh_has_slot(d, place->owner, accessor);
    if (accessor != GLTF_NONE && !follows &&
        (place->kind == GLTF_INDEX_ACCESSOR || place->kind == GLTF_INDEX_SHAPE))
        m->used[accessor] = true;
}

static void mark_primitive(const gltf_primitive *primitive, bool *used)
{
    for (size_t i = 0; i < primitive->attribute_count; i++)
        if (primitive->attributes[i].semantic == GLTF_OTHER)
            used[primitive->attributes[i].accessor] = true;
    for (size_t i = 0; i < primitive->target_attribute_count; i++)
        if (primitive->targets[i].semantic == GLTF_OTHER)
            used[primitive->targets[i].accessor] = true;
    if (primitive->indices >= 0)
        used[primitive->indices] = true;
}

void ffd_gltf_mark_rig_users(const gltf_document *d, const gltf_values *but, bool *used)
{
    const uint32_t animations = ffd_json_tree_member(&d->tree, 0, "animations");
    for (uint32_t a = ffd_json_tree_first(&d->tree, animations); a != JSON_NONE;
         a = ffd_json_tree_after(&d->tree, a))
        if (!ffd_gltf_is_among(but, a))
            ffd_gltf_mark_animation(d, a, used);
    mark_skins(d, used);
}

void ffd_gltf_mark_other_users(const gltf_document *d, bool *used)
{
    for (size_t i = 0; i < d->model.primitive_count; i++)
        mark_primitive(&d->model.primitives[i], used);
    ffd_gltf_visit_indices(d, mark_extension, &(marks){d, used});
}

/* Whether the key of a value makes it the index of a bufferView: in images, sparse and compressed data, and
   in property tables of EXT_structural_metadata. */
static bool names_view(const json_tree *tree, uint32_t value)
{
    static const char *const keys[] = {"bufferView", "values", "arrayOffsets", "stringOffsets"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (ffd_json_tree_key_is(tree, value, keys[i]))
            return true;
    return false;
}

/* Whether the value is a member of an accessor, or of its sparse indices or values. */
static bool is_of_accessor(const json_tree *tree, uint32_t value, uint32_t accessors)
{
    const uint32_t above = tree->values[tree->values[value].parent].parent;
    if (above == accessors)
        return true;
    return above != JSON_NONE && ffd_json_tree_key_is(tree, above, "sparse") &&
           tree->values[tree->values[above].parent].parent == accessors;
}

void ffd_gltf_mark_other_views(const gltf_document *d, bool *used)
{
    const json_tree *const tree = &d->tree;
    const uint32_t accessors = ffd_json_tree_member(tree, 0, "accessors");
    for (uint32_t v = 1; v < tree->count; v++) {
        double view;
        if (tree->values[v].kind != JSON_NUMBER || !names_view(tree, v) || is_of_accessor(tree, v, accessors))
            continue;
        if (ffd_json_tree_number(tree, v, &view) && view >= 0 && view < (double)d->model.view_count)
            used[(size_t)view] = true;
    }
}

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
    for (size_t i = 0; i < d->model.primitive_count; i++)
        count_primitive(&d->model.primitives[i], users);
    ffd_free(others);
    return users;
}
