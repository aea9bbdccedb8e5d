/* embedding_file.h - the file that `ffd embed -o` writes and `ffd deform --embedding` reuses: u,v,w and
   status of every vertex, with hashes that identify the mesh and the rest lattice.

   It is a NumPy array file with a trailer that numpy.load ignores. Layout for N vertices in the order of
   `ffd embed`; H is the length of the array's header (a multiple of 64):

     offset       size
     0            H     NumPy header, version 1.0: float64, shape (N, 3), C order; descr '<f8' or '>f8', the
                        byte order of the machine that wrote the file
     H            24 N  u,v,w of vertex 0, of vertex 1, ..., in the range of the knots; NaN: none
     H + 24 N     N     statuses, one byte a vertex: 0 inside 1 outside 2 multiple 3 singular 4 invalid
     F = H + 25 N       the footer, 72 bytes:
     F            16    hash of the mesh's positions (ffd_embedding_hash_positions)
     F + 16       16    hash of the rest lattice (ffd_embedding_hash_rest)
     F + 32       16    hash of the bytes 0 .. F-1
     F + 48       8     N
     F + 56       4     format version, 1
     F + 60       4     reserved, 0
     F + 64       8     "ffd-embd": the end of the file

   Numbers in the footer are little-endian unsigned integers. Hashes are XXH3 with 128 bits and seed 0, in its
   canonical form (big-endian). The input of a hash is numbers of 8 bytes, doubles or unsigned integers,
   little-endian. */
#ifndef FFD_JOB_INPUT_EMBEDDING_FILE_H
#define FFD_JOB_INPUT_EMBEDDING_FILE_H

#include "base/memory/hash.h"
#include "mesh/mesh.h"
#include <ffd/embedding.h>

/* Hashes the positions in the lattice's space. Each run of 1024 vertices of a part (the last may be shorter;
   parts that repeat positions are left out) is hashed separately, then the list of these hashes followed by
   the number of vertices. If any position has a rounding cell, the list ends with one more hash for each of
   these parts, of six numbers: whether x, y, z are float32 (1 or 0), and their steps (mesh/rounding.h). The
   number of threads does not change the result. Errors: FFD_E_MEMORY. */
ffd_status ffd_embedding_hash_positions(const mesh_document *document, int threads, hash128 *hash,
                                        ffd_error *error);

/* Returns ffd_rest_hash; with a snap (world units), the hash of that hash and the snap's hash. */
hash128 ffd_embedding_hash_rest(const ffd_lattice *lattice, double snap);

/* Writes an embedding of count vertices to the file that output began last. uvw: 3 numbers a vertex.
   statuses: one a vertex. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_embedding_write(file_output *output, const double *uvw, const uint8_t *statuses, size_t count,
                               const hash128 *positions, const hash128 *lattice, ffd_error *error);

typedef struct embedding_file {
    const double *uvw; /* 3 numbers a vertex */
    const uint8_t
        *statuses; /* ffd_vertex_status of each vertex; uvw is finite where it is inside or multiple */
    size_t count;
    file_input input; /* owns the bytes that both point to */
    double *turned;   /* copy of u,v,w with swapped byte order, if the file has the other one; else NULL */
} embedding_file;

/* Opens a file, or bytes of that name, as an embedding for a mesh with count vertices and
   these hashes. Refuses (FFD_E_INVALID) a file that is truncated or corrupt (all bytes are checked), of
   another version, or made for another mesh or rest lattice. The arrays are borrowed from file, which must be
   closed; it is empty on failure. A forged file may hold u,v,w outside of the domain or of other points: the
   pass over the vertices checks that. Errors also: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_embedding_open(const ffd_embedding_source *source, size_t count, const hash128 *positions,
                              const hash128 *lattice, embedding_file *file, ffd_error *error);
/* Closes the file; its arrays are no longer valid. */
void ffd_embedding_close(embedding_file *file);

/* Opens the embedding that `ffd embed` made for this document, lattice and snap (world units). The lattice
   must be fitted to the mesh. Errors: as of ffd_embedding_open. */
ffd_status ffd_embedding_reuse(const ffd_embedding_source *source, const mesh_document *document,
                               const ffd_lattice *lattice, double snap, int threads, embedding_file *file,
                               ffd_error *error);

/* Fills the location of a vertex at p as a search would: u,v,w clipped to the domain, the residual
   recomputed, no evaluations. */
void ffd_embedding_locate(const embedding_file *file, size_t vertex, const ffd_lattice *lattice,
                          const double p[3], ffd_location *location);

#endif
