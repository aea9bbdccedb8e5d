/* obj_users.h - which elements of an OBJ file its faces, lines and points name by their numbers.

   Blocks are read together with their vectors. A block that counts back, or names more elements than were
   expected, is late: it is read again once all elements are known. */
#ifndef FFD_IO_OBJ_OBJ_USERS_H
#define FFD_IO_OBJ_OBJ_USERS_H

#include "io/obj/obj_document.h"
#include <stdatomic.h>

/* A corner's vertex and normal, from 0. */
typedef struct obj_vertex_normal {
    uint32_t vertex, normal;
} obj_vertex_normal;

/* The faces, lines and points of one block. */
typedef struct obj_block_users {
    size_t corners, lines, points; /* corners: of faces */
    size_t vertices, normals;      /* the greatest numbers that are named, from 1; 0: none */
    obj_vertex_normal *others;     /* corners of faces with a normal that is not their vertex' first */
    size_t other_count, other_capacity;
    size_t counts_back; /* offset after the last index of a normal that does; 0: none */
    bool is_late;       /* to be read again, as a whole */
    ffd_status status;
} obj_block_users;

/* The users of a file. */
typedef struct obj_users {
    obj_block_users *blocks; /* one a block */
    /* For each vertex the number, from 1, of a normal that is named together with it, whichever thread came
       first; 0: none so far. Nearly all vertices of most meshes have only one. NULL: normals are not wanted,
       or none yet. What a block has left here that turns out to be late is found there again, or refused. */
    _Atomic uint32_t *firsts;
    size_t first_count;
} obj_users;

/* Allocates for a document that has its blocks, where so many vertices and normals are expected. Errors:
   FFD_E_MEMORY. To be freed in any case. */
ffd_status ffd_obj_users_begin(const obj_document *document, size_t vertices, size_t normals,
                               obj_users *users, ffd_error *error);
/* Reads the current statement of a scan while elements are still being read, unless the block is late already
   or becomes late. Thread-safe for different blocks; the caller stores *block when the block ends. */
void ffd_obj_users_scan(const obj_document *document, const obj_users *users, obj_scan *scan,
                        obj_block_users *block);
/* Frees the users of one block. */
void ffd_obj_free_block_users(obj_block_users *block);
/* Reads the late blocks, now that the document has its elements, and refuses indices out of range. firsts are
   then those of all vertices, or NULL. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_obj_users_finish(const obj_document *document, obj_users *users, ffd_error *error);
/* Frees the users of a file. */
void ffd_obj_users_free(const obj_document *document, obj_users *users);

/* Returns that number of a vertex. */
static inline uint32_t ffd_obj_first_normal(const obj_users *users, size_t vertex)
{
    return atomic_load_explicit(&users->firsts[vertex], memory_order_relaxed);
}

#endif
