/* replace.h - which existing files a run may replace beside a job's output. */
#ifndef FFD_JOB_REPORT_REPLACE_H
#define FFD_JOB_REPORT_REPLACE_H

#include "base/file/input.h"

/* Refuses (FFD_E_EXISTS) to replace a file that is not empty and not of the same kind. is_own: tests for that
   kind, which `kind` names in the message. Streams are always allowed. Errors also: those of reading the
   file. */
ffd_status ffd_replace_check(const char *path, bool (*is_own)(const file_input *old), const char *kind,
                             ffd_error *error);

#endif
