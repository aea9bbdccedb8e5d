/* main.c - the program ffd: finds the command and runs it. */
#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_command *const commands[] = {&cli_deform, &cli_embed, &cli_compare, &cli_info,
                                              &cli_lattice_new};
enum { COMMANDS = sizeof commands / sizeof *commands };

void cli_print_help(const cli_command *command)
{
    printf("%s\n\n%s\nOptions:\n", command->summary, command->synopsis);
    cli_print_options(command->options);
}

void cli_log(void *user, ffd_log_level level, const char *line)
{
    const cli_talk *talk = user;
    if (talk->quiet || (level != FFD_LOG_WARNING && !talk->verbose))
        return;
    if (talk->subject)
        cli_complain("%s: %s", talk->subject, line);
    else
        cli_complain("%s", line);
}

int cli_fail(const ffd_error *error)
{
    char line[2048];
    ffd_error_format(error, line, sizeof line);
    cli_complain("%s", line);
    return ffd_status_exit_code(error->status);
}

int cli_usage(const cli_command *command, const char *why)
{
    cli_complain("%s: %s (ffd %s --help shows how)", command->name, why, command->name);
    return EXIT_USAGE;
}

bool cli_begin(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
               cli_words *words, int *exit_code)
{
    words->words = calloc((size_t)count + 1, sizeof *words->words);
    if (!words->words) {
        cli_complain("out of memory");
        *exit_code = ffd_status_exit_code(FFD_E_MEMORY);
        return false;
    }
    if (!cli_parse(command->options, settings, count, arguments, words)) {
        *exit_code = EXIT_USAGE;
    } else if (*help) {
        cli_print_help(command);
        *exit_code = EXIT_DONE;
    } else {
        return true;
    }
    free(words->words);
    words->words = NULL;
    return false;
}

static void print_overview(void)
{
    printf("ffd %s - free-form deformation of meshes with B-spline lattices\n\nCommands:\n", ffd_version());
    for (int i = 0; i < COMMANDS; i++)
        printf("  ffd %-12s  %s\n", commands[i]->name, commands[i]->summary);
    printf("  ffd %-12s  %s\n  ffd %-12s  %s\n\nffd help COMMAND and ffd COMMAND --help tell more.\n", "help",
           "what there is, or one command", "--version", "the version");
}

/* The number of words of a command's name that the arguments begin with, or 0. */
static int name_words(const cli_command *command, int count, char **arguments)
{
    const char *space = strchr(command->name, ' ');
    const size_t first = space ? (size_t)(space - command->name) : strlen(command->name);
    if (count < 1 || strlen(arguments[0]) != first || memcmp(arguments[0], command->name, first) != 0)
        return 0;
    if (!space)
        return 1;
    return count > 1 && strcmp(arguments[1], space + 1) == 0 ? 2 : 0;
}

static const cli_command *find_command(int count, char **arguments, int *words)
{
    for (int i = 0; i < COMMANDS; i++) {
        *words = name_words(commands[i], count, arguments);
        if (*words)
            return commands[i];
    }
    return NULL;
}

static int unknown_command(int count, char **arguments)
{
    const bool lattice = strcmp(arguments[0], "lattice") == 0;
    if (lattice && count > 1)
        cli_complain("unknown command \"lattice %s\" (known: lattice new)", arguments[1]);
    else if (lattice)
        cli_complain("lattice: which? (known: lattice new)");
    else
        cli_complain("unknown command \"%s\" (known: deform, embed, compare, info, lattice new, help)",
                     arguments[0]);
    return EXIT_USAGE;
}

static int run(int count, char **arguments)
{
    int words = 0;
    if (count == 0) {
        cli_complain("no command (ffd help shows what there is)");
        return EXIT_USAGE;
    }
    if (strcmp(arguments[0], "--version") == 0) {
        printf("ffd %s\n", ffd_version());
        return EXIT_DONE;
    }
    const bool help = strcmp(arguments[0], "help") == 0;
    if (strcmp(arguments[0], "--help") == 0 || strcmp(arguments[0], "-h") == 0 || (help && count == 1)) {
        print_overview();
        return EXIT_DONE;
    }
    if (help) {
        const cli_command *command = find_command(count - 1, arguments + 1, &words);
        if (!command || words != count - 1)
            return unknown_command(count - 1, arguments + 1);
        cli_print_help(command);
        return EXIT_DONE;
    }
    const cli_command *command = find_command(count, arguments, &words);
    return command ? command->run(command, count - words, arguments + words)
                   : unknown_command(count, arguments);
}

int main(int argc, char **argv)
{
    int code = run(argc - 1, argv + 1);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        cli_complain("standard output: cannot be written");
        if (code == EXIT_DONE)
            code = ffd_status_exit_code(FFD_E_IO);
    }
    return code;
}
