/* lattice_text.h - makes lattices from the JSON of a rest volume and of moves. Includes come after
   cmocka.h. */
#ifndef FFD_TESTS_LATTICE_TEXT_H
#define FFD_TESTS_LATTICE_TEXT_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include "message.h"
#include <stdio.h>
#include <string.h>

/* rest: the members "size" to "rest". moves: the elements of "moves". */
static inline ffd_status parse(const char *rest, const char *moves, ffd_lattice **lattice, ffd_error *error)
{
    static char text[8192];
    snprintf(text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s,\"moves\":[%s]}", rest, moves);
    return ffd_lattice_parse(text, strlen(text), "t.json", lattice, error);
}

/* Fails the test if the text is refused. */
static inline ffd_lattice *make(const char *rest, const char *moves)
{
    ffd_lattice *lattice;
    ffd_error error;
    if (parse(rest, moves, &lattice, &error))
        fail_msg("%s\n%s", message_of(&error), moves);
    return lattice;
}

#endif
