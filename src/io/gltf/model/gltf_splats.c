#include "io/gltf/model/gltf_splats.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/read/gltf_elements.h"
#include "splat/harmonics.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define SPLATTING "KHR_gaussian_splatting"

/* Memory of a group of attributes of a part. */
#define GROUP_BYTES (sizeof(gltf_part) + sizeof(mesh_part) + GLTF_DEFORMED * sizeof(int))

/* The splat attributes of a primitive. */
typedef struct splat_attributes {
    size_t accessors[GLTF_SPLAT_ATTRIBUTES]; /* GLTF_NONE: absent */
    bool all_usable;                         /* whether all that are present can be changed */
    splat_form form;
} splat_attributes;

static size_t groups_of(const splat_form *form)
{
    const size_t count = GLTF_SPLAT_HARMONICS + (size_t)harmonics_count(form->degree);
    return count / GLTF_DEFORMED + (count % GLTF_DEFORMED != 0);
}

/* Whether the accessor's type is allowed for the attribute; signed scales are those of drafts. */
static bool has_type(const gltf_accessor *accessor, size_t attribute)
{
    const bool is_float = accessor->component == GLTF_FLOAT;
    const bool is_signed = accessor->component == GLTF_I8 || accessor->component == GLTF_I16;
    if (accessor->columns != 1 || accessor->rows != (attribute == GLTF_SPLAT_ROTATION ? 4 : 3))
        return false;
    if (attribute == GLTF_SPLAT_ROTATION)
        return is_float || (is_signed && accessor->normalized);
    return is_float || (attribute == GLTF_SPLAT_SCALE && accessor->component != GLTF_U32);
}

/* Whether results can replace the accessor's elements. */
static bool is_usable(const gltf_document *d, size_t a, size_t attribute)
{
    const gltf_accessor *const accessor = &d->model.accessors[a];
    return has_type(accessor, attribute) && d->layouts[a].readable && d->layouts[a].packing != GLTF_DRACO &&
           (accessor->view >= 0 || accessor->sparse.present);
}

/* Returns the largest degree up to which all coefficients are present. */
static int find_degree(const size_t *accessors)
{
    int degree = 0;
    for (int next = 1; next <= HARMONICS_DEGREES; next++) {
        for (int i = harmonics_count(next - 1); i < harmonics_count(next); i++)
            if (accessors[GLTF_SPLAT_HARMONICS + i] == GLTF_NONE)
                return degree;
        degree = next;
    }
    return degree;
}

static splat_attributes find_attributes(const gltf_document *d, const gltf_primitive *primitive)
{
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive->value, "attributes");
    splat_attributes found = {.all_usable = true};
    for (size_t i = 0; i < GLTF_SPLAT_ATTRIBUTES; i++) {
        char name[GLTF_SPLAT_NAME];
        ffd_gltf_splat_name(i, name);
        const uint32_t value = ffd_json_tree_member(&d->tree, attributes, name);
        found.accessors[i] = ffd_gltf_index(d, value, d->model.accessor_count);
        if (found.accessors[i] != GLTF_NONE && !is_usable(d, found.accessors[i], i))
            found.all_usable = false;
    }
    found.all_usable = found.all_usable && found.accessors[GLTF_SPLAT_ROTATION] != GLTF_NONE &&
                       found.accessors[GLTF_SPLAT_SCALE] != GLTF_NONE;
    found.form.degree = find_degree(found.accessors);
    return found;
}

/* Whether some scale is below 0. */
static bool has_negative(const gltf_document *d, size_t a)
{
    enum { STEP = 256 };
    const size_t count = (size_t)d->model.accessors[a].count;
    double scales[3 * STEP];
    for (size_t first = 0; first < count; first += STEP) {
        const size_t some = count - first < STEP ? count - first : STEP;
        ffd_gltf_read(d, a, first, some, 3, scales);
        for (size_t i = 0; i < 3 * some; i++)
            if (scales[i] < 0)
                return true;
    }
    return false;
}

/* Notes negative scales, which are logarithms as in drafts of the extension, and degrees of harmonics that
   are not complete. */
static ffd_status find_flaws(gltf_document *d, const gltf_primitive *primitive, splat_attributes *found,
                             ffd_error *error)
{
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive->value, "attributes");
    found->form.is_logarithmic = has_negative(d, found->accessors[GLTF_SPLAT_SCALE]);
    if (found->form.is_logarithmic)
        TRY(ffd_gltf_flaw(d, ffd_json_tree_member(&d->tree, attributes, SPLATTING ":SCALE"), error,
                          "scales of Gaussian splats are negative: they are read as logarithms, as in drafts "
                          "of " SPLATTING));
    for (int i = harmonics_count(found->form.degree); i < HARMONICS_MOST; i++)
        if (found->accessors[GLTF_SPLAT_HARMONICS + i] != GLTF_NONE)
            return ffd_gltf_flaw(
                d, attributes, error,
                "spherical harmonics of Gaussian splats above degree %d are not complete: these are "
                "not turned",
                found->form.degree);
    return FFD_OK;
}

