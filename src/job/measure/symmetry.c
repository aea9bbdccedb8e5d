#include "job/measure/symmetry.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/input/source.h"
#include "job/pass/pass.h"
#include "lattice/lattice.h"
#include "lattice/mirror.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <string.h>

/* An image may miss its vertex by this part of the diagonal. */
#define TOLERANCE 1e-3
/* Fewer than this part of the vertices with an image are a warning. */
#define ENOUGH 0.99

enum {
    BLOCK = 256,       /* vertices that are read at once */
    QUERIES = 1 << 16, /* of more vertices as many are drawn, always the same ones */
    BUCKETS = 1 << 17,
    CELLS_OF_ONE = 8,     /* the cells that an image may be near to */
    STEPS_OF_ONE = 1 << 9 /* comparisons a vertex after which the question is dropped: a mesh of heaps */
};

/* An image in one of the cells near to it. */
typedef struct image_entry {
    uint32_t image, next; /* next: 1 + index of the next entry of the bucket; 0: none */
    uint64_t cell;
} image_entry;

/* The images of the drawn vertices, in a hashed grid, until a vertex is found at each. */
typedef struct image_grid {
    mirror_plane plane;
    double origin[3], edge; /* of the cells: two tolerances */
    uint64_t vertices, seen, drawn, found, steps;
    double *images; /* 3 a drawn vertex */
    bool *is_found;
    size_t image_count, entry_count;
    image_entry *entries;
    uint32_t *buckets;
} image_grid;

/* The positions of a mesh as a link gets them. */
typedef struct shape_walk {
    const deform_job *job;
    mesh_state state;
    const double *positions; /* behind other links; NULL: those of the document */
} shape_walk;

typedef void place_visit(void *context, const double place[3]);

static void walk(const shape_walk *shape, place_visit *visit, void *context)
{
    const mesh_document *const document = shape->job->document;
    const double *behind = shape->positions;
    double block[3 * BLOCK];
    for (size_t p = 0; p < document->part_count; p++) {
        const mesh_part *const part = &document->parts[p];
        if (part->repeats_positions)
            continue;
        for (size_t first = 0; first < part->vertex_count; first += BLOCK) {
            const size_t left = part->vertex_count - first, count = left < BLOCK ? left : BLOCK;
            const double *const xyz = behind ? behind + 3 * first : block;
            if (part->hidden || part->skipped)
                break;
            if (!behind)
                ffd_source_positions(document, shape->state, p, first, count, block);
            for (size_t i = 0; i < count; i++)
                if (ffd_part_selects(part, first + i) && vec_is_finite(xyz + 3 * i))
                    visit(context, xyz + 3 * i);
        }
        behind = behind ? behind + 3 * part->vertex_count : NULL;
    }
}

typedef struct extent_count {
    ffd_bounds box;
    uint64_t vertices;
} extent_count;

static void count_place(void *context, const double place[3])
{
    extent_count *const extent = context;
    ffd_bounds_widen(&extent->box, place);
    extent->vertices++;
}

/* splitmix64: numbers that look random, the same for each run. */
static uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* The cell of a place; coordinates are within a few hundred cells of the origin. */
static uint64_t cell_of(const image_grid *grid, const double place[3])
{
    uint64_t cell = 0;
    for (int a = 0; a < 3; a++)
        cell = cell << 20 | (uint64_t)(floor_of((place[a] - grid->origin[a]) / grid->edge) + 16);
    return cell;
}

static void add_image(image_grid *grid, const double image[3])
{
    const uint32_t index = (uint32_t)grid->image_count++;
    uint64_t cells[CELLS_OF_ONE];
    size_t count = 0;
    memcpy(grid->images + 3 * (size_t)index, image, 3 * sizeof *image);
    for (int corner = 0; corner < CELLS_OF_ONE; corner++) {
        double near[3];
        for (int a = 0; a < 3; a++)
            near[a] = image[a] + (corner >> a & 1 ? 0.5 : -0.5) * grid->edge;
        const uint64_t cell = cell_of(grid, near);
        bool is_new = true;
        for (size_t i = 0; i < count; i++)
            is_new = is_new && cells[i] != cell;
        if (is_new)
            cells[count++] = cell;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t *const bucket = &grid->buckets[mix(cells[i]) % BUCKETS];
        grid->entries[grid->entry_count] = (image_entry){index, *bucket, cells[i]};
        *bucket = (uint32_t)++grid->entry_count;
    }
}

/* Draws a vertex. An image beyond the bounds is not a vertex. */
static void draw(void *context, const double place[3])
{
    image_grid *const grid = context;
    double image[3];
    const uint64_t turn = grid->seen++;
    if (grid->vertices > QUERIES && mix(turn) % grid->vertices >= QUERIES)
        return;
    if (grid->image_count == QUERIES)
        return;
    grid->drawn++;
    ffd_mirror_point(&grid->plane, place, image);
    const double reach = grid->edge / TOLERANCE;
    for (int a = 0; a < 3; a++)
        if (!(image[a] >= grid->origin[a] - grid->edge && image[a] <= grid->origin[a] + reach))
            return;
    add_image(grid, image);
}

/* Finds the images at a vertex, and takes their entries out of its bucket. */
static void find(void *context, const double place[3])
{
    image_grid *const grid = context;
    const uint64_t cell = cell_of(grid, place);
    uint32_t *link = &grid->buckets[mix(cell) % BUCKETS];
    while (*link && grid->steps <= STEPS_OF_ONE * (grid->vertices + QUERIES)) {
        image_entry *const entry = &grid->entries[*link - 1];
        const double *const image = grid->images + 3 * (size_t)entry->image;
        const double away[3] = {image[0] - place[0], image[1] - place[1], image[2] - place[2]};
        grid->steps++;
        if (entry->cell == cell && !grid->is_found[entry->image] && vec_length(away) <= 0.5 * grid->edge) {
            grid->is_found[entry->image] = true;
            grid->found++;
        }
        if (grid->is_found[entry->image])
            *link = entry->next;
        else
            link = &entry->next;
    }
}

