/* page_edit.h - the data of the page of `ffd edit`: the edited lattice, and the points that it moves. */
#ifndef FFD_VIEW_PAGE_EDIT_H
#define FFD_VIEW_PAGE_EDIT_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "view/view_edit.h"
#include "json/json_text.h"

/* The points of a scene that a page has: its vertices, then the further points of these. */
typedef struct page_edit {
    const page_mesh *mesh;
    uint32_t *points; /* count indices in edit_points; NULL: the page edits nothing */
    size_t count;
} page_edit;

/* Lists the points of a mesh that is indexed. Errors: FFD_E_MEMORY. Call ffd_page_edit_free in every case. */
ffd_status ffd_page_edit_make(const page_mesh *mesh, page_edit *edit, ffd_error *error);
/* Adds the member "edit" to the JSON of a scene. */
void ffd_page_edit_describe(const page_edit *edit, json_text *json);
/* Writes the blocks. */
void ffd_page_edit_write(const page_edit *edit, page_writer *w);
/* Frees the list. */
void ffd_page_edit_free(page_edit *edit);

#endif
