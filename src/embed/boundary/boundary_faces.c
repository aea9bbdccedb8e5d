/* boundary_faces.c - divides the faces of the domain into patches, and builds a tree over them. The tree
   halves the rectangle of cells of a face, so neighbours on the surface stay together, and no sorting is
   needed. */
#include "embed/boundary/boundary_faces.h"
#include "base/memory/memory.h"
#include "spline/bezier.h"
#include <float.h>
#include <string.h>

enum { N = PATCH_COMPONENTS };

/* The most bytes of stored patches; with more of them, each search makes the patches it needs. */
#define KEPT_SIZE ((size_t)64 << 20)
/* Stored patches are halved until the distance has one minimum for points about as far away as the patch is
   large, but at most MOST_CUTS times, and into MOST_PARTS in total. */
#define MOST_CUTS 6
#define MOST_PARTS ((size_t)1 << 14)
/* Control points of the faces are stored, 32 bytes each, if there are at most this many. */
#define KEPT_POINTS ((size_t)1 << 20)
/* A leaf holds one cell; or several if there would be more leaves than this. */
#define MOST_LEAVES ((size_t)1 << 18)

typedef struct builder {
    boundary *border;
    bool keeps;
    int cuts;
    face_patch *scratch; /* if patches are not stored */
    size_t cells_a_leaf;
    ffd_error *error;
} builder;

/* Patches */

/* A patch of the face's orders, without contents; NULL if memory runs out. */
static face_patch *make_patch(const boundary *border, int face)
{
    const int order[2] = {boundary_knots(border, face, 0)->degree + 1,
                          boundary_knots(border, face, 1)->degree + 1};
    return ffd_patch_create(order, border->lattice->rest_weights != NULL);
}

void ffd_boundary_free_patches(face_patch *list)
{
    while (list) {
        face_patch *next = list->next;
        ffd_free(list);
        list = next;
    }
}

/* Computes a control point of a face by its two indices, in the search's units. */
static void sum_point(const boundary *border, const boundary_face *face, const size_t point[2], double sum[N])
{
    const double h = face->sums.weights ? border->weight_scale : 1;
    size_t index[3];
    index[face->direction] = 0;
    for (int f = 0; f < 2; f++)
        index[face->along[f]] = point[f];
    ffd_border_point(&face->sums, index, border->origin, sum);
    for (int c = 0; c < 3; c++)
        sum[c] = sum[c] * h * border->scale;
    sum[3] = face->sums.weights ? sum[3] * h : 1; /* without weights the sum is 1 except for rounding */
}

/* Computes the control point of two basis functions. */
static void control_point(const boundary *border, int index, const size_t function[2], double result[N])
{
    const boundary_face *face = &border->faces[index];
    const knot_vector *knots[2] = {boundary_knots(border, index, 0), boundary_knots(border, index, 1)};
    const size_t point[2] = {ffd_knots_point(knots[0], function[0]), ffd_knots_point(knots[1], function[1])};
    if (face->points)
        memcpy(result, face->points + N * (point[0] + knots[0]->points * point[1]), N * sizeof *result);
    else
        sum_point(border, face, point, result);
}

/* Multiplies the rows of points along f by the extraction matrix of the span. */
static void extract(face_patch *made, int f, const double *matrix)
{
    const size_t stride = N * (f == 0 ? 1 : (size_t)made->order[0]);
    const size_t next_line = N * (f == 0 ? (size_t)made->order[0] : 1);
    const int order = made->order[f], components = made->rational ? N : 3;
    for (int line_index = 0; line_index < made->order[1 - f]; line_index++) {
        double line[MAX_ORDER][N];
        double *first = made->points + next_line * (size_t)line_index;
        for (int i = 0; i < order; i++)
            memcpy(line[i], first + stride * (size_t)i, sizeof line[i]);
        for (int r = 0; r < order; r++)
            for (int c = 0; c < components; c++) {
                double sum = 0;
                for (int i = 0; i < order; i++)
                    sum += matrix[r * order + i] * line[i][c];
                first[stride * (size_t)r + (size_t)c] = sum;
            }
    }
}

