/* ply_header.h - the header of a PLY file.

   All header lines end like the first one: with LF, CRLF or CR. In a binary file the data starts right after
   the line end of "end_header", so that the first byte of data in a file with CR lines may be an LF. A byte
   order mark before the header is skipped. */
#ifndef FFD_IO_PLY_PLY_HEADER_H
#define FFD_IO_PLY_PLY_HEADER_H

#include "base/file/input.h"
#include "io/ply/ply_value.h"
#include <stdint.h>

/* The maximum number of elements in a header, and of properties of all elements together. */
#define PLY_DECLARATIONS_MAX 4096

/* Slots of vertex properties: x y z, nx ny nz, and for Gaussian splats rot_0 to rot_3, scale_0 to scale_2,
   f_rest_0 and so on. */
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
    number_type count_type; /* type of a list's count */
    number_type type;       /* of the value, or of a list's items */
    unsigned char slot;
} ply_property;

typedef struct ply_element {
    text_word name;
    size_t line;
    uint64_t count;
    const ply_property *properties; /* property_count */
    size_t property_count;
    bool has_lists;
    size_t least; /* minimum bytes of a row (ascii: with its line end); exact for binary rows without lists */
    size_t begin, begin_line; /* offset and (ascii) line of its first row; set by ffd_ply_walk_check */
} ply_element;

typedef struct ply_header {
    ply_encoding encoding;
    ply_element *elements;
    size_t element_count, element_capacity;
    ply_property *properties; /* of all elements, in order */
    size_t property_count, property_capacity;
    /* Lines with a meaning beyond a comment: obj_info, and "comment TextureFile NAME". */
    text_word *notes;
    size_t note_count, note_capacity;
    const char *line_end; /* "LF", "CRLF", "CR" */
    size_t body;          /* offset of the data */
    size_t body_line;     /* number of its first line */
    size_t end;           /* offset of the end of the rows: the file's end or its Ctrl-Z */
} ply_header;

/* Reads the header and checks that the counts fit the file's size. name is for messages. Free the header with
   ffd_ply_header_free, after an error too; its words point into input. */
ffd_status ffd_ply_header_read(const file_input *input, const char *name, ply_header *header,
                               ffd_error *error);
/* Frees the arrays of the header. */
void ffd_ply_header_free(ply_header *header);

/* Returns the element of this name; NULL if there is none. */
const ply_element *ffd_ply_find_element(const ply_header *header, const char *name);
/* Returns the property of this name; NULL if there is none. */
const ply_property *ffd_ply_find_property(const ply_element *element, const char *name);

#endif
