/* stand_in.h - recognizes what stands in a text file's place because the file was not fetched. */
#ifndef FFD_BASE_TEXT_STAND_IN_H
#define FFD_BASE_TEXT_STAND_IN_H

#include <stddef.h>

#define STAND_IN_LFS "a Git LFS pointer: the file itself is not there"
#define STAND_IN_ANNEX "a git-annex pointer: the file itself is not there"
#define STAND_IN_HTML "an HTML page"

/* Returns one of these, by the first words; NULL: the text is neither. */
const char *ffd_stand_in(const void *data, size_t size);

#endif
