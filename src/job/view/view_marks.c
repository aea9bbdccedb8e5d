/* view_marks.c - marks of a deformation in a scene: statuses, det F, flipped faces, torn edges, the witness
   of a fold; and the control lattices. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/measure/quality.h"
#include "job/view/view.h"
#include "lattice/file/lattice_source.h"
#include "lattice/lattice.h"
#include <math.h>
#include <string.h>

static uint64_t index_of(const view_scene *scene, size_t vertex)
{
    return scene->indices ? scene->indices[vertex] : vertex;
}

static ffd_status add_statuses(const job_details *details, const mesh_model *model, view_scene *scene,
                               ffd_error *error)
{
    TRY(model->budget ? ffd_budget_take(model->budget, scene->vertex_count, 1 + sizeof *scene->dets, error)
                      : FFD_OK);
    scene->statuses = ffd_alloc(scene->vertex_count, 1);
    scene->dets = ffd_alloc(scene->vertex_count, sizeof *scene->dets);
    if (!scene->statuses || !scene->dets)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < scene->vertex_count; v++) {
        const size_t index = (size_t)index_of(scene, v);
        double f[9];
        scene->statuses[v] = details->statuses[index];
        scene->dets[v] = NAN;
        if (!details->gradients)
            continue;
        memcpy(f, details->gradients + 9 * index, sizeof f);
        for (size_t a = 0; a < 3; a++)
            f[4 * a] += 1;
        scene->dets[v] = details->collapsed && details->collapsed[index] ? 0 : mat_determinant(f);
    }
    return FFD_OK;
}

/* Whether a polygon of the model is flipped. indices: scratch memory for its corners. */
static bool is_flipped(const job_details *details, const view_scene *scene, const mesh_model *model,
                       size_t face, uint32_t *indices)
{
    size_t count;
    const model_corner *const corners = model_element(&model->lists[MODEL_FACES], face, &count);
    for (size_t c = 0; c < count; c++)
        indices[c] = (uint32_t)index_of(scene, corners[c].position);
    const face_motion motion = {details->faces.positions, details->deformed, details->gradients,
                                details->collapsed};
    return ffd_quality_is_flipped(indices, count, &motion);
}

static ffd_status add_flipped(const job_details *details, const mesh_model *model, const uint32_t *faces,
                              view_scene *scene, ffd_error *error)
{
    uint32_t *indices = NULL;
    size_t capacity = 0;
    bool flipped = false;
    if (!details->has_faces || scene->flipped_faces == 0)
        return FFD_OK;
    scene->flipped = ffd_alloc_zero(scene->triangle_count, 1);
    bool made = scene->flipped;
    for (size_t t = 0; t < scene->triangle_count && made; t++) {
        const size_t face = faces[t];
        if (t == 0 || faces[t - 1] != face) {
            const model_list *const list = &model->lists[MODEL_FACES];
            made = ffd_grow((void **)&indices, &capacity, list->starts[face + 1] - list->starts[face],
                            sizeof *indices);
            flipped = made && is_flipped(details, scene, model, face, indices);
        }
        scene->flipped[t] = flipped;
    }
    ffd_free(indices);
    return made ? FFD_OK : ffd_fail_memory(error);
}

/* Maps vertex numbers of the document to vertices of the scene; VIEW_NONE: not shown. */
static uint32_t *make_vertices(const view_scene *scene, size_t count)
{
    uint32_t *const vertices = ffd_alloc(count, sizeof *vertices);
    for (size_t i = 0; vertices && i < count; i++)
        vertices[i] = VIEW_NONE;
    for (size_t v = 0; vertices && v < scene->vertex_count; v++)
        vertices[index_of(scene, v)] = (uint32_t)v;
    return vertices;
}

static ffd_status add_tears(const job_details *details, size_t count, view_scene *scene, ffd_error *error)
{
    const torn_edges *const torn = &details->tears;
    if (torn->count == 0)
        return FFD_OK;
    uint32_t *const vertices = make_vertices(scene, count);
    scene->tears = vertices ? ffd_alloc(torn->count, sizeof *scene->tears) : NULL;
    for (size_t i = 0; scene->tears && i < torn->count; i++) {
        const torn_edge *const edge = &torn->list[i];
        const view_tear tear = {{vertices[edge->ends[0]], vertices[edge->ends[1]]}, edge->step};
        if (tear.vertices[0] != VIEW_NONE && tear.vertices[1] != VIEW_NONE)
            scene->tears[scene->tear_count++] = tear;
    }
    ffd_free(vertices);
    return scene->tears ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_view_add_marks(const deform_job *job, const ffd_job_result *result, const mesh_model *model,
                              const uint32_t *faces, view_scene *scene, ffd_error *error)
{
    const job_details *const details = job->details;
    const size_t count = (size_t)ffd_mesh_vertex_count(job->document);
    scene->flipped_faces = result->flipped_faces;
    scene->tear_edges = result->tear.edges;
    scene->witness = result->folds.witness;
    TRY(add_statuses(details, model, scene, error));
    TRY(add_flipped(details, model, faces, scene, error));
    return add_tears(details, count, scene, error);
}

static double *copy_points(const double *points, size_t count)
{
    double *const copy = ffd_alloc(count, 3 * sizeof *copy);
    if (copy)
        memcpy(copy, points, 3 * count * sizeof *copy);
    return copy;
}

ffd_status ffd_view_add_cages(const lattice_chain *chain, const ffd_lattice_source *sources,
                              view_scene *scene, ffd_error *error)
{
    scene->cages = ffd_alloc_zero(chain->count, sizeof *scene->cages);
    if (!scene->cages)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < chain->count; l++) {
        const ffd_lattice *const lattice = ffd_link_mover(&chain->links[l]);
        view_cage *const cage = &scene->cages[scene->cage_count++];
        for (int a = 0; a < 3; a++) {
            cage->size[a] = lattice->size[a];
            cage->closed[a] = ffd_knots_closed(&lattice->knots[a]);
        }
        cage->name = ffd_text_copy(ffd_path_name(ffd_lattice_name(&sources[l])));
        cage->rest = copy_points(lattice->rest, lattice->count);
        cage->deformed = copy_points(lattice->deformed, lattice->count);
        if (!cage->name || !cage->rest || !cage->deformed)
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

void ffd_view_measure(view_scene *scene)
{
    for (size_t v = 0; v < scene->vertex_count; v++) {
        double along[3];
        for (size_t a = 0; a < 3; a++)
            along[a] = scene->after[3 * v + a] - scene->before[3 * v + a];
        const double length = vec_length(along);
        if (isfinite(length) && length > scene->displacement_max)
            scene->displacement_max = length;
    }
}
