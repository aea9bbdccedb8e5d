/* boundary_cell.c - decides whether the border meets a cell (a box in space). Boxes of the tree, patches and
   their halves are dropped if a plane separates them from the cell, until a point of a patch is found in the
   cell or none is left. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/boundary/boundary_faces.h"
#include <string.h>

/* The most patches and parts of patches that a search examines. */
#define BUDGET 4096
/* Parts of a patch that are this short, relative to a cell of the face, are not halved. */
#define LEAST_PART 0x1p-44

typedef struct cell_visit {
    const boundary *border;
    patch_cell cell;
    face_patch *scratch; /* large enough for any patch; allocated when first needed */
    int budget;
    bool meets, undecided;
    ffd_error *error;
} cell_visit;

static ffd_status visit_patch(cell_visit *visit, const face_patch *patch);

static ffd_status visit_halves(cell_visit *visit, const face_patch *patch, int f)
{
    face_patch *half[2] = {ffd_patch_create(patch->order, patch->rational),
                           ffd_patch_create(patch->order, patch->rational)};
    ffd_status status;
    TRY_END(half[0] && half[1] ? FFD_OK : ffd_fail_memory(visit->error));
    ffd_patch_split(patch, f, half[0], half[1]);
    for (int i = 0; i < 2 && !visit->meets; i++)
        TRY_END(visit_patch(visit, half[i]));
end:
    ffd_free(half[0]);
    ffd_free(half[1]);
    return status;
}

static ffd_status visit_patch(cell_visit *visit, const face_patch *patch)
{
    int longer = 0;
    if (visit->budget-- <= 0) {
        visit->undecided = true;
        return FFD_OK;
    }
    const patch_view view = ffd_patch_view_cell(patch, &visit->cell, &longer);
    visit->meets = visit->meets || view == PATCH_MEETS;
    if (view != PATCH_UNKNOWN)
        return FFD_OK;
    if (patch->hi[longer] - patch->lo[longer] > LEAST_PART)
        return visit_halves(visit, patch, longer);
    visit->undecided = true;
    return FFD_OK;
}

static ffd_status make_scratch(cell_visit *visit)
{
    const int order[2] = {MAX_ORDER, MAX_ORDER};
    if (!visit->scratch)
        visit->scratch = ffd_patch_create(order, true);
    return visit->scratch ? FFD_OK : ffd_fail_memory(visit->error);
}

/* Examines the patches of a leaf whose patches are not stored. */
static ffd_status visit_cells(cell_visit *visit, const boundary_node *leaf)
{
    TRY(make_scratch(visit));
    for (size_t j = 0; j < leaf->cells[1]; j++)
        for (size_t i = 0; i < leaf->cells[0] && !visit->meets; i++) {
            const size_t cell[2] = {leaf->cell[0] + i, leaf->cell[1] + j};
            ffd_boundary_patch(visit->border, leaf->face, cell, visit->scratch);
            TRY(visit_patch(visit, visit->scratch));
        }
    return FFD_OK;
}

static ffd_status visit_node(cell_visit *visit, uint32_t index)
{
    const boundary_node *const node = &visit->border->nodes[index];
    if (visit->meets || !bounds_hold(&node->box, visit->cell.centre, visit->cell.half))
        return FFD_OK;
    if (node->patch)
        return visit_patch(visit, node->patch);
    if (!node->child)
        return visit_cells(visit, node);
    TRY(visit_node(visit, node->child));
    return visit_node(visit, node->child + 1);
}

/* Makes a patch of a face of a box with an affine map. */
static void make_box_face(const boundary *border, int direction, int end, face_patch *patch)
{
    const int along[2] = {direction == 0 ? 1 : 0, direction == 2 ? 1 : 2};
    patch->rational = false;
    for (int f = 0; f < 2; f++) {
        patch->order[f] = 2;
        patch->lo[f] = 0;
        patch->hi[f] = 1;
    }
    for (int corner = 0; corner < 4; corner++) {
        double *const point = patch->points + PATCH_COMPONENTS * corner;
        double t[3];
        t[direction] = end;
        t[along[0]] = corner & 1;
        t[along[1]] = corner >> 1;
        mat_apply(border->frame, t, point);
        point[3] = 1;
    }
}

static ffd_status visit_box(cell_visit *visit)
{
    TRY(make_scratch(visit));
    for (int face = 0; face < MOST_FACES && !visit->meets; face++) {
        make_box_face(visit->border, face / 2, face % 2, visit->scratch);
        TRY(visit_patch(visit, visit->scratch));
    }
    return FFD_OK;
}

ffd_status ffd_boundary_view_cell(const boundary *border, const patch_cell *cell, patch_view *view,
                                  ffd_error *error)
{
    cell_visit visit = {.border = border, .cell = *cell, .budget = BUDGET, .error = error};
    ffd_status status = FFD_OK;
    if (border->lattice->form == REST_BOX_AFFINE)
        TRY_END(visit_box(&visit));
    for (int i = 0; i < border->face_count; i++)
        TRY_END(visit_node(&visit, border->faces[i].root));
end:
    ffd_free(visit.scratch);
    *view = visit.meets ? PATCH_MEETS : visit.undecided ? PATCH_UNKNOWN : PATCH_MISSES;
    return status;
}
