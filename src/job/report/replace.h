/* replace.h - files beside a job's output that a later run writes again: what they may replace. */
#ifndef FFD_JOB_REPORT_REPLACE_H
#define FFD_JOB_REPORT_REPLACE_H

#include "base/file/input.h"

/* Refuses (FFD_E_EXISTS) the path of a file that is not empty and not of the own kind, which
   `kind` names in the message. Streams are free. Errors: those of reading it too. */
ffd_status ffd_replace_check(const char *path, bool (*is_own)(const file_input *old), const char *kind,
                             ffd_error *error);

#endif
