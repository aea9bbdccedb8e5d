#include "io/gltf/read/gltf_draco.h"
#include "base/file/path.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/gltf/read/draco.h"
#include "io/gltf/read/gltf_views.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define INDICES_SOURCE UINT64_MAX

/* Limits the points and corners of all decodings together, per byte of the memory budget: many primitives can
   name the same data, and each decoding takes time. */
#define MOST_DECODED_A_BYTE 0.25

/* A compressed primitive, and the bufferView of its data. */
typedef struct packed_primitive {
    size_t view;
    const gltf_primitive *primitive;
} packed_primitive;

/* What is needed while a primitive is decoded. */
typedef struct unpacker {
    gltf_document *document;
    const draco_mesh *mesh;
    size_t view;
    ffd_error *error;
} unpacker;

uint32_t ffd_gltf_draco_value(const gltf_document *d, const gltf_primitive *primitive)
{
    return ffd_gltf_extension(d, primitive->value, "KHR_draco_mesh_compression");
}

static ffd_status fail(const gltf_document *d, uint32_t value, ffd_status status, ffd_error *error,
                       const char *what)
{
    return ffd_json_tree_fail(&d->tree, value, d->name, status, error, "%s", what);
}

static uint64_t integer(const gltf_document *d, uint32_t value)
{
    double number = 0;
    ffd_json_tree_number(&d->tree, value, &number);
    return (uint64_t)number;
}

/* Gives decoded elements to an accessor. If it has decoded elements already, compares both and frees the new
   ones. */
static void give_elements(gltf_document *d, size_t accessor, size_t stride, uint64_t source, size_t view,
                          unsigned char *bytes)
{
    gltf_layout *layout = &d->layouts[accessor];
    gltf_unpacked *unpacked = &d->unpacked[accessor];
    const size_t size = (size_t)d->model.accessors[accessor].count * stride;
    if (unpacked->bytes) {
        unpacked->clash =
            unpacked->clash || unpacked->size != size || memcmp(unpacked->bytes, bytes, size) != 0;
        ffd_free(bytes);
        return;
    }
    *unpacked = (gltf_unpacked){.bytes = bytes,
                                .size = size,
                                .source = source,
                                .view = view,
                                .fallback = layout->data,
                                .fallback_stride = layout->stride};
    layout->data = bytes;
    layout->stride = stride;
    layout->begin = 0;
    layout->readable = true;
    layout->packing = GLTF_DRACO;
}

/* Directions whose length differs more from 1 are not valid in readers' eyes. */
#define UNIT_TOLERANCE 0.005f

/* Makes decoded normals or tangents unit vectors again where their quantization was too coarse, and the
   handedness of tangents (rows 4) 1 or -1. */
static void mend_directions(unsigned char *bytes, size_t count, size_t stride, int rows)
{
    for (size_t i = 0; i < count; i++, bytes += stride) {
        float v[4];
        for (int c = 0; c < rows; c++)
            v[c] = load_float(bytes + (size_t)c * sizeof *v);
        const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (length > 0 && fabsf(length - 1) > UNIT_TOLERANCE && length <= FLT_MAX)
            for (int c = 0; c < 3; c++)
                v[c] /= length;
        if (rows == 4)
            v[3] = v[3] < 0 ? -1.0f : 1.0f;
        for (int c = 0; c < rows; c++)
            store_float(bytes + (size_t)c * sizeof *v, v[c]);
    }
}

/* Whether an attribute has directions as floats. */
static bool has_directions(const gltf_document *d, uint32_t attribute, const gltf_accessor *accessor)
{
    const bool normals = accessor->rows == 3 && ffd_json_tree_key_is(&d->tree, attribute, "NORMAL");
    const bool tangents = accessor->rows == 4 && ffd_json_tree_key_is(&d->tree, attribute, "TANGENT");
    return accessor->component == GLTF_FLOAT && (normals || tangents);
}

/* Decodes one attribute (source: its id) or the indices (INDICES_SOURCE) into accessor a. value: the JSON
   value that names it. */
