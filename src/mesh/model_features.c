/* model_features.c - determines the features of a model, and describes those that a format loses. */
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/deadline.h"
#include "mesh/model.h"
#include "mesh/precision.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Tolerance of 255 * colour as an integer: half a unit of the sixth decimal digit, with a margin. */
#define BYTE_TOLERANCE 2e-4

static bool same(const double *values, size_t width, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < width && a != b; i++)
        if (values[width * a + i] < values[width * b + i] || values[width * a + i] > values[width * b + i])
            return false;
    return true;
}

/* Records the value of a corner for its position. Returns whether it differs from an earlier one. */
static bool note(uint32_t *index, uint32_t value, const double *values, size_t width)
{
    if (value == MODEL_NONE)
        return false;
    if (*index == MODEL_NONE)
        *index = value;
    return !same(values, width, *index, value);
}

static void clear(const mesh_model *model, uint32_t *indices)
{
    for (size_t i = 0; i < model->position_count; i++)
        indices[i] = MODEL_NONE;
}

/* Records the normals or texture coordinates of all corners by position. Returns whether there are different
   ones. */
static bool note_corners(const mesh_model *model, bool normals, uint32_t *indices)
{
    const double *values = normals ? model->normals : model->texcoords;
    bool several = false;
    clear(model, indices);
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < model->lists[k].corner_count && !ffd_deadline_passed_at(i); i++) {
            const model_corner *corner = &model->lists[k].corners[i];
            const uint32_t value = normals ? corner->normal : corner->texcoord;
            several = note(&indices[corner->position], value, values, normals ? 3 : 2) || several;
        }
    return several;
}

bool ffd_model_texcoords_by_position(const mesh_model *model, uint32_t *indices)
{
    return note_corners(model, false, indices);
}

bool ffd_model_normals_by_position(const mesh_model *model, uint32_t *indices)
{
    return note_corners(model, true, indices);
}

static bool fit_bytes(const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double scaled = 255 * numbers[i];
        if (!(scaled >= 0 && scaled <= 255 && fabs(scaled - floor_of(scaled + 0.5)) <= BYTE_TOLERANCE))
            return false;
    }
    return true;
}

bool ffd_model_colours_fit_bytes(const mesh_model *model)
{
    return !model->colours || model->coarse_colours || fit_bytes(model->colours, 4 * model->position_count);
}

bool ffd_model_face_colours_fit_bytes(const mesh_model *model)
{
    return !model->face_colours || fit_bytes(model->face_colours, 4 * model->coloured_faces);
}

bool ffd_model_has_face_alpha(const mesh_model *model)
{
    bool found = false;
    for (size_t i = 0; i < model->coloured_faces; i++)
        found = found || model->face_colours[4 * i + 3] < 1;
    return found;
}

/* Returns whether colours are from 0 to 255, which some files do not declare: all are integers, and not all
   are 0 or 1. */
static bool are_bytes(const double *colours, size_t count)
{
    bool large = false;
    for (size_t i = 0; i < 4 * count; i++) {
        const double value = colours[i];
        if (i % 4 == 3 || !isfinite(value))
            continue;
        if (value < 0 || value > 255 || floor_of(value) < value)
            return false;
        large = large || value > 1;
    }
    return large;
}

static void scale_colours(double *colours, size_t count)
{
    const bool bytes = colours && are_bytes(colours, count);
    for (size_t i = 0; bytes && i < count; i++)
        for (size_t c = 0; c < 4; c++)
            colours[4 * i + c] /= c < 3 || colours[4 * i + 3] > 1 ? 255 : 1;
}

/* If nothing uses the vertices, and they are not control points, they are a point cloud. Normals are in the
   order of the vertices. */
static ffd_status make_cloud(mesh_model *model, ffd_error *error)
{
    const bool normals = model->normal_count == model->position_count,
               texcoords = model->texcoord_count == model->position_count;
    for (int k = 0; k < MODEL_KINDS; k++)
        if (model->lists[k].count > 0)
            return FFD_OK;
    if (model->features & MODEL_HAS_FREE_FORM)
        return FFD_OK;
    if (model->position_count > 0 && model->run_count == 0)
        TRY(ffd_model_begin_run(model, NULL, NULL, NULL, error));
    for (size_t i = 0; i < model->position_count; i++) {
        const uint32_t index = (uint32_t)i;
        const model_corner corner = {index, texcoords ? index : MODEL_NONE, normals ? index : MODEL_NONE};
        TRY(ffd_model_add(model, MODEL_POINTS, &corner, 1, error));
    }
    return FFD_OK;
}

