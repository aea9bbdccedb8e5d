#include "io/write/glb_plan.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/sort.h"
#include "io/write/glb_values.h"
#include "mesh/model_triangles.h"
#include <string.h>

/* Bytes of a corner in the plan, and of a run with its mesh and its text. */
#define CORNER_BYTES 40
#define RUN_BYTES 780

/* The state of making a plan. */
typedef struct planner {
    glb_plan *plan;
    const mesh_model *model;
    /* Per texture coordinate or normal, the first one with the same value; MODEL_NONE: it cannot be used. */
    uint32_t *texcoords, *normals;
    intern_table primitives; /* keys: primitive_key */
    size_t primitive_capacity;
    uint32_t *primitive_of[MODEL_KINDS]; /* per element */
    size_t *elements[MODEL_KINDS];       /* sorted by primitive */
    face_triangles scratch;
    model_corner *sorted; /* the corners of the current primitive */
    ffd_error *error;
} planner;

typedef struct primitive_key {
    uint32_t mesh, material, kind, normals, texcoords;
} primitive_key;

_Static_assert(sizeof(primitive_key) == 5 * sizeof(uint32_t), "a key has no padding");

static bool read_texcoord(const mesh_model *model, uint32_t index, float *values)
{
    ffd_glb_texcoord(model, index, values);
    return true;
}

/* The values include the offsets of morph targets. */
static bool read_normal(const mesh_model *model, uint32_t index, float *values)
{
    for (size_t k = 0; k < model->morph_count; k++)
        ffd_glb_normal_offset(model, k, index, values + 3 + 3 * k);
    return ffd_glb_normal(model, index, values);
}

typedef bool value_reader(const mesh_model *model, uint32_t index, float *values);

/* Finds equal values, so that corners that refer to them by different indices share a vertex. Values that
   cannot be used get MODEL_NONE. */
static ffd_status join_values(planner *p, size_t count, value_reader *read, size_t size, uint32_t **indices)
{
    intern_table values = {0};
    uint32_t *first = ffd_alloc(count, sizeof *first);
    float *const value = ffd_alloc(size, sizeof *value);
    *indices = ffd_alloc(count, sizeof **indices);
    ffd_status status = FFD_OK;
    if (!*indices || !first || !value)
        TRY_END(ffd_fail_memory(p->error));
    for (size_t i = 0; i < count; i++) {
        uint32_t index;
        const size_t known = values.count;
        TRY_END(ffd_deadline_check_at(i, p->error));
        (*indices)[i] = MODEL_NONE;
        if (!read(p->model, (uint32_t)i, value))
            continue;
        if (!ffd_intern(&values, value, size * sizeof *value, &index))
            TRY_END(ffd_fail_memory(p->error));
        else {
            if (values.count > known)
                first[index] = (uint32_t)i;
            (*indices)[i] = first[index];
        }
    }
end:
    ffd_intern_free(&values);
    ffd_free(first);
    ffd_free(value);
    return status;
}

static model_corner joined(const planner *p, const model_corner *corner)
{
    return (model_corner){corner->position,
                          corner->texcoord == MODEL_NONE ? MODEL_NONE : p->texcoords[corner->texcoord],
                          corner->normal == MODEL_NONE ? MODEL_NONE : p->normals[corner->normal]};
}

static ffd_status find_primitive(planner *p, const primitive_key *key, uint32_t *index)
{
    glb_plan *plan = p->plan;
    if (!ffd_intern(&p->primitives, key, sizeof *key, index))
        return ffd_fail_memory(p->error);
    if (*index < plan->primitive_count)
        return FFD_OK;
    if (!ffd_grow((void **)&plan->primitives, &p->primitive_capacity, plan->primitive_count + 1,
                  sizeof *plan->primitives))
        return ffd_fail_memory(p->error);
    plan->primitives[plan->primitive_count++] = (glb_primitive){.mesh = key->mesh,
                                                                .material = key->material,
                                                                .kind = (model_kind)key->kind,
                                                                .normals = key->normals != 0,
                                                                .texcoords = key->texcoords != 0};
    return FFD_OK;
}

