/* page_writer.h - the bytes of a page, in order. The first failure is kept: only the end needs a check. */
#ifndef FFD_VIEW_PAGE_WRITER_H
#define FFD_VIEW_PAGE_WRITER_H

#include "base/file/output.h"
#include "base/text/buffer.h"

typedef struct page_writer {
    file_output *output;
    ffd_error *error;
    ffd_status status;
    unsigned char *bytes; /* of a block, and their base64 */
    char *text;
} page_writer;

/* Elements of at most this many bytes. */
#define PAGE_ELEMENT 48

/* Gives the bytes of count elements from first on. */
typedef void (*page_fill)(const void *of, size_t first, size_t count, unsigned char *bytes);

/* Starts a page in the file begun last. Errors: FFD_E_MEMORY. */
ffd_status ffd_page_writer_begin(page_writer *w, file_output *output, ffd_error *error);
/* Writes bytes. */
void ffd_page_write(page_writer *w, const void *bytes, size_t size);
/* Writes what a buffer holds, and frees it. */
void ffd_page_write_buffer(page_writer *w, byte_buffer *buffer);
/* Writes a data block in base64, a script element with that id that no browser runs. */
void ffd_page_write_block(page_writer *w, const char *id, size_t count, size_t element, page_fill fill,
                          const void *of);
/* Frees; returns the first failure. */
ffd_status ffd_page_writer_end(page_writer *w);

#endif