/* Stores the accessors in the primitive, and marks their attributes as GLTF_SPLAT. */
static ffd_status keep_accessors(gltf_document *d, gltf_primitive *primitive, const splat_attributes *found,
                                 ffd_error *error)
{
    const size_t groups = groups_of(&found->form), slots = GLTF_DEFORMED * groups;
    TRY(ffd_budget_take(&d->base.budget, groups, GROUP_BYTES, error));
    primitive->splat_accessors = ffd_alloc(slots, sizeof *primitive->splat_accessors);
    if (!primitive->splat_accessors)
        return ffd_fail_memory(error);
    primitive->splat_groups = groups;
    for (size_t i = 0; i < slots; i++) {
        const bool is_there = i < GLTF_SPLAT_HARMONICS + (size_t)harmonics_count(found->form.degree);
        const int a = is_there ? (int)found->accessors[i] : -1;
        primitive->splat_accessors[i] = a;
        for (size_t k = 0; k < primitive->attribute_count && is_there; k++)
            if (primitive->attributes[k].accessor == a && primitive->attributes[k].semantic == GLTF_OTHER) {
                primitive->attributes[k].semantic = GLTF_SPLAT;
                break;
            }
    }
    return FFD_OK;
}

/* Whether two primitives have the same splats. */
static bool are_same(const gltf_primitive *a, const gltf_primitive *b)
{
    if (a->splat_groups != b->splat_groups)
        return false;
    for (size_t i = 0; i < GLTF_DEFORMED * a->splat_groups; i++)
        if (a->splat_accessors[i] != b->splat_accessors[i])
            return false;
    return true;
}

/* The last visited primitive of a part, and whether primitives of the part have different splats. */
typedef struct part_owner {
    const gltf_primitive *primitive; /* NULL: none yet */
    bool is_split;
} part_owner;

static void mark_part(gltf_document *d, const gltf_primitive *primitive, const splat_attributes *found,
                      size_t part, part_owner *owner)
{
    mesh_part *const made = &d->mesh_parts[part];
    made->splats = true;
    made->place = d->parts[part].node == GLTF_NONE ? MESH_NO_PLACE : d->parts[part].node;
    owner->is_split = owner->is_split || (owner->primitive && !are_same(owner->primitive, primitive));
    owner->primitive = primitive;
    made->has_ellipsoids = primitive->splat_groups > 0 && !owner->is_split;
    made->form = found->form;
}

/* Marks the parts of the primitives with splats. */
static ffd_status mark_primitives(gltf_document *d, part_owner *owners, ffd_error *error)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        gltf_primitive *const primitive = &d->model.primitives[i];
        const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
        if (!ffd_gltf_has_extension(d, primitive->value, SPLATTING))
            continue;
        splat_attributes found = find_attributes(d, primitive);
        if (found.all_usable && d->mesh_uses[primitive->mesh].node_count > 0) {
            TRY(find_flaws(d, primitive, &found, error));
            TRY(keep_accessors(d, primitive, &found, error));
        }
        for (size_t n = 0; n < d->mesh_uses[primitive->mesh].node_count; n++)
            if (instances[n].part[GLTF_POSITION] != GLTF_NONE)
                mark_part(d, primitive, &found, instances[n].part[GLTF_POSITION],
                          &owners[instances[n].part[GLTF_POSITION]]);
    }
    return FFD_OK;
}

/* Appends the parts that hold results. */
static ffd_status add_groups(gltf_document *d, const part_owner *owners, ffd_error *error)
{
    size_t groups = 0, next = ffd_gltf_shape_end(d);
    for (size_t i = 0; i < d->base.part_count; i++)
        if (d->mesh_parts[i].has_ellipsoids)
            groups += owners[i].primitive->splat_groups;
    if (groups == 0)
        return FFD_OK;
    const size_t all = next + groups;
    gltf_part *const parts = ffd_realloc(d->parts, all, sizeof *parts);
    if (!parts)
        return ffd_fail_memory(error);
    d->parts = parts;
    mesh_part *const mesh_parts = ffd_realloc(d->mesh_parts, all, sizeof *mesh_parts);
    if (!mesh_parts)
        return ffd_fail_memory(error);
    d->mesh_parts = mesh_parts;
    d->base.parts = mesh_parts;
    d->splat_groups = groups;
    for (size_t i = 0; i < d->base.part_count; i++) {
        if (!d->mesh_parts[i].has_ellipsoids)
            continue;
        d->parts[i].first_splat = next;
        d->parts[i].splat_groups = owners[i].primitive->splat_groups;
        for (size_t slot = 0; slot < GLTF_DEFORMED * d->parts[i].splat_groups; slot++) {
            const size_t group = next + slot / GLTF_DEFORMED, s = slot % GLTF_DEFORMED;
            const int a = owners[i].primitive->splat_accessors[slot];
            if (s == 0) {
                d->parts[group] = (gltf_part){.node = d->parts[i].node, .first_splat = GLTF_NONE};
                d->mesh_parts[group] = (mesh_part){.vertex_count = d->mesh_parts[i].vertex_count};
            }
            d->parts[group].streams[s].accessor = a < 0 ? GLTF_NONE : (size_t)a;
            d->parts[group].streams[s].components = slot == GLTF_SPLAT_ROTATION ? 4 : 3;
        }
        next += d->parts[i].splat_groups;
    }
    return FFD_OK;
}

