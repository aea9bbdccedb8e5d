#include "io/gltf/model/gltf_faces.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/read/gltf_drawing.h"
#include "io/gltf/read/gltf_elements.h"
#include "mesh/mixed_faces.h"
#include <stdatomic.h>
#include <string.h>

#define MOST_TRIANGLES INT32_MAX

/* What a primitive draws for one use. */
typedef struct drawing {
    size_t corners; /* number of indices, or of vertices without indices */
    size_t triangles, lines, points;
} drawing;

static drawing count_drawing(const gltf_document *d, const gltf_primitive *primitive)
{
    drawing counted = {0};
    if (primitive->accessor[GLTF_POSITION] < 0)
        return counted;
    const size_t n = primitive->indices >= 0
                         ? ffd_gltf_drawn_count(d, primitive)
                         : (size_t)d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    if (primitive->mode == MODE_UNKNOWN)
        return counted;
    counted.corners = n;
    switch (primitive->mode) {
    case MODE_POINTS:
        counted.points = n;
        break;
    case MODE_LINES:
        counted.lines = n / 2;
        break;
    case MODE_LINE_LOOP:
        counted.lines = n > 1 ? n : 0;
        break;
    case MODE_LINE_STRIP:
        counted.lines = n > 1 ? n - 1 : 0;
        break;
    case MODE_TRIANGLES:
        counted.triangles = n / 3;
        break;
    default:
        counted.triangles = n > 2 ? n - 2 : 0;
    }
    return counted;
}

void ffd_gltf_count_drawing(const gltf_document *d, const gltf_primitive *primitive, size_t *triangles,
                            size_t *lines, size_t *points)
{
    const drawing counted = count_drawing(d, primitive);
    *triangles += counted.triangles;
    *lines += counted.lines;
    *points += counted.points;
}

size_t ffd_gltf_count_triangles(const gltf_document *d, const gltf_primitive *primitive)
{
    return count_drawing(d, primitive).triangles;
}

static ffd_status refuse_primitive(const gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    if (primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    TRY(ffd_gltf_refuse_unreadable(d, primitive, primitive->accessor[GLTF_POSITION], error));
    if (primitive->indices < 0)
        return FFD_OK;
    return ffd_gltf_refuse_unreadable(d, primitive, primitive->indices, error);
}

static ffd_status count_all(const gltf_document *d, mesh_faces *faces, ffd_error *error)
{
    uint64_t triangles = 0, lines = 0, points = 0;
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_primitive *const primitive = d->instances[i].primitive;
        TRY(refuse_primitive(d, primitive, error));
        const drawing counted = count_drawing(d, primitive);
        triangles += counted.triangles;
        lines += counted.lines;
        points += counted.points;
        if (triangles > MOST_TRIANGLES)
            return ffd_fail_file(error, FFD_E_LIMIT, d->name, "its scene has more than %d triangles",
                                 MOST_TRIANGLES);
    }
    faces->face_count = (size_t)triangles;
    faces->lines = (size_t)lines;
    faces->points = (size_t)points;
    return FFD_OK;
}

/* Fills in the positions of all parts in order; base[i] becomes the first vertex of part i. */
static void fill_positions(const gltf_document *d, mesh_state state, mesh_faces *faces, size_t *base)
{
    size_t at = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *part = &d->mesh_parts[i];
        base[i] = at;
        if (part->repeats_positions)
            continue;
        double *positions = faces->positions + 3 * at;
        ffd_gltf_read_shown(d, i, GLTF_POSITION, state, 0, part->vertex_count, 3, positions);
        ffd_part_transform(&d->base, i, 0, part->vertex_count, positions);
        at += part->vertex_count;
    }
}

static ffd_status refuse_index(const gltf_document *d, const gltf_primitive *primitive, size_t i,
                               ffd_error *error)
{
    const gltf_accessor *positions = &d->model.accessors[primitive->accessor[GLTF_POSITION]];
    uint32_t index;
    ffd_gltf_read_drawn(d, primitive, i, 1, &index);
    return ffd_json_tree_fail(&d->tree, primitive->value, d->name, FFD_E_INVALID, error,
                              "index %zu is %lu, but the count of vertices is %llu", i, (unsigned long)index,
                              (unsigned long long)positions->count);
}

