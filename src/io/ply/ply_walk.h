/* ply_walk.h - a walk over the rows of a PLY file, value by value, in the order of the file.

   In ascii each row is a line; empty lines are skipped, and line ends may be any mixture of LF, CRLF and CR.
   An element without properties has no rows. */
#ifndef FFD_IO_PLY_PLY_WALK_H
#define FFD_IO_PLY_PLY_WALK_H

#include "io/ply/ply_header.h"

typedef struct ply_walk {
    const ply_header *header;
    const char *at, *last;
    size_t line; /* ascii: the line of at */
} ply_walk;

/* Call ffd_ply_walk_row before each row of an element, then one function per property of the row. All return
   false if the file does not match its header, which cannot happen after ffd_ply_walk_check has passed. */

/* Moves to the next row. */
bool ffd_ply_walk_row(ply_walk *walk);
/* Takes the next value: a scalar, a list's count or an item of a list. Returns false, with an empty *word, if
   there is none. */
bool ffd_ply_walk_value(ply_walk *walk, number_type type, text_word *word);
/* Takes the next value as a list's count or an index. Returns false if it is not one; *word is then the
   value. */
bool ffd_ply_walk_count(ply_walk *walk, number_type type, text_word *word, size_t *count);
/* Takes the count of a list. Returns false, with a count of 0, if there is none, or if the rest of the file
   cannot hold as many items: another program has changed it. *word is the value. */
bool ffd_ply_walk_list(ply_walk *walk, const ply_property *list, text_word *word, size_t *count);
/* Moves past a property: one value, or a list with all its items. */
bool ffd_ply_walk_skip(ply_walk *walk, const ply_property *property);

/* Visits all rows, refuses a file that does not match its header, and sets where the rows of each element
   begin. *behind becomes the offset after the last row. */
ffd_status ffd_ply_walk_check(ply_header *header, const file_input *input, const char *name, size_t *behind,
                              ffd_error *error);

#endif
