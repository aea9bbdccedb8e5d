/* image_tiles.h - names that stand for the images of several tiles of the texture space: "skin.<UDIM>.png"
   for skin.1001.png (u and v from 0 to 1), skin.1002.png (u from 1 to 2) and so on, "<UVTILE>" for u1_v1,
   "<U>" and "<V>" for its two numbers, "<u>" and "<v>" for these counted from 0. */
#ifndef FFD_MESH_RESOURCE_IMAGE_TILES_H
#define FFD_MESH_RESOURCE_IMAGE_TILES_H

#include <stdbool.h>
#include <stddef.h>

/* The number of tiles that are looked for. */
#define IMAGE_TILES 1000

/* Whether a name stands for tiles. */
bool ffd_image_has_tiles(const char *name);

/* Returns the name of the image of tile i, below IMAGE_TILES; NULL if memory runs out. The caller frees
   it. */
char *ffd_image_tile(const char *name, size_t i);

#endif
