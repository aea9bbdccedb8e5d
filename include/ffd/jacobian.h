/* jacobian.h - the derivative of the positions of a mesh with respect to control points, or to the parameters
   of a lattice file (the placeholders in its moves). */
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

/* What positions are differentiated with respect to. */
typedef enum ffd_jacobian_by { FFD_BY_POINTS = 0, FFD_BY_PARAMETERS } ffd_jacobian_by;

/* Value of ffd_jacobian_desc.of: the last lattice of the job. */
#define FFD_LATTICE_LAST SIZE_MAX

/* A job of `ffd jacobian`. Fill with ffd_jacobian_desc_init, then set job and output. The matrix has a row
   for each of the N vertices, in the order of `ffd embed`.

   FFD_BY_POINTS: the value in row i, column j (u fastest) is R_j(u_i) (The NURBS Book 4.2), the derivative of
   each coordinate of vertex i with respect to the same coordinate of the deformed control point j. With
   components, and where further lattices follow, each value is a 3 x 3 block in rows 3i..3i+2 and columns
   3j..3j+2: M^-1 F R_j. F is the product of the deformation gradients of the later lattices at the vertex, M
   the linear part of the transform of its node. M applies with components only; positions are then in the
   space of the file, otherwise in that of the scene.

   FFD_BY_PARAMETERS: row 3i+a is for coordinate a of vertex i; there is a column for each number of each
   placeholder, in the order in which the file first uses them.

   Rows of vertices that do not move (outside, invalid, not selected) are empty. A vertex that
   FFD_OUTSIDE_EXTEND moves has the row of its border point. Where faces are held (ffd_deform_desc.seam),
   columns stay those of the control points as they are: R_j is what the free layers have of them. */
typedef struct ffd_jacobian_desc {
    size_t struct_size;         /* sizeof(ffd_jacobian_desc) in the caller's header */
    const ffd_deform_desc *job; /* used are input, lattices, set, outside, falloff, seam, snap, only,
                                   weight, threads, isa, force, log, sink, timeout */
    const char *output; /* a path or name that ends in .npz (CSR as SciPy reads it), .mtx (Matrix Market) or
                           .npy (dense); not "-" */
    ffd_jacobian_by by;
    bool components; /* 3 x 3 blocks in the space of the file, as above; default false */
    size_t of;       /* FFD_BY_POINTS: index of the lattice, from 0; default FFD_LATTICE_LAST */
    /* At most one of these: an .npy whose array is multiplied with the matrix; output is then the product, an
       .npy. times: J x. By points x has n rows of 3 numbers, for n control points (with components in the
       space of the file), and the product is N x 3; by parameters x has m numbers. transposed: J^T x; x is N
       x 3, and the product n x 3, or m numbers. */
    const char *times, *transposed;
    bool check; /* compares the matrix with central differences of the deformation at 16 vertices */
    /* The content of these files in memory; times, or transposed, is then only a name for messages, or
       NULL. */
    ffd_bytes times_bytes, transposed_bytes;
} ffd_jacobian_desc;

/* Sets desc to defaults. size: sizeof(ffd_jacobian_desc) in the caller's header. */
FFD_API void ffd_jacobian_desc_init(ffd_jacobian_desc *desc, size_t size);

/* What ffd_jacobian_run has written. Set struct_size to sizeof(ffd_jacobian_result) before the call. */
typedef struct ffd_jacobian_result {
    size_t struct_size;              /* sizeof(ffd_jacobian_result) in the caller's header */
    uint64_t rows, columns, entries; /* of the matrix; entries: stored values, which are not 0 */
    uint64_t vertices, moving;       /* N, and how many of them have rows that are not empty */
    double worst; /* with check: the largest difference, relative to the largest number of the row */
} ffd_jacobian_result;

/* Runs the job. With check it fails with FFD_E_GATE, and writes nothing, if worst is greater than 1e-6.
   result may be NULL. Thread-safe for jobs that share no objects. Errors: those of ffd_check_run,
   FFD_E_INVALID (a placeholder whose value is not numeric, an array of the wrong shape), FFD_E_IO,
   FFD_E_EXISTS. */
FFD_API ffd_status ffd_jacobian_run(const ffd_jacobian_desc *desc, ffd_jacobian_result *result,
                                    ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
