#include "view/page_writer.h"
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include <assert.h>
#include <string.h>

/* Elements per write. A multiple of three, so that runs of base64 can be concatenated without padding. */
#define RUN 3072

ffd_status ffd_page_writer_begin(page_writer *w, file_output *output, ffd_error *error)
{
    *w = (page_writer){.output = output, .error = error};
    w->bytes = ffd_alloc(RUN, PAGE_ELEMENT);
    w->text = ffd_alloc(ffd_base64_length(RUN * PAGE_ELEMENT), 1);
    if (!w->bytes || !w->text)
        w->status = ffd_fail_memory(error);
    return w->status;
}

void ffd_page_write(page_writer *w, const void *bytes, size_t size)
{
    if (!w->status)
        w->status = ffd_output_write(w->output, bytes, size, w->error);
}

void ffd_page_write_buffer(page_writer *w, byte_buffer *buffer)
{
    if (!w->status && buffer->failed)
        w->status = ffd_fail_memory(w->error);
    if (buffer->size)
        ffd_page_write(w, buffer->data, buffer->size);
    ffd_buffer_free(buffer);
}

void ffd_page_write_block(page_writer *w, const char *id, size_t count, size_t element, page_fill fill,
                          const void *of)
{
    byte_buffer head = {0};
    assert(element <= PAGE_ELEMENT);
    ffd_buffer_format(&head, "<script type=\"application/octet-stream\" id=\"%s\">", id);
    ffd_page_write_buffer(w, &head);
    for (size_t first = 0; first < count && !w->status; first += RUN) {
        const size_t run = count - first < RUN ? count - first : RUN;
        fill(of, first, run, w->bytes);
        ffd_base64_encode(w->bytes, run * element, w->text);
        ffd_page_write(w, w->text, ffd_base64_length(run * element));
    }
    static const char tail[] = "</script>\n";
    ffd_page_write(w, tail, sizeof tail - 1);
}

ffd_status ffd_page_writer_end(page_writer *w)
{
    ffd_free(w->bytes);
    ffd_free(w->text);
    w->bytes = NULL;
    w->text = NULL;
    return w->status;
}
