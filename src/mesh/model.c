#include "mesh/model.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <inttypes.h>
#include <string.h>

void ffd_model_free(mesh_model *model)
{
    ffd_free(model->indices);
    ffd_free(model->positions);
    ffd_free(model->texcoords);
    ffd_free(model->normals);
    for (size_t k = 0; k < model->morph_count; k++) {
        ffd_free(model->morphs[k].positions);
        ffd_free(model->morphs[k].normals);
    }
    ffd_free(model->morphs);
    ffd_free(model->colours);
    ffd_free(model->face_colours);
    for (int k = 0; k < MODEL_KINDS; k++) {
        ffd_free(model->lists[k].starts);
        ffd_free(model->lists[k].corners);
    }
    ffd_free(model->runs);
    ffd_intern_free(&model->names);
    *model = (mesh_model){0};
}

/* Estimated bytes for a corner, with its share of a face, and for a run with its names. */
#define CORNER_BYTES (sizeof(model_corner) + sizeof(size_t) / 3 + 1)
#define RUN_BYTES 192

ffd_status ffd_model_take(mesh_model *model, uint64_t count, uint64_t size, ffd_error *error)
{
    return model->budget ? ffd_budget_take(model->budget, count, size, error) : FFD_OK;
}

static ffd_status make(mesh_model *model, double **values, size_t count, size_t width, ffd_error *error)
{
    if (count > MODEL_VALUES_MAX)
        return ffd_fail(error, FFD_E_LIMIT, "a conversion takes at most %" PRIu32 " vertices or normals",
                        MODEL_VALUES_MAX);
    const ffd_status status = ffd_model_take(model, count, width * sizeof **values, error);
    if (count == 0 || status)
        return status;
    *values = ffd_alloc_zero(count, width * sizeof **values);
    return *values ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_model_make_values(mesh_model *model, size_t positions, size_t texcoords, size_t normals,
                                 ffd_error *error)
{
    TRY(make(model, &model->positions, positions, 3, error));
    TRY(make(model, &model->texcoords, texcoords, 2, error));
    TRY(make(model, &model->normals, normals, 3, error));
    model->position_count = positions;
    model->texcoord_count = texcoords;
    model->normal_count = normals;
    return FFD_OK;
}

ffd_status ffd_model_make_colours(mesh_model *model, ffd_error *error)
{
    if (model->colours)
        return FFD_OK;
    TRY(ffd_model_take(model, model->position_count, 4 * sizeof *model->colours, error));
    model->colours = ffd_alloc(model->position_count, 4 * sizeof *model->colours);
    if (!model->colours)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 4 * model->position_count; i++)
        model->colours[i] = 1;
    return FFD_OK;
}

static bool find_name(mesh_model *model, const char *text, uint32_t *name)
{
    *name = MODEL_NONE;
    return !text || !*text || ffd_intern(&model->names, text, strlen(text), name);
}

/* Begins a run whose names are set; replaces the last run if that is empty. */
static ffd_status add_run(mesh_model *model, model_run run, ffd_error *error)
{
    const model_run *const last = model->run_count ? &model->runs[model->run_count - 1] : NULL;
    for (int k = 0; k < MODEL_KINDS; k++)
        run.first[k] = model->lists[k].count;
    if (last && memcmp(last->first, run.first, sizeof run.first) == 0)
        model->run_count--; /* the last run is empty */
    else
        TRY(ffd_model_take(model, 1, RUN_BYTES, error));
    if (!ffd_grow((void **)&model->runs, &model->run_capacity, model->run_count + 1, sizeof *model->runs))
        return ffd_fail_memory(error);
    model->runs[model->run_count++] = run;
    return FFD_OK;
}

ffd_status ffd_model_begin_run(mesh_model *model, const char *object, const char *group, const char *material,
                               ffd_error *error)
{
    model_run run;
    if (!find_name(model, object, &run.object) || !find_name(model, group, &run.group) ||
        !find_name(model, material, &run.material))
        return ffd_fail_memory(error);
    run.material_index = MODEL_NONE;
    run.glow_step = 0;
    const model_run *last = model->run_count ? &model->runs[model->run_count - 1] : NULL;
    if (last && last->object == run.object && last->group == run.group && last->material == run.material)
        return FFD_OK;
    return add_run(model, run, error);
}

ffd_status ffd_model_set_material(mesh_model *model, uint32_t index, int64_t glow_step, ffd_error *error)
{
    model_run run = model->runs[model->run_count - 1];
    if (run.material_index == index && run.glow_step == glow_step)
        return FFD_OK;
    run.material_index = index;
    run.glow_step = glow_step;
    return add_run(model, run, error);
}

static ffd_status append(model_list *list, const model_corner *corners, size_t count, ffd_error *error)
{
    if (!ffd_grow((void **)&list->starts, &list->start_capacity, list->count + 2, sizeof *list->starts) ||
        !ffd_grow((void **)&list->corners, &list->corner_capacity, list->corner_count + count,
                  sizeof *list->corners))
        return ffd_fail_memory(error);
    memcpy(list->corners + list->corner_count, corners, count * sizeof *corners);
    list->starts[list->count++] = list->corner_count;
    list->corner_count += count;
    list->starts[list->count] = list->corner_count;
    return FFD_OK;
}

