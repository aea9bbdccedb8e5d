#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cli_print_help(const cli_command *command)
{
    printf("%s\n\n%s\nOptions:\n", command->summary, command->synopsis);
    cli_print_options(&command->options);
    printf("\nExamples:\n");
    for (const cli_example *example = command->examples; example && example->line; example++)
        printf("  %s:\n      %s\n", example->what, example->line);
}

const char *cli_display_name(const char *path)
{
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

bool cli_knows_format(const char *path, ffd_format given)
{
    ffd_error error;
    if (given != FFD_FORMAT_AUTO || !ffd_format_check_name(path, &error))
        return true;
    cli_fail(&error);
    return false;
}

void cli_log(void *user, ffd_log_level level, const char *line)
{
    const cli_logging *logging = user;
    if (logging->quiet || (level != FFD_LOG_WARNING && !logging->verbose))
        return;
    if (logging->subject)
        cli_complain("%s: %s", cli_display_name(logging->subject), line);
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

int cli_check_reports(const cli_command *command, const cli_words *words)
{
    size_t streams = 0;
    for (size_t i = 0; i < words->count; i++)
        streams += strcmp(words->words[i], "-") == 0;
    if (words->count == 0)
        return cli_usage(command, "needs at least one REPORT");
    return streams > 1 ? cli_usage(command, "standard input can be read only once") : EXIT_DONE;
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
    if (!cli_parse(&command->options, settings, help, count, arguments, words)) {
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

int cli_run(const cli_command *command, void *settings, const bool *help, int count, char **arguments,
            cli_action *action)
{
    cli_words words;
    int code = EXIT_USAGE;
    if (!cli_begin(command, settings, help, count, arguments, &words, &code))
        return code;
    code = action(command, settings, &words);
    free(words.words);
    return code;
}