static ffd_status fill_corners(const gltf_document *d, const gltf_primitive *primitive, size_t count,
                               uint32_t *corners, ffd_error *error)
{
    const uint64_t vertices = d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    if (primitive->indices < 0) {
        for (size_t i = 0; i < count; i++)
            corners[i] = (uint32_t)i;
        return FFD_OK;
    }
    const uint32_t largest = ffd_gltf_read_drawn(d, primitive, 0, count, corners);
    for (size_t i = 0; i < count && largest >= vertices; i++)
        if (corners[i] >= vertices)
            return refuse_index(d, primitive, i, error);
    return FFD_OK;
}

ffd_status ffd_gltf_read_corners(const gltf_document *d, const gltf_primitive *primitive, uint32_t **corners,
                                 size_t *count, ffd_error *error)
{
    ffd_status status = refuse_primitive(d, primitive, error);
    *corners = NULL;
    if (status)
        return status;
    *count = count_drawing(d, primitive).corners;
    *corners = ffd_alloc(*count, sizeof **corners);
    if (!*corners)
        return ffd_fail_memory(error);
    status = fill_corners(d, primitive, *count, *corners, error);
    if (status) {
        ffd_free(*corners);
        *corners = NULL;
    }
    return status;
}

static ffd_status add_primitive(const gltf_document *d, const gltf_primitive *primitive, const size_t *base,
                                uint32_t *to, size_t *added, ffd_error *error)
{
    const drawing counted = count_drawing(d, primitive);
    const gltf_mesh_uses *uses = &d->mesh_uses[primitive->mesh];
    if (counted.triangles == 0 || uses->node_count == 0)
        return FFD_OK;
    uint32_t *corners;
    size_t count;
    ffd_status status;
    TRY_END(ffd_gltf_read_corners(d, primitive, &corners, &count, error));
    for (size_t n = 0; n < uses->node_count; n++) {
        const gltf_instance *instance = &ffd_gltf_instances(d, primitive)[n];
        for (size_t t = 0; t < counted.triangles; t++) {
            uint32_t *triangle = to + 3 * (*added)++;
            gltf_triangle(primitive->mode, t, corners, triangle);
            for (int c = 0; c < 3; c++)
                triangle[c] += (uint32_t)base[instance->part[GLTF_POSITION]];
        }
    }
end:
    ffd_free(corners);
    return status;
}

uint64_t ffd_gltf_most_corners(const gltf_document *d)
{
    uint64_t most = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const uint64_t corners = count_drawing(d, &d->model.primitives[i]).corners;
        most = corners > most ? corners : most;
    }
    return most;
}

/* Checks the memory of the faces plus the corners of one primitive. */
static ffd_status check_budget(const gltf_document *d, const mesh_faces *faces, ffd_error *error)
{
    memory_budget budget = d->base.budget;
    TRY(ffd_mesh_faces_take(faces, 3 * (uint64_t)faces->face_count, &budget, error));
    return ffd_budget_check(&budget, ffd_gltf_most_corners(d), sizeof(uint32_t), error);
}

ffd_status ffd_gltf_faces(const mesh_document *document, mesh_state state, mesh_faces *faces,
                          ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    *faces = (mesh_faces){0};
    TRY(count_all(d, faces, error));
    for (size_t i = 0; i < d->base.part_count; i++)
        faces->vertex_count += d->mesh_parts[i].repeats_positions ? 0 : d->mesh_parts[i].vertex_count;
    TRY(check_budget(d, faces, error));
    TRY(ffd_mesh_faces_make(document, faces, 3 * faces->face_count, error));
    size_t *base = ffd_alloc(d->base.part_count, sizeof *base);
    ffd_status status = FFD_OK;
    if (!base)
        TRY_END(ffd_fail_memory(error));
    fill_positions(d, state, faces, base);
    for (size_t i = 0; i <= faces->face_count; i++)
        faces->start[i] = 3 * i;
    size_t added = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY_END(add_primitive(d, &d->model.primitives[i], base, faces->corners, &added, error));
end:
    ffd_free(base);
    if (status)
        ffd_mesh_faces_free(faces);
    return status;
}