void ffd_boundary_patch(const boundary *border, int face, const size_t cell[2], face_patch *made)
{
    int span[2];
    made->face = face;
    for (int f = 0; f < 2; f++) {
        const knot_vector *knots = boundary_knots(border, face, f);
        made->cell[f] = cell[f];
        made->order[f] = knots->degree + 1;
        made->lo[f] = 0;
        made->hi[f] = 1;
        span[f] = knots->spans[cell[f]];
    }
    made->rational = border->lattice->rest_weights != NULL;
    double *point = made->points;
    for (int j = 0; j < made->order[1]; j++)
        for (int i = 0; i < made->order[0]; i++, point += N) {
            const size_t function[2] = {(size_t)(span[0] - made->order[0] + 1 + i),
                                        (size_t)(span[1] - made->order[1] + 1 + j)};
            control_point(border, face, function, point);
        }
    for (int f = 0; f < 2; f++) {
        double matrix[MAX_ORDER * MAX_ORDER];
        ffd_bezier_extraction(boundary_knots(border, face, f), span[f], matrix);
        extract(made, f, matrix);
    }
}

/* The tree */

static void unite(bounds *box, const bounds *other)
{
    bounds_add(box, other->lo);
    bounds_add(box, other->hi);
}

/* Adds two nodes. Addresses of nodes change when the array grows. */
static ffd_status add_children(builder *build, uint32_t *first)
{
    boundary *border = build->border;
    if (!ffd_grow((void **)&border->nodes, &border->node_capacity, border->node_count + 2,
                  sizeof *border->nodes))
        return ffd_fail_memory(build->error);
    *first = (uint32_t)border->node_count;
    memset(border->nodes + border->node_count, 0, 2 * sizeof *border->nodes);
    border->node_count += 2;
    return FFD_OK;
}

static void close_inner_node(boundary *border, uint32_t node, uint32_t child)
{
    boundary_node *at = &border->nodes[node];
    at->child = child;
    at->box = border->nodes[child].box;
    unite(&at->box, &border->nodes[child + 1].box);
}

static bool is_cut_enough(const face_patch *patch)
{
    bounds residual;
    const double *half = patch->half;
    const double size = 2 * (half[0] + half[1] + half[2]);
    for (int k = 0; k < 3; k++) {
        residual.lo[k] = -size;
        residual.hi[k] = size;
    }
    return ffd_patch_has_one_minimum(patch, &residual);
}

/* Makes the node of a measured patch. The boundary takes ownership of the patch. */
static ffd_status keep(builder *build, uint32_t node, face_patch *patch, int cuts)
{
    boundary *border = build->border;
    if (cuts == 0 || is_cut_enough(patch)) {
        border->nodes[node].box = ffd_patch_hull(patch);
        border->nodes[node].patch = patch;
        border->nodes[node].face = patch->face;
        patch->next = border->patches;
        border->patches = patch;
        return FFD_OK;
    }
    face_patch *half[2] = {ffd_patch_create(patch->order, patch->rational),
                           ffd_patch_create(patch->order, patch->rational)};
    uint32_t child = 0;
    ffd_status status;
    TRY_END(half[0] && half[1] ? add_children(build, &child) : ffd_fail_memory(build->error));
    ffd_patch_halve(patch, ffd_patch_direction(patch), half[0], half[1]);
    ffd_free(patch);
    patch = NULL;
    for (uint32_t i = 0; i < 2; i++) {
        face_patch *const kept = half[i];
        half[i] = NULL;
        TRY_END(keep(build, child + i, kept, cuts - 1));
    }
    close_inner_node(border, node, child);
end:
    ffd_free(patch);
    ffd_free(half[0]);
    ffd_free(half[1]);
    return status;
}

static ffd_status make_leaf(builder *build, uint32_t node)
{
    boundary *border = build->border;
    const boundary_node at = border->nodes[node];
    const size_t cell[2] = {at.cell[0], at.cell[1]};
    if (at.cells[0] == 1 && at.cells[1] == 1) {
        face_patch *patch = build->keeps ? make_patch(border, at.face) : build->scratch;
        if (!patch)
            return ffd_fail_memory(build->error);
        ffd_boundary_patch(border, at.face, cell, patch);
        if (build->keeps) {
            ffd_patch_measure(patch);
            return keep(build, node, patch, build->cuts);
        }
        border->nodes[node].box = ffd_patch_hull(patch);
        return FFD_OK;
    }
    /* Several cells: the bounds of their control points. */
    size_t from[2], to[2], function[2];
    for (int f = 0; f < 2; f++) {
        const knot_vector *knots = boundary_knots(border, at.face, f);
        from[f] = (size_t)(knots->spans[at.cell[f]] - knots->degree);
        to[f] = (size_t)knots->spans[at.cell[f] + at.cells[f] - 1];
    }
    bounds box = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (function[1] = from[1]; function[1] <= to[1]; function[1]++)
        for (function[0] = from[0]; function[0] <= to[0]; function[0]++) {
            double point[N];
            control_point(border, at.face, function, point);
            for (int c = 0; c < 3; c++)
                point[c] /= point[3];
            bounds_add(&box, point);
        }
    border->nodes[node].box = box;
    return FFD_OK;
}

