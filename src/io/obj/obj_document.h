/* obj_document.h - an OBJ file as a mesh document: one part, in the lattice's space.

   Every `v` is a vertex, in the order of the file. The normals of a vertex are the distinct `vn` that face
   corners name together with it. Coordinates are held as numbers; all else stays in the file's bytes, which
   are scanned again where it is needed (saving, faces, comparison). obj_results.c has what a deformation
   changes. */
#ifndef FFD_IO_OBJ_OBJ_DOCUMENT_H
#define FFD_IO_OBJ_OBJ_DOCUMENT_H

#include "base/file/spill.h"
#include "io/obj/obj_blocks.h"
#include "io/obj/obj_corner.h"
#include "io/text/file_document.h"
#include "mesh/linked_files.h"
#include "mesh/selector.h"

/* A walk is a scan that knows which element each statement is, so that indices can be looked up. */

/* Elements of one kind: in the whole file, and up to the current statement (which is the last of them where
   it is one itself); seen <= total. Positive indices count in the former, negative ones in the latter. */
typedef struct obj_count {
    size_t total, seen;
} obj_count;

/* The caller sets the totals. */
typedef struct obj_walk {
    obj_scan scan;
    obj_count vertices, texcoords, normals, faces;
} obj_walk;

/* Goes to the next statement and counts it. False at the end of the file, and at an element that is more than
   the total: the file was changed after they were counted. */
bool ffd_obj_walk_next(obj_walk *walk);

/* The element, from 0, that an index names. Returns false if there is none. */
bool ffd_obj_find(int64_t index, obj_count count, size_t *element);

/* A corner of a face with the elements it names, from 0. */
typedef struct obj_face_corner {
    size_t vertex, normal;
    bool has_normal;
    text_word normal_text; /* the index as written */
} obj_face_corner;

/* Takes the next corner of the current face in a file whose faces are known to be valid. Returns false
   if there is none left. The vertices of free-form geometry are not known to be: at one that is not there it
   returns false too. */
bool ffd_obj_walk_corner(obj_walk *walk, obj_face_corner *corner);

/* Whether the current statement is free-form geometry with control vertices; passes the numbers before
   these. */
bool ffd_obj_walk_freeform(obj_walk *walk);

/* Whether the current statement uses vertices, which ffd_obj_walk_corner takes: a face, line or point, or
   free-form geometry. */
static inline bool ffd_obj_walk_uses(obj_walk *walk)
{
    const obj_keyword keyword = walk->scan.keyword;
    return keyword == OBJ_FACE || keyword == OBJ_LINE || keyword == OBJ_POINT ||
           (keyword == OBJ_OTHER && ffd_obj_walk_freeform(walk));
}

/* Vertices and `vn` that a file may have: their numbers, and one value for none, are 32 bits. */
#define OBJ_ELEMENTS_MAX (UINT32_MAX - 1)
#define OBJ_NONE UINT32_MAX

/* Bytes of a position or direction. */
#define OBJ_VECTOR (3 * sizeof(double))

/* Statements that are not known. */
typedef struct obj_unknown {
    size_t count, line; /* line: of the first one */
    text_word name;     /* of the first one */
} obj_unknown;

typedef struct obj_document {
    /* positions: of each `v`; directions: of each `vn`, NULL: not held; new_directions: of each pair. Results
       may be where what was read was (mesh_results.replace). */
    file_document file;
    size_t vertices, texcoords, normals;                       /* `v`, `vt`, `vn` */
    size_t faces, corners, lines, points;                      /* statements; corners of faces */
    spill_array position_store, direction_store, result_store; /* what positions, directions and new_positions
                                                                  point to */
    bool only_positions; /* normals are checked but not held, and the part has none */
    /* A pair is a vertex with one of its normals: pairs pair_start[i] .. pair_start[i+1]-1 are those of
       vertex i, with the `vn` pair_normal[.] (from 0) ascending. NULL where no face corner names a normal. */
    uint32_t *pair_start, *pair_normal;
    /* Where `vn` can be added so that every index keeps its meaning: an offset into the file. */
    size_t addition;
    size_t end;         /* offset where the text ends: at a Ctrl-Z, or with the file */
    size_t joined_line; /* the first that a backslash joins to a statement of its own; 0: none */
    obj_unknown unknown;
    bool names_files;  /* there is a statement that ffd_obj_names_file knows */
    obj_blocks blocks; /* of the file */
    int threads;
    /* What ffd_obj_select selected: a byte for each vertex, face and pair; and one for each `vn`, set if a
       face that is not selected uses it, so that it must stay. NULL: all is selected. */
    uint8_t *selected_vertices, *selected_faces, *selected_pairs, *held_normals;
    /* For each vertex and each pair, a bit for each coordinate whose bits have changed. */
    uint8_t *position_changes, *direction_changes;
} obj_document;

static inline const obj_document *ffd_obj_of(const mesh_document *document)
{
    return (const obj_document *)document;
}

/* A walk over the document's file, totals set. */
void ffd_obj_document_walk(const obj_document *document, obj_walk *walk);
/* The same from the first block on with a statement that may name elements: faces, lines, points, and what is
   not known. */
void ffd_obj_document_walk_users(const obj_document *document, obj_walk *walk);
/* The same over one block. */
void ffd_obj_document_walk_block(const obj_document *document, size_t block, obj_walk *walk);
/* Releases the pages of a block; they are read again when they are needed. */
void ffd_obj_forget_block(const obj_document *document, size_t block);
/* The entries of the format's table. */
mesh_open_function ffd_obj_open;
mesh_close_function ffd_obj_close;
mesh_list_files_function ffd_obj_list_linked;
mesh_select_function ffd_obj_select;
mesh_mark_function ffd_obj_mark;
mesh_list_things_function ffd_obj_list_parts;
mesh_mark_used_function ffd_obj_mark_used;
mesh_read_function ffd_obj_read;
mesh_begin_results_function ffd_obj_begin_results;
mesh_write_function ffd_obj_write;
mesh_save_function ffd_obj_save;
mesh_faces_function ffd_obj_faces;
mesh_mixed_faces_function ffd_obj_mixed_faces;
mesh_name_owner_function ffd_obj_name_part;
mesh_corner_normals_function ffd_obj_corner_normals;
mesh_model_function ffd_obj_model;
mesh_describe_function ffd_obj_describe;
mesh_compare_function ffd_obj_compare;

/* Frees the results of normals, if there are any: normals are kept. */
void ffd_obj_free_normals(obj_document *document);
/* Releases the pages of the positions and results of count vertices if they are in a memory-mapped file. */
void ffd_obj_forget_vectors(const obj_document *document, size_t first, size_t count);

#endif