/* Triangles that are passed at a time: an even number, as every second one of a strip is turned. */
#define TRIANGLE_RUN ((size_t)1024)

/* Reads the vertices of `count` triangles of a primitive from `first` on, which is even. room: for the
   corners of a strip or fan. */
static ffd_status read_triangles(const gltf_document *d, const gltf_primitive *primitive, size_t first,
                                 size_t count, uint32_t *room, uint32_t *triangles, ffd_error *error)
{
    const uint64_t vertices = d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    const bool apart = primitive->mode == MODE_TRIANGLES, is_fan = primitive->mode == MODE_FAN;
    const size_t from = apart ? 3 * first : first + is_fan, size = apart ? 3 * count : count + 2 - is_fan;
    uint32_t *const to = apart ? triangles : room + is_fan;
    uint32_t largest = is_fan;
    if (primitive->indices < 0) {
        room[0] = 0;
        for (size_t i = 0; i < size; i++)
            to[i] = (uint32_t)(from + i);
    } else {
        largest = is_fan ? ffd_gltf_read_drawn(d, primitive, 0, 1, room) : 0;
        const uint32_t more = ffd_gltf_read_drawn(d, primitive, from, size, to);
        largest = more > largest ? more : largest;
        for (size_t i = 0; i < size && largest >= vertices; i++)
            if (to[i] >= vertices)
                return refuse_index(d, primitive, from + i, error);
        if (largest >= vertices)
            return refuse_index(d, primitive, 0, error);
    }
    for (size_t t = 0; t < count && !apart; t++)
        gltf_triangle(primitive->mode, t, room, triangles + 3 * t);
    return FFD_OK;
}

/* Passes the triangles of a primitive for one of its uses, whose first vertex is `base`. */
static ffd_status visit_use(const gltf_document *d, const gltf_primitive *primitive, size_t base,
                            mesh_triangle_visitor *visit, void *context, ffd_error *error)
{
    const size_t triangles = count_drawing(d, primitive).triangles;
    uint32_t room[TRIANGLE_RUN + 2], corners[3 * TRIANGLE_RUN];
    for (size_t first = 0; first < triangles; first += TRIANGLE_RUN) {
        const size_t left = triangles - first, count = left < TRIANGLE_RUN ? left : TRIANGLE_RUN;
        TRY(ffd_deadline_check(error));
        TRY(read_triangles(d, primitive, first, count, room, corners, error));
        for (size_t i = 0; i < 3 * count && base > 0; i++)
            corners[i] += (uint32_t)base;
        visit(context, corners, count);
    }
    return FFD_OK;
}

ffd_status ffd_gltf_visit_triangles(const mesh_document *document, const size_t *first,
                                    mesh_triangle_visitor *visit, void *context, ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        TRY(refuse_primitive(d, instance->primitive, error));
        if (instance->part[GLTF_POSITION] != GLTF_NONE)
            TRY(visit_use(d, instance->primitive, first[instance->part[GLTF_POSITION]], visit, context,
                          error));
    }
    return FFD_OK;
}

/* Sets the normals of one instance's corners: vertex i of its positions has normal i of its normals. */
static void set_normals(const gltf_instance *instance, const size_t *first_vertices,
                        const size_t *first_normals, const uint32_t *corners, size_t count, uint32_t *normals)
{
    const size_t part = instance->part[GLTF_NORMAL];
    if (part == GLTF_NONE) {
        for (size_t c = 0; c < count; c++)
            normals[c] = MESH_NO_NORMAL;
        return;
    }
    const size_t first = first_vertices[instance->part[GLTF_POSITION]];
    for (size_t c = 0; c < count; c++)
        normals[c] = (uint32_t)(first_normals[part] + (corners[c] - first));
}

