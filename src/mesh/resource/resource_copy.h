/* resource_copy.h - copies the files that a mesh refers to next to an output in another folder, and warns
   about those that the output does not reach. */
#ifndef FFD_MESH_RESOURCE_RESOURCE_COPY_H
#define FFD_MESH_RESOURCE_RESOURCE_COPY_H

#include "base/file/file_folder.h"
#include "base/file/output.h"
#include "mesh/mesh.h"
#include "mesh/mesh_log.h"
#include "mesh/resource/copy_notes.h"
#include "mesh/resource/resource_list.h"

/* Capacity for a path in a message, including the final 0: what follows it has room too. */
#define RESOURCE_SHOWN 401

/* Source and destination of copies. */
typedef struct resource_copier {
    file_folder mesh;      /* where the names in the mesh file lead */
    const char *from, *to; /* folders of the mesh file and of the output */
    file_output *output;   /* NULL: only make the checks, copy nothing */
    const mesh_log *log;
    const mesh_save_options *options;
} resource_copier;

/* Loads a file that a mesh names, if it may be copied. *left: NULL, or the reason why it is not copied: its
   name or content is not of its kind, or it is hidden, missing or reached through a symbolic link.
   refused->status: FFD_OK, or the file must not be read, because it is outside of the mesh's folder or not a
   regular file. If neither is set, the file is loaded, and the caller unloads it. Errors: FFD_E_MEMORY. */
ffd_status ffd_resource_load(const file_folder *mesh, const mesh_resource *resource, file_input *bytes,
                             const char **left, ffd_error *refused, ffd_error *error);
/* Whether a file that is there is outside of the mesh's folder, by its path or by links. */
bool ffd_resource_is_outside(const file_folder *mesh, const char *path);
/* Copies a file to the same relative path in the output's folder, as a further file of copier->output. Logs a
   warning if it is not copied; the caller reports refused. An existing file must have the same bytes
   (otherwise FFD_E_IO). Files must be copied in the order of their paths (ffd_resources_sort). Errors:
   FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_resource_copy(const resource_copier *copier, const mesh_resource *resource, ffd_error *refused,
                             ffd_error *error);
/* Adds the path of a file that was copied or embedded to `copied`. Errors: FFD_E_MEMORY. */
ffd_status ffd_resource_note(const resource_copier *c, const mesh_resource *resource, ffd_error *error);
/* Checks that an output does not replace the file or, if is_copied, its copy. Errors: FFD_E_EXISTS,
   FFD_E_MEMORY. */
ffd_status ffd_resource_check_target(const resource_copier *copier, const mesh_resource *resource,
                                     bool is_copied, const char *target, ffd_error *error);

/* Copies the sorted files of a list beside the output, or (copies false) warns of those that the output does
   not reach. What cannot be copied is named in a warning. is_stay: mesh and output are in one folder, so that
   nothing is done but the check: target, the output's path, may not be that of a file or of its copy.
   Errors: FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_resources_bring(const resource_copier *copier, const resource_list *list, bool copies,
                               bool is_stay, const char *target, ffd_error *error);

#endif
