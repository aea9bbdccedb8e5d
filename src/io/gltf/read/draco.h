/* draco.h - decodes a mesh of KHR_draco_mesh_compression with the Draco library. The implementation is C++,
   but no function throws an exception. Declares draco_load.c too: in a program that loads modules it has
   these functions. */
#ifndef FFD_IO_GLTF_READ_DRACO_H
#define FFD_IO_GLTF_READ_DRACO_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the glTF file states about the mesh. The header of the Draco data is compared with it before any large
   allocation. */
typedef struct draco_claim {
    uint64_t points;
    uint64_t corners; /* the number of indices; UINT64_MAX: the primitive has no indices */
} draco_claim;

typedef struct draco_mesh draco_mesh;

/* Decodes size bytes into a mesh, which ffd_draco_free frees. The working memory must fit into the memory
   budget, but nothing is taken from the budget. Errors, without a file's name: FFD_E_INVALID,
   FFD_E_UNSUPPORTED (another version, not a mesh; no library), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_draco_decode(const unsigned char *bytes, size_t size, const draco_claim *claim,
                            const memory_budget *budget, draco_mesh **mesh, ffd_error *error);

/* Frees a mesh; NULL is allowed. */
void ffd_draco_free(draco_mesh *mesh);

/* Returns the number of points. */
size_t ffd_draco_point_count(const draco_mesh *mesh);

/* Returns the number of corners: 3 for each triangle. */
size_t ffd_draco_corner_count(const draco_mesh *mesh);

/* Writes the attribute of this unique id as glTF stores it: per point `components` little-endian numbers of
   the type `component` (a gltf_component), `stride` bytes from point to point. Padding between the elements
   is not written. Errors: FFD_E_INVALID (no such attribute, another number of components, a number that the
   type cannot represent), FFD_E_UNSUPPORTED. */
ffd_status ffd_draco_attribute(const draco_mesh *mesh, uint32_t id, int component, int components,
                               size_t stride, unsigned char *bytes, ffd_error *error);

/* Returns the quantization step of the attribute of this unique id plus the possible rounding of its
   dequantization; 0: it was not quantized. */
double ffd_draco_step(const draco_mesh *mesh, uint32_t id);

/* Writes the corners of the triangles as contiguous indices of type GLTF_U8, GLTF_U16 or GLTF_U32.
   Errors: FFD_E_INVALID (a corner that is not a point, or that the type cannot represent). */
ffd_status ffd_draco_indices(const draco_mesh *mesh, int component, unsigned char *bytes, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
