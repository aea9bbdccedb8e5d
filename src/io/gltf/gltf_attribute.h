/* gltf_attribute.h - attributes of primitives that a deformation leaves as they are, for conversions: the
   accessor of one, and the texture coordinates that a texture takes. */
#ifndef FFD_IO_GLTF_GLTF_ATTRIBUTE_H
#define FFD_IO_GLTF_GLTF_ATTRIBUTE_H

#include "io/gltf/document/gltf_document.h"

/* Returns the accessor of an attribute with least to most numbers per element for all of a primitive's
   vertices; GLTF_NONE if it has none that can be used. */
size_t ffd_gltf_attribute(const gltf_document *document, size_t mesh, size_t primitive, const char *name,
                          int least, int most);

/* Texture coordinates as a texture takes them: of an accessor, transformed (KHR_texture_transform):
   u' = to_u[0] u + to_u[1] v + to_u[2], and v' likewise. A key: no bytes between the members. */
typedef struct gltf_texcoords {
    size_t accessor; /* GLTF_NONE: there are none */
    double to_u[3], to_v[3];
} gltf_texcoords;

/* Finds those of a primitive's base colour; of another texture of its material if that has none. Without a
   texture, or where the primitive lacks what it takes: TEXCOORD_0 as it is. */
void ffd_gltf_texcoords(const gltf_document *document, size_t mesh, size_t primitive,
                        gltf_texcoords *texcoords);

/* Whether the primitive has further sets, or a texture of its material takes other coordinates than these. */
bool ffd_gltf_has_more_texcoords(const gltf_document *document, size_t mesh, size_t primitive,
                                 const gltf_texcoords *texcoords);

/* Reads all of them, 2 numbers each, with v upwards. */
void ffd_gltf_read_texcoords(const gltf_document *document, const gltf_texcoords *texcoords, double *values);

#endif
