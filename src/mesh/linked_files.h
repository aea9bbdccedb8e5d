/* linked_files.h - the further files of a mesh: those that it consists of, and those that it names. */
#ifndef FFD_MESH_LINKED_FILES_H
#define FFD_MESH_LINKED_FILES_H

#include "mesh/mesh.h"

/* What a mesh names; existing or not. NULL: not asked for. */
typedef struct mesh_named {
    path_list *files;  /* every file beside it: buffers, images, material libraries and their maps, files of
                          extensions */
    path_list *copies; /* images and other files that are copied with an output */
    path_list *linked; /* those that no job reads or copies */
} mesh_named;

/* Adds the files that a mesh names, by scanning the bytes of the file at a path without opening a document.
   An invalid file has none. */
typedef ffd_status mesh_find_named_function(const char *path, const file_input *bytes,
                                            const mesh_named *named, ffd_error *error);
typedef ffd_status mesh_list_files_function(const mesh_document *document, path_list *files,
                                            ffd_error *error);

/* The files that meshes name. */
struct mesh_resource_calls {
    mesh_find_named_function *find_named;
    /* Adds files that no job reads or copies, wherever they are: those of extensions of a glTF, of call and
       others in an OBJ. NULL: none. */
    mesh_list_files_function *list_linked;
};

/* Counts the further files, without images, that saving a mesh as `to` writes, by scanning the bytes of
   the input (NULL if its format is another one). An invalid file has none. */
typedef size_t mesh_count_sidecars_function(const file_input *bytes, ffd_format from, ffd_format to);
/* Returns the path of number `index` of these files, if no other model names it (resource/sidecar.h). */
typedef char *mesh_name_sidecar_function(const char *output, size_t index);

/* Calls list_linked if the format has it. */
static inline ffd_status ffd_mesh_list_linked(const mesh_document *document, path_list *files,
                                              ffd_error *error)
{
    const mesh_resource_calls *const calls = document->format->resources;
    return calls && calls->list_linked ? calls->list_linked(document, files, error) : FFD_OK;
}

/* The files that a mesh consists of. */
struct mesh_sidecar_calls {
    /* Adds the further files that open has read: the buffers of a .gltf, the faces of OpenFOAM. A file that
       is referenced twice is added twice. */
    mesh_list_files_function *list;
    /* Adds the referenced images in the folder of the file or below, whether they exist or not. */
    mesh_list_files_function *list_images;
    /* NULL: none are written with an output. */
    mesh_count_sidecars_function *count;
    mesh_name_sidecar_function *name;
};

#endif