static ffd_status unpack_accessor(const unpacker *u, uint32_t value, size_t a, uint64_t source)
{
    gltf_document *d = u->document;
    const gltf_accessor *accessor = &d->model.accessors[a];
    const gltf_unpacked *unpacked = &d->unpacked[a];
    /* Elements of a vertex attribute start at multiples of 4 bytes (glTF 2.0, 3.6.2.4). */
    const size_t element = d->layouts[a].element_size;
    const size_t stride = source == INDICES_SOURCE ? element : ffd_gltf_align(element);
    if (accessor->columns > 1 || accessor->sparse.present)
        return fail(d, value, FFD_E_UNSUPPORTED, u->error,
                    "a matrix or a sparse accessor compressed by Draco is not supported");
    if (unpacked->bytes && unpacked->source == source && unpacked->view == u->view)
        return FFD_OK;
    ffd_error problem = {0};
    ffd_status status = ffd_budget_take(&d->base.budget, accessor->count, stride, &problem);
    if (status)
        return fail(d, value, status, u->error, problem.message);
    unsigned char *bytes = ffd_alloc_zero((size_t)accessor->count, stride);
    if (!bytes)
        return ffd_fail_memory(u->error);
    if (source == INDICES_SOURCE)
        status = ffd_draco_indices(u->mesh, accessor->component, bytes, &problem);
    else
        status = ffd_draco_attribute(u->mesh, (uint32_t)source, accessor->component, accessor->rows, stride,
                                     bytes, &problem);
    if (status) {
        ffd_free(bytes);
        return fail(d, value, status, u->error, problem.message);
    }
    const double step = source != INDICES_SOURCE ? ffd_draco_step(u->mesh, (uint32_t)source) : 0;
    if (step > 0 && has_directions(d, value, accessor))
        mend_directions(bytes, (size_t)accessor->count, stride, accessor->rows);
    give_elements(d, a, stride, source, u->view, bytes);
    if (source != INDICES_SOURCE)
        d->unpacked[a].step = step;
    return FFD_OK;
}

/* Returns the accessor that `attributes` has under the same key as the JSON value `attribute`; GLTF_NONE:
   none. */
static size_t find_accessor(const gltf_document *d, uint32_t attributes, uint32_t attribute)
{
    for (uint32_t v = ffd_json_tree_first(&d->tree, attributes); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        if (ffd_json_tree_compare_keys(&d->tree, v, &d->tree, attribute) == 0)
            return (size_t)integer(d, v);
    return GLTF_NONE;
}

static ffd_status unpack_primitive(const unpacker *u, const packed_primitive *packed)
{
    gltf_document *d = u->document;
    const gltf_primitive *primitive = packed->primitive;
    const uint32_t value = packed->primitive->value;
    const uint32_t draco = ffd_gltf_draco_value(d, packed->primitive);
    const uint32_t attributes = ffd_json_tree_member(&d->tree, value, "attributes");
    for (uint32_t v = ffd_json_tree_first(&d->tree, ffd_json_tree_member(&d->tree, draco, "attributes"));
         v != JSON_NONE; v = ffd_json_tree_after(&d->tree, v)) {
        const size_t accessor = find_accessor(d, attributes, v);
        if (accessor == GLTF_NONE)
            return fail(d, v, FFD_E_INVALID, u->error, "the primitive has no such attribute");
        TRY(unpack_accessor(u, v, accessor, integer(d, v)));
    }
    if (primitive->indices >= 0)
        TRY(unpack_accessor(u, ffd_json_tree_member(&d->tree, value, "indices"), (size_t)primitive->indices,
                            INDICES_SOURCE));
    return FFD_OK;
}

/* Reads what the glTF file states about a primitive's mesh. */
static ffd_status read_claim(const gltf_document *d, const packed_primitive *packed, draco_claim *claim,
                             ffd_error *error)
{
    const gltf_primitive *primitive = packed->primitive;
    const uint32_t value = ffd_gltf_draco_value(d, packed->primitive);
    if (packed->view >= d->model.view_count)
        return fail(d, ffd_json_tree_member(&d->tree, value, "bufferView"), FFD_E_INVALID, error,
                    "the bufferView does not exist");
    if (primitive->attribute_count == 0)
        return fail(d, value, FFD_E_INVALID, error, "the primitive has no attributes");
    if (primitive->indices >= 0 && primitive->mode != MODE_TRIANGLES)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_UNSUPPORTED, error,
                                  "indices of mode %d compressed by Draco are not supported, only triangles",
                                  primitive->mode);
    *claim = (draco_claim){d->model.accessors[primitive->attributes[0].accessor].count, UINT64_MAX};
    if (primitive->indices >= 0)
        claim->corners = d->model.accessors[primitive->indices].count;
    return FFD_OK;
}

