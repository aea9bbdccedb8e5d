/* resource_list.h - the files that a mesh's file names for how it looks: images, material libraries. They go
   with an output in another folder. */
#ifndef FFD_MESH_RESOURCE_RESOURCE_LIST_H
#define FFD_MESH_RESOURCE_RESOURCE_LIST_H

#include "base/fail.h"
#include "base/memory/intern.h"
#include <stdbool.h>
#include <stddef.h>

/* What kind of file may be copied. A mesh's file must not be able to bring anything else into the folder of
   the output. */
typedef struct resource_kind {
    const char *name; /* for messages: "image" */
    bool (*has_name)(const char *path);
    bool (*has_content)(const unsigned char *bytes, size_t size);
    const char *other_name, *other_content; /* why another file is not copied */
} resource_kind;

extern const resource_kind ffd_resource_image;

typedef struct mesh_resource {
    char *path; /* relative to the mesh's folder, normalized */
    const resource_kind *kind;
    size_t number; /* of what names it, in the order of the mesh's file */
} mesh_resource;

/* Zeroed: none. */
typedef struct resource_list {
    mesh_resource *resources;
    size_t count, capacity;
    intern_table known; /* the paths */
} resource_list;

/* Adds a file, unless it is there already. Takes ownership of the path, also after a failure. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_resources_add(resource_list *list, const resource_kind *kind, size_t number, char *path,
                             ffd_error *error);
/* Orders the files by their paths. */
void ffd_resources_sort(resource_list *list);
/* Frees the files; the list is empty then. */
void ffd_resources_free(resource_list *list);

#endif
