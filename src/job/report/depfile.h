/* depfile.h - the rules of a depfile (public: ffd/job.h). */
#ifndef FFD_JOB_REPORT_DEPFILE_H
#define FFD_JOB_REPORT_DEPFILE_H

#include "base/file/path_list.h"
#include "base/text/buffer.h"
#include <ffd/job.h>

/* Appends the rule "OUT OUT ...: INPUT INPUT ..." to rules, each input once. Errors: FFD_E_IO for a name with
   a line break, which a depfile cannot hold. */
ffd_status ffd_depfile_rule(const path_list *outputs, const path_list *inputs, byte_buffer *rules,
                            ffd_error *error);
/* Whether a name contains a character that make or ninja cannot read in a depfile, however it is escaped. */
bool ffd_depfile_troubles(const char *name);
/* Adds complete rules. Lack of memory is reported later, by ffd_depfile_write. */
void ffd_depfile_add(ffd_depfile *depfile, const byte_buffer *rules);
/* Adds rules of outputs that are not in place yet, and writes all rules, so that no output is placed whose
   rule does not fit on the disk; to a stream they are written at the end. If this fails, or the outputs
   cannot be placed, the rules are to be withdrawn. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_depfile_offer(ffd_depfile *depfile, const byte_buffer *rules, ffd_error *error);
/* Removes the rules that were offered last. */
void ffd_depfile_withdraw(ffd_depfile *depfile, const byte_buffer *rules);

#endif