static ffd_status decode_mesh(gltf_document *d, const packed_primitive *packed, const draco_claim *claim,
                              draco_mesh **mesh, ffd_error *error)
{
    const uint32_t value = ffd_gltf_draco_value(d, packed->primitive);
    const unsigned char *bytes = ffd_gltf_view_bytes(d, packed->view);
    ffd_error problem = {0};
    if (!bytes)
        return fail(d, value, FFD_E_INVALID, error, "the bufferView has no bytes");
    if (!LITTLE_ENDIAN_MACHINE) /* the library copies numbers as the machine has them */
        return fail(d, value, FFD_E_UNSUPPORTED, error, "Draco is not supported on big-endian machines");
    const ffd_status status = ffd_draco_decode(bytes, (size_t)d->model.views[packed->view].length, claim,
                                               &d->base.budget, mesh, &problem);
    if (status)
        return fail(d, value, status, error, problem.message);
    d->draco_decoded += (uint64_t)ffd_draco_point_count(*mesh) + ffd_draco_corner_count(*mesh);
    if ((double)d->draco_decoded > MOST_DECODED_A_BYTE * (double)ffd_budget_most(&d->base.budget))
        return fail(d, value, FFD_E_LIMIT, error, "the file's Draco data would be decoded too many times");
    return FFD_OK;
}

static bool same_claim(const draco_claim *a, const draco_claim *b)
{
    return a->points == b->points && a->corners == b->corners;
}

/* Decodes a primitive. *mesh is the previous primitive's if that has the same bufferView
   and claim, else NULL. */
static ffd_status decode_primitive(gltf_document *d, const packed_primitive *packed, const draco_claim *claim,
                                   draco_mesh **mesh, ffd_error *error)
{
    TRY(*mesh ? FFD_OK : decode_mesh(d, packed, claim, mesh, error));
    const unpacker u = {d, *mesh, packed->view, error};
    return unpack_primitive(&u, packed);
}

static int compare_packed(const void *a, const void *b)
{
    const packed_primitive *x = a, *y = b;
    if (x->view != y->view)
        return x->view < y->view ? -1 : 1;
    return (x->primitive > y->primitive) - (x->primitive < y->primitive);
}

/* Lists the compressed primitives, sorted by bufferView. */
static size_t list_packed(const gltf_document *d, packed_primitive *list)
{
    size_t count = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const uint32_t value = ffd_gltf_draco_value(d, &d->model.primitives[i]);
        if (value == JSON_NONE)
            continue;
        const uint32_t view = ffd_json_tree_member(&d->tree, value, "bufferView");
        list[count++] = (packed_primitive){(size_t)integer(d, view), &d->model.primitives[i]};
    }
    if (count > 0)
        qsort(list, count, sizeof *list, compare_packed);
    return count;
}

static void forget(gltf_document *d, size_t accessor)
{
    if (!d->unpacked[accessor].bytes)
        d->layouts[accessor].readable = false;
}

/* Marks the accessors of a primitive that could not be decoded as unreadable: their elements are not
   zeros. */
static void forget_primitive(gltf_document *d, const packed_primitive *packed)
{
    const uint32_t value = packed->primitive->value;
    const uint32_t draco = ffd_gltf_draco_value(d, packed->primitive);
    const uint32_t attributes = ffd_json_tree_member(&d->tree, value, "attributes");
    for (uint32_t v = ffd_json_tree_first(&d->tree, ffd_json_tree_member(&d->tree, draco, "attributes"));
         v != JSON_NONE; v = ffd_json_tree_after(&d->tree, v)) {
        const size_t accessor = find_accessor(d, attributes, v);
        if (accessor != GLTF_NONE)
            forget(d, accessor);
    }
    if (packed->primitive->indices >= 0)
        forget(d, (size_t)packed->primitive->indices);
}

/* Keeps the message of unsupported data: it is a failure only where the data is used (gltf_refuse.c). */
static ffd_status keep_problem(gltf_document *d, const packed_primitive *packed, ffd_status status,
                               const ffd_error *problem, ffd_error *error)
{
    if (status == FFD_E_UNSUPPORTED) {
        forget_primitive(d, packed);
        char *words = ffd_text_copy(problem->message);
        d->draco_problems[packed->primitive - d->model.primitives] = words;
        return words ? FFD_OK : ffd_fail_memory(error);
    }
    if (status && error)
        *error = *problem;
    return status;
}

