/* page_data.h - the numbers of a page's mesh, and their blocks: positions before in 16 bits of the box that
   holds both shapes, displacements in 16 bits of the largest of their components. */
#ifndef FFD_VIEW_PAGE_DATA_H
#define FFD_VIEW_PAGE_DATA_H

#include "view/page_mesh.h"
#include "view/page_writer.h"

typedef struct page_data {
    const page_mesh *mesh;
    double low[3], step[3]; /* x = low + step q, q from 0 to 65535 */
    double move_step;       /* d = move_step q, q from -32767 to 32767 */
    size_t number_size;     /* bytes of a vertex's number: 4, 8 (a double); 0: they are 0, 1, 2 .. */
} page_data;

/* Measures a mesh that is numbered. */
void ffd_page_data_measure(const page_mesh *mesh, page_data *data);
/* Writes the blocks of what the mesh has. */
void ffd_page_data_write(const page_data *data, page_writer *w);
/* Writes a cage's points: six doubles each, at rest and deformed. */
void ffd_page_data_write_cage(const view_cage *cage, const char *id, page_writer *w);

#endif
