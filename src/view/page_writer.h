/* page_writer.h - writes the bytes of a page in order. The first failure is kept and ends all writing, so
   only the end must be checked. */
#ifndef FFD_VIEW_PAGE_WRITER_H
#define FFD_VIEW_PAGE_WRITER_H

#include "base/file/output.h"
#include "base/text/buffer.h"

typedef struct page_writer {
    file_output *output;
    ffd_error *error;
    ffd_status status;
    unsigned char *bytes; /* buffers for a run of elements, and for its base64 */
    char *text;
} page_writer;

/* The largest size of an element in bytes. */
#define PAGE_ELEMENT 104

/* Fills bytes with the elements first to first + count - 1 of `of`. */
typedef void (*page_fill)(const void *of, size_t first, size_t count, unsigned char *bytes);

/* Begins a page in the file that output began last. Errors: FFD_E_MEMORY. */
ffd_status ffd_page_writer_begin(page_writer *w, file_output *output, ffd_error *error);
/* Writes bytes. */
void ffd_page_write(page_writer *w, const void *bytes, size_t size);
/* Writes a buffer's content, and frees the buffer. */
void ffd_page_write_buffer(page_writer *w, byte_buffer *buffer);
/* Writes a data block: base64 in a script element of that id, whose type no browser runs. element: bytes of
   each, at most PAGE_ELEMENT. */
void ffd_page_write_block(page_writer *w, const char *id, size_t count, size_t element, page_fill fill,
                          const void *of);
/* Frees the buffers. Returns the first failure. */
ffd_status ffd_page_writer_end(page_writer *w);

#endif
