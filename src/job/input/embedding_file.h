/* embedding_file.h - the file that `ffd embed -o` writes and `ffd deform --embedding` reuses: u,v,w and
   status of every vertex, and of which mesh and rest lattice they are.

   It is an array file of NumPy with a trailer, which numpy.load does not look at. For N vertices in the order
   of `ffd embed`, H being the length of the array's header (a multiple of 64):

     offset       size
     0            H     header of NumPy's format 1.0: float64, shape (N, 3), C order; descr '<f8' or '>f8', as
                        the machine that wrote it holds numbers
     H            24 N  u,v,w of vertex 0, of vertex 1, ..., in the knots' range; NaN where there is none
     H + 24 N     N     statuses, one byte a vertex: 0 inside 1 outside 2 multiple 3 singular 4 invalid
     F = H + 25 N       the footer, 72 bytes:
     F            16    hash of the mesh's positions (ffd_embedding_hash_positions)
     F + 16       16    hash of the rest lattice (ffd_embedding_hash_rest)
     F + 32       16    hash of the bytes 0 .. F-1
     F + 48       8     N
     F + 56       4     format version, 1
     F + 60       4     reserved, 0
     F + 64       8     "ffd-embd": the end of the file

   Numbers of the footer are little-endian unsigned integers. Hashes are XXH3's with 128 bits, seed 0, in its
   canonical form (the highest byte first); numbers that are hashed are the 8 bytes of a double or of an
   unsigned integer, little-endian. */
#ifndef FFD_JOB_INPUT_EMBEDDING_FILE_H
#define FFD_JOB_INPUT_EMBEDDING_FILE_H

#include "base/memory/hash.h"
#include "mesh/mesh.h"
#include <ffd/embedding.h>

/* Hashes the positions in the lattice's space: each run of 1024 vertices of each part (the last may be
   shorter; parts that repeat positions are left out) for itself; then the list of these hashes with the
   number of vertices after it. Where numbers do not stand for themselves there follows, for each of these
   parts, the hash of six: whether x, y, z are float32 (1 or 0), and their steps (mesh/rounding.h). The same
   for any number of threads. Errors: FFD_E_MEMORY. */
ffd_status ffd_embedding_hash_positions(const mesh_document *document, int threads, hash128 *hash,
                                        ffd_error *error);

/* ffd_rest_hash, or, with a snap (world units), the hash of that hash and the hash of the snap.
 */
hash128 ffd_embedding_hash_rest(const ffd_lattice *lattice, double snap);

/* Appends an embedding of count vertices to the file that output began last. */
ffd_status ffd_embedding_write(file_output *output, const double *uvw, const uint8_t *statuses, size_t count,
                               const hash128 *positions, const hash128 *lattice, ffd_error *error);

typedef struct embedding_file {
    const double *uvw;       /* 3 a vertex */
    const uint8_t *statuses; /* ffd_vertex_status, one a vertex; u,v,w is finite where inside or multiple */
    size_t count;
    file_input input; /* which holds them */
    double *turned;   /* u,v,w of a machine with the other byte order; else NULL */
} embedding_file;

/* Opens an embedding of the mesh with count vertices and these hashes. A file that ends early, was changed,
   is of another version, or belongs to another mesh or rest lattice is refused (FFD_E_INVALID); every byte is
   looked at. Values are lent by file, which is to be closed; empty on failure. u,v,w of a forged file may lie
   outside the domain, or miss the vertex: the pass over the vertices looks at that. Errors also: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_embedding_open(const char *path, size_t count, const hash128 *positions,
                              const hash128 *lattice, embedding_file *file, ffd_error *error);
/* Closes the file and frees its values. */
void ffd_embedding_close(embedding_file *file);

/* Opens the embedding that `ffd embed` made of this document and lattice with this snap (world units), as
   ffd_embedding_open. The lattice must be fitted to its mesh. Errors: the same. */
ffd_status ffd_embedding_reuse(const char *path, const mesh_document *document, const ffd_lattice *lattice,
                               double snap, int threads, embedding_file *file, ffd_error *error);

/* What a search has found for a vertex at p: u,v,w taken to the domain, the residual anew, no evaluations. */
void ffd_embedding_locate(const embedding_file *file, size_t vertex, const ffd_lattice *lattice,
                          const double p[3], ffd_location *location);

#endif
