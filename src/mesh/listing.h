/* listing.h - the listing of the things in a document that `--only` can name, with what they draw. */
#ifndef FFD_MESH_LISTING_H
#define FFD_MESH_LISTING_H

#include "mesh/mesh.h"
#include "mesh/selector.h"

/* An entry: all nodes of a name with their descendants, all meshes or materials of a name, ... */
typedef struct mesh_thing {
    selector_kind kind;
    char *name;               /* owned; NULL: no name */
    size_t index;             /* if it has no name: index in its kind, from 0 */
    uint64_t vertices, faces; /* that it draws; each vertex counted once */
    ffd_bounds bounds;        /* of its finite vertices, in the space of the lattice */
} mesh_thing;

struct mesh_listing {
    mesh_thing *things; /* count */
    size_t count, capacity;
    double *xyz;    /* positions of the document in the space of the lattice */
    size_t *first;  /* index of the first vertex of each part */
    uint32_t *seen; /* for each vertex: 1 + the thing that drew it last */
};

/* Begins the listing of a document, which the caller frees also after a failure. Errors: FFD_E_MEMORY,
   FFD_E_LIMIT (memory budget). */
ffd_status ffd_listing_begin(const mesh_document *document, mesh_listing *listing, ffd_error *error);
/* Frees a listing and empties it. */
void ffd_listing_free(mesh_listing *listing);

/* Adds a thing, to which all following vertices and faces belong. An empty name counts as none. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_listing_add(mesh_listing *listing, selector_kind kind, const char *name, size_t size,
                           size_t index, ffd_error *error);
/* Adds vertices of a part to the last thing; duplicates are allowed. */
void ffd_listing_draw(mesh_listing *listing, size_t part, const uint32_t *vertices, size_t count);
/* Adds count faces to the last thing. */
void ffd_listing_draw_faces(mesh_listing *listing, size_t count);

#endif
