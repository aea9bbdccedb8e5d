#include "io/gltf/model/gltf_refuse.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_contents.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_views.h"
#include <string.h>

/* The effect of a required extension on the vertices. */
typedef enum extension_effect {
    EXTENSION_UNKNOWN,
    EXTENSION_APART,  /* none: no vertex is elsewhere or stored differently because of it */
    EXTENSION_READ,   /* supported where it is used */
    EXTENSION_PLACES, /* it places vertices, which is not supported */
    EXTENSION_HOLDS   /* it holds geometry in an unsupported form */
} extension_effect;

typedef struct known_extension {
    const char *name; /* a final '*' stands for any letters; the first match counts */
    extension_effect effect;
} known_extension;

/* The extensions of the registry (github.com/KhronosGroup/glTF, extensions, July 2026) with its archive and
   drafts, and others that widespread programs write. */
static const known_extension known[] = {
    {"KHR_accessor_float64", EXTENSION_HOLDS},
    {"KHR_animation_pointer", EXTENSION_READ},
    {"KHR_audio*", EXTENSION_APART},
    {"KHR_character*", EXTENSION_APART},
    {"KHR_collision_shapes", EXTENSION_APART},
    {"KHR_draco_mesh_compression", EXTENSION_READ},
    {"KHR_environment_map", EXTENSION_APART},
    {"KHR_gaussian_splatting", EXTENSION_READ},
    {"KHR_gaussian_splatting_compression_*", EXTENSION_HOLDS},
    {"KHR_implicit_shapes", EXTENSION_READ},
    {"KHR_interactivity", EXTENSION_APART},
    {"KHR_lights_*", EXTENSION_APART},
    {"KHR_materials_*", EXTENSION_APART},
    {"KHR_mesh_instancing", EXTENSION_PLACES},
    {"KHR_mesh_primitive_restart", EXTENSION_READ},
    {"KHR_mesh_quantization", EXTENSION_READ},
    {"KHR_meshopt_compression", EXTENSION_READ},
    {"KHR_node_hoverability", EXTENSION_APART},
    {"KHR_node_selectability", EXTENSION_APART},
    {"KHR_node_visibility", EXTENSION_READ},
    {"KHR_physics_rigid_bodies", EXTENSION_READ},
    {"KHR_rigid_bodies", EXTENSION_APART},
    {"KHR_spz_gaussian_splats_compression", EXTENSION_HOLDS},
    {"KHR_techniques_webgl", EXTENSION_APART},
    {"KHR_texture_*", EXTENSION_APART},
    {"KHR_xmp*", EXTENSION_APART},

    {"EXT_feature_metadata", EXTENSION_APART},
    {"EXT_implicit_*", EXTENSION_HOLDS},
    {"EXT_instance_features", EXTENSION_APART},
    {"EXT_lights_*", EXTENSION_APART},
    {"EXT_materials_*", EXTENSION_APART},
    {"EXT_mesh_features", EXTENSION_APART},
    {"EXT_mesh_gpu_instancing", EXTENSION_READ},
    {"EXT_mesh_manifold", EXTENSION_APART},
    {"EXT_mesh_polygon", EXTENSION_APART},
    {"EXT_mesh_primitive_edge_visibility", EXTENSION_APART},
    {"EXT_mesh_primitive_restart", EXTENSION_APART},
    {"EXT_meshopt_compression", EXTENSION_READ},
    {"EXT_primitive_voxels", EXTENSION_HOLDS},
    {"EXT_structural_metadata", EXTENSION_APART},
    {"EXT_texture*", EXTENSION_APART},

    {"ADOBE_materials_*", EXTENSION_APART},
    {"AGI_articulations", EXTENSION_PLACES}, /* a stage need not start at 0 */
    {"AGI_stk_metadata", EXTENSION_APART},
    {"ASOBO_asset_optimized", EXTENSION_HOLDS},
    {"ASOBO_*", EXTENSION_APART},
    {"AVR_*", EXTENSION_APART},
    {"BENTLEY_materials_*", EXTENSION_APART},
    {"BENTLEY_primitive_restart", EXTENSION_APART},
    {"BLENDER_*", EXTENSION_APART},
    {"CESIUM_RTC", EXTENSION_PLACES},
    {"CESIUM_mesh_vector", EXTENSION_APART},
    {"CESIUM_primitive_outline", EXTENSION_APART},
    {"CESIUM_tile_edges", EXTENSION_APART},
    {"EPIC_*", EXTENSION_APART},
    {"FB_geometry_metadata", EXTENSION_APART},
    {"FB_materials_*", EXTENSION_APART},
    {"FB_ngon_encoding", EXTENSION_APART},
    {"GODOT_single_root", EXTENSION_APART},
    {"GOOGLE_*", EXTENSION_APART},
    {"GRIFFEL_bim_data", EXTENSION_APART},
    {"HUBS_components", EXTENSION_APART},
    {"MAXAR_*", EXTENSION_APART},
    {"MOZ_*", EXTENSION_APART},
    {"MPEG_accessor_timed", EXTENSION_HOLDS},
    {"MPEG_buffer_circular", EXTENSION_HOLDS},
    {"MPEG_primitive_V3C", EXTENSION_HOLDS},
    {"MPEG_*", EXTENSION_APART},
    {"MSFT_audio_emitter", EXTENSION_APART},
    {"MSFT_collision_mesh", EXTENSION_APART},
    {"MSFT_lod", EXTENSION_READ},
    {"MSFT_packing_*", EXTENSION_APART},
    {"MSFT_physics", EXTENSION_APART},
    {"MSFT_texture_dds", EXTENSION_APART},
    {"NEEDLE_*", EXTENSION_APART},
    {"NGA_gpm*", EXTENSION_APART},
    {"NV_displacement_micromap", EXTENSION_PLACES},
    {"NV_materials_mdl", EXTENSION_APART},
    {"NV_opacity_micromap", EXTENSION_APART},
    {"OMI_*", EXTENSION_APART},
    {"PANDA3D_physics_collision_shapes", EXTENSION_APART},
    {"VRM", EXTENSION_APART},
    {"VRMC_*", EXTENSION_APART},
    {"WEB3D_quantized_attributes", EXTENSION_HOLDS},
};

