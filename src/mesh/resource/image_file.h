/* image_file.h - which files may be copied as the images of a mesh: its file says their names, and must not
   be able to bring anything else into the folder of the output. */
#ifndef FFD_MESH_RESOURCE_IMAGE_FILE_H
#define FFD_MESH_RESOURCE_IMAGE_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the name ends as those of images do (.png, .jpg, .ktx2 and others; letters in any case). */
bool ffd_image_has_name(const char *path);
/* Whether some part of the path begins with a dot, as hidden files and folders do; "." and ".." count. */
bool ffd_image_is_hidden(const char *path);
/* Whether the bytes begin as an image of some kind does. That an image has the ending of another kind is
   common, and does no harm. */
bool ffd_image_has_content(const unsigned char *bytes, size_t size);

#endif
