/* command.h - the description of a command, and code that all commands share. */
#ifndef FFD_CLI_COMMAND_H
#define FFD_CLI_COMMAND_H

#include "cli/options.h"
#include <ffd/ffd.h>

/* Exit codes that do not come from an ffd_status. */
enum { EXIT_DONE = 0, EXIT_NO = 1, EXIT_USAGE = 2 };

typedef struct cli_example {
    const char *what; /* what it does: "deform a mesh" */
    const char *line; /* shell command, "ffd deform ..." */
} cli_example;

/* Everything about a command. Help, man page and shell completions are made from it. */
typedef struct cli_command {
    const char *name;     /* "lattice new" */
    const char *summary;  /* one line */
    const char *synopsis; /* lines of usage, each with its line break */
    cli_table options;
    /* Runs the command. Gets the arguments behind its name. Returns the exit code. */
    int (*run)(const struct cli_command *command, int count, char **arguments);
    /* The kind of the positional arguments, in the words for options' values: "MESH". */
    const char *arguments;
    const cli_example *examples; /* terminated by NULL; a test runs them in order */
} cli_command;

/* The commands, each in the source file of its name. */
extern const cli_command cli_animate, cli_batch, cli_deform, cli_check, cli_embed, cli_compare, cli_fit,
    cli_edit, cli_info, cli_lattice_new, cli_lattice_convert, cli_lattice_refine, cli_lattice_set, cli_view,
    cli_jacobian, cli_report_merge, cli_report_junit;

/* Prints the help of a command to stdout. */
void cli_print_help(const cli_command *command);

/* Logging of a command, set by the options -q and -v. */
typedef struct cli_logging {
    bool quiet, verbose;
    /* The current mesh, "-" for standard input; NULL: lines name it themselves. */
    const char *subject;
} cli_logging;

/* An ffd_log_function whose user is a cli_logging. */
void cli_log(void *user, ffd_log_level level, const char *line);

/* Returns the name of an input for messages. */
const char *cli_display_name(const char *path);

/* Whether the format of a mesh is known: given, or by the ending of its name. Complains if not. */
bool cli_knows_format(const char *path, ffd_format given);

/* Prints an error. Returns its exit code. */
int cli_fail(const ffd_error *error);

/* Prints why the arguments are wrong, and the usage. Returns the exit code. */
int cli_usage(const cli_command *command, const char *why);
/* Checks that the words name at least one report, and standard input only once. Returns EXIT_DONE, or after a
   message EXIT_USAGE. */
int cli_check_reports(const cli_command *command, const cli_words *words);

/* Runs a command with its parsed settings and words. Returns the exit code. */
typedef int cli_action(const cli_command *command, void *settings, const cli_words *words);

/* Parses the arguments into settings and words, and runs the action. Returns its exit code, or that of a
   complaint or of help. */
int cli_run(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
            cli_action *action);

/* Parses the arguments into settings and words, which the caller frees. Returns true to go on; else the
   command must end with *exit_code, after a complaint or help. */
bool cli_begin(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
               cli_words *words, int *exit_code);

#endif
