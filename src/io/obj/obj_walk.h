/* obj_walk.h - a scan that knows which element each statement is, so that indices can be looked up. */
#ifndef FFD_IO_OBJ_OBJ_WALK_H
#define FFD_IO_OBJ_OBJ_WALK_H

#include "io/obj/obj_corner.h"

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
   if there is none left. */
bool ffd_obj_walk_corner(obj_walk *walk, obj_face_corner *corner);

#endif
