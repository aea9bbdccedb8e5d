/* image_file.h - decides which files may be copied as images of a mesh. Their names come from the mesh file,
   which must not be able to copy other kinds of files into the folder of the output. */
#ifndef FFD_MESH_RESOURCE_IMAGE_FILE_H
#define FFD_MESH_RESOURCE_IMAGE_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns whether a name has the ending of an image (.png, .jpg, .ktx2 and others, in upper or lower
   case). */
bool ffd_image_has_name(const char *path);
/* Returns whether a component of the path begins with a dot, as hidden files and folders do; "." and ".."
   count too. */
bool ffd_image_is_hidden(const char *path);
/* Returns whether the bytes have the signature of an image format. It need not match the ending: a wrong
   ending is common and harmless. */
bool ffd_image_has_content(const unsigned char *bytes, size_t size);

/* Returns the media type of such bytes, as "image/png". */
const char *ffd_image_media_type(const unsigned char *bytes, size_t size);

#endif
