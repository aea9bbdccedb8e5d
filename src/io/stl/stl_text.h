/* stl_text.h - the facets of an ascii STL file, in its order.

   The file is a sequence of words, so that lines and spacing do not matter, but for the name after solid and
   endsolid: it reaches to the end of the line, or to the words "facet normal". Letters of keywords may be
   large or small.

   Three things are read that are not in the format: "end solid" in two words, lines "color r g b" between
   facets, and a Ctrl-Z at the end. */
#ifndef FFD_IO_STL_STL_TEXT_H
#define FFD_IO_STL_STL_TEXT_H

#include "io/text/text_scan.h"
#include "mesh/flaws.h"

typedef struct stl_text {
    text_scan scan;
    size_t solids;     /* begun so far */
    text_word name;    /* of the solid begun last, blanks round it left out */
    bool inside;       /* a solid */
    mesh_flaws *flaws; /* get what is not in the format; NULL: nothing is noted */
} stl_text;

typedef struct stl_facet {
    text_word normal[3];
    text_word corners[9]; /* x y z of the three corners */
    size_t line;          /* of its first word */
} stl_facet;

typedef enum stl_event { STL_AT_END, STL_AT_SOLID, STL_AT_FACET } stl_event;

/* Begins to read an ascii file. flaws: NULL, or what gets those of the solids. */
void ffd_stl_text_begin(stl_text *text, const void *data, size_t size, mesh_flaws *flaws);
/* Goes on by a facet, which it takes, or to the beginning of a solid. Refuses anything else;
   name is for the message. */
ffd_status ffd_stl_text_step(stl_text *text, const char *name, stl_facet *facet, stl_event *event,
                             ffd_error *error);
/* Goes on to the next facet. *found is false at the end of the file. */
ffd_status ffd_stl_text_next(stl_text *text, const char *name, stl_facet *facet, bool *found,
                             ffd_error *error);

/* A number of a normal. Many programs write "-1.#IND" and the like where a facet has none: NaN. Returns false
   if the word is anything else. */
bool ffd_stl_text_normal(text_word word, double *value);

#endif
