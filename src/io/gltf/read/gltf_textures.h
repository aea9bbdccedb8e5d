/* gltf_textures.h - the textures of materials (textureInfo), the texture coordinates that they use, and other
   attributes that a deformation does not change. */
#ifndef FFD_IO_GLTF_READ_GLTF_TEXTURES_H
#define FFD_IO_GLTF_READ_GLTF_TEXTURES_H

#include "io/gltf/read/gltf_document.h"

/* What a texture does with the coordinates of a set: scale, rotate, offset (KHR_texture_transform). */
typedef struct gltf_texture_use {
    size_t set;
    double offset[2], scale[2], radians;
} gltf_texture_use;

/* Values of a texture that glTF does not allow, at most. */
enum { TEXTURE_FAULTS = 7 };

typedef struct gltf_texture_faults {
    uint32_t values[TEXTURE_FAULTS];
    size_t count;
} gltf_texture_faults;

/* Returns the first texture of a material after v, one of its values or the material itself; JSON_NONE:
   none. */
uint32_t ffd_gltf_next_texture(const gltf_document *document, uint32_t material, uint32_t v);
/* Reads how a texture (JSON_NONE: none) uses texture coordinates. A value that glTF does not allow is
   ignored, and added to faults, which may be NULL. */
void ffd_gltf_read_texture(const gltf_document *document, uint32_t texture, gltf_texture_use *use,
                           gltf_texture_faults *faults);

/* Returns the accessor of an attribute with least to most components for all of a primitive's vertices;
   GLTF_NONE if it is absent or cannot be used. */
size_t ffd_gltf_attribute(const gltf_document *document, const gltf_primitive *primitive, const char *name,
                          int least, int most);

/* Texture coordinates as a texture uses them: those of an accessor, transformed (KHR_texture_transform): u' =
   to_u[0] u + to_u[1] v + to_u[2], and v' likewise. The bytes of the struct are a key for lookups. */
typedef struct gltf_texcoords {
    unsigned long long accessor; /* GLTF_NONE: no texture coordinates. As wide as a double: a size_t may leave
                                    padding behind it, with any bytes. */
    double to_u[3], to_v[3];
} gltf_texcoords;

_Static_assert(sizeof(gltf_texcoords) == 7 * sizeof(double), "a key has no padding");

/* Finds the texture coordinates of a primitive's base colour texture, or else of another texture of its
   material. Without a texture, or if the primitive lacks the set that it uses: TEXCOORD_0, untransformed.
   Returns the number of the set. *stands_in: set to true where the primitive lacks the set of a texture, and
   TEXCOORD_0 takes its place; else it stays. */
size_t ffd_gltf_texcoords(const gltf_document *document, const gltf_primitive *primitive,
                          gltf_texcoords *texcoords, bool *stands_in);

/* The same for the texture of its emission. Returns GLTF_NONE if there is none, or the primitive lacks its
 * set. */
size_t ffd_gltf_glow_texcoords(const gltf_document *document, const gltf_primitive *primitive,
                               gltf_texcoords *texcoords);

/* Whether the primitive has further sets, or a texture of its material uses texture coordinates other than
   these. */
bool ffd_gltf_has_more_texcoords(const gltf_document *document, const gltf_primitive *primitive,
                                 const gltf_texcoords *texcoords);

/* Turns the values of the accessor, 2 numbers each, into texture coordinates with v pointing upwards. */
void ffd_gltf_turn_texcoords(const gltf_texcoords *texcoords, size_t count, double *values);

#endif
