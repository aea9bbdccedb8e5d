/* job.h - what the commands that deform meshes share: deform and check. */
#ifndef FFD_CLI_JOB_H
#define FFD_CLI_JOB_H

#include "cli/command.h"
#include "cli/files.h"
#include "cli/member.h"

/* Set by cli_job_options. Each command's settings begin with it. */
typedef struct cli_job {
    ffd_deform_desc desc;          /* the options that are members; cli_job_describe adds the following */
    ffd_job_result *morph_results; /* of the last job, one for each of its lattices; or NULL */
    const char *report;
    bool stable, shares_box;
    size_t own_boxes;           /* jobs with a box round their own mesh */
    ffd_shared_box *shared_box; /* of all jobs, or NULL */
    ffd_output_set *output_set; /* files written so far */
    ffd_output_list *outputs;   /* of the last job, for the report; or NULL */
    ffd_job_cache *cache;       /* cache of several jobs, which all have the same lattices */
    ffd_error refusal;          /* why the library refuses the options */
    cli_logging logging;
    bool help;
} cli_job;

extern const cli_option cli_job_options[];

/* Options of ffd deform without effect on other commands. They are accepted, so that "deform" in a command
   line can be replaced by another command. */
typedef struct cli_kept {
    ffd_deform_desc desc;
    const char *depfile;
} cli_kept;

/* Entries for these options in a command's table. at: the offset of the cli_kept in its settings. */
#define CLI_KEPT_HELP "without effect: no mesh is written"
#define CLI_KEPT_OPTIONS(at)                                                                                 \
    {"in-place", 0, NULL, CLI_KEPT_HELP, cli_set_member, (at) + offsetof(cli_kept, desc), NULL},             \
        {"if-changed", 0, NULL, CLI_KEPT_HELP, cli_set_member, (at) + offsetof(cli_kept, desc), NULL},       \
        {"depfile", 0, "FILE", CLI_KEPT_HELP, cli_set_text, (at) + offsetof(cli_kept, depfile), NULL},       \
    {                                                                                                        \
        "resources", 0, "copy|reference|refresh", CLI_KEPT_HELP, cli_set_member,                             \
            (at) + offsetof(cli_kept, desc), NULL                                                            \
    }

/* Parses the arguments into job, the head of the command's settings, and words. Returns true to go on;
   cli_job_end must follow. Else *exit_code is set. */
bool cli_job_begin(const cli_command *command, cli_job *job, int count, char **arguments, cli_words *words,
                   int *exit_code);
/* Frees the words and the memory of options. */
void cli_job_end(cli_job *job, cli_words *words);
/* cli_run for commands with a job, the head of their settings: the action's settings are these. */
int cli_job_run(const cli_command *command, cli_job *job, int count, char **arguments, cli_action *action);

/* Whether some lattices make morph targets, and others none. */
bool cli_job_mixes_morphs(const cli_job *job);
/* Returns what is wrong with the options, or NULL. inputs: the number of words that are read; the others are
   written. */
const char *cli_job_mistake(cli_job *job, const cli_words *words, size_t inputs);
/* The same for commands that work without a lattice. */
const char *cli_job_option_mistake(cli_job *job, const cli_words *words, size_t inputs);

/* Whether the formats of all inputs are known. Complains if not. */
bool cli_job_knows_formats(const cli_job *job, const cli_words *words, size_t inputs);

/* Fills desc for one mesh, except for its output. */
void cli_job_describe(cli_job *job, const char *input, ffd_deform_desc *desc);

/* Complains if a job failed, and adds it to the report (NULL: none). Returns its exit code. */
int cli_job_ended(cli_job *job, const ffd_job_result *result, const char *input, const char *output,
                  ffd_report *report);

/* Runs the job for one mesh. Returns its exit code. */
typedef int (*cli_job_function)(cli_job *job, const char *input, ffd_report *report);

/* Runs the job for each input, and writes the report. Returns the exit code. */
int cli_job_run_all(cli_job *job, const cli_words *words, size_t inputs, cli_job_function one);

#endif