ffd_status ffd_model_add(mesh_model *model, model_kind kind, const model_corner *corners, size_t count,
                         ffd_error *error)
{
    TRY(ffd_deadline_check_at(model->lists[kind].count, error));
    TRY(ffd_model_take(model, count, CORNER_BYTES, error));
    if (kind == MODEL_POINTS || count == 1) {
        for (size_t i = 0; i < count; i++)
            TRY(append(&model->lists[MODEL_POINTS], corners + i, 1, error));
        return FFD_OK;
    }
    return count == 0 ? FFD_OK
                      : append(&model->lists[count == 2 ? MODEL_LINES : kind], corners, count, error);
}

/* The colour of a face without one (Geomview's manual, OFF). */
#define GREY (2.0 / 3)

/* Adds colours of faces up to `count`: grey ones. */
static ffd_status colour_up_to(mesh_model *model, size_t count, ffd_error *error)
{
    const size_t more = count - model->coloured_faces;
    TRY(ffd_model_take(model, more, 4 * sizeof *model->face_colours, error));
    if (!ffd_grow((void **)&model->face_colours, &model->face_colour_capacity, 4 * count,
                  sizeof *model->face_colours))
        return ffd_fail_memory(error);
    for (size_t i = 4 * model->coloured_faces; i < 4 * count; i++)
        model->face_colours[i] = i % 4 == 3 ? 1 : GREY;
    model->coloured_faces = count;
    return FFD_OK;
}

ffd_status ffd_model_colour_face(mesh_model *model, const double colour[4], ffd_error *error)
{
    const size_t count = model->lists[MODEL_FACES].count;
    TRY(colour_up_to(model, count, error));
    if (count > 0)
        memcpy(model->face_colours + 4 * (count - 1), colour, 4 * sizeof *colour);
    return FFD_OK;
}

ffd_status ffd_model_colour_rest(mesh_model *model, ffd_error *error)
{
    return model->face_colours ? colour_up_to(model, model->lists[MODEL_FACES].count, error) : FFD_OK;
}

ffd_status ffd_model_check_memory(const mesh_model *model, size_t corner_bytes, size_t run_bytes,
                                  ffd_error *error)
{
    if (!model->budget)
        return FFD_OK;
    memory_budget budget = *model->budget;
    TRY(ffd_budget_take(&budget, model->run_count, run_bytes, error));
    for (int k = 0; k < MODEL_KINDS; k++) {
        const model_list *list = &model->lists[k];
        const size_t corners = list->corner_count; /* at least 3 for each face */
        TRY(ffd_budget_take(&budget, k == MODEL_FACES ? 3 * (corners - 2 * list->count) : corners,
                            corner_bytes, error));
    }
    return FFD_OK;
}

static void copy_vector(const double *from, uint32_t i, double *to, uint32_t k)
{
    memcpy(to + 3 * (size_t)k, from + 3 * (size_t)i, 3 * sizeof *to);
}

static double *copy_vectors(const double *vectors, size_t count)
{
    double *copy = ffd_alloc(count, 3 * sizeof *copy);
    if (copy && count > 0)
        memcpy(copy, vectors, 3 * count * sizeof *copy);
    return copy;
}

/* Both models have the same corners with the same positions, but a normal that several corners shared can be
   split in the second model. Normals get the indices of the second model. A document splits them in the same
   way for each target of a job. */
static void join_corners(mesh_model *before, const mesh_model *after, double *positions, double *normals)
{
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < before->lists[k].corner_count; i++) {
            model_corner *corner = &before->lists[k].corners[i];
            const model_corner *moved = &after->lists[k].corners[i];
            copy_vector(after->positions, corner->position, positions, corner->position);
            if (corner->normal != MODEL_NONE)
                copy_vector(before->normals, corner->normal, normals, moved->normal);
            corner->normal = moved->normal;
        }
}

ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error)
{
    if (!ffd_grow((void **)&before->morphs, &before->morph_capacity, before->morph_count + 1,
                  sizeof *before->morphs))
        return ffd_fail_memory(error);
    /* Values that no corner refers to do not move. */
    double *normals = copy_vectors(after->normals, after->normal_count);
    double *positions = copy_vectors(before->positions, before->position_count);
    if (!normals || !positions) {
        ffd_free(normals);
        ffd_free(positions);
        return ffd_fail_memory(error);
    }
    join_corners(before, after, positions, normals);
    ffd_free(before->normals);
    before->normals = normals;
    before->normal_count = after->normal_count;
    before->morphs[before->morph_count++] = (model_morph){positions, after->normals, name};
    after->normals = NULL;
    ffd_model_free(after);
    return FFD_OK;
}

static bool differ(const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (a[i] < b[i] || a[i] > b[i])
            return true;
    return false;
}

bool ffd_model_morphs(const mesh_model *model, size_t morph)
{
    const model_morph *const target = &model->morphs[morph];
    return differ(model->positions, target->positions, 3 * model->position_count) ||
           differ(model->normals, target->normals, target->normals ? 3 * model->normal_count : 0);
}
