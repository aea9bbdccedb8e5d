#include "io/gltf/read/gltf_conformance.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_schema.h"
#include <math.h>

static uint32_t member_or(const gltf_document *d, uint32_t object, const char *key)
{
    const uint32_t member = ffd_json_tree_member(&d->tree, object, key);
    return member == JSON_NONE ? object : member;
}

static bool has(const gltf_document *d, uint32_t object, const char *key)
{
    return ffd_json_tree_member(&d->tree, object, key) != JSON_NONE;
}

/* How far the length of a rotation may be from 1: rounding of numbers with three decimals. */
#define UNIT_TOLERANCE 1e-3

/* How far the axes of a matrix may be from right angles, as a cosine: rounding of numbers in single
   precision. */
#define SHEAR_TOLERANCE 1e-4

/* Whether no translation, rotation and scale make up a matrix: viewers that take it apart differ. */
static bool is_sheared(const double matrix[16])
{
    for (int i = 0; i < 3; i++) {
        const double *const a = matrix + 4 * i, *const b = matrix + 4 * ((i + 1) % 3);
        const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const double squares =
            (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
        if (fabs(dot) > SHEAR_TOLERANCE * sqrt(squares))
            return true;
    }
    return false;
}

static ffd_status note_node(gltf_document *d, size_t n, ffd_error *error)
{
    const gltf_node *const node = &d->model.nodes[n];
    const uint32_t value = d->node_values.values[n];
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += node->rotation[i] * node->rotation[i];
    if (node->has_matrix &&
        (has(d, value, "translation") || has(d, value, "rotation") || has(d, value, "scale")))
        TRY(ffd_gltf_flaw(d, value, error,
                          "a node has a matrix or a translation, rotation and scale, not both: its "
                          "matrix counts"));
    if (node->has_matrix && is_sheared(node->matrix))
        TRY(ffd_gltf_flaw(d, member_or(d, value, "matrix"), error,
                          "the matrix shears: no translation, rotation and scale make it up"));
    if (!node->has_matrix && has(d, value, "rotation") && !(fabs(sqrt(square) - 1) <= UNIT_TOLERANCE))
        TRY(ffd_gltf_flaw(
            d, member_or(d, value, "rotation"), error,
            "a rotation is a unit quaternion, but this one has the length %.6g: it scales as well, and "
            "viewers differ in this",
            sqrt(square)));
    return FFD_OK;
}

static ffd_status note_accessor(gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_accessor *const accessor = &d->model.accessors[i];
    if (accessor->normalized && (accessor->component == GLTF_FLOAT || accessor->component == GLTF_U32))
        return ffd_gltf_flaw(d, member_or(d, d->accessor_values.values[i], "normalized"), error,
                             "numbers of component type %d are not normalized: they count as they are",
                             accessor->component);
    return FFD_OK;
}

static ffd_status note_positions(gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    const int accessor = primitive->accessor[GLTF_POSITION];
    if (accessor < 0)
        return FFD_OK;
    const uint32_t value = d->accessor_values.values[accessor];
    if (!has(d, value, "min") || !has(d, value, "max"))
        TRY(ffd_gltf_flaw(d, value, error, "an accessor of positions has a min and a max: %s is missing",
                          has(d, value, "min") ? "max" : "min"));
    if (d->model.accessors[accessor].component != GLTF_FLOAT &&
        !ffd_gltf_uses(&d->tree, "KHR_mesh_quantization"))
        TRY(ffd_gltf_flaw(d, value, error,
                          "positions of component type %d need KHR_mesh_quantization in extensionsUsed",
                          d->model.accessors[accessor].component));
    return FFD_OK;
}

static ffd_status note_indices(gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    const int accessor = primitive->indices;
    const int view = accessor < 0 ? -1 : d->model.accessors[accessor].view;
    if (view < 0 || d->model.views[view].stride == 0)
        return FFD_OK;
    return ffd_gltf_flaw(d, ffd_json_tree_member(&d->tree, primitive->value, "indices"), error,
                         "the bufferView of indices states a byteStride, which counts here: viewers differ "
                         "in this");
}

static ffd_status note_primitive(gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    double material = 0;
    const uint32_t index = ffd_json_tree_member(&d->tree, primitive->value, "material");
    const uint32_t materials = ffd_json_tree_member(&d->tree, 0, "materials");
    TRY(note_positions(d, primitive, error));
    TRY(note_indices(d, primitive, error));
    if (ffd_json_tree_number(&d->tree, index, &material) &&
        !(material >= 0 && material < (double)ffd_json_tree_count(&d->tree, materials)))
        TRY(ffd_gltf_flaw(d, index, error, "there is no material %.0f", material));
    return FFD_OK;
}

static ffd_status note_extensions(gltf_document *d, ffd_error *error)
{
    const uint32_t required = ffd_json_tree_member(&d->tree, 0, "extensionsRequired");
    for (uint32_t v = ffd_json_tree_first(&d->tree, required); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        char *const name = ffd_json_tree_string(&d->tree, v, NULL);
        if (!name)
            return ffd_fail_memory(error);
        const ffd_status status = ffd_gltf_uses(&d->tree, name)
                                      ? FFD_OK
                                      : ffd_gltf_flaw(d, v, error,
                                                      "%s is in extensionsRequired, but not in "
                                                      "extensionsUsed",
                                                      name);
        ffd_free(name);
        TRY(status);
    }
    return FFD_OK;
}

ffd_status ffd_gltf_note_errors(gltf_document *d, ffd_error *error)
{
    for (size_t n = 0; n < d->model.node_count; n++)
        TRY(note_node(d, n, error));
    for (size_t i = 0; i < d->model.accessor_count; i++)
        TRY(note_accessor(d, i, error));
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY(note_primitive(d, &d->model.primitives[i], error));
    for (size_t m = 0; m < d->model.mesh_count; m++)
        if (d->model.meshes[m].primitive_count == 0)
            TRY(ffd_gltf_flaw(d, d->mesh_values.values[m], error,
                              "a mesh has at least one primitive, this one has none"));
    return note_extensions(d, error);
}
