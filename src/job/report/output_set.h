/* output_set.h - the record of a run's outputs, the names of a job's outputs (public: ffd/job.h), and which
   models share buffers with them. */
#ifndef FFD_JOB_REPORT_OUTPUT_SET_H
#define FFD_JOB_REPORT_OUTPUT_SET_H

#include "base/file/file_users.h"
#include "base/file/path_list.h"
#include "base/file/written_files.h"
#include <ffd/job.h>

/* All zeros: none. */
typedef struct known_users {
    file_users users;
    intern_table folders; /* places of the folders whose models are among the users */
    bool is_complete;     /* no folder needs to be read, and the files of no input are missing */
} known_users;

struct ffd_output_set {
    written_files files;
    known_users users;
    const struct copy_notes *notes; /* mesh/resource/copy_notes.h: of the run; NULL: those of the user */
};

struct ffd_output_list {
    path_list names;
};

/* Frees the users; leaves all zeros. */
void ffd_known_users_free(known_users *known);

/* Returns the list for ffd_output_record. Accepts and returns NULL. */
static inline written_files *ffd_output_set_list(ffd_output_set *output_set)
{
    return output_set ? &output_set->files : NULL;
}

#endif