static extension_effect effect_of(const char *name)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strlen(known[i].name);
        const bool family = known[i].name[length - 1] == '*';
        if (family ? strncmp(name, known[i].name, length - 1) == 0 : strcmp(name, known[i].name) == 0)
            return known[i].effect;
    }
    return EXTENSION_UNKNOWN;
}

static bool holds_geometry(const char *extension)
{
    return effect_of(extension) == EXTENSION_HOLDS;
}

static bool is_allowed(const ffd_source *source, const char *name)
{
    for (size_t i = 0; i < source->allow_extension_count; i++)
        if (strcmp(source->allow_extensions[i], name) == 0)
            return true;
    return false;
}

ffd_status ffd_gltf_find_required(gltf_document *d, const ffd_source *source, ffd_error *error)
{
    const uint32_t required = ffd_json_tree_member(&d->tree, 0, "extensionsRequired");
    d->refused_extension = JSON_NONE;
    for (uint32_t v = ffd_json_tree_first(&d->tree, required);
         v != JSON_NONE && d->refused_extension == JSON_NONE; v = ffd_json_tree_after(&d->tree, v)) {
        char *name = ffd_json_tree_string(&d->tree, v, NULL);
        if (!name)
            return ffd_fail_memory(error);
        const extension_effect effect = effect_of(name);
        if (effect != EXTENSION_APART && effect != EXTENSION_READ && !is_allowed(source, name))
            d->refused_extension = v;
        ffd_free(name);
    }
    return FFD_OK;
}

/* Refuses the document if it has such an extension. Errors: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
static ffd_status refuse_required(const gltf_document *d, ffd_error *error)
{
    if (d->refused_extension == JSON_NONE)
        return FFD_OK;
    char *name = ffd_json_tree_string(&d->tree, d->refused_extension, NULL);
    if (!name)
        return ffd_fail_memory(error);
    const extension_effect effect = effect_of(name);
    const char *why = effect == EXTENSION_PLACES  ? "places vertices in a way that is not supported"
                      : effect == EXTENSION_HOLDS ? "holds geometry in a form that is not supported"
                                                  : "is not known";
    const ffd_status status = ffd_json_tree_fail(
        &d->tree, d->refused_extension, d->name, FFD_E_UNSUPPORTED, error,
        "the required extension \"%s\" %s ({input.allow_extensions=%s} deforms %s)", name, why, name,
        effect == EXTENSION_HOLDS ? "what else the file holds" : "the file all the same");
    ffd_free(name);
    return status;
}

/* Whether a JSON value is an extension that holds geometry in an unsupported form. */
static bool holds(const gltf_document *d, uint32_t extension)
{
    char *const name = ffd_json_tree_key(&d->tree, extension);
    const bool found = name && holds_geometry(name);
    ffd_free(name);
    return found;
}

/* Finds the first such extension of an object, or of its extensions in turn; JSON_NONE: there is none. The
   values of an object lie between it and the next one. */
static uint32_t find_holder(const gltf_document *d, uint32_t object)
{
    const uint32_t extensions = ffd_json_tree_member(&d->tree, object, "extensions");
    if (extensions == JSON_NONE)
        return JSON_NONE;
    for (uint32_t v = extensions + 1; v < d->tree.values[extensions].next; v++) {
        const uint32_t parent = d->tree.values[v].parent;
        if ((parent == extensions || ffd_json_tree_key_is(&d->tree, parent, "extensions")) && holds(d, v))
            return v;
    }
    return JSON_NONE;
}

