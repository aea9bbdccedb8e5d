/* resource_list.h - the list of files that a mesh refers to for its appearance: images, material libraries.
   They are copied with an output in another folder. */
#ifndef FFD_MESH_RESOURCE_RESOURCE_LIST_H
#define FFD_MESH_RESOURCE_RESOURCE_LIST_H

#include "base/fail.h"
#include "base/memory/intern.h"
#include "mesh/linked_files.h"
#include <stdbool.h>
#include <stddef.h>

/* A kind of file that may be copied. A mesh file must not be able to copy other kinds of files into the
   folder of the output. */
typedef struct resource_kind {
    const char *name; /* for messages: "image" */
    bool (*has_name)(const char *path);
    bool (*has_content)(const unsigned char *bytes, size_t size);
    const char *other_name, *other_content; /* reasons, for messages, why a file of another kind is not
                                               copied */
} resource_kind;

extern const resource_kind ffd_resource_image;

typedef struct mesh_resource {
    char *path; /* relative to the folder of the mesh, normalized */
    const resource_kind *kind;
    size_t index; /* of the thing that refers to it, in the order of the mesh file */
} mesh_resource;

/* All zeros: empty. */
typedef struct resource_list {
    mesh_resource *resources;
    size_t count, capacity;
    intern_table known; /* the paths */
} resource_list;

/* Adds a file unless it is in the list. Takes ownership of path, also after a failure. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_resources_add(resource_list *list, const resource_kind *kind, size_t index, char *path,
                             ffd_error *error);
/* Sorts the files by path. */
void ffd_resources_sort(resource_list *list);
/* Frees the files and empties the list. */
void ffd_resources_free(resource_list *list);
/* Adds a file that a mesh at a path names to what is asked for; one outside the mesh's folder is not copied.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_resource_add_named(const char *path, const char *relative, const mesh_named *named,
                                  ffd_error *error);

#endif