ffd_status ffd_gltf_corner_normals(const mesh_document *document, const mesh_faces *faces, uint32_t *normals,
                                   ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    size_t *first_normals = ffd_alloc(d->base.part_count, sizeof *first_normals), *first_vertices = NULL;
    ffd_status status;
    TRY_END(first_normals ? ffd_first_vertices(document, &first_vertices, error) : ffd_fail_memory(error));
    size_t index = 0, corner = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        first_normals[i] = index;
        index += d->mesh_parts[i].normal_count;
    }
    for (size_t i = 0; i < d->instance_count; i++) {
        const size_t count = 3 * count_drawing(d, d->instances[i].primitive).triangles;
        if (count > 0)
            set_normals(&d->instances[i], first_vertices, first_normals, faces->corners + corner, count,
                        normals + corner);
        corner += count;
    }
end:
    ffd_free(first_normals);
    ffd_free(first_vertices);
    return status;
}

/* Indices read at a time, and indices in a thread's tile, whose mmap pages are then released. */
#define CORNERS_RUN ((size_t)4096)
#define CORNERS_TILE (16 * CORNERS_RUN)

/* A primitive, and the parts of the nodes that show it. */
typedef struct drawn_primitive {
    gltf_document *document;
    const gltf_instance *instances;
    size_t nodes;
    const gltf_primitive *primitive;
    atomic_bool failed; /* set if an index is out of range */
} drawn_primitive;

/* Returns the part to mark for a node; NULL: no part, or all its vertices are marked. */
static gltf_part *part_of(const drawn_primitive *primitive, size_t node)
{
    const size_t part = primitive->instances[node].part[GLTF_POSITION];
    gltf_part *const found = part == GLTF_NONE ? NULL : &primitive->document->parts[part];
    return found && !found->is_all_used ? found : NULL;
}

static size_t vertices_of(const drawn_primitive *primitive, size_t node)
{
    return primitive->document->mesh_parts[primitive->instances[node].part[GLTF_POSITION]].vertex_count;
}

/* Marks all vertices, for a primitive without indices or with indices that cannot be read. */
static void mark_all(const drawn_primitive *primitive)
{
    for (size_t n = 0; n < primitive->nodes; n++) {
        gltf_part *const part = part_of(primitive, n);
        if (!part)
            continue;
        part->is_all_used = true;
        if (part->used)
            memset(part->used, 1, vertices_of(primitive, n));
    }
}

/* Sets the bytes of vertices. Other threads may set the same bytes at the same time. */
static void mark(uint8_t *used, const uint32_t *vertices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        atomic_store_explicit((_Atomic uint8_t *)&used[vertices[i]], 1, memory_order_relaxed);
}

static void mark_run(drawn_primitive *primitive, size_t first, size_t count)
{
    uint32_t indices[CORNERS_RUN];
    const uint32_t largest =
        ffd_gltf_read_drawn(primitive->document, primitive->primitive, first, count, indices);
    for (size_t n = 0; n < primitive->nodes; n++) {
        const gltf_part *const part = part_of(primitive, n);
        if (part && largest >= vertices_of(primitive, n))
            atomic_store(&primitive->failed, true);
        else if (part && part->used)
            mark(part->used, indices, count);
    }
}

static void mark_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    drawn_primitive *const primitive = context;
    (void)tile;
    (void)worker;
    for (size_t run = first; run < last && !atomic_load(&primitive->failed); run += CORNERS_RUN)
        mark_run(primitive, run, last - run < CORNERS_RUN ? last - run : CORNERS_RUN);
    if (!primitive->primitive->drawn)
        ffd_gltf_forget_elements(primitive->document, (size_t)primitive->primitive->indices, first,
                                 last - first);
}

