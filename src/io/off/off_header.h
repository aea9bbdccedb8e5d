/* off_header.h - the header of an OFF file.

   [ST][C][N]OFF, with the letters in any order; then the numbers of vertices, faces and edges, on the same
   line or on later ones. The keyword may be missing, as the format's manual allows, and the first number may
   follow it without a blank ("OFF8 6 0"), as in some collections. The number of edges, which nobody uses, may
   be missing too. */
#ifndef FFD_IO_OFF_OFF_HEADER_H
#define FFD_IO_OFF_OFF_HEADER_H

#include "base/file/input.h"
#include "base/text/text_scan.h"

/* The maximum number of vertices: corners of faces are 32-bit numbers. */
#define OFF_VERTICES_MAX (UINT32_MAX - 1)

typedef struct off_header {
    text_word keyword; /* empty: none */
    bool has_texcoords, has_colours, has_normals;
    size_t vertices, faces;
    /* In nearly all files each vertex and each face has a line of its own. A file with fewer lines is read as
       a sequence of words, where a line end matters only after a face's corners: it ends the rest of the
       face. But if its first line looks like a vertex, the file has lost its end instead. */
    bool free_layout;
    text_scan body; /* starts right after the header */
} off_header;

/* Reads the header and checks that the counts fit the file's size. name is for messages. The words of header
   point into input. */
ffd_status ffd_off_header_read(const file_input *input, const char *name, off_header *header,
                               ffd_error *error);

/* Returns how many numbers of a vertex can change: x y z and the normal. */
static inline size_t off_vertex_width(const off_header *header)
{
    return header->has_normals ? 6 : 3;
}

/* Returns the minimum number of words after them: a colour if the keyword has C, and u v. */
size_t ffd_off_header_rest_min(const off_header *header);
/* Returns the maximum number. Without the free layout, a colour of up to 4 words is allowed even without
   C. */
size_t ffd_off_header_rest_max(const off_header *header);

#endif