/* Sets the instances' first_splat. */
static void find_results(gltf_document *d)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const size_t part = d->instances[i].part[GLTF_POSITION];
        if (part != GLTF_NONE && d->instances[i].primitive->splat_groups > 0)
            d->instances[i].first_splat = d->parts[part].first_splat;
    }
}

ffd_status ffd_gltf_find_splats(gltf_document *d, ffd_error *error)
{
    part_owner *const owners = ffd_alloc_zero(d->base.part_count, sizeof *owners);
    if (!owners)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(mark_primitives(d, owners, error));
    TRY_END(add_groups(d, owners, error));
    find_results(d);
end:
    ffd_free(owners);
    return status;
}

/* Splats read at a time. */
#define STEP ((size_t)64)

/* Returns the stream of an attribute of a part's splats. */
static gltf_stream *stream_of(const gltf_document *d, size_t part, size_t attribute)
{
    return &d->parts[d->parts[part].first_splat + attribute / GLTF_DEFORMED]
                .streams[attribute % GLTF_DEFORMED];
}

static size_t attribute_count(const gltf_document *d, size_t part)
{
    return GLTF_SPLAT_HARMONICS + (size_t)harmonics_count(d->mesh_parts[part].form.degree);
}

/* Allocates the result of a stream, unless it has one. */
static ffd_status make_result(gltf_document *d, size_t count, gltf_stream *stream, ffd_error *error)
{
    if (stream->result)
        return FFD_OK;
    const size_t size = stream->components * sizeof *stream->result;
    TRY(ffd_budget_take(&d->base.budget, count, size, error));
    stream->result = ffd_alloc_whole(count, size);
    return stream->result ? FFD_OK : ffd_fail_memory(error);
}

static void drop_result(gltf_document *d, size_t count, gltf_stream *stream)
{
    if (stream->result)
        ffd_budget_return(&d->base.budget, count, stream->components * sizeof *stream->result);
    ffd_free(stream->result);
    stream->result = NULL;
}

ffd_status ffd_gltf_begin_splats(gltf_document *d, ffd_error *error)
{
    atomic_store(&d->unturned, 0);
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *const part = &d->mesh_parts[i];
        const bool follows = (!part->skipped || part->carried) && !part->singular &&
                             !part->repeats_positions && !d->morph_name && !d->results.converted;
        for (size_t a = 0; part->has_ellipsoids && a < attribute_count(d, i); a++)
            if (follows)
                TRY(make_result(d, part->vertex_count, stream_of(d, i, a), error));
            else
                drop_result(d, part->vertex_count, stream_of(d, i, a));
    }
    return FFD_OK;
}

void ffd_gltf_warn_of_splats(const gltf_document *d, const mesh_log *log)
{
    const size_t unturned = atomic_load(&d->unturned);
    if (unturned > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu Gaussian splat%s spherical harmonics that are not numbers, or too large: they are "
                     "not turned",
                     unturned, unturned == 1 ? " has" : "s have");
}

/* glTF stores quaternions as x, y, z, w. */
void ffd_gltf_read_splats(const mesh_document *document, size_t part, size_t first, size_t count,
                          splat_ellipsoid *splats)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t rotations = stream_of(d, part, GLTF_SPLAT_ROTATION)->accessor,
                 scales = stream_of(d, part, GLTF_SPLAT_SCALE)->accessor;
    double rotation[4 * STEP], scale[3 * STEP];
    for (size_t done = 0; done < count; done += STEP) {
        const size_t some = count - done < STEP ? count - done : STEP;
        ffd_gltf_read(d, rotations, first + done, some, 4, rotation);
        ffd_gltf_read(d, scales, first + done, some, 3, scale);
        for (size_t i = 0; i < some; i++) {
            const double *const q = rotation + 4 * i, *const s = scale + 3 * i;
            splats[done + i] =
                (splat_ellipsoid){.rotation = {q[3], q[0], q[1], q[2]}, .scale = {s[0], s[1], s[2]}};
        }
    }
}

