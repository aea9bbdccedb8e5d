/* written_text.h - text that is gathered and written in large pieces. */
#ifndef FFD_LATTICE_FORMATS_WRITTEN_TEXT_H
#define FFD_LATTICE_FORMATS_WRITTEN_TEXT_H

#include "base/file/output.h"
#include "base/text/buffer.h"

/* Writes what has gathered and empties the text, if it is 64 kB or more, or the last of the file. Errors:
   FFD_E_MEMORY if the text has failed, those of ffd_output_write. */
ffd_status ffd_text_written(byte_buffer *text, bool is_last, file_output *output, ffd_error *error);

#endif
