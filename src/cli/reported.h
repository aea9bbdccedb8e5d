/* reported.h - a job of a command with the report that is asked for. */
#ifndef FFD_CLI_REPORTED_H
#define FFD_CLI_REPORTED_H

#include <ffd/ffd.h>

/* The report that is asked for; path NULL: none. */
typedef struct cli_report {
    const char *path;
    bool stable; /* without seconds */
} cli_report;

/* Runs a job whose outputs are noted in files, and adds it to the report (NULL: none). Returns the exit code.
 */
typedef int cli_reported(void *context, ffd_output_set *files, ffd_report *report);

/* Runs the job and writes the report. Returns the exit code. */
int cli_run_reported(const cli_report *asked, cli_reported *run, void *context);

/* Returns what is wrong with the options of a report, beside the names of files; NULL: nothing. output: of
   the command. */
const char *cli_report_mistake(const cli_report *asked, const char *output);
/* Whether the report would replace a file; path may be NULL. */
bool cli_report_meets(const cli_report *asked, const char *path);

#endif
