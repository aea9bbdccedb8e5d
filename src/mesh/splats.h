/* splats.h - the ellipsoids of a mesh's Gaussian splats. */
#ifndef FFD_MESH_SPLATS_H
#define FFD_MESH_SPLATS_H

#include "mesh/mesh.h"
#include "splat/splat.h"

/* Read and write the ellipsoids, for parts that have them; as the reader and the writer of positions. The
   harmonics of splat i are rotated by turns[i]. */
typedef void mesh_read_splats_function(const mesh_document *document, size_t part, size_t first, size_t count,
                                       splat_ellipsoid *splats);
typedef void mesh_write_splats_function(mesh_document *document, size_t part, size_t first, size_t count,
                                        const splat_ellipsoid *splats, const splat_turn *turns,
                                        const uint8_t *changed);

struct mesh_splat_calls {
    mesh_read_splats_function *read;
    mesh_write_splats_function *write;
};

#endif
