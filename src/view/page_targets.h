/* page_targets.h - the morph targets of a page: of each the vertices that it moves, and their offsets in 16
   bits of the largest component. */
#ifndef FFD_VIEW_PAGE_TARGETS_H
#define FFD_VIEW_PAGE_TARGETS_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "json/json_text.h"

/* Limit of a page without `full`: offsets of all targets together, 10 bytes each. */
#define VIEW_PAGE_OFFSETS 1000000

/* All zeros: the page has no sliders. */
typedef struct page_targets {
    const page_mesh *mesh;
    bool *has_slider;     /* of each slider of the scene: whether the page has it */
    size_t *numbers;      /* its index among those of the page */
    size_t slider_count;  /* of those */
    size_t left_out;      /* sliders that are over the limit */
    byte_buffer vertices; /* u32 each, target by target: those before, then those after */
    byte_buffer offsets;  /* 3 i16 each */
    size_t *counts[2];    /* of each target of the scene: its entries */
    double *steps[2];     /* offset = step q, q from -32767 to 32767 */
} page_targets;

/* Takes the targets of an indexed mesh (ffd_page_mesh_index): what does not round to 0 of the vertices that
   the page has. Sliders get in in their order, as long as the limit allows; a slider that moves nothing is
   left out. Errors: FFD_E_MEMORY. Call ffd_page_targets_free in every case. */
ffd_status ffd_page_targets_make(const page_mesh *mesh, bool full, page_targets *targets, ffd_error *error);
/* Writes the blocks. */
void ffd_page_targets_write(const page_targets *targets, page_writer *w);
/* Adds the members that describe them. */
void ffd_page_targets_describe(const page_targets *targets, json_text *json);
/* Frees the arrays. */
void ffd_page_targets_free(page_targets *targets);

#endif
