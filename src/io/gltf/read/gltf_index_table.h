/* gltf_index_table.h - the places where extensions refer to meshes and accessors by number. */
#ifndef FFD_IO_GLTF_READ_GLTF_INDEX_TABLE_H
#define FFD_IO_GLTF_READ_GLTF_INDEX_TABLE_H

#include "io/gltf/read/gltf_document.h"

/* What a value refers to. */
typedef enum gltf_index_kind {
    GLTF_INDEX_MESH,
    GLTF_INDEX_ACCESSOR,
    GLTF_INDEX_SHAPE,  /* an accessor of positions, normals or tangents */
    GLTF_INDEX_POINTER /* a JSON pointer that may lead into a mesh: "/meshes/3/weights/0" */
} gltf_index_kind;

/* A value of the file that is in the table. */
typedef struct gltf_index_place {
    gltf_index_kind kind;
    uint32_t value;
    /* The array element with this value, to be repeated for each copy of the mesh; JSON_NONE: none. */
    uint32_t repeats;
    size_t owner;     /* number of the node or mesh (see list) that holds the value; GLTF_NONE: none */
    const char *list; /* "nodes", "meshes" or another top-level list */
} gltf_index_place;

typedef void gltf_index_visit(void *context, const gltf_index_place *place);

/* Visits all values of the file that are in the table, in the order of its rows. */
void ffd_gltf_visit_indices(const gltf_document *document, gltf_index_visit *visit, void *context);

/* Visits the values of one mesh. */
void ffd_gltf_visit_mesh_indices(const gltf_document *document, size_t mesh, gltf_index_visit *visit,
                                 void *context);

/* Whether an accessor holds positions, normals or tangents of a primitive or morph target of the mesh. */
bool ffd_gltf_mesh_has_slot(const gltf_document *document, size_t mesh, size_t accessor);

/* Returns the number in a JSON pointer into an element of a top-level list: 3 in "/meshes/3/weights" for
   "meshes". GLTF_NONE: it points elsewhere. *rest is the text after the number: "/weights". */
size_t ffd_gltf_pointed(const char *pointer, const char *list, const char **rest);

#endif
