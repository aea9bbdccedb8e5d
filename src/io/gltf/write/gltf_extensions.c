/* gltf_extensions.c - finds the extensions that the output no longer needs. */
#include "io/gltf/write/gltf_extensions.h"
#include "base/memory/memory.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_unpack.h"
#include <string.h>

#define TEXCOORD "TEXCOORD_"

/* Whether glTF 2.0 itself (3.7.2.1) does not allow this type for the attribute. */
static bool needs_quantization(const char *attribute, int component, bool normalized)
{
    if (component == GLTF_FLOAT)
        return false;
    for (int s = 0; s < GLTF_DEFORMED; s++)
        if (strcmp(attribute, ffd_gltf_semantic_names[s]) == 0)
            return true;
    return strncmp(attribute, TEXCOORD, sizeof TEXCOORD - 1) == 0 &&
           !(normalized && (component == GLTF_U8 || component == GLTF_U16));
}

/* The attributes of a primitive, or of one of its morph targets, for one use of its mesh. */
typedef struct attribute_set {
    size_t mesh, p, use;
    size_t first_slot;
    uint32_t attributes; /* a JSON value */
} attribute_set;

/* Returns the component type of an attribute in the output. accessor: its accessor in the input. */
static int output_component(const gltf_saver *saver, const attribute_set *set, const char *attribute,
                            const gltf_accessor *accessor)
{
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const size_t version = ffd_gltf_version_at(saver->document, &saver->plan, set->mesh, set->p,
                                                   set->first_slot + s, set->use);
        if (strcmp(attribute, ffd_gltf_semantic_names[s]) == 0 && version != GLTF_NONE)
            return saver->plan.versions[version].component;
    }
    return accessor->component;
}

static bool are_quantized(gltf_saver *saver, const attribute_set *set)
{
    const gltf_document *d = saver->document;
    for (uint32_t v = ffd_json_span_first(&d->tree, set->attributes); v != JSON_NONE;
         v = ffd_json_span_after(&d->tree, v)) {
        double number;
        char *name = ffd_json_span_key(&d->tree, v);
        if (!name || !ffd_json_span_number(&d->tree, v, &number)) {
            saver->edits.failed = true;
            ffd_free(name);
            return true;
        }
        const gltf_accessor *accessor = &d->model.accessors[(size_t)number];
        const bool needed =
            needs_quantization(name, output_component(saver, set, name, accessor), accessor->normalized);
        ffd_free(name);
        if (needed)
            return true;
    }
    return false;
}

static bool is_quantized_mesh(gltf_saver *saver, size_t mesh, size_t use)
{
    const gltf_document *d = saver->document;
    for (size_t p = 0; p < d->model.meshes[mesh].primitive_count; p++) {
        const uint32_t primitive = ffd_gltf_primitive_value(d, mesh, p);
        const uint32_t targets = ffd_json_span_member(&d->tree, primitive, "targets");
        attribute_set set = {mesh, p, use, 0, ffd_json_span_member(&d->tree, primitive, "attributes")};
        if (are_quantized(saver, &set))
            return true;
        for (uint32_t t = ffd_json_span_first(&d->tree, targets); t != JSON_NONE;
             t = ffd_json_span_after(&d->tree, t)) {
            set.first_slot += GLTF_DEFORMED;
            set.attributes = t;
            if (are_quantized(saver, &set))
                return true;
        }
    }
    return false;
}

/* Whether some accessor became floats and no other accessor needs the extension. */
static bool lost_quantization(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    bool lost = false;
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *version = &saver->plan.versions[saver->plan.appended[i]];
        lost = lost ||
               (version->width == 0 && version->component != d->model.accessors[version->accessor].component);
    }
    for (size_t m = 0; m < d->model.mesh_count && lost; m++)
        lost = !is_quantized_mesh(saver, m, saver->plan.base_uses[m]);
    for (size_t i = 0; i < saver->plan.copy_count && lost; i++)
        lost = !is_quantized_mesh(saver, saver->plan.copies[i].mesh, saver->plan.copies[i].use);
    return lost;
}

/* Removes the names from a list. An empty list is not valid glTF: a list that would become empty is added to
   `empty` instead. Returns how many were added. */
static size_t take_out(gltf_saver *saver, const char *key, const char *const *names, size_t name_count,
                       uint32_t *empty)
{
    const json_span *tree = &saver->document->tree;
    const uint32_t list = ffd_json_span_member(tree, 0, key);
    if (list == JSON_NONE || tree->values[list].count == 0)
        return 0;
    uint32_t *gone = ffd_alloc(tree->values[list].count, sizeof *gone);
    size_t count = 0;
    if (!gone) {
        saver->edits.failed = true;
        return 0;
    }
    for (uint32_t v = ffd_json_span_first(tree, list); v != JSON_NONE; v = ffd_json_span_after(tree, v))
        for (size_t i = 0; i < name_count; i++)
            if (ffd_json_span_string_is(tree, v, names[i])) {
                gone[count++] = v;
                break;
            }
    const bool all = count == tree->values[list].count;
    if (all)
        *empty = list;
    else
        ffd_edits_remove(&saver->edits, tree, list, gone, count);
    ffd_free(gone);
    return all;
}

void ffd_gltf_drop_extensions(gltf_saver *saver)
{
    static const struct {
        const char *name;
        bool (*is_lost)(gltf_saver *saver);
    } known[] = {{"KHR_mesh_quantization", lost_quantization},
                 {"KHR_draco_mesh_compression", ffd_gltf_lost_draco},
                 {"EXT_meshopt_compression", ffd_gltf_lost_ext_meshopt},
                 {"KHR_meshopt_compression", ffd_gltf_lost_khr_meshopt}};
    const char *names[sizeof known / sizeof *known];
    size_t name_count = 0, empty_count = 0;
    uint32_t empty[2];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].is_lost(saver))
            names[name_count++] = known[i].name;
    if (name_count == 0)
        return;
    empty_count += take_out(saver, "extensionsUsed", names, name_count, &empty[empty_count]);
    empty_count += take_out(saver, "extensionsRequired", names, name_count, &empty[empty_count]);
    ffd_edits_remove(&saver->edits, &saver->document->tree, 0, empty, empty_count);
}
