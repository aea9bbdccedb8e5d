/* ply_walk.h - the rows after a PLY header, value by value, in the order of the file.

   In ascii each row is a line of its own; empty lines are passed over, and lines end with LF, CRLF or CR,
   also mixed. An element without properties has no rows. */
#ifndef FFD_IO_PLY_PLY_WALK_H
#define FFD_IO_PLY_PLY_WALK_H

#include "io/ply/ply_header.h"

typedef struct ply_walk {
    const ply_header *header;
    const char *at, *last;
    size_t line; /* ascii: of at */
} ply_walk;

/* For an element: its rows, each begun and ended; in a row, the properties. The following return false
   where the file is not as the header says, which does not happen in one that ffd_ply_walk_check passed. */

/* Goes to the next row. */
bool ffd_ply_walk_row(ply_walk *walk);
/* Takes the next value: a scalar, a list's count or one of its items. False (and *word is
   empty): it is not there. */
bool ffd_ply_walk_value(ply_walk *walk, ply_type type, text_word *word);
/* Takes the next value as a list's count or an index. False: it is not one, and *word is what is there. */
bool ffd_ply_walk_count(ply_walk *walk, ply_type type, text_word *word, size_t *count);
/* Moves past a property, a list with all of its items. */
bool ffd_ply_walk_skip(ply_walk *walk, const ply_property *property);

/* Goes through all rows, refuses what is not as the header says, and sets where the rows of each element
   begin. *behind: the offset after the last row. */
ffd_status ffd_ply_walk_check(ply_header *header, const file_input *input, const char *name, size_t *behind,
                              ffd_error *error);

#endif
