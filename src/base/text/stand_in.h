/* stand_in.h - recognizes what stands in a text file's place because the file was not fetched. */
#ifndef FFD_BASE_TEXT_STAND_IN_H
#define FFD_BASE_TEXT_STAND_IN_H

#include "base/fail.h"
#include <stddef.h>

#define STAND_IN_LFS "a Git LFS pointer: the file itself is not there"
#define STAND_IN_ANNEX "a git-annex pointer: the file itself is not there"
#define STAND_IN_HTML "an HTML page"

/* Returns one of these, by the first words; NULL: the text is neither. */
const char *ffd_stand_in(const void *data, size_t size);
/* Adds to the message of a text that is not valid (FFD_E_INVALID) what it seems to be. error may be NULL. */
void ffd_stand_in_describe(const void *data, size_t size, ffd_error *error);

#endif
