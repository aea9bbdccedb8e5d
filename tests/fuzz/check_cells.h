/* check_cells.h - what holds for the cells of any volume mesh that opens. */
#ifndef FFD_TESTS_FUZZ_CHECK_CELLS_H
#define FFD_TESTS_FUZZ_CHECK_CELLS_H

#include "mesh/mesh.h"

/* Measures each volume cell: its numbers and what is said of it agree. A broken promise aborts. */
void check_cells(const mesh_document *document);

#endif