/* Writes an element of a result: values rounded to the accessor's type, or the file's element if values is
   NULL. */
static void write_element(const gltf_document *d, const gltf_stream *stream, size_t i, const double *values)
{
    float *const result = stream->result + stream->components * i;
    if (!values) {
        ffd_gltf_original(d, stream->accessor, i, stream->components, result);
        return;
    }
    for (size_t c = 0; c < stream->components; c++)
        result[c] = ffd_gltf_round(&d->model.accessors[stream->accessor], values[c]);
}

/* Whether floats can hold a channel's turned coefficients. */
static bool fit(const double c[HARMONICS_MOST], int count)
{
    for (int m = 0; m < count; m++)
        if (!(fabs(c[m]) <= FLT_MAX))
            return false;
    return true;
}

/* Takes over turned coefficients. Returns false if floats cannot hold those of some channel, which then
   stay. */
static bool take_turned(const harmonics_block turned, int count, harmonics_block c)
{
    bool all = true;
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const bool fits = fit(turned[k], count);
        for (int m = 0; m < count && fits; m++)
            c[k][m] = turned[k][m];
        all = all && fits;
    }
    return all;
}

/* Turns the coefficients of the listed splats, at most STEP. Returns the number of splats with a channel that
   stays. */
static size_t turn_listed(const splat_turn *turns, int degree, const size_t *listed, size_t count,
                          harmonics_block *c)
{
    harmonics_block turned[STEP];
    splat_turn own[STEP];
    size_t unturned = 0;
    if (count == 0)
        return 0;
    for (size_t k = 0; k < count; k++) {
        memcpy(turned[k], c[listed[k]], sizeof turned[k]);
        own[k] = turns[listed[k]];
    }
    ffd_harmonics_turn(FFD_ISA_AUTO, own, degree, count, turned);
    for (size_t k = 0; k < count; k++)
        unturned +=
            !take_turned((const double(*)[HARMONICS_MOST])turned[k], harmonics_count(degree), c[listed[k]]);
    return unturned;
}

static void write_harmonics(gltf_document *d, size_t part, size_t first, size_t count,
                            const splat_turn *turns, const uint8_t *changed)
{
    const int degree = d->mesh_parts[part].form.degree, functions = harmonics_count(degree);
    harmonics_block c[STEP] = {{{0}}};
    size_t listed[STEP], open = 0;
    for (int m = 0; m < functions; m++) {
        double values[STEP][HARMONICS_CHANNELS];
        ffd_gltf_read(d, stream_of(d, part, GLTF_SPLAT_HARMONICS + (size_t)m)->accessor, first, count,
                      HARMONICS_CHANNELS, values[0]);
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < HARMONICS_CHANNELS; k++)
                c[i][k][m] = values[i][k];
    }
    for (size_t i = 0; i < count && functions > 0; i++)
        if (changed[i] && turns[i].is_turn)
            listed[open++] = i;
    const size_t unturned = turn_listed(turns, degree, listed, open, c);
    for (int m = 0; m < functions; m++) {
        const gltf_stream *const stream = stream_of(d, part, GLTF_SPLAT_HARMONICS + (size_t)m);
        for (size_t i = 0; i < count; i++) {
            const double values[HARMONICS_CHANNELS] = {c[i][0][m], c[i][1][m], c[i][2][m]};
            write_element(d, stream, first + i, changed[i] && turns[i].is_turn ? values : NULL);
        }
    }
    if (unturned > 0)
        atomic_fetch_add(&d->unturned, unturned);
}

void ffd_gltf_write_splats(mesh_document *document, size_t part, size_t first, size_t count,
                           const splat_ellipsoid *splats, const splat_turn *turns, const uint8_t *changed)
{
    gltf_document *const d = (gltf_document *)document;
    const gltf_stream *const rotation = stream_of(d, part, GLTF_SPLAT_ROTATION), *const scale = stream_of(
                                                                                     d, part,
                                                                                     GLTF_SPLAT_SCALE);
    if (!rotation->result)
        return;
    for (size_t i = 0; i < count; i++) {
        const double *const q = splats[i].rotation;
        write_element(d, rotation, first + i, changed[i] ? (double[4]){q[1], q[2], q[3], q[0]} : NULL);
        write_element(d, scale, first + i, changed[i] ? splats[i].scale : NULL);
    }
    for (size_t done = 0; done < count; done += STEP)
        write_harmonics(d, part, first + done, count - done < STEP ? count - done : STEP, turns + done,
                        changed + done);
}
