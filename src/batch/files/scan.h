/* scan.h - what a worker finds when it scans the files of a job before it works, as text that is sent to
   the first process. */
#ifndef FFD_BATCH_FILES_SCAN_H
#define FFD_BATCH_FILES_SCAN_H

#include "base/file/path_list.h"
#include "base/text/buffer.h"

typedef enum scan_kind {
    SCAN_NAMED = 'n',   /* a file that the mesh names */
    SCAN_COPY = 'c',    /* one that may be copied with the output */
    SCAN_LATTICE = 'l', /* a lattice of the job */
    SCAN_BOX = 'b',     /* a file of a mesh that the box of the last such lattice goes round */
    SCAN_FOLDER = 'f',  /* the folder of the output, whose models were scanned */
    SCAN_MODEL = 'm',   /* a model there */
    SCAN_BUFFER = 'u'   /* a file that the last such model names */
} scan_kind;

/* Adds a path. */
void ffd_scan_add(byte_buffer *text, scan_kind kind, const char *path);
/* Adds all paths of a list. */
void ffd_scan_add_all(byte_buffer *text, scan_kind kind, const path_list *paths);
/* Returns the path of the entry at an offset, which is moved behind it; NULL: the end. */
const char *ffd_scan_next(const byte_buffer *text, size_t *at, scan_kind *kind);

#endif
