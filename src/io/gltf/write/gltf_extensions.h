/* gltf_extensions.h - drops the extensions that the output no longer needs. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_EXTENSIONS_H
#define FFD_IO_GLTF_WRITE_GLTF_EXTENSIONS_H

#include "io/gltf/write/gltf_saver.h"

/* Removes them from extensionsUsed and extensionsRequired. */
void ffd_gltf_drop_extensions(gltf_saver *saver);

#endif