static ffd_status mark_indices(drawn_primitive *primitive, ffd_error *error)
{
    gltf_document *const d = primitive->document;
    const size_t count = ffd_gltf_drawn_count(d, primitive->primitive);
    for (size_t n = 0; n < primitive->nodes; n++) {
        gltf_part *const part = part_of(primitive, n);
        TRY(part && !part->used ? ffd_used_make(&d->base, vertices_of(primitive, n), &part->used, error)
                                : FFD_OK);
    }
    ffd_parallel_tiles(count, CORNERS_TILE, d->threads, mark_tile, primitive);
    return FFD_OK;
}

/* Marks the vertices that a primitive draws, in the part of each node that shows it. */
static ffd_status mark_primitive(gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    drawn_primitive drawn = {.document = d,
                             .primitive = primitive,
                             .instances = ffd_gltf_instances(d, primitive),
                             .nodes = d->mesh_uses[primitive->mesh].node_count};
    if (drawn.nodes == 0 || primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    const bool failed =
        primitive->indices < 0 || ffd_gltf_refuse_unreadable(d, primitive, primitive->indices, NULL);
    atomic_init(&drawn.failed, failed);
    if (!failed)
        TRY(mark_indices(&drawn, error));
    if (atomic_load(&drawn.failed))
        mark_all(&drawn);
    return FFD_OK;
}

ffd_status ffd_gltf_mark_used(mesh_document *document, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY(mark_primitive(d, &d->model.primitives[i], error));
    for (size_t i = 0; i < d->base.part_count; i++)
        if (d->parts[i].used && ffd_used_keep(document, d->mesh_parts[i].vertex_count, &d->parts[i].used))
            d->mesh_parts[i].used = d->parts[i].used;
    return FFD_OK;
}

/* Triangles that a thread searches at a time, and triangles whose indices it reads at a time. */
#define TRIANGLES_TILE ((size_t)1 << 14)
#define TRIANGLES_RUN ((size_t)1024)

/* The triangles of one primitive under one node. */
typedef struct mixed_work {
    const gltf_document *document;
    const vertex_marks *marks;
    size_t indices; /* the accessor; GLTF_NONE: no indices */
    size_t first, vertices;
    face_list *lists; /* per tile; vertex numbers are those of the document */
} mixed_work;

/* Lists the mixed triangles in [first, last), at most TRIANGLES_RUN triangles. The list fails if an index is
   out of range. */
static void search_run(const mixed_work *work, size_t first, size_t last, face_list *list)
{
    const vertex_marks own = {work->marks->bytes + work->first, work->marks->planes, work->marks->vertices};
    const size_t count = 3 * (last - first);
    uint32_t indices[3 * TRIANGLES_RUN];
    uint32_t largest = (uint32_t)(3 * last - 1);
    for (size_t i = 0; i < count && work->indices == GLTF_NONE; i++)
        indices[i] = (uint32_t)(3 * first + i);
    if (work->indices != GLTF_NONE)
        largest = ffd_gltf_read_indices(work->document, work->indices, 3 * first, count, indices);
    list->failed = list->failed || largest >= work->vertices;
    for (size_t i = 0; i < count && !list->failed; i += 3) {
        if (!ffd_marks_differ(&own, indices + i, 3))
            continue;
        for (size_t c = i; c < i + 3; c++)
            ffd_face_list_corner(list, (uint32_t)work->first + indices[c]);
        ffd_face_list_end(list, work->marks);
    }
}

static void search_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const mixed_work *const work = context;
    face_list list = {0};
    (void)worker;
    for (size_t run = first; run < last && !list.failed; run += TRIANGLES_RUN)
        search_run(work, run, last - run < TRIANGLES_RUN ? last : run + TRIANGLES_RUN, &list);
    work->lists[tile] = list;
    if (work->indices != GLTF_NONE)
        ffd_gltf_forget_elements(work->document, work->indices, 3 * first, 3 * (last - first));
}

/* Whether all vertices of a part have equal marks: its triangles need not be read then. */
static bool is_uniform(const mixed_work *work)
{
    for (size_t p = 0; p < work->marks->planes; p++) {
        const uint8_t *const marks = work->marks->bytes + p * work->marks->vertices + work->first;
        if (work->vertices > 1 && memcmp(marks, marks + 1, work->vertices - 1) != 0)
            return false;
    }
    return true;
}