static uint32_t features_of_corners(const mesh_model *model)
{
    uint32_t found = 0;
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < model->lists[k].corner_count; i++) {
            const model_corner *corner = &model->lists[k].corners[i];
            found |= corner->texcoord != MODEL_NONE ? MODEL_HAS_TEXCOORDS : 0;
            if (corner->normal != MODEL_NONE)
                found |= k == MODEL_FACES ? MODEL_HAS_NORMALS : MODEL_HAS_NORMALS | MODEL_HAS_POINT_NORMALS;
        }
    const model_list *faces = &model->lists[MODEL_FACES];
    if (faces->corner_count > 3 * faces->count)
        found |= MODEL_HAS_POLYGONS;
    found |= model->lists[MODEL_LINES].count > 0 ? MODEL_HAS_LINES : 0;
    found |= model->lists[MODEL_POINTS].count > 0 ? MODEL_HAS_POINTS : 0;
    return found;
}

static uint32_t features_of_names(const mesh_model *model)
{
    uint32_t found = 0;
    for (size_t i = 0; i < model->run_count; i++) {
        found |= model->runs[i].object != MODEL_NONE ? MODEL_HAS_OBJECTS : 0;
        found |= model->runs[i].group != MODEL_NONE ? MODEL_HAS_GROUPS : 0;
        found |= model->runs[i].material != MODEL_NONE ? MODEL_HAS_MATERIAL_NAMES : 0;
    }
    return found;
}

static bool has_loose(const mesh_model *model, uint32_t *used)
{
    clear(model, used);
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < model->lists[k].corner_count; i++)
            used[model->lists[k].corners[i].position] = 0;
    for (size_t i = 0; i < model->position_count; i++)
        if (used[i] == MODEL_NONE)
            return true;
    return false;
}

static uint32_t features_of_colours(const mesh_model *model)
{
    if (!model->colours)
        return 0;
    for (size_t i = 0; i < model->position_count; i++)
        if (model->colours[4 * i + 3] < 1)
            return MODEL_HAS_COLOURS | MODEL_HAS_ALPHA;
    return MODEL_HAS_COLOURS;
}

/* Returns whether float32 changes the shape of a model as a whole. */
static bool loses_shape(const mesh_model *model)
{
    ffd_bounds box = ffd_bounds_empty();
    double error = 0;
    for (size_t i = 0; i < model->position_count; i++) {
        ffd_bounds_widen_finite(&box, model->positions + 3 * i);
        error = larger_of(error, ffd_float_error(model->positions + 3 * i));
    }
    const double side = ffd_bounds_side(&box);
    return side > 0 && error > SHAPE_TOLERANCE * side;
}

/* What rounding does to an object or group. */
typedef struct part_error {
    ffd_bounds box;
    double error;
} part_error;

static void measure_run(const mesh_model *model, size_t run, part_error *part)
{
    for (int k = 0; k < MODEL_KINDS; k++) {
        const model_list *const list = &model->lists[k];
        const size_t first = model->runs[run].first[k], end = model_run_end(model, run, (model_kind)k);
        for (size_t c = first < end ? list->starts[first] : 0; first < end && c < list->starts[end]; c++) {
            const double *const position = model->positions + 3 * (size_t)list->corners[c].position;
            ffd_bounds_widen_finite(&part->box, position);
            part->error = larger_of(part->error, ffd_float_error(position));
        }
    }
}

/* Finds whether float32 changes the shape of an object or group. A shape that is small beside its distance
   from the origin is lost even where the model reaches from there to the origin. */
static ffd_status find_lost_parts(const mesh_model *model, bool *lost, ffd_error *error)
{
    intern_table names = {0};
    part_error *const parts = ffd_alloc(model->run_count, sizeof *parts);
    ffd_status status;
    TRY_END(parts ? FFD_OK : ffd_fail_memory(error));
    for (size_t r = 0; r < model->run_count; r++) {
        const uint32_t key[2] = {model->runs[r].object, model->runs[r].group};
        const size_t known = names.count;
        uint32_t index;
        if (!ffd_intern(&names, key, sizeof key, &index))
            TRY_END(ffd_fail_memory(error));
        if (index == known)
            parts[index] = (part_error){.box = ffd_bounds_empty()};
        measure_run(model, r, &parts[index]);
    }
    for (size_t p = 0; p < names.count; p++) {
        const double side = ffd_bounds_side(&parts[p].box);
        *lost = *lost || (side > 0 && parts[p].error > PART_TOLERANCE * side);
    }
end:
    ffd_intern_free(&names);
    ffd_free(parts);
    return status;
}

static ffd_status find_fine_positions(mesh_model *model, ffd_error *error)
{
    bool lost = loses_shape(model);
    const ffd_status status = lost ? FFD_OK : find_lost_parts(model, &lost, error);
    model->features |= lost ? MODEL_HAS_FINE_POSITIONS : 0;
    return status;
}

