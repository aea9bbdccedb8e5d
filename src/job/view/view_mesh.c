/* view_mesh.c - makes a scene's geometry from a model and its deformed positions. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "job/view/view.h"
#include "mesh/model_triangles.h"
#include <math.h>
#include <string.h>

/* Memory of a triangle: corners, their texture coordinates, its polygon and a mark. */
#define TRIANGLE_BYTES (3 * sizeof(uint32_t) + 6 * sizeof(float) + sizeof(uint32_t) + 1)
/* Of further texture coordinates. */
#define GLOW_BYTES (6 * sizeof(float))

typedef struct mesh_taker {
    const mesh_model *model;
    view_scene *scene;
    uint32_t *faces;
    size_t triangles;        /* triangles so far */
    const model_run *run;    /* the current one */
    mesh_texture base, glow; /* of its material */
    face_triangles scratch;
    ffd_error *error;
} mesh_taker;

/* Returns the material of this number, or else the first of this name. */
static uint32_t material_of_run(const mesh_taker *t, const model_run *run)
{
    const mesh_materials *const materials = &t->scene->materials;
    const char *const name = model_name(t->model, run->material);
    if (run->material_index != MODEL_NONE)
        return run->material_index < materials->count ? run->material_index : VIEW_NONE;
    for (size_t i = 0; name && i < materials->count; i++)
        if (strcmp(materials->list[i].name, name) == 0)
            return (uint32_t)i;
    return VIEW_NONE;
}

static bool has_same_coordinates(const mesh_texture *a, const mesh_texture *b)
{
    return memcmp(a->scale, b->scale, sizeof a->scale) == 0 &&
           memcmp(a->offset, b->offset, sizeof a->offset) == 0;
}

/* Whether the emission of a material has a texture that takes other coordinates than its base colour. */
static bool has_own_glow(const mesh_taker *t, const model_run *run)
{
    const uint32_t index = material_of_run(t, run);
    if (index == VIEW_NONE)
        return false;
    const mesh_material *const m = &t->scene->materials.list[index];
    return m->glow.image != MATERIAL_NONE &&
           (run->glow_step != 0 || !has_same_coordinates(&m->base, &m->glow));
}

static ffd_status make_glow(mesh_taker *t)
{
    view_scene *const scene = t->scene;
    memory_budget *const budget = t->model->budget;
    bool is_needed = false;
    for (size_t r = 0; r < t->model->run_count && scene->texcoords && !is_needed; r++)
        is_needed = has_own_glow(t, &t->model->runs[r]);
    if (!is_needed)
        return FFD_OK;
    TRY(budget ? ffd_budget_take(budget, scene->triangle_count, GLOW_BYTES, t->error) : FFD_OK);
    scene->glow_texcoords = ffd_alloc_zero(scene->triangle_count, 6 * sizeof *scene->glow_texcoords);
    return scene->glow_texcoords ? FFD_OK : ffd_fail_memory(t->error);
}

static ffd_status make_arrays(mesh_taker *t)
{
    view_scene *const scene = t->scene;
    const size_t count = model_triangle_count(t->model);
    const size_t ends = t->model->lists[MODEL_LINES].corner_count,
                 points = t->model->lists[MODEL_POINTS].corner_count;
    if (count > UINT32_MAX / 3)
        return ffd_fail(t->error, FFD_E_LIMIT, "%zu triangles are more than can be shown", count);
    memory_budget *const budget = t->model->budget;
    if (budget && (ffd_budget_take(budget, count, TRIANGLE_BYTES, t->error) ||
                   ffd_budget_take(budget, ends, 3 * sizeof *scene->segments, t->error) ||
                   ffd_budget_take(budget, points, 2 * sizeof *scene->points, t->error)))
        return FFD_E_LIMIT;
    scene->triangle_count = count;
    scene->triangles = ffd_alloc(count, 3 * sizeof *scene->triangles);
    scene->texcoords =
        t->model->texcoord_count ? ffd_alloc_sparse(count, 6 * sizeof *scene->texcoords) : NULL;
    scene->segments = ffd_alloc(ends, 2 * sizeof *scene->segments);
    scene->points = ffd_alloc(points, sizeof *scene->points);
    scene->segment_materials = ffd_alloc(ends, sizeof *scene->segment_materials);
    scene->point_materials = ffd_alloc(points, sizeof *scene->point_materials);
    scene->parts = ffd_alloc_zero(t->model->run_count, sizeof *scene->parts);
    t->faces = ffd_alloc(count, sizeof *t->faces);
    const bool made = scene->triangles && (scene->texcoords || !t->model->texcoord_count) &&
                      scene->segments && scene->points && scene->segment_materials &&
                      scene->point_materials && scene->parts && t->faces;
    return made ? make_glow(t) : ffd_fail_memory(t->error);
}

static void put_texcoord(const mesh_taker *t, int64_t texcoord, const mesh_texture *by, float *to)
{
    for (size_t a = 0; a < 2; a++)
        to[a] = (float)(by->scale[a] * t->model->texcoords[2 * (size_t)texcoord + a] + by->offset[a]);
}

static void put_corner(mesh_taker *t, const model_corner *corner, size_t at)
{
    view_scene *const scene = t->scene;
    scene->triangles[at] = corner->position;
    if (!scene->texcoords || corner->texcoord == MODEL_NONE)
        return;
    put_texcoord(t, corner->texcoord, &t->base, scene->texcoords + 2 * at);
    if (scene->glow_texcoords)
        put_texcoord(t, corner->texcoord + t->run->glow_step, &t->glow, scene->glow_texcoords + 2 * at);
}

