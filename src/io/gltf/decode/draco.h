/* draco.h - decodes the mesh of KHR_draco_mesh_compression, by the Draco library. The functions are C++
   inside; none throws an exception. Declares draco_load.c too, which a program that loads them has instead.
 */
#ifndef FFD_IO_GLTF_DECODE_DRACO_H
#define FFD_IO_GLTF_DECODE_DRACO_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the glTF file states about the mesh. The data's own header is compared with it before anything
   large is allocated. */
typedef struct draco_claim {
    uint64_t points;
    uint64_t corners; /* elements of its indices; UINT64_MAX: it has none */
} draco_claim;

typedef struct draco_mesh draco_mesh;

/* Decodes size bytes into a mesh that ffd_draco_free frees. Working memory must fit into the memory
   budget, from which nothing is taken. Errors, without a file's name: FFD_E_INVALID, FFD_E_UNSUPPORTED
   (another version, not a mesh; no library), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_draco_decode(const unsigned char *bytes, size_t size, const draco_claim *claim,
                            const memory_budget *budget, draco_mesh **mesh, ffd_error *error);

/* Frees a mesh; NULL is allowed. */
void ffd_draco_free(draco_mesh *mesh);

/* Returns the number of points. */
size_t ffd_draco_point_count(const draco_mesh *mesh);

/* Returns the number of corners: 3 for each triangle. */
size_t ffd_draco_corner_count(const draco_mesh *mesh);

/* Writes the attribute of this unique id as glTF stores it: for each point `components` numbers of the
   type `component` (a gltf_component), little-endian, `stride` bytes from point to point. The bytes
   between stay as they are. Errors: FFD_E_INVALID (no such attribute, another number of components, a
   number that the type cannot represent), FFD_E_UNSUPPORTED. */
ffd_status ffd_draco_attribute(const draco_mesh *mesh, uint32_t id, int component, int components,
                               size_t stride, unsigned char *bytes, ffd_error *error);

/* Returns the step that the attribute of this unique id was quantized with, and what its way back to floats
   may have rounded; 0: it was not quantized. */
double ffd_draco_step(const draco_mesh *mesh, uint32_t id);

/* Writes the corners of the triangles as contiguous indices of type GLTF_U8, GLTF_U16 or GLTF_U32.
   Errors: FFD_E_INVALID (a corner that is not a point, or that the type cannot represent). */
ffd_status ffd_draco_indices(const draco_mesh *mesh, int component, unsigned char *bytes, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
