/* gltf_index_table.h - where extensions name meshes and accessors by their numbers. */
#ifndef FFD_IO_GLTF_REFER_GLTF_INDEX_TABLE_H
#define FFD_IO_GLTF_REFER_GLTF_INDEX_TABLE_H

#include "io/gltf/document/gltf_document.h"

/* What a value is. */
typedef enum gltf_index_kind {
    GLTF_INDEX_MESH,
    GLTF_INDEX_ACCESSOR,
    GLTF_INDEX_SHAPE,  /* an accessor of positions, normals or tangents */
    GLTF_INDEX_POINTER /* a JSON pointer that may lead into a mesh: "/meshes/3/weights/0" */
} gltf_index_kind;

/* A value of the file that the table knows. */
typedef struct gltf_index_place {
    gltf_index_kind kind;
    uint32_t value;
    uint32_t repeats; /* the element of an array that holds it and that a copied mesh gets another of;
                         JSON_NONE: there is none */
    size_t owner;     /* the node or mesh that holds it, by what `list` says; GLTF_NONE: none */
    const char *list; /* "nodes", "meshes" or another list at the top of the JSON */
} gltf_index_place;

typedef void gltf_index_visit(void *context, const gltf_index_place *place);

/* Visits all these values of a file, in the order of the table's rows. */
void ffd_gltf_visit_indices(const gltf_document *document, gltf_index_visit *visit, void *context);

/* Visits those of one mesh. */
void ffd_gltf_visit_mesh_indices(const gltf_document *document, size_t mesh, gltf_index_visit *visit,
                                 void *context);

/* Whether an accessor holds positions, normals or tangents of one of the mesh's primitives or morph targets.
 */
bool ffd_gltf_mesh_has_slot(const gltf_document *document, size_t mesh, size_t accessor);

/* Returns the number in a JSON pointer to an element of a list at the top, or below it: 3 in
   "/meshes/3/weights" for "meshes". GLTF_NONE: it leads elsewhere. *rest is what follows the number:
   "/weights". */
size_t ffd_gltf_pointed(const char *pointer, const char *list, const char **rest);

#endif
