/* info_text.h - the JSON of `ffd info` as text for people. */
#ifndef FFD_JOB_INFO_TEXT_H
#define FFD_JOB_INFO_TEXT_H

#include "base/fail.h"
#include <stddef.h>

/* Renders a JSON object (size bytes) as aligned lines: a member a line, the members of an inner object
   indented below its name, "format" and "version" left out. *text is freed with ffd_text_free. */
ffd_status ffd_info_render(const char *json, size_t size, char **text, ffd_error *error);

#endif
