#include "io/gltf/scene/gltf_held.h"
#include "base/memory/memory.h"
#include "io/gltf/decode/gltf_draco.h"
#include "io/gltf/decode/gltf_stated.h"
#include "io/gltf/scene/gltf_required.h"

/* Whether a JSON value is an extension that holds geometry in an unsupported form. */
static bool holds(const gltf_document *d, uint32_t extension)
{
    char *const name = ffd_json_span_key(&d->tree, extension);
    const bool found = name && ffd_gltf_holds_geometry(name);
    ffd_free(name);
    return found;
}

/* Finds the first such extension of an object, or of its extensions in turn; JSON_NONE: there is none. The
   values of an object lie between it and the next one. */
static uint32_t find_holder(const gltf_document *d, uint32_t object)
{
    const uint32_t extensions = ffd_json_span_member(&d->tree, object, "extensions");
    if (extensions == JSON_NONE)
        return JSON_NONE;
    for (uint32_t v = extensions + 1; v < d->tree.values[extensions].next; v++) {
        const uint32_t parent = d->tree.values[v].parent;
        if ((parent == extensions || ffd_json_span_key_is(&d->tree, parent, "extensions")) && holds(d, v))
            return v;
    }
    return JSON_NONE;
}

static uint32_t holder_of(const gltf_document *d, size_t m, size_t p)
{
    return find_holder(d, ffd_gltf_primitive_value(d, m, p));
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
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++) {
            const int a = d->model.meshes[m].primitives[p].accessor[GLTF_POSITION];
            if (is_empty(d, a) && (states_other_than_zeros(d, a) || holder_of(d, m, p) != JSON_NONE))
                d->layouts[a].readable = false;
        }
}

ffd_status ffd_gltf_refuse_held(const gltf_document *d, size_t m, size_t p, ffd_error *error)
{
    const int a = d->model.meshes[m].primitives[p].accessor[GLTF_POSITION];
    if (!is_empty(d, a) || d->layouts[a].readable || ffd_gltf_draco_value(d, m, p) != JSON_NONE)
        return FFD_OK;
    const uint32_t holder = holder_of(d, m, p);
    if (holder == JSON_NONE)
        return ffd_json_span_fail(&d->tree, d->accessor_values.values[a], d->name, FFD_E_UNSUPPORTED, error,
                                  "the accessor has no bytes, but its min and max are not 0: the positions "
                                  "are in a form that is not supported");
    char *const name = ffd_json_span_key(&d->tree, holder);
    if (!name)
        return ffd_fail_memory(error);
    const ffd_status status =
        ffd_json_span_fail(&d->tree, holder, d->name, FFD_E_UNSUPPORTED, error,
                           "the extension \"%s\" holds the geometry in a form that is not supported", name);
    ffd_free(name);
    return status;
}

ffd_status ffd_gltf_warn_of_held(const gltf_document *d, const mesh_log *log, ffd_error *error)
{
    const uint32_t used = ffd_json_span_member(&d->tree, 0, "extensionsUsed");
    for (uint32_t v = ffd_json_span_first(&d->tree, used); v != JSON_NONE;
         v = ffd_json_span_after(&d->tree, v)) {
        char *const name = ffd_json_span_string(&d->tree, v, NULL);
        if (!name)
            return ffd_fail_memory(error);
        if (ffd_gltf_holds_geometry(name))
            ffd_log_line(log, FFD_LOG_WARNING,
                         "the extension \"%s\" holds geometry in a form of its own, which is not deformed: "
                         "viewers that read it show the old one",
                         name);
        ffd_free(name);
    }
    return FFD_OK;
}
