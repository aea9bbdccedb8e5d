#include "lattice/formats/written_text.h"

/* Bytes that are gathered. */
#define AT_ONCE 65536

ffd_status ffd_text_written(byte_buffer *text, bool is_last, file_output *output, ffd_error *error)
{
    if (text->failed)
        return ffd_fail_memory(error);
    if (text->size < AT_ONCE && !is_last)
        return FFD_OK;
    TRY(ffd_output_write(output, text->data, text->size, error));
    text->size = 0;
    return FFD_OK;
}
