/* command.h - what a command is, and what all commands do alike. */
#ifndef FFD_CLI_COMMAND_H
#define FFD_CLI_COMMAND_H

#include "cli/options.h"
#include <ffd/ffd.h>

/* Exit codes that are not those of a status. */
enum { EXIT_DONE = 0, EXIT_NO = 1, EXIT_USAGE = 2 };

typedef struct cli_example {
    const char *what; /* it does, as "deform a mesh" */
    const char *line; /* of a shell, "ffd deform ..." */
} cli_example;

/* What there is to know of a command: help, the man page and the completions of shells are made from it. */
typedef struct cli_command {
    const char *name;     /* "lattice new" */
    const char *summary;  /* one line */
    const char *synopsis; /* lines of usage, each ended by a line break */
    cli_table options;
    /* Gets the arguments after the name. Returns the exit code. */
    int (*run)(const struct cli_command *command, int count, char **arguments);
    /* What the positional arguments are, in the words of options' values: "MESH". */
    const char *arguments;
    const cli_example *examples; /* ended by NULL; a test runs them, one after the other */
} cli_command;

/* The commands, each in the source of its name. */
extern const cli_command cli_batch, cli_deform, cli_check, cli_embed, cli_compare, cli_info, cli_lattice_new,
    cli_view, cli_jacobian, cli_report_merge;

/* Prints the help text of the command. */
void cli_print_help(const cli_command *command);

/* What is common to commands that log: filled by the options -q, -v. */
typedef struct cli_logging {
    bool quiet, verbose;
    /* The mesh that is being worked on, "-" for standard input; NULL: the lines name it themselves. */
    const char *subject;
} cli_logging;

/* An ffd_log_function whose user is a cli_logging. */
void cli_log(void *user, ffd_log_level level, const char *line);

/* The name of an input in messages. */
const char *cli_display_name(const char *path);

/* Whether the format of a mesh is known: as given, or by the name's ending. Else says what is missing. */
bool cli_knows_format(const char *path, ffd_format given);

/* Says what went wrong, returns its exit code. */
int cli_fail(const ffd_error *error);

/* "usage: ..." for a wrong number of words. */
int cli_usage(const cli_command *command, const char *why);

/* What a command does with its settings and words. Returns the exit code. */
typedef int cli_action(const cli_command *command, void *settings, const cli_words *words);

/* Runs a command: parses into settings and words, and lets the action do the rest. Returns the exit code: the
   action's, or that of a complaint or of help. */
int cli_run(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
            cli_action *action);

/* Parses into settings and words (to be freed by the caller). Returns 0 to go on, else with *exit_code to
   end: after a complaint, or help. */
bool cli_begin(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
               cli_words *words, int *exit_code);

#endif