/* A primitive has an attribute only if all corners of its elements have it. */
static ffd_status assign_element(planner *p, primitive_key *key, size_t i)
{
    size_t count;
    const model_corner *corners = model_element(&p->model->lists[key->kind], i, &count);
    key->normals = key->texcoords = 1;
    for (size_t c = 0; c < count; c++) {
        const model_corner corner = joined(p, corners + c);
        key->normals = key->normals && corner.normal != MODEL_NONE;
        key->texcoords = key->texcoords && corner.texcoord != MODEL_NONE;
    }
    TRY(find_primitive(p, key, &p->primitive_of[key->kind][i]));
    glb_primitive *primitive = &p->plan->primitives[p->primitive_of[key->kind][i]];
    primitive->elements++;
    primitive->index_count += key->kind == MODEL_FACES   ? 3 * (count - 2)
                              : key->kind == MODEL_LINES ? 2 * (count - 1)
                                                         : 0;
    return FFD_OK;
}

static ffd_status assign_run(planner *p, size_t r)
{
    const model_run *run = &p->model->runs[r];
    const uint32_t names[2] = {run->object, run->group};
    primitive_key key = {.material = MODEL_NONE};
    bool empty = true;
    for (int k = 0; k < MODEL_KINDS; k++)
        empty = empty && run->first[k] == model_run_end(p->model, r, (model_kind)k);
    if (empty)
        return FFD_OK;
    if (!ffd_intern(&p->plan->meshes, names, sizeof names, &key.mesh) ||
        (run->material != MODEL_NONE &&
         !ffd_intern(&p->plan->materials, &run->material, sizeof run->material, &key.material)))
        return ffd_fail_memory(p->error);
    for (key.kind = 0; key.kind < MODEL_KINDS; key.kind++) {
        const size_t last = model_run_end(p->model, r, (model_kind)key.kind);
        for (size_t i = run->first[key.kind]; i < last; i++) {
            TRY(ffd_deadline_check_at(i, p->error));
            TRY(assign_element(p, &key, i));
        }
    }
    return FFD_OK;
}

static ffd_status assign_all(planner *p)
{
    for (int k = 0; k < MODEL_KINDS; k++) {
        p->primitive_of[k] = ffd_alloc(p->model->lists[k].count, sizeof *p->primitive_of[k]);
        p->elements[k] = ffd_alloc(p->model->lists[k].count, sizeof *p->elements[k]);
        if (!p->primitive_of[k] || !p->elements[k])
            return ffd_fail_memory(p->error);
    }
    for (size_t r = 0; r < p->model->run_count; r++)
        TRY(assign_run(p, r));
    return FFD_OK;
}

/* Sorts the elements of each kind by primitive; within a primitive they keep the model's order. */
static ffd_status sort_elements(planner *p)
{
    const glb_plan *plan = p->plan;
    size_t *next = ffd_alloc(plan->primitive_count, sizeof *next), at[MODEL_KINDS] = {0};
    if (!next)
        return ffd_fail_memory(p->error);
    for (size_t i = 0; i < plan->primitive_count; i++) {
        next[i] = at[plan->primitives[i].kind];
        at[plan->primitives[i].kind] += plan->primitives[i].elements;
    }
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < p->model->lists[k].count; i++)
            p->elements[k][next[p->primitive_of[k][i]]++] = i;
    ffd_free(next);
    return FFD_OK;
}

static ffd_status sort_primitives(planner *p)
{
    glb_plan *plan = p->plan;
    size_t *next = ffd_alloc_zero(plan->meshes.count + 1, sizeof *next);
    plan->by_mesh = ffd_alloc(plan->primitive_count, sizeof *plan->by_mesh);
    if (!next || !plan->by_mesh) {
        ffd_free(next);
        return ffd_fail_memory(p->error);
    }
    for (size_t i = 0; i < plan->primitive_count; i++)
        next[plan->primitives[i].mesh + 1]++;
    for (size_t m = 0; m < plan->meshes.count; m++)
        next[m + 1] += next[m];
    for (size_t i = 0; i < plan->primitive_count; i++)
        plan->by_mesh[next[plan->primitives[i].mesh]++] = (uint32_t)i;
    ffd_free(next);
    return FFD_OK;
}

static int compare_corners(const void *a, const void *b)
{
    const model_corner *x = a, *y = b;
    if (x->position != y->position)
        return x->position < y->position ? -1 : 1;
    if (x->texcoord != y->texcoord)
        return x->texcoord < y->texcoord ? -1 : 1;
    return (x->normal > y->normal) - (x->normal < y->normal);
}