static uint32_t holder_of(const gltf_document *d, const gltf_primitive *primitive)
{
    return find_holder(d, primitive->value);
}

/* Whether an accessor is of zeros, without bytes of its own. */
static bool is_empty(const gltf_document *d, int a)
{
    return a >= 0 && d->model.accessors[a].view < 0 && !d->model.accessors[a].sparse.present &&
           !d->layouts[a].data;
}

static bool states_other_than_zeros(const gltf_document *d, int a)
{
    double min[3], max[3];
    bool other = false;
    if (!ffd_gltf_stated(d, (size_t)a, min, max))
        return false;
    for (int c = 0; c < 3; c++)
        other = other || min[c] < 0 || min[c] > 0 || max[c] < 0 || max[c] > 0;
    return other;
}

void ffd_gltf_find_held(gltf_document *d)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        const int a = primitive->accessor[GLTF_POSITION];
        if (is_empty(d, a) && holder_of(d, primitive) != JSON_NONE)
            d->layouts[a].readable = false;
        for (size_t s = 0; s < gltf_vector_slots(primitive); s++) {
            const int of = gltf_slot_accessor(primitive, s);
            if (is_empty(d, of) && states_other_than_zeros(d, of))
                d->layouts[of].readable = false;
        }
    }
}

/* Refuses a morph target, or a normal, that only min and max tell of. */
static ffd_status refuse_stated(const gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    for (size_t s = 0; s < gltf_vector_slots(primitive); s++) {
        const int a = gltf_slot_accessor(primitive, s);
        if (s != GLTF_POSITION && is_empty(d, a) && !d->layouts[a].readable && states_other_than_zeros(d, a))
            return ffd_json_tree_fail(&d->tree, d->accessor_values.values[a], d->name, FFD_E_UNSUPPORTED,
                                      error,
                                      "the accessor has no bytes, but its min and max are not 0: the %s are "
                                      "in a form that is not supported",
                                      s >= GLTF_DEFORMED ? "offsets" : "normals");
    }
    return FFD_OK;
}