/* Fills a node whose rectangle of cells is set. */
static ffd_status divide(builder *build, uint32_t node)
{
    boundary *border = build->border;
    const boundary_node whole = border->nodes[node];
    if ((size_t)whole.cells[0] * whole.cells[1] <= build->cells_a_leaf)
        return make_leaf(build, node);
    const int f = whole.cells[1] > whole.cells[0];
    uint32_t child = 0;
    TRY(add_children(build, &child));
    boundary_node *half = border->nodes + child;
    for (int i = 0; i < 2; i++) {
        half[i].face = whole.face;
        memcpy(half[i].cell, whole.cell, sizeof whole.cell);
        memcpy(half[i].cells, whole.cells, sizeof whole.cells);
    }
    half[0].cells[f] = whole.cells[f] / 2;
    half[1].cell[f] += half[0].cells[f];
    half[1].cells[f] -= half[0].cells[f];
    for (uint32_t i = 0; i < 2; i++)
        TRY(divide(build, child + i));
    close_inner_node(border, node, child);
    return FFD_OK;
}

/* Lists the faces in the order of directions, the first face before the last. */
static void list_faces(boundary *border)
{
    for (int direction = 0; direction < 3; direction++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&border->lattice->knots[direction]); end++) {
            boundary_face *face = &border->faces[border->face_count++];
            ffd_border_face(border->lattice, FFD_VOLUME_REST, direction, end, &face->sums);
            face->direction = direction;
            face->end = end;
            face->along[0] = direction == 0 ? 1 : 0;
            face->along[1] = direction == 2 ? 1 : 2;
            for (int f = 0; f < 2; f++)
                face->cells[f] = border->lattice->knots[face->along[f]].span_count;
        }
}

static ffd_status keep_points(boundary *border, ffd_error *error)
{
    size_t count = 0, point[2];
    for (int i = 0; i < border->face_count; i++)
        count += boundary_knots(border, i, 0)->points * boundary_knots(border, i, 1)->points;
    if (count > KEPT_POINTS)
        return FFD_OK;
    for (int i = 0; i < border->face_count; i++) {
        const size_t size[2] = {boundary_knots(border, i, 0)->points, boundary_knots(border, i, 1)->points};
        double *points = ffd_alloc(size[0] * size[1], N * sizeof *points);
        if (!points)
            return ffd_fail_memory(error);
        border->faces[i].points = points;
        for (point[1] = 0; point[1] < size[1]; point[1]++)
            for (point[0] = 0; point[0] < size[0]; point[0]++, points += N)
                sum_point(border, &border->faces[i], point, points);
    }
    return FFD_OK;
}

/* Returns how many patches of the orders of a face may be stored. */
static size_t patches_to_keep(const boundary *border)
{
    int order = 0;
    for (int a = 0; a < 3; a++)
        if (border->lattice->knots[a].degree + 1 > order)
            order = border->lattice->knots[a].degree + 1;
    return KEPT_SIZE / (sizeof(face_patch) + (size_t)(order * order) * N * sizeof(double));
}

ffd_status ffd_boundary_build(boundary *border, ffd_error *error)
{
    size_t cells = 0;
    list_faces(border);
    for (int i = 0; i < border->face_count; i++)
        cells += border->faces[i].cells[0] * border->faces[i].cells[1];
    const int largest[2] = {MAX_ORDER, MAX_ORDER};
    builder build = {.border = border, .keeps = cells <= patches_to_keep(border), .error = error};
    build.cells_a_leaf = 1 + (cells ? (cells - 1) / MOST_LEAVES : 0);
    while (build.cuts < MOST_CUTS && cells << (build.cuts + 1) <= MOST_PARTS)
        build.cuts++;
    build.scratch = ffd_patch_create(largest, true);
    ffd_status status;
    TRY_END(build.scratch ? keep_points(border, error) : ffd_fail_memory(error));
    for (int i = 0; i < border->face_count; i += 2) {
        /* The two faces of a direction use a pair of nodes. */
        uint32_t root = 0;
        TRY_END(add_children(&build, &root));
        for (int end = 0; end < 2; end++) {
            boundary_face *face = &border->faces[i + end];
            boundary_node *node = &border->nodes[root + (uint32_t)end];
            face->root = root + (uint32_t)end;
            node->face = i + end;
            for (int f = 0; f < 2; f++)
                node->cells[f] = (uint32_t)face->cells[f];
            TRY_END(divide(&build, face->root));
        }
    }
end:
    ffd_free(build.scratch);
    return status;
}
