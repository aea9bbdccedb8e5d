/* bash.c - the parts of the completion for bash: arms of its case statements. */
#include "cli/commands.h"
#include "cli/pages/pages.h"
#include "cli/pages/value.h"
#include <stdio.h>

void pages_bash_commands(void)
{
    for (int i = 0; cli_commands[i]; i++)
        printf("        '%s'\n", cli_commands[i]->name);
}

void pages_bash_options(void)
{
    for (int i = 0; cli_commands[i]; i++) {
        cli_option_walk walk = cli_begin_walk(&cli_commands[i]->options);
        printf("        '%s') echo '", cli_commands[i]->name);
        for (const cli_option *option; (option = cli_next_option(&walk));)
            printf("--%s ", option->name);
        fputs("' ;;\n", stdout);
    }
}

static void put_value(const pages_value *value)
{
    if (value->list)
        printf("_ffd_list '%s'", value->words);
    else if (*value->words)
        printf("_ffd_words '%s'", value->words);
    else if (value->whole)
        printf("_ffd_files '@(%s)' %s", value->endings, value->whole);
    else if (*value->endings)
        printf("_filedir '@(%s)'", value->endings);
    else
        fputs(value->files ? "_filedir" : value->folders ? "_filedir -d" : ":", stdout);
    fputs(" ;;\n", stdout);
}

void pages_bash_values(void)
{
    for (int i = 0; cli_commands[i]; i++) {
        cli_option_walk walk = cli_begin_walk(&cli_commands[i]->options);
        for (const cli_option *option; (option = cli_next_option(&walk));) {
            const pages_value value = pages_option_value(option);
            if (!option->value)
                continue;
            printf("        '%s --%s'", cli_commands[i]->name, option->name);
            if (option->letter)
                printf(" | '%s -%c'", cli_commands[i]->name, option->letter);
            fputs(") ", stdout);
            put_value(&value);
        }
    }
}

void pages_bash_arguments(void)
{
    for (int i = 0; cli_commands[i]; i++) {
        const pages_value value = pages_command_arguments(cli_commands[i]);
        printf("        '%s') ", cli_commands[i]->name);
        put_value(&value);
    }
}