/* Refuses a primitive of which an extension holds such numbers. Errors: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
static ffd_status refuse_held_by(const gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    const int a = primitive->accessor[GLTF_POSITION];
    if (ffd_gltf_draco_value(d, primitive) != JSON_NONE || a < 0)
        return FFD_OK;
    if (!is_empty(d, a) || d->layouts[a].readable)
        return refuse_stated(d, primitive, error);
    const uint32_t holder = holder_of(d, primitive);
    if (holder == JSON_NONE)
        return ffd_json_tree_fail(&d->tree, d->accessor_values.values[a], d->name, FFD_E_UNSUPPORTED, error,
                                  "the accessor has no bytes, but its min and max are not 0: the positions "
                                  "are in a form that is not supported");
    char *const name = ffd_json_tree_key(&d->tree, holder);
    if (!name)
        return ffd_fail_memory(error);
    const ffd_status status =
        ffd_json_tree_fail(&d->tree, holder, d->name, FFD_E_UNSUPPORTED, error,
                           "the extension \"%s\" holds the geometry in a form that is not supported", name);
    ffd_free(name);
    return status;
}

ffd_status ffd_gltf_warn_of_held(const gltf_document *d, const mesh_log *log, ffd_error *error)
{
    const uint32_t used = ffd_json_tree_member(&d->tree, 0, "extensionsUsed");
    for (uint32_t v = ffd_json_tree_first(&d->tree, used); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        char *const name = ffd_json_tree_string(&d->tree, v, NULL);
        if (!name)
            return ffd_fail_memory(error);
        if (holds_geometry(name))
            ffd_log_line(log, FFD_LOG_WARNING,
                         "the extension \"%s\" holds geometry in a form of its own, which is not deformed: "
                         "viewers that read it show the old one",
                         name);
        ffd_free(name);
    }
    return FFD_OK;
}

static ffd_status refuse(const gltf_document *d, uint32_t value, ffd_error *error, const char *what)
{
    return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_UNSUPPORTED, error, "%s", what);
}

ffd_status ffd_gltf_refuse_unreadable(const gltf_document *d, const gltf_primitive *primitive, int accessor,
                                      ffd_error *error)
{
    ffd_status status = ffd_gltf_refuse_draco(d, primitive, error);
    if (status || d->layouts[accessor].readable)
        return status;
    const uint32_t value = d->accessor_values.values[accessor];
    if (d->unpacked[accessor].clash)
        return refuse(d, value, error,
                      "primitives read different values for the accessor, from Draco data and from "
                      "elsewhere: this is not supported");
    if (d->model.accessors[accessor].view >= 0)
        status = ffd_gltf_refuse_view(d, (size_t)d->model.accessors[accessor].view, error);
    return status ? status : refuse(d, value, error, "an accessor without bytes is not supported");
}

static ffd_status refuse_primitive(const gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    if (primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    TRY(ffd_gltf_refuse_unreadable(d, primitive, primitive->accessor[GLTF_POSITION], error));
    for (size_t s = GLTF_DEFORMED; s < gltf_vector_slots(primitive); s++)
        if (gltf_slot_accessor(primitive, s) >= 0)
            TRY(ffd_gltf_refuse_unreadable(d, primitive, gltf_slot_accessor(primitive, s), error));
    return FFD_OK;
}

/* Refuses a skin whose joints or weights cannot be read: they move the vertices of an instance. */
static ffd_status refuse_skin(const gltf_document *d, const gltf_instance *instance, ffd_error *error)
{
    const gltf_primitive *const primitive = instance->primitive;
    const gltf_skin *const skin = ffd_gltf_skin_of(d, instance);
    if (!skin || primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK; /* nothing to move, and nobody has checked its influences */
    if (skin->inverse_bind >= 0)
        TRY(ffd_gltf_refuse_unreadable(d, primitive, skin->inverse_bind, error));
    for (size_t i = 0; i < primitive->influence_count; i++) {
        TRY(ffd_gltf_refuse_unreadable(d, primitive, primitive->influences[i].joints, error));
        TRY(ffd_gltf_refuse_unreadable(d, primitive, primitive->influences[i].weights, error));
    }
    return FFD_OK;
}

static ffd_status refuse_shared_child(const gltf_document *d, ffd_error *error)
{
    if (d->shared_child == GLTF_NONE || d->space == FFD_SPACE_MESH)
        return FFD_OK;
    return ffd_json_tree_fail(&d->tree, d->node_values.values[d->shared_child], d->name, FFD_E_INVALID, error,
                              "the node is a child of both node %zu and node %zu", d->shared_by[0],
                              d->shared_by[1]);
}

/* A reader of 2.0 can read any 2.x unless the file requires a newer version (glTF 2.0, 3.2). */
static ffd_status refuse_newer_version(const gltf_document *d, ffd_error *error)
{
    const uint32_t version =
        ffd_json_tree_member(&d->tree, ffd_json_tree_member(&d->tree, 0, "asset"), "minVersion");
    if (version == JSON_NONE)
        return FFD_OK;
    char *text = ffd_json_tree_string(&d->tree, version, NULL);
    if (!text)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    if (strcmp(text, "2.0") != 0)
        status = ffd_json_tree_fail(&d->tree, version, d->name, FFD_E_UNSUPPORTED, error,
                                    "the file needs glTF %s, but only 2.0 is supported", text);
    ffd_free(text);
    return status;
}

/* Refuses geometry that an extension holds, with or without --allow-extension. */
static ffd_status refuse_held(const gltf_document *d, ffd_error *error)
{
    for (size_t i = 0; i < d->model.primitive_count; i++)
        if (d->mesh_uses[d->model.primitives[i].mesh].node_count > 0)
            TRY(refuse_held_by(d, &d->model.primitives[i], error));
    return FFD_OK;
}

ffd_status ffd_gltf_refuse_read(const gltf_document *d, ffd_error *error)
{
    TRY(refuse_newer_version(d, error));
    TRY(refuse_shared_child(d, error));
    TRY(refuse_held(d, error));
    TRY(refuse_required(d, error));
    if (d->skins_status) {
        if (error)
            *error = d->skins_error;
        return d->skins_status;
    }
    if (d->instancing_status) {
        if (error)
            *error = d->instancing_error;
        return d->instancing_status;
    }
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        TRY(refuse_primitive(d, instance->primitive, error));
        TRY(refuse_skin(d, instance, error));
    }
    return FFD_OK;
}

/* Refuses accessors that cannot be read: results could be written neither in place nor into a copy. */
ffd_status ffd_gltf_refuse_store(const gltf_document *d, bool directions, ffd_error *error)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        const bool wanted[GLTF_DEFORMED] = {true, directions,
                                            directions && primitive->accessor[GLTF_NORMAL] >= 0};
        if (d->mesh_uses[primitive->mesh].node_count == 0 || primitive->accessor[GLTF_POSITION] < 0)
            continue;
        for (size_t s = 0; s < gltf_vector_slots(primitive); s++) {
            const int accessor = gltf_slot_accessor(primitive, s);
            if (!wanted[s % GLTF_DEFORMED] || accessor < 0)
                continue;
            TRY(ffd_gltf_refuse_unreadable(d, primitive, accessor, error));
        }
    }
    return FFD_OK;
}
