/* deform.h - the parts of ffd deform that a batch uses: its options, and single jobs from words. */
#ifndef FFD_CLI_DEFORM_H
#define FFD_CLI_DEFORM_H

#include "cli/job.h"

/* Begins with the settings that ffd check has too. */
typedef struct cli_deform_settings {
    cli_job job;
    const char *output; /* OUT for a single IN; NULL with several IN */
    const char *out_dir;
    const char *depfile_path;
    ffd_depfile *depfile;      /* NULL: not wanted */
    const char *output_ending; /* as it was given; NULL: none */
    bool no_output;            /* job of a batch: write no mesh, only positions */
} cli_deform_settings;

/* The options that only ffd deform has; cli_job_options are the others. */
extern const cli_option cli_deform_options[];

/* As worker_program.open (batch/worker.h). */
void *cli_deform_open(int count, char **words, bool has_output, ffd_deform_desc *desc, ffd_error *error);
/* Frees what cli_deform_open has returned. */
void cli_deform_close(void *opened);

#endif
