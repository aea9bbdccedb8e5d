/* deform.h - what a batch takes over from ffd deform: its options, and single jobs by its words. */
#ifndef FFD_CLI_DEFORM_H
#define FFD_CLI_DEFORM_H

#include "cli/job.h"

/* Begins with what ffd check has too. */
typedef struct cli_deform_settings {
    cli_job job;
    const char *output; /* of the one IN; NULL where there may be many */
    const char *out_dir;
    const char *depfile_path;
    ffd_depfile *depfile; /* NULL: none is wanted */
    int resources;
    ffd_format output_format;
    bool force, if_changed, in_place;
    bool no_output; /* of a job of a batch: no mesh is written, only positions */
} cli_deform_settings;

/* The options of ffd deform alone; the others are cli_job_options. */
extern const cli_option cli_deform_options[];

/* The members of a worker_program (batch/worker.h). */
void *cli_deform_open(int count, char **words, bool has_output, ffd_deform_desc *desc, ffd_error *error);
/* Frees what cli_deform_open has returned. */
void cli_deform_close(void *opened);

#endif
