/* content.h - what a file seems to be that is not a mesh, or not one of the format that its name says. */
#ifndef FFD_IO_TEXT_CONTENT_H
#define FFD_IO_TEXT_CONTENT_H

#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct content_kind {
    const char *name;  /* "a gzip file" */
    ffd_format format; /* FFD_FORMAT_AUTO: none of ours */
    bool is_binary;    /* no text begins so */
} content_kind;

/* By the first bytes. NULL: they say nothing. */
const content_kind *ffd_content_kind(const void *data, size_t size);

#endif
