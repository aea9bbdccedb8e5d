/* draco_orientations.h - a number in Draco data that the library believes. C++, of draco.cpp only.

   Texture coordinates can be predicted with one bit for each of a number of orientations. The library makes
   room for that number and reads as many bits, up to 2^31 out of nothing, whatever the size of the mesh. */
#ifndef FFD_IO_GLTF_DECODE_DRACO_ORIENTATIONS_H
#define FFD_IO_GLTF_DECODE_DRACO_ORIENTATIONS_H

#include <draco/compression/mesh/mesh_decoder.h>

/* Lets the attributes' decoders refuse more orientations than the mesh has corners. Comes when they are made
   and have read nothing yet. */
bool limit_draco_orientations(draco::MeshDecoder &decoder);

#endif
