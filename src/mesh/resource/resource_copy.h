/* resource_copy.h - copies the files that a mesh's file names beside an output in another folder. */
#ifndef FFD_MESH_RESOURCE_RESOURCE_COPY_H
#define FFD_MESH_RESOURCE_RESOURCE_COPY_H

#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path_list.h"
#include "mesh/mesh_log.h"
#include "mesh/resource/resource_list.h"

/* From where to where files are copied. */
typedef struct resource_copier {
    const char *mesh;      /* the path of its file */
    const char *from, *to; /* folders, of this file and of the output */
    file_output *output;   /* NULL: nothing is copied, but what would be refused is */
    const mesh_log *log;
    path_list *copied; /* gets the paths of what is copied, or is there already; or NULL */
} resource_copier;

/* Loads a file if it may be copied. *left: NULL, or why it is not copied: it has not the name or the content
   of its kind, is hidden, missing or reached through a link. refused: FFD_OK, or why it must not be read: it
   is outside of the mesh's folder, or no file. With neither it is loaded, the caller's to unload. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_resource_load(const resource_copier *copier, const mesh_resource *resource, file_input *bytes,
                             const char **left, ffd_error *refused, ffd_error *error);
/* Copies a file to the same place in the output's folder, as a further file of copier->output. What is left
   is named in a warning; refused is for the caller to say. A file that is there already must have the same
   bytes (FFD_E_IO). Files are copied in the order of their paths (ffd_resources_sort). Errors: FFD_E_EXISTS,
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_resource_copy(const resource_copier *copier, const mesh_resource *resource, ffd_error *refused,
                             ffd_error *error);
/* Refuses an output that would replace the file, or its copy (is_copied), by another file. Errors:
   FFD_E_EXISTS, FFD_E_MEMORY. */
ffd_status ffd_resource_check_target(const resource_copier *copier, const mesh_resource *resource,
                                     bool is_copied, const char *target, ffd_error *error);

#endif
