/* table.h - lattices as tables (table_csv.c) and as arrays (table_npy.c). */
#ifndef FFD_LATTICE_TABLE_TABLE_H
#define FFD_LATTICE_TABLE_TABLE_H

#include "base/file/input.h"
#include "base/file/output.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"

/* What a file does not tell. */
typedef struct table_wish {
    size_t size[3]; /* of an array (n, 3); 0: not given */
    int degree[3];  /* 0: min(3, n - 1); of a file that has its own FFD_E_ARGUMENT */
} table_wish;

/* Reads rows i,j,k,x,y,z,dx,dy,dz[,weight[,weight_deformed]] (data/schema/lattice.md 12). The caller frees
 *spec. Errors: FFD_E_INVALID with the line, FFD_E_ARGUMENT, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_lattice_read_csv(const file_input *file, const char *name, const table_wish *wish,
                                lattice_spec **spec, ffd_error *error);
/* Reads a NumPy array (n, 3), u fastest, or (n_u, n_v, n_w, 3): the control points at rest. Errors as
   above. */
ffd_status ffd_lattice_read_npy(const file_input *file, const char *name, const table_wish *wish,
                                lattice_spec **spec, ffd_error *error);

/* Writes all of a lattice with control points into an output that has begun. */
ffd_status ffd_lattice_write_csv(const ffd_lattice *lattice, file_output *output, ffd_error *error);
/* Writes the control points of a volume as (n_u, n_v, n_w, 3) float64. */
ffd_status ffd_lattice_write_npy(const ffd_lattice *lattice, ffd_volume volume, file_output *output,
                                 ffd_error *error);

/* Begins a spec of this size with clamped uniform knots and control points to be filled in. The caller frees
 *spec. Errors: FFD_E_INVALID for a direction of one control point, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_lattice_table_begin(const size_t size[3], const char *name, const table_wish *wish,
                                   lattice_spec **spec, ffd_error *error);
/* The degree of a direction that tells none. */
int ffd_lattice_table_degree(size_t size);

#endif
