/* content.h - guesses the kind of a file that is not a mesh, or not of the format that its name says. */
#ifndef FFD_BASE_TEXT_CONTENT_H
#define FFD_BASE_TEXT_CONTENT_H

#include <ffd/error.h>
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

/* The name of the kind of any XML. */
#define CONTENT_XML "an XML file"

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

/* Whether a text is in UTF-16: by its mark, or by characters of ASCII at its start. */
bool ffd_content_is_utf16(const void *data, size_t size);
/* Adds to a message what the file seems to be, unless it says so. NULL: nothing is added. */
void ffd_content_mention(const content_kind *kind, ffd_error *error);

#endif
