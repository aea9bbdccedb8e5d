/* draco_orientations.h - limits a number in Draco data that the library trusts. C++, of draco.cpp only.

   Texture coordinates can be predicted with one bit for each of a number of orientations. The library
   allocates memory for that number and reads as many bits, up to 2^31 of them, whatever the mesh's size. */
#ifndef FFD_IO_GLTF_DECODE_DRACO_ORIENTATIONS_H
#define FFD_IO_GLTF_DECODE_DRACO_ORIENTATIONS_H

#include <draco/compression/mesh/mesh_decoder.h>

/* Makes the attributes' decoders refuse more orientations than the mesh has corners. To be called when
   they exist and have read nothing yet. Returns false if that fails. */
bool limit_draco_orientations(draco::MeshDecoder &decoder);

#endif