/* The lists of all primitives under all nodes. */
typedef struct mixed_lists {
    face_list *lists;
    size_t count, capacity;
} mixed_lists;

static bool search(mixed_work *work, size_t triangles, mixed_lists *all)
{
    const size_t tiles = triangles / TRIANGLES_TILE + (triangles % TRIANGLES_TILE != 0);
    bool done = ffd_grow((void **)&all->lists, &all->capacity, all->count + tiles, sizeof *all->lists);
    if (!done)
        return false;
    work->lists = all->lists + all->count;
    memset(work->lists, 0, tiles * sizeof *work->lists);
    all->count += tiles;
    ffd_parallel_tiles(triangles, TRIANGLES_TILE, work->document->threads, search_tile, work);
    for (size_t t = 0; t < tiles; t++)
        done = done && !work->lists[t].failed;
    return done;
}

/* Searches a primitive under all nodes. Returns false for anything this simple search cannot handle: all
   faces must then be read. */
static bool search_primitive(mixed_work *work, const size_t *first, const gltf_primitive *primitive,
                             mixed_lists *all)
{
    const gltf_document *const d = work->document;
    if (primitive->accessor[GLTF_POSITION] < 0)
        return true;
    const size_t triangles = ffd_gltf_count_triangles(d, primitive);
    if (primitive->indices >= 0 && ffd_gltf_refuse_unreadable(d, primitive, primitive->indices, NULL))
        return false;
    work->indices = primitive->indices >= 0 ? (size_t)primitive->indices : GLTF_NONE;
    for (size_t n = 0; triangles > 0 && n < d->mesh_uses[primitive->mesh].node_count; n++) {
        const size_t part = ffd_gltf_instances(d, primitive)[n].part[GLTF_POSITION];
        if (part == GLTF_NONE)
            return false;
        work->first = first[part];
        work->vertices = d->mesh_parts[part].vertex_count;
        if (!is_uniform(work) &&
            (primitive->mode != MODE_TRIANGLES || primitive->drawn || !search(work, triangles, all)))
            return false;
    }
    return true;
}

static void read_positions(const gltf_document *d, mesh_state state, const size_t *first,
                           const mesh_faces *faces)
{
    size_t part = 0;
    for (size_t v = 0; v < faces->vertex_count; v++) {
        const size_t vertex = faces->vertices[v];
        double *const xyz = faces->positions + 3 * v;
        if (d->mesh_parts[part].repeats_positions || vertex < first[part] ||
            vertex >= first[part] + d->mesh_parts[part].vertex_count)
            for (part = 0; d->mesh_parts[part].repeats_positions || vertex < first[part] ||
                           vertex >= first[part] + d->mesh_parts[part].vertex_count;)
                part++;
        ffd_gltf_read_shown(d, part, GLTF_POSITION, state, vertex - first[part], 1, 3, xyz);
        ffd_part_transform(&d->base, part, vertex - first[part], 1, xyz);
    }
}

static bool search_all(mixed_work *work, const size_t *first, mixed_lists *all)
{
    const gltf_model *const model = &work->document->model;
    bool plain = true;
    for (size_t i = 0; i < model->primitive_count && plain; i++)
        plain = search_primitive(work, first, &model->primitives[i], all);
    return plain;
}

ffd_status ffd_gltf_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                                mesh_faces *faces, ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    mixed_work work = {.document = d, .marks = marks};
    mixed_lists all = {0};
    size_t *first;
    TRY(ffd_first_vertices(document, &first, error));
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    ffd_status status = FFD_OK;
    if (search_all(&work, first, &all)) {
        TRY_END(ffd_face_lists_narrow(document, all.lists, all.count, faces, error));
        read_positions(d, state, first, faces);
    } else
        TRY_END(ffd_gltf_faces(document, state, faces, error));
end:
    for (size_t l = 0; l < all.count; l++)
        ffd_free(all.lists[l].words);
    ffd_free(all.lists);
    ffd_free(first);
    return status;
}
