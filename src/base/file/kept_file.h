/* kept_file.h - the bytes of a file that was read for one purpose, kept for the next reader. */
#ifndef FFD_BASE_FILE_KEPT_FILE_H
#define FFD_BASE_FILE_KEPT_FILE_H

#include "base/file/input.h"

/* All zeros: empty. */
typedef struct kept_file {
    char *path; /* NULL: none */
    file_stamp stamp;
    file_input input;
} kept_file;

/* Takes over the input, which was loaded from path after the file had this stamp, if nothing is kept yet and
   the input is not mapped (to map it again is as fast). Else unloads it. */
void ffd_kept_put(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input);
/* Hands over the bytes of path, if they are those of a file with this stamp, and keeps nothing then. kept may
   be NULL. */
bool ffd_kept_take(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input);
/* Unloads what is kept. */
void ffd_kept_free(kept_file *kept);

#endif