/* Returns a corner without the attributes that its primitive does not have. */
static model_corner corner_of(const planner *p, const glb_primitive *primitive, const model_corner *corner)
{
    model_corner own = joined(p, corner);
    own.texcoord = primitive->texcoords ? own.texcoord : MODEL_NONE;
    own.normal = primitive->normals ? own.normal : MODEL_NONE;
    return own;
}

/* Appends the corners that an element draws to p->sorted. */
static ffd_status draw(planner *p, const glb_primitive *primitive, size_t element, size_t *drawn)
{
    size_t count, triangles = 0;
    const model_corner *corners = model_element(&p->model->lists[primitive->kind], element, &count);
    if (primitive->kind == MODEL_FACES) {
        TRY(ffd_face_triangles(&p->scratch, p->model, element, &triangles, p->error));
        for (size_t i = 0; i < 3 * triangles; i++)
            p->sorted[(*drawn)++] = corner_of(p, primitive, corners + p->scratch.triangles[i]);
        return FFD_OK;
    }
    if (primitive->kind == MODEL_POINTS)
        p->sorted[(*drawn)++] = corner_of(p, primitive, corners);
    for (size_t c = 0; c + 1 < count; c++) {
        p->sorted[(*drawn)++] = corner_of(p, primitive, corners + c);
        p->sorted[(*drawn)++] = corner_of(p, primitive, corners + c + 1);
    }
    return FFD_OK;
}

static bool is_corner_up_to(const void *vertex, const void *corner)
{
    return compare_corners(vertex, corner) <= 0;
}

static uint32_t find_vertex(const model_corner *vertices, size_t count, const model_corner *corner)
{
    return (uint32_t)last_up_to(corner, vertices, count, sizeof *vertices, is_corner_up_to);
}

/* Makes the vertices: each combination once, in the order of the model's positions. Points keep their own
   order. */
static ffd_status number_vertices(planner *p, glb_primitive *primitive, size_t drawn)
{
    glb_plan *plan = p->plan;
    model_corner *vertices = plan->vertices + plan->vertex_count;
    primitive->first_vertex = plan->vertex_count;
    memcpy(vertices, p->sorted, drawn * sizeof *vertices);
    if (primitive->kind == MODEL_POINTS) {
        primitive->vertex_count = drawn;
        plan->vertex_count += drawn;
        return FFD_OK;
    }
    TRY(ffd_sort(vertices, drawn, sizeof *vertices, compare_corners, p->error));
    size_t kept = 0;
    for (size_t i = 0; i < drawn; i++)
        if (i == 0 || compare_corners(vertices + i, vertices + kept - 1) != 0)
            vertices[kept++] = vertices[i];
    primitive->vertex_count = kept;
    plan->vertex_count += kept;
    if (kept > UINT32_MAX - 1)
        return ffd_fail(p->error, FFD_E_LIMIT,
                        "a mesh would have %zu vertices, more than 32-bit indices can number", kept);
    for (size_t i = 0; i < drawn; i++) {
        TRY(ffd_deadline_check_at(i, p->error));
        plan->indices[plan->index_count++] = find_vertex(vertices, kept, p->sorted + i);
    }
    return FFD_OK;
}

/* Allocates for the maximum, one vertex per drawn corner; the rest is released later. */
static ffd_status allocate(planner *p)
{
    glb_plan *plan = p->plan;
    size_t corners = 0, indices = 0, largest = 0;
    for (size_t i = 0; i < plan->primitive_count; i++) {
        const glb_primitive *primitive = &plan->primitives[i];
        const size_t own = primitive->kind == MODEL_POINTS ? primitive->elements : primitive->index_count;
        corners += own;
        indices += primitive->index_count;
        largest = own > largest ? own : largest;
    }
    plan->vertices = ffd_alloc(corners, sizeof *plan->vertices);
    plan->indices = ffd_alloc(indices, sizeof *plan->indices);
    p->sorted = ffd_alloc(largest, sizeof *p->sorted);
    return plan->vertices && plan->indices && p->sorted ? FFD_OK : ffd_fail_memory(p->error);
}