static bool allocate(image_grid *grid)
{
    grid->images = ffd_alloc(QUERIES, 3 * sizeof *grid->images);
    grid->is_found = ffd_alloc_zero(QUERIES, sizeof *grid->is_found);
    grid->entries = ffd_alloc(QUERIES * CELLS_OF_ONE, sizeof *grid->entries);
    grid->buckets = ffd_alloc_zero(BUCKETS, sizeof *grid->buckets);
    return grid->images && grid->is_found && grid->entries && grid->buckets;
}

/* Finds the part of the vertices that have a mirror image; 1 where there is nothing to say. */
static ffd_status find_part(const shape_walk *shape, const mirror_plane *plane, double *part,
                            ffd_error *error)
{
    extent_count extent = {.box = ffd_bounds_empty()};
    image_grid grid = {.plane = *plane};
    double sides[3];
    *part = 1;
    walk(shape, count_place, &extent);
    for (int a = 0; a < 3; a++) {
        grid.origin[a] = extent.box.min[a];
        sides[a] = extent.box.max[a] - extent.box.min[a];
    }
    grid.edge = 2 * TOLERANCE * vec_length(sides);
    grid.vertices = extent.vertices;
    if (extent.vertices == 0 || !(grid.edge > 0) || !isfinite(grid.edge / TOLERANCE))
        return FFD_OK;
    ffd_status status;
    TRY_END(allocate(&grid) ? FFD_OK : ffd_fail_memory(error));
    walk(shape, draw, &grid);
    walk(shape, find, &grid);
    if (grid.drawn > 0 && grid.steps <= STEPS_OF_ONE * (grid.vertices + QUERIES))
        *part = (double)grid.found / (double)grid.drawn;
end:
    ffd_free(grid.images);
    ffd_free(grid.is_found);
    ffd_free(grid.entries);
    ffd_free(grid.buckets);
    return status;
}

/* Sends the vertices through the links before this one. *positions stays NULL where the memory allowed does
   not suffice. */
static ffd_status send(const deform_job *job, size_t links, mesh_state state, double **positions,
                       ffd_error *error)
{
    memory_budget budget = job->document->budget;
    const uint64_t vertices = ffd_mesh_vertex_count(job->document);
    pass_totals totals;
    if (ffd_budget_take(&budget, vertices, 3 * sizeof **positions, NULL))
        return FFD_OK;
    *positions = ffd_alloc((size_t)vertices, 3 * sizeof **positions);
    if (!*positions)
        return ffd_fail_memory(error);
    const mesh_pass pass = {.document = job->document,
                            .state = state,
                            .chain = &job->chain,
                            .links = links,
                            .threads = job->threads,
                            .deformed = *positions};
    return ffd_pass_over_mesh(&pass, &totals, error);
}

static ffd_status judge_axis(const shape_walk *shape, const ffd_lattice *lattice, int axis, ffd_error *error)
{
    const mirror_plane plane = ffd_mirror_middle(lattice, axis);
    double part;
    char name[100];
    TRY(find_part(shape, &plane, &part, error));
    if (part >= ENOUGH)
        return FFD_OK;
    ffd_name_shown(lattice->spec->name, name, sizeof name);
    ffd_log_line(
        &shape->job->log, FFD_LOG_WARNING,
        "\"mirror\": \"%c\" in %s takes the middle of its box, the plane %s, where %.3g %% of the vertices "
        "have a mirror image; {\"axis\": \"%c\", \"at\": 0} names a plane",
        "xyz"[axis], name, ffd_mirror_describe(&plane).text, 100 * part, "xyz"[axis]);
    return FFD_OK;
}

static bool mirrors(const lattice_spec *spec, int axis)
{
    for (size_t list = 0; list <= spec->keys.count; list++) {
        size_t count;
        const lattice_move *const moves = ffd_spec_moves(spec, list, &count);
        for (size_t i = 0; i < count; i++)
            if (moves[i].mirror.kind == MIRROR_MIDDLE && moves[i].mirror.normal[axis] != 0)
                return true;
    }
    return false;
}

static ffd_status judge_link(const deform_job *job, size_t l, ffd_error *error)
{
    const ffd_lattice *const lattice = job->chain.links[l].lattice;
    const size_t links = job->chain.blocks ? 0 : l;
    shape_walk shape = {.job = job, .state = ffd_job_judged(job)};
    double *positions = NULL;
    ffd_status status = FFD_OK;
    if (!lattice->spec || lattice->edited ||
        !(mirrors(lattice->spec, 0) || mirrors(lattice->spec, 1) || mirrors(lattice->spec, 2)))
        return FFD_OK;
    if (links > 0) {
        TRY_END(send(job, links, shape.state, &positions, error));
        if (!positions)
            return FFD_OK;
        shape.positions = positions;
    }
    for (int axis = 0; axis < 3; axis++)
        if (mirrors(lattice->spec, axis))
            TRY_END(judge_axis(&shape, lattice, axis, error));
end:
    ffd_free(positions);
    return status;
}

ffd_status ffd_symmetry_warn(const deform_job *job, ffd_error *error)
{
    for (size_t l = 0; l < job->chain.count; l++)
        TRY(judge_link(job, l, error));
    return FFD_OK;
}