ffd_status ffd_model_finish(mesh_model *model, ffd_error *error)
{
    TRY(make_cloud(model, error));
    scale_colours(model->colours, model->position_count);
    scale_colours(model->face_colours, model->coloured_faces);
    TRY(ffd_model_colour_rest(model, error));
    TRY(find_fine_positions(model, error));
    uint32_t *indices = ffd_alloc(model->position_count, sizeof *indices);
    if (!indices)
        return ffd_fail_memory(error);
    model->features |= features_of_corners(model) | features_of_names(model) | features_of_colours(model);
    model->features |= model->face_colours ? MODEL_HAS_FACE_COLOURS : 0;
    if (ffd_model_normals_by_position(model, indices))
        model->features |= MODEL_HAS_CORNER_NORMALS;
    if (ffd_model_texcoords_by_position(model, indices))
        model->features |= MODEL_HAS_CORNER_TEXCOORDS;
    if (has_loose(model, indices))
        model->features |= MODEL_HAS_LOOSE;
    ffd_free(indices);
    return ffd_deadline_check(error);
}

/* Features that are not named if another one is lost too, because they depend on it. */
static const struct {
    uint32_t feature, implied_by;
    const char *words;
} descriptions[] = {
    {MODEL_HAS_FINE_POSITIONS, 0, "the precision of coordinates that far from the origin"},
    {MODEL_HAS_RATIONAL, MODEL_HAS_FREE_FORM, "w of vertices"},
    {MODEL_HAS_POLYGONS, 0, "polygons (written as triangles)"},
    {MODEL_HAS_LINES, 0, "lines"},
    {MODEL_HAS_POINTS, 0, "points"},
    {MODEL_HAS_LOOSE, 0, "vertices that nothing uses"},
    {MODEL_HAS_NORMALS, 0, "vertex normals"},
    {MODEL_HAS_CORNER_NORMALS, MODEL_HAS_NORMALS, "vertex normals (a vertex has several)"},
    {MODEL_HAS_POINT_NORMALS, MODEL_HAS_NORMALS, "normals of lines and points"},
    {MODEL_HAS_TANGENTS, 0, "tangents"},
    {MODEL_HAS_TEXCOORDS, 0, "texture coordinates"},
    {MODEL_HAS_CORNER_TEXCOORDS, MODEL_HAS_TEXCOORDS, "texture coordinates (a vertex has several)"},
    {MODEL_HAS_MORE_TEXCOORDS, MODEL_HAS_TEXCOORDS, "further texture coordinates"},
    {MODEL_HAS_COLOURS, 0, "vertex colours"},
    {MODEL_HAS_ALPHA, MODEL_HAS_COLOURS, "the alpha of vertex colours"},
    {MODEL_HAS_FACE_COLOURS, 0, "face colours"},
    {MODEL_HAS_SMOOTHING, 0, "smoothing groups"},
    {MODEL_HAS_OBJECTS, 0, "object names"},
    {MODEL_HAS_GROUPS, 0, "group names"},
    {MODEL_HAS_MATERIAL_NAMES, MODEL_HAS_MATERIALS, "material names"},
    {MODEL_HAS_MATERIALS, 0, "materials"},
    {MODEL_HAS_TEXTURES, 0, "textures"},
    {MODEL_HAS_FREE_FORM, 0, "free-form curves and surfaces"},
    {MODEL_HAS_HIERARCHY, 0, "the node hierarchy"},
    {MODEL_HAS_TRANSFORMS, 0, "the transforms of nodes ({input.space=mesh})"},
    {MODEL_HAS_SKINS, 0, "skins"},
    {MODEL_HAS_MORPHS, 0, "morph targets"},
    {MODEL_HAS_ANIMATIONS, 0, "animations"},
    {MODEL_HAS_CAMERAS, 0, "cameras and lights"},
    {MODEL_HAS_HIDDEN, 0, "what is not in the displayed scene"},
    {MODEL_HAS_MORE, 0, "further data of vertices and faces"},
};

void ffd_model_describe_loss(const mesh_model *model, uint32_t holds, char *text, size_t capacity)
{
    const uint32_t lost = model->features & ~holds;
    size_t length = 0;
    text[0] = 0;
    for (size_t i = 0; i < sizeof descriptions / sizeof *descriptions; i++) {
        const char *words = descriptions[i].words;
        if (!(lost & descriptions[i].feature) || lost & descriptions[i].implied_by)
            continue;
        if (descriptions[i].feature == MODEL_HAS_MATERIALS && holds & MODEL_HAS_MATERIAL_NAMES &&
            model->features & MODEL_HAS_MATERIAL_NAMES)
            words = "materials (their names are kept)";
        const int more =
            snprintf(text + length, capacity - length, "%s%s", length ? ", " : "", SPELLED(words));
        if (more < 0 || (size_t)more >= capacity - length)
            return;
        length += (size_t)more;
    }
}