static ffd_status make_vertices(planner *p)
{
    glb_plan *plan = p->plan;
    size_t at[MODEL_KINDS] = {0};
    TRY(allocate(p));
    for (size_t i = 0; i < plan->primitive_count; i++) {
        glb_primitive *primitive = &plan->primitives[i];
        size_t drawn = 0;
        primitive->first_index = plan->index_count;
        for (size_t e = 0; e < primitive->elements; e++) {
            TRY(ffd_deadline_check_at(e, p->error));
            TRY(draw(p, primitive, p->elements[primitive->kind][at[primitive->kind]++], &drawn));
        }
        TRY(number_vertices(p, primitive, drawn));
    }
    model_corner *block = ffd_realloc(plan->vertices, plan->vertex_count, sizeof *block);
    plan->vertices = block ? block : plan->vertices;
    return FFD_OK;
}

static bool is_zero(const float values[3])
{
    for (int a = 0; a < 3; a++)
        if (values[a] < 0 || values[a] > 0)
            return false;
    return true;
}

static bool is_moved(const glb_plan *plan, const glb_primitive *primitive, size_t morph)
{
    for (size_t i = 0; i < primitive->vertex_count; i++) {
        const model_corner *vertex = &plan->vertices[primitive->first_vertex + i];
        float offset[3], turn[3] = {0, 0, 0};
        ffd_glb_position_offset(plan->model, morph, vertex->position, offset);
        if (primitive->normals)
            ffd_glb_normal_offset(plan->model, morph, vertex->normal, turn);
        if (!is_zero(offset) || !is_zero(turn))
            return true;
    }
    return false;
}

/* A mesh has a target if any of its primitives moves; then all its primitives have it. If nothing moves at
   all, every mesh has it, unless the model drops it. */
static void mark_morph(glb_plan *plan, size_t morph)
{
    const size_t morphs = plan->model->morph_count;
    bool any = false;
    for (size_t i = 0; i < plan->primitive_count; i++) {
        bool *const moved = &plan->morphed[plan->primitives[i].mesh * morphs + morph];
        *moved = *moved || is_moved(plan, &plan->primitives[i], morph);
        any = any || *moved;
    }
    for (size_t m = 0; m < plan->meshes.count && !any && !plan->model->drops_still; m++)
        plan->morphed[m * morphs + morph] = true;
}

static ffd_status mark_morphs(glb_plan *plan, ffd_error *error)
{
    plan->morphed = ffd_alloc_zero(plan->meshes.count, plan->model->morph_count * sizeof *plan->morphed);
    if (!plan->morphed)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < plan->model->morph_count; k++)
        mark_morph(plan, k);
    return FFD_OK;
}

ffd_status ffd_glb_make_plan(const mesh_model *model, glb_plan *plan, ffd_error *error)
{
    planner p = {.plan = plan, .model = model, .error = error};
    *plan = (glb_plan){.model = model};
    ffd_status status;
    TRY_END(ffd_model_check_memory(model, CORNER_BYTES, RUN_BYTES, error));
    TRY_END(join_values(&p, model->texcoord_count, read_texcoord, 2, &p.texcoords));
    TRY_END(join_values(&p, model->normal_count, read_normal, 3 + 3 * model->morph_count, &p.normals));
    TRY_END(assign_all(&p));
    TRY_END(sort_elements(&p));
    TRY_END(sort_primitives(&p));
    TRY_END(make_vertices(&p));
    if (model->morph_count > 0)
        TRY_END(mark_morphs(plan, error));
end:
    for (int k = 0; k < MODEL_KINDS; k++) {
        ffd_free(p.primitive_of[k]);
        ffd_free(p.elements[k]);
    }
    ffd_free(p.texcoords);
    ffd_free(p.normals);
    ffd_free(p.sorted);
    ffd_intern_free(&p.primitives);
    plan->hurried_polygons = p.scratch.cutter.hurried;
    ffd_face_triangles_free(&p.scratch);
    return status;
}

void ffd_glb_free_plan(glb_plan *plan)
{
    ffd_intern_free(&plan->meshes);
    ffd_intern_free(&plan->materials);
    ffd_free(plan->primitives);
    ffd_free(plan->by_mesh);
    ffd_free(plan->vertices);
    ffd_free(plan->indices);
    ffd_free(plan->morphed);
    *plan = (glb_plan){0};
}
