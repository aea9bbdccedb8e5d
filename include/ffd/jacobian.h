/* jacobian.h - the derivative of a mesh's positions by control points, or by the placeholders of their moves.
 */
#ifndef FFD_JACOBIAN_H
#define FFD_JACOBIAN_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What positions are differentiated by. */
typedef enum ffd_jacobian_by { FFD_BY_POINTS = 0, FFD_BY_PARAMETERS } ffd_jacobian_by;

/* The last lattice of a job. */
#define FFD_LATTICE_LAST SIZE_MAX

/* The job of `ffd jacobian`. Fill with ffd_jacobian_desc_init, then set what is known. Rows are vertices in
   the order of `ffd embed`: N of them.

   By points the value in row i and column j (u fastest) is R_j(u_i), the derivative of each coordinate of the
   vertex by the same coordinate of deformed control point j (NURBS Book 4.2). With components, and where
   further lattices follow, it is 3 x 3 numbers, row 3i+a and column 3j+b: M^-1 F R_j, F the product of the
   gradients of the later lattices at the vertex and M the linear part of its node (components only: in the
   space of the file; else the scene's). By parameters the row 3i+a has a column for each number of each
   placeholder, in the order of their first use.

   Rows of vertices that do not move (outside, invalid, not selected) are empty; those that FFD_OUTSIDE_EXTEND
   moves have the border point's. */
typedef struct ffd_jacobian_desc {
    size_t struct_size; /* sizeof(ffd_jacobian_desc) of the caller */
    const ffd_deform_desc
        *job; /* input, lattices, set, outside, falloff, snap, only, threads, isa, force, log, sink */
    const char *output; /* .npz (CSR as SciPy reads it), .mtx (Matrix Market), .npy; "-" is not possible */
    ffd_jacobian_by by;
    bool components;
    size_t of; /* by points: the lattice, from 0; default FFD_LATTICE_LAST */
    /* One of these, or neither: an .npy that is multiplied instead, so that output, an .npy, is the product:
       by points n x 3 numbers (components: in the file's space) give N x 3, by parameters m numbers;
       transposed: N x 3 numbers give n x 3, or m. */
    const char *times, *transposed;
    bool check; /* compare with central differences of the program at 16 vertices */
    /* Those of the file; times, or transposed, is then a name, or NULL. */
    ffd_bytes times_bytes, transposed_bytes;
} ffd_jacobian_desc;

/* Fills desc, of which the caller knows size bytes (sizeof(ffd_jacobian_desc)), with defaults. */
FFD_API void ffd_jacobian_desc_init(ffd_jacobian_desc *desc, size_t size);

/* What was written. Set struct_size to sizeof(ffd_jacobian_result) before the call. */
typedef struct ffd_jacobian_result {
    size_t struct_size;
    uint64_t rows, columns, entries; /* of the matrix; entries: not 0 */
    uint64_t vertices, moving;       /* N, and those whose rows are not empty */
    double worst; /* with check: the largest difference, relative to the row's largest number */
} ffd_jacobian_result;

/* Runs the job. With check FFD_E_GATE where the worst difference is more than 1e-6; nothing is written then.
   result may be NULL. Errors: those of ffd_check_run, FFD_E_INVALID (a placeholder that is no number, an
   array of another shape), FFD_E_IO, FFD_E_EXISTS. */
FFD_API ffd_status ffd_jacobian_run(const ffd_jacobian_desc *desc, ffd_jacobian_result *result,
                                    ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
