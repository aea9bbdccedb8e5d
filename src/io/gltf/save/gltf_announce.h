/* gltf_announce.h - log lines that summarize saving. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_ANNOUNCE_H
#define FFD_IO_GLTF_SAVE_GLTF_ANNOUNCE_H

#include "io/gltf/save/gltf_saver.h"

/* Logs what was left unchanged, copied or stored in another way. Call it after all edits. */
void ffd_gltf_announce(const gltf_saver *saver);

#endif
