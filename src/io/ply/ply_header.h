/* ply_header.h - the header of a PLY file, and what it says about the rest.

   Header lines end as the first one does: with LF, CRLF or CR. In a binary file data starts right after the
   line end of "end_header", so that a file of CR lines may go on with a byte that is an LF. A byte order mark
   before the header is passed over. */
#ifndef FFD_IO_PLY_PLY_HEADER_H
#define FFD_IO_PLY_PLY_HEADER_H

#include "base/file/input.h"
#include "io/ply/ply_value.h"
#include <stdint.h>

/* Elements, and properties of all elements together, that a header may have. */
#define PLY_DECLARATIONS_MAX 4096

/* What a property of the vertices is: x y z, nx ny nz, and of Gaussian splats rot_0 to rot_3, scale_0 to
   scale_2, f_rest_0 and so on. */
enum {
    PLY_NORMAL_SLOT = 3,
    PLY_ROTATION_SLOT = 6,
    PLY_SCALE_SLOT = 10,
    PLY_REST_SLOT = 13,
    PLY_RESTS = 45,
    PLY_SLOT_COUNT = PLY_REST_SLOT + PLY_RESTS,
    PLY_NO_SLOT = PLY_SLOT_COUNT
};

typedef struct ply_property {
    text_word name;
    size_t line;
    bool is_list;
    ply_type count_type; /* of lists */
    ply_type type;       /* of the value, or of a list's items */
    unsigned char slot;
} ply_property;

typedef struct ply_element {
    text_word name;
    size_t line;
    uint64_t count;
    const ply_property *properties; /* property_count */
    size_t property_count;
    bool has_lists;
    size_t least; /* bytes of a row at least (ascii: with its line end); binary without lists: exactly */
    size_t begin, begin_line; /* offset and (ascii) line where its rows begin; ffd_ply_walk_check sets them */
} ply_element;

typedef struct ply_header {
    ply_encoding encoding;
    ply_element *elements;
    size_t element_count, element_capacity;
    ply_property *properties; /* of all elements, in their order */
    size_t property_count, property_capacity;
    /* Lines that say more than a comment does: obj_info, and "comment TextureFile NAME". */
    text_word *notes;
    size_t note_count, note_capacity;
    const char *line_end; /* "LF", "CRLF", "CR" */
    size_t body;          /* offset after the header */
    size_t body_line;     /* the first line after it */
    size_t end;           /* offset where the rows must end: that of the file's end, or of its Ctrl-Z */
} ply_header;

/* Reads the header and checks that the counts fit the file's size. name is for messages. header must be freed
   in every case; its words are in input. */
ffd_status ffd_ply_header_read(const file_input *input, const char *name, ply_header *header,
                               ffd_error *error);
/* Frees the elements and properties. */
void ffd_ply_header_free(ply_header *header);

/* The element of this name; NULL if there is none. */
const ply_element *ffd_ply_find_element(const ply_header *header, const char *name);
/* The property of this name; NULL if there is none. */
const ply_property *ffd_ply_find_property(const ply_element *element, const char *name);

#endif
