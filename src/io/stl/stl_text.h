/* stl_text.h - reads the facets of an ascii STL file in order.

   The file is a sequence of words: lines and spacing do not matter, except that the name after solid and
   endsolid extends to the end of the line or to the words "facet normal". Keywords are case-insensitive.
   Three extensions of the format are accepted: "end solid" as two words, lines "color r g b" between facets,
   and a Ctrl-Z at the end. */
#ifndef FFD_IO_STL_STL_TEXT_H
#define FFD_IO_STL_STL_TEXT_H

#include "base/text/text_scan.h"
#include "mesh/flaws.h"

typedef struct stl_text {
    text_scan scan;
    size_t solids;     /* number of solids begun so far */
    text_word name;    /* of the current solid, without surrounding blanks */
    bool inside;       /* whether inside a solid */
    mesh_flaws *flaws; /* gets what is not in the format; NULL: it is not noted */
} stl_text;

typedef struct stl_facet {
    text_word normal[3];
    text_word corners[9]; /* x y z of the three corners */
    size_t line;          /* the line of its first word */
} stl_facet;

typedef enum stl_event { STL_AT_END, STL_AT_SOLID, STL_AT_FACET } stl_event;

/* Begins reading an ascii file. flaws: gets the flaws of the solids, or NULL. */
void ffd_stl_text_begin(stl_text *text, const void *data, size_t size, mesh_flaws *flaws);
/* Moves to the next facet, which it reads, or to the beginning of the next solid. Refuses anything else; name
   is for the message. */
ffd_status ffd_stl_text_step(stl_text *text, const char *name, stl_facet *facet, stl_event *event,
                             ffd_error *error);
/* Moves to the next facet. *found is false at the end of the file. */
ffd_status ffd_stl_text_next(stl_text *text, const char *name, stl_facet *facet, bool *found,
                             ffd_error *error);

/* Reads a number of a normal. Many programs write "-1.#IND" or the like where a facet has no normal: that
   reads as NaN. Returns false for any other word. */
bool ffd_stl_text_normal(text_word word, double *value);

#endif
