/* kept_file.h - keeps the content of a file that was read for one purpose for the next reader. */
#ifndef FFD_BASE_FILE_KEPT_FILE_H
#define FFD_BASE_FILE_KEPT_FILE_H

#include "base/file/input.h"

/* All zeros: empty. */
typedef struct kept_file {
    char *path; /* NULL: none */
    file_stamp stamp;
    file_input input;
} kept_file;

/* Takes over an input that was loaded from path after the stamp was taken, if nothing is kept yet and the
   input is not mapped (mapping it again is as fast). Otherwise unloads it. */
void ffd_kept_put(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input);
/* Hands over the content of path if it is kept with the same stamp; kept is then empty. Returns whether it
   was. kept may be NULL. */
bool ffd_kept_take(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input);
/* Unloads the kept file. */
void ffd_kept_free(kept_file *kept);

#endif
