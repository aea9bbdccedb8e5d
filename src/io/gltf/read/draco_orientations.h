/* draco_orientations.h - limits a count in Draco data that the library trusts. C++, for draco.cpp only.

   The prediction of texture coordinates can use one bit per orientation. The library allocates memory for the
   stated number of orientations and reads as many bits, up to 2^31, whatever the size of the mesh. */
#ifndef FFD_IO_GLTF_READ_DRACO_ORIENTATIONS_H
#define FFD_IO_GLTF_READ_DRACO_ORIENTATIONS_H

#include <draco/compression/mesh/mesh_decoder.h>

/* Makes the attribute decoders refuse more orientations than the mesh has corners. Call it when the decoders
   exist and have read nothing yet. Returns false if that fails. */
bool limit_draco_orientations(draco::MeshDecoder &decoder);

#endif
