/* main.c - the program ffd: finds the command and runs it. */
#include "cli/commands.h"
#include "cli/member.h"
#include <errno.h>
#include <ffd/program.h>
#include <stdio.h>
#include <string.h>

/* The most commands that are compared with an unknown one. */
#define MOST_COMMANDS 32

static void print_overview(void)
{
    printf("ffd %s - free-form deformation of meshes with B-spline lattices\n\nCommands:\n", ffd_version());
    for (int i = 0; cli_commands[i]; i++)
        printf("  ffd %-12s  %s\n", cli_commands[i]->name, cli_commands[i]->summary);
    printf("  ffd %-12s  %s\n  ffd %-12s  %s\n\nffd help COMMAND and ffd COMMAND --help show more.\n", "help",
           "list the commands, or show the help of one", "--version", "the version");
}

/* Returns the number of words of a command's name, if the arguments begin with it; else 0. */
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
    for (int i = 0; cli_commands[i]; i++) {
        *words = name_words(cli_commands[i], count, arguments);
        if (*words)
            return cli_commands[i];
    }
    return NULL;
}

/* Returns the next command of a group such as "report" from number *next on; NULL: there is none. */
static const cli_command *next_of_group(const char *group, int *next)
{
    const size_t length = strlen(group);
    for (; length && cli_commands[*next]; ++*next)
        if (strncmp(cli_commands[*next]->name, group, length) == 0 &&
            cli_commands[*next]->name[length] == ' ')
            return cli_commands[(*next)++];
    return NULL;
}

static const char *first_of_group(const char *group)
{
    int next = 0;
    return next_of_group(group, &next)->name;
}

static bool is_group(const char *word)
{
    int next = 0;
    return next_of_group(word, &next) != NULL;
}

static void print_help_of_group(const char *group)
{
    int next = 0;
    for (const cli_command *command; (command = next_of_group(group, &next)) != NULL;)
        cli_print_help(command);
}

/* Returns the command that a word probably means; NULL: none. A command of two words is compared by its first
   one. */
static const char *command_meant(const char *typed)
{
    char firsts[MOST_COMMANDS][32];
    const char *known[MOST_COMMANDS];
    size_t count = 0, found = 0;
    for (; cli_commands[count] && count + 1 < MOST_COMMANDS; count++) {
        const char *const name = cli_commands[count]->name;
        snprintf(firsts[count], sizeof firsts[count], "%.*s", (int)strcspn(name, " "), name);
        known[count] = firsts[count];
    }
    known[count] = "help";
    const char *const meant = ffd_word_meant(typed, known, count + 1);
    while (meant && known[found] != meant)
        found++;
    return meant && found < count ? cli_commands[found]->name : meant;
}

/* Likewise of the commands of a group, by the second word. */
static const char *member_meant(const char *group, const char *typed)
{
    const char *known[MOST_COMMANDS];
    size_t count = 0;
    int next = 0;
    for (const cli_command *command;
         count < MOST_COMMANDS && (command = next_of_group(group, &next)) != NULL;)
        known[count++] = command->name + strlen(group) + 1;
    const char *const meant = ffd_word_meant(typed, known, count);
    return meant ? meant - strlen(group) - 1 : NULL;
}

static int unknown_command(int count, char **arguments)
{
    char typed[64];
    const bool two = is_group(arguments[0]) && count > 1;
    snprintf(typed, sizeof typed, "%s%s%s", arguments[0], two ? " " : "", two ? arguments[1] : "");
    const char *const meant = two ? member_meant(arguments[0], arguments[1]) : command_meant(arguments[0]);
    if (!meant && strpbrk(arguments[two], "./\\")) { /* a file: the command before it is missing */
        cli_complain("\"%s\" is not a command; a command comes first, as in: ffd %s %s ...", typed,
                     two ? first_of_group(arguments[0]) : "deform", arguments[two]);
        return EXIT_USAGE;
    }
    cli_complain("unknown command \"%s\" (%s%s)", typed,
                 meant ? "nearest: " : "ffd help lists the known ones", meant ? meant : "");
    return EXIT_USAGE;
}

static bool is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

static int run_help(int count, char **arguments)
{
    int words = 0;
    if (count == 0 || (count == 1 && (is_help(arguments[0]) || strcmp(arguments[0], "help") == 0))) {
        print_overview();
        return EXIT_DONE;
    }
    if (count == 1 && is_group(arguments[0])) {
        print_help_of_group(arguments[0]);
        return EXIT_DONE;
    }
    const cli_command *const command = find_command(count, arguments, &words);
    if (!command)
        return unknown_command(count, arguments);
    if (words && words != count) {
        cli_complain("help: unexpected argument \"%s\"", arguments[words]);
        return EXIT_USAGE;
    }
    cli_print_help(command);
    return EXIT_DONE;
}

static int run_version(int count, char **arguments)
{
    if (count > 0) {
        cli_complain("--version: unexpected argument \"%s\"", arguments[0]);
        return EXIT_USAGE;
    }
    printf("ffd %s\n", ffd_version_build());
    return EXIT_DONE;
}

static int unknown_option(const char *argument)
{
    static const char *const known[] = {"--help", "--version"};
    const char *const meant = ffd_word_meant(argument, known, sizeof known / sizeof *known);
    cli_complain("unknown option %.60s (%s%s%soptions follow a command)", argument, meant ? "nearest: " : "",
                 meant ? meant : "", meant ? "; other " : "");
    return EXIT_USAGE;
}

static int run(int count, char **arguments)
{
    int words = 0;
    if (count == 0) {
        cli_complain("no command is given (ffd help lists them)");
        return EXIT_USAGE;
    }
    if (strcmp(arguments[0], "--version") == 0)
        return run_version(count - 1, arguments + 1);
    if (is_help(arguments[0]))
        return run_help(0, NULL);
    if (strcmp(arguments[0], "help") == 0)
        return run_help(count - 1, arguments + 1);
    if (arguments[0][0] == '-')
        return unknown_option(arguments[0]);
    if (count > 1 && is_help(arguments[1]) && is_group(arguments[0]))
        return run_help(1, arguments);
    const cli_command *command = find_command(count, arguments, &words);
    return command ? command->run(command, count - words, arguments + words)
                   : unknown_command(count, arguments);
}

int main(int argc, char **argv)
{
    ffd_occupy_closed_streams();
    ffd_cleanup_on_signals();
    ffd_spell_members(cli_spell);
    int code;
    if (!ffd_worker_main(argc, argv, &code)) {
        ffd_guard_inputs();
        code = run(argc - 1, argv + 1);
    }
    errno = 0;
    if (fflush(stdout) != 0 || ferror(stdout)) {
        cli_complain("standard output: cannot be written%s%s", errno ? ": " : "",
                     errno ? strerror(errno) : "");
        if (code == EXIT_DONE || code == EXIT_NO) /* the output did not reach anyone */
            code = ffd_status_exit_code(FFD_E_IO);
    }
    return code;
}
