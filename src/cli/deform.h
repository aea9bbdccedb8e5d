/* deform.h - the options of ffd deform, which a batch has too. */
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
} cli_deform_settings;

/* The options that only ffd deform has; cli_job_options are the others. */
extern const cli_option cli_deform_options[];

#endif
