/* page_data.h - the data blocks of a page's mesh, quantized: positions before to 16 bits of the box that
   holds both shapes, displacements to 16 bits of their largest component. */
#ifndef FFD_VIEW_PAGE_DATA_H
#define FFD_VIEW_PAGE_DATA_H

#include "view/page_mesh.h"
#include "view/page_writer.h"

typedef struct page_data {
    const page_mesh *mesh;
    double low[3], step[3]; /* x = low + step q, q from 0 to 65535 */
    double move_step;       /* d = move_step q, q from -32767 to 32767 */
    size_t index_size; /* bytes of a stored index of a vertex: 4, or 8 (a double); 0: none is stored, they are
                          0, 1, 2 .. */
} page_data;

/* Chooses the steps of quantization. The mesh must be indexed (ffd_page_mesh_index). */
void ffd_page_data_measure(const page_mesh *mesh, page_data *data);
/* Writes the blocks of all data that the mesh has. */
void ffd_page_data_write(const page_data *data, page_writer *w);
/* Writes the points of a cage: six doubles each, at rest, then deformed. */
void ffd_page_data_write_cage(const view_cage *cage, const char *id, page_writer *w);

#endif
