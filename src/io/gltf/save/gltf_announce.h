/* gltf_announce.h - log lines that sum up a saving. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_ANNOUNCE_H
#define FFD_IO_GLTF_SAVE_GLTF_ANNOUNCE_H

#include "io/gltf/save/gltf_saver.h"

/* Logs what was left alone, copied or stored in another way. To be called after all edits are made. */
void ffd_gltf_announce(const gltf_saver *saver);

#endif
