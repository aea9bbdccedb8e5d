/* content.h - guesses the kind of a file that is not a mesh, or not of the format that its name says. */
#ifndef FFD_BASE_TEXT_CONTENT_H
#define FFD_BASE_TEXT_CONTENT_H

#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct content_kind {
    const char *name;  /* "a gzip file" */
    ffd_format format; /* FFD_FORMAT_AUTO: not a mesh format */
    bool is_binary;    /* whether no text begins like this */
    bool is_stand_in;  /* whether it stands in for a file that was not fetched */
} content_kind;

/* Guesses the kind from the first bytes. NULL: unknown. */
const content_kind *ffd_content_kind(const void *data, size_t size);

/* The same for bytes that may be numbers: NULL too where numbers may well begin like this. */
const content_kind *ffd_content_sure_kind(const void *data, size_t size);

#endif