static ffd_status take_face(mesh_taker *t, size_t face)
{
    size_t count, triangles = 0;
    const model_corner *const corners = model_element(&t->model->lists[MODEL_FACES], face, &count);
    TRY(ffd_face_triangles(&t->scratch, t->model, face, &triangles, t->error));
    for (size_t i = 0; i < 3 * triangles; i++)
        put_corner(t, &corners[t->scratch.triangles[i]], 3 * t->triangles + i);
    for (size_t i = 0; i < triangles; i++)
        t->faces[t->triangles++] = (uint32_t)face;
    return FFD_OK;
}

static const char *name_of_run(const mesh_model *model, const model_run *run)
{
    const char *const names[] = {model_name(model, run->group), model_name(model, run->object),
                                 model_name(model, run->material)};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i])
            return names[i];
    return "";
}

/* Takes the lines and points of a run, which has no part of its own. */
static void take_lines(mesh_taker *t, size_t r, uint32_t material)
{
    view_scene *const scene = t->scene;
    const mesh_model *const model = t->model;
    const model_run *const run = &model->runs[r];
    size_t count;
    for (size_t l = run->first[MODEL_LINES]; l < model_run_end(model, r, MODEL_LINES); l++) {
        const model_corner *const corners = model_element(&model->lists[MODEL_LINES], l, &count);
        for (size_t c = 1; c < count; c++) {
            uint32_t *const segment = scene->segments + 2 * scene->segment_count;
            segment[0] = corners[c - 1].position;
            segment[1] = corners[c].position;
            scene->segment_materials[scene->segment_count++] = material;
        }
    }
    for (size_t p = run->first[MODEL_POINTS]; p < model_run_end(model, r, MODEL_POINTS); p++) {
        const model_corner *const corners = model_element(&model->lists[MODEL_POINTS], p, &count);
        for (size_t c = 0; c < count; c++) {
            scene->points[scene->point_count] = corners[c].position;
            scene->point_materials[scene->point_count++] = material;
        }
    }
}

static ffd_status take_run(mesh_taker *t, size_t r)
{
    const model_run *const run = &t->model->runs[r];
    const size_t first = t->triangles, end = model_run_end(t->model, r, MODEL_FACES);
    view_part *const part = &t->scene->parts[t->scene->part_count];
    const uint32_t material = material_of_run(t, run);
    const mesh_material *const m = material == VIEW_NONE ? NULL : &t->scene->materials.list[material];
    t->run = run;
    t->base = m ? m->base : ffd_texture_none();
    t->glow = m ? m->glow : ffd_texture_none();
    for (size_t f = run->first[MODEL_FACES]; f < end; f++)
        TRY(take_face(t, f));
    take_lines(t, r, material);
    if (t->triangles == first)
        return FFD_OK;
    *part = (view_part){.name = ffd_text_copy(name_of_run(t->model, run)),
                        .material = material,
                        .first_triangle = first,
                        .triangle_count = t->triangles - first};
    t->scene->part_count++;
    return part->name ? FFD_OK : ffd_fail_memory(t->error);
}

/* Moves positions, colours and numbers from the model to the scene. */
static void take_vertices(mesh_model *model, view_scene *scene)
{
    scene->vertex_count = scene->vertices_all = model->position_count;
    scene->before = model->positions;
    scene->indices = model->indices;
    scene->colors = model->colours;
    model->positions = model->colours = NULL;
    model->indices = NULL;
    model->position_count = 0;
}

ffd_status ffd_view_take_mesh(mesh_model *model, view_scene *scene, uint32_t **faces, const mesh_log *log,
                              ffd_error *error)
{
    mesh_taker t = {.model = model, .scene = scene, .error = error};
    ffd_status status;
    TRY_END(make_arrays(&t));
    for (size_t r = 0; r < model->run_count; r++)
        TRY_END(take_run(&t, r));
    take_vertices(model, scene);
    ffd_polygon_cut_warn(t.scratch.cutter.hurried, log);
    if (model->features & MODEL_HAS_TEXTURES && scene->materials.count == 0)
        ffd_log_line(log, FFD_LOG_WARNING, "the textures that the file names are not shown");
    if (model->face_colours)
        ffd_log_line(log, FFD_LOG_WARNING, "the colours of faces are not shown");
end:
    ffd_face_triangles_free(&t.scratch);
    *faces = t.faces;
    return status;
}

ffd_status ffd_view_place_after(const mesh_model *model, const double *deformed, view_scene *scene,
                                ffd_error *error)
{
    const size_t vertex = 3 * sizeof *scene->after;
    if (model->budget)
        TRY(ffd_budget_take(model->budget, scene->vertex_count, vertex, error));
    scene->after = ffd_alloc(scene->vertex_count, vertex);
    if (!scene->after)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < scene->vertex_count; v++) {
        const size_t index = ffd_view_vertex_of(scene, 1, v);
        const bool has_place = deformed && !isnan(deformed[3 * index]);
        memcpy(scene->after + 3 * v, has_place ? deformed + 3 * index : scene->before + 3 * v, vertex);
    }
    return FFD_OK;
}
