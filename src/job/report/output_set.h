/* output_set.h - the record of a run's outputs (public: ffd/job.h). */
#ifndef FFD_JOB_REPORT_OUTPUT_SET_H
#define FFD_JOB_REPORT_OUTPUT_SET_H

#include "base/file/written_files.h"
#include <ffd/job.h>

struct ffd_written {
    written_files files;
};

/* Returns the list for ffd_output_record. Accepts and returns NULL. */
static inline written_files *ffd_written_list(ffd_written *written)
{
    return written ? &written->files : NULL;
}

#endif
