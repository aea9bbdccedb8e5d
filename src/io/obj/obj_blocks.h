/* obj_blocks.h - an OBJ file cut into blocks of whole statements, which threads scan in parallel. */
#ifndef FFD_IO_OBJ_OBJ_BLOCKS_H
#define FFD_IO_OBJ_OBJ_BLOCKS_H

#include "base/fail.h"
#include "base/file/input.h"
#include <stdbool.h>
#include <stddef.h>

/* A block, and what is before it in the file. Whoever cuts the file fills in first and last only. */
typedef struct obj_block {
    const char *first, *last;
    size_t line; /* of its first character, from 1 */
    size_t vertices, texcoords, normals, faces;
    bool plain;          /* see obj_scan */
    bool names_groups;   /* has a `g` or `o` */
    bool names_elements; /* has a statement that may name elements by their numbers */
} obj_block;

typedef struct obj_blocks {
    obj_block *list; /* at least one */
    size_t count;
    size_t vertices, normals; /* an estimate from how each block begins */
} obj_blocks;

/* Cuts the input from `first` on, after its byte order mark, up to its text's end (ffd_text_size), at line
   ends that nothing continues: at the first one from each multiple of `target` bytes on. Errors:
   FFD_E_MEMORY; *blocks is then empty. */
ffd_status ffd_obj_blocks_cut(const file_input *input, const char *first, size_t target, obj_blocks *blocks,
                              ffd_error *error);
/* Frees the list of blocks. */
void ffd_obj_blocks_free(obj_blocks *blocks);

#endif
