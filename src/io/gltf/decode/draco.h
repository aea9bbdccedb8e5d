/* draco.h - decodes the mesh that KHR_draco_mesh_compression holds, by the Draco library. Behind this header
   there is C++; no exception leaves. */
#ifndef FFD_IO_GLTF_DECODE_DRACO_H
#define FFD_IO_GLTF_DECODE_DRACO_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the glTF file says of the mesh. The data's own header is held against it before anything large is
   allocated. */
typedef struct draco_claim {
    uint64_t points;
    uint64_t corners; /* elements of its indices; UINT64_MAX: it has none */
} draco_claim;

typedef struct draco_mesh draco_mesh;

/* Decodes size bytes; free the mesh with ffd_draco_free. Working memory must fit into room, from which
   nothing is taken. Errors, without a file's name: FFD_E_INVALID, FFD_E_UNSUPPORTED (another version, no
   mesh), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_draco_decode(const unsigned char *bytes, size_t size, const draco_claim *claim,
                            const mesh_room *room, draco_mesh **mesh, ffd_error *error);
void ffd_draco_free(draco_mesh *mesh); /* NULL allowed */

size_t ffd_draco_point_count(const draco_mesh *mesh);
size_t ffd_draco_corner_count(const draco_mesh *mesh);

/* Writes the attribute of this unique id as glTF stores it: for each point `components` numbers of the type
   `component` (a gltf_component), little-endian, the next point `stride` bytes on. What lies between stays as
   it is. Errors: FFD_E_INVALID (no such attribute, other components, a number that the type does not hold),
   FFD_E_UNSUPPORTED. */
ffd_status ffd_draco_attribute(const draco_mesh *mesh, uint32_t id, int component, int components,
                               size_t stride, unsigned char *bytes, ffd_error *error);

/* Writes the corners of the triangles as indices of type GLTF_U8, GLTF_U16 or GLTF_U32 without gaps. Errors:
   FFD_E_INVALID (a corner that is no point, or that the type does not hold). */
ffd_status ffd_draco_indices(const draco_mesh *mesh, int component, unsigned char *bytes, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
