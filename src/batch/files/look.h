/* look.h - what a worker finds when it looks at the files of a job before it works, as text that is sent to
   the first process. */
#ifndef FFD_BATCH_FILES_LOOK_H
#define FFD_BATCH_FILES_LOOK_H

#include "base/file/path_list.h"
#include "base/text/buffer.h"

typedef enum look_kind {
    LOOK_NAMED = 'n',   /* a file that the mesh names */
    LOOK_COPY = 'c',    /* one that may be copied with the output */
    LOOK_LATTICE = 'l', /* a lattice of the job */
    LOOK_BOX = 'b',     /* a file of a mesh that the box of the last such lattice goes round */
    LOOK_FOLDER = 'f',  /* the folder of the output, whose models were looked through */
    LOOK_MODEL = 'm',   /* a model there */
    LOOK_BUFFER = 'u'   /* a file that the last such model names */
} look_kind;

/* Adds a path. */
void ffd_look_add(byte_buffer *text, look_kind kind, const char *path);
/* Adds all paths of a list. */
void ffd_look_add_all(byte_buffer *text, look_kind kind, const path_list *paths);
/* Returns the path of the entry at an offset, which is moved behind it; NULL: the end. */
const char *ffd_look_next(const byte_buffer *text, size_t *at, look_kind *kind);

#endif
