/* off_header.h - the beginning of an OFF file, and what it says about the rest.

   [ST][C][N]OFF, in any order of the letters; then the numbers of vertices, faces and edges, on the same line
   or on later ones. The keyword may be missing, as the format's manual allows, and the first number may
   follow it without a blank ("OFF8 6 0"), as in some collections; the number of edges, which nobody uses, may
   be missing too. */
#ifndef FFD_IO_OFF_OFF_HEADER_H
#define FFD_IO_OFF_OFF_HEADER_H

#include "base/file/input.h"
#include "io/text/text_scan.h"

/* Vertices that a file may have: corners of faces are 32 bits. */
#define OFF_VERTICES_MAX (UINT32_MAX - 1)

typedef struct off_header {
    text_word keyword; /* empty: there is none */
    bool has_texcoords, has_colours, has_normals;
    size_t vertices, faces;
    /* Each vertex and each face has a line of its own in nearly all files. One with fewer lines than that is
       read as a sequence of words in which only what follows a face's corners ends with the line; unless its
       first line is that of a vertex, for then it has lost its end. */
    bool free_layout;
    text_scan body; /* right after the header */
} off_header;

/* Reads the header and checks that the counts fit the file's size. name is for messages;
   the words are in input. */
ffd_status ffd_off_header_read(const file_input *input, const char *name, off_header *header,
                               ffd_error *error);

/* How many numbers of a vertex can change: x y z and the normal. */
static inline size_t off_header_numbers(const off_header *header)
{
    return header->has_normals ? 6 : 3;
}

/* The fewest words that may follow them: a colour, if the keyword has C, and u v. */
size_t ffd_off_header_rest_min(const off_header *header);
/* The most of these words. Without the free layout, up to 4 words of a colour may be there without C too. */
size_t ffd_off_header_rest_max(const off_header *header);

#endif