static ffd_status decode_all(gltf_document *d, const packed_primitive *list, size_t count, ffd_error *error)
{
    draco_mesh *mesh = NULL;
    draco_claim last = {0, 0};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < count; i++) {
        draco_claim claim = {0, 0};
        ffd_error problem = {0};
        status = read_claim(d, &list[i], &claim, &problem);
        if (i > 0 && (list[i].view != list[i - 1].view || !same_claim(&claim, &last))) {
            ffd_draco_free(mesh);
            mesh = NULL;
        }
        status = status ? status : decode_primitive(d, &list[i], &claim, &mesh, &problem);
        TRY_END(keep_problem(d, &list[i], status, &problem, error));
        last = claim;
    }
end:
    ffd_draco_free(mesh);
    return status;
}

/* Whether a primitive reads the accessor of an attribute from its compressed data. */
static bool takes_from_draco(const gltf_document *d, uint32_t draco, uint32_t attribute)
{
    return draco != JSON_NONE &&
           find_accessor(d, ffd_json_tree_member(&d->tree, draco, "attributes"), attribute) != GLTF_NONE;
}

/* Whether the decoded elements of an accessor equal its uncompressed ones. */
static bool equals_fallback(const gltf_document *d, size_t a)
{
    const gltf_unpacked *unpacked = &d->unpacked[a];
    const gltf_layout *layout = &d->layouts[a];
    for (size_t i = 0; unpacked->fallback && i < d->model.accessors[a].count; i++)
        if (memcmp(unpacked->bytes + i * layout->stride, unpacked->fallback + i * unpacked->fallback_stride,
                   layout->element_size) != 0)
            return false;
    return unpacked->fallback;
}

/* Marks the accessors that a primitive reads uncompressed. */
static void mark_plain_uses(gltf_document *d, const gltf_primitive *primitive, bool *plain)
{
    const uint32_t value = primitive->value, draco = ffd_gltf_draco_value(d, primitive);
    const uint32_t attributes = ffd_json_tree_member(&d->tree, value, "attributes");
    for (uint32_t v = ffd_json_tree_first(&d->tree, attributes); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        if (!takes_from_draco(d, draco, v))
            plain[integer(d, v)] = true;
    for (size_t i = 0; i < primitive->target_attribute_count; i++)
        plain[primitive->targets[i].accessor] = true;
    if (primitive->indices >= 0 && draco == JSON_NONE)
        plain[primitive->indices] = true;
}

/* Marks the accessors for which primitives read different values, and makes them unreadable. */
static ffd_status mark_clashes(gltf_document *d, ffd_error *error)
{
    bool *plain = ffd_alloc_zero(d->model.accessor_count, sizeof *plain);
    if (!plain)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->model.primitive_count; i++)
        mark_plain_uses(d, &d->model.primitives[i], plain);
    for (size_t a = 0; a < d->model.accessor_count; a++) {
        gltf_unpacked *unpacked = &d->unpacked[a];
        unpacked->clash = unpacked->clash || (plain[a] && unpacked->bytes && !equals_fallback(d, a));
        if (unpacked->clash)
            d->layouts[a].readable = false;
    }
    ffd_free(plain);
    return FFD_OK;
}

ffd_status ffd_gltf_decode_draco(gltf_document *d, ffd_error *error)
{
    packed_primitive *list = ffd_alloc(d->model.primitive_count, sizeof *list);
    d->draco_problems = ffd_alloc_zero(d->model.primitive_count, sizeof *d->draco_problems);
    d->unpacked = ffd_alloc_zero(d->model.accessor_count, sizeof *d->unpacked);
    ffd_status status;
    TRY_END(list && d->draco_problems && d->unpacked ? FFD_OK : ffd_fail_memory(error));
    const size_t count = list_packed(d, list);
    TRY_END(decode_all(d, list, count, error));
    if (count > 0)
        TRY_END(mark_clashes(d, error));
end:
    ffd_free(list);
    return status;
}

ffd_status ffd_gltf_refuse_draco(const gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    const char *problem = d->draco_problems[primitive - d->model.primitives];
    return problem ? fail(d, ffd_gltf_draco_value(d, primitive), FFD_E_UNSUPPORTED, error, problem) : FFD_OK;
}
