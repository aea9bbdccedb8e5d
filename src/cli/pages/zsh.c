/* zsh.c - the parts of the zsh completion: specifications for _arguments. */
#include "cli/commands.h"
#include "cli/pages/pages.h"
#include "cli/pages/value.h"
#include <stdio.h>
#include <string.h>

/* Escapes text inside single quotes, where specifications give some characters a meaning. */
static void put_text(const char *text)
{
    for (; *text; text++) {
        if (*text == '\'')
            fputs("'\\'", stdout);
        else if (strchr("\\:[]", *text))
            putchar('\\');
        putchar(*text);
    }
}

void pages_zsh_commands(void)
{
    for (int i = 0; cli_commands[i]; i++) {
        printf("        '%s' '", cli_commands[i]->name);
        put_text(cli_commands[i]->summary);
        fputs("'\n", stdout);
    }
}

/* Writes ":WHAT:ACTION". */
static void put_value(const pages_value *value, const char *what)
{
    putchar(':');
    put_text(what);
    putchar(':');
    if (value->list)
        printf("_ffd_list %s", value->words);
    else if (*value->words)
        printf("(%s)", value->words);
    else if (value->whole)
        printf("_files -g \"(*.(#i)(%s)|%s)(-.)\"", value->endings, value->whole);
    else if (*value->endings)
        printf("_files -g \"*.(#i)(%s)(-.)\"", value->endings);
    else
        fputs(value->files ? "_files" : value->folders ? "_files -/" : " ", stdout);
}

static void put_option(const cli_option *option)
{
    fputs("                '*'", stdout);
    if (option->letter)
        printf("{-%c%s,--%s%s}", option->letter, option->value ? "+" : "", option->name,
               option->value ? "=" : "");
    else
        printf("--%s%s", option->name, option->value ? "=" : "");
    fputs("'[", stdout);
    put_text(option->help);
    putchar(']');
    if (option->value) {
        const pages_value value = pages_option_value(option);
        put_value(&value, option->value);
    }
    fputs("' \\\n", stdout);
}

void pages_zsh_arguments(void)
{
    for (int i = 0; cli_commands[i]; i++) {
        const cli_command *command = cli_commands[i];
        const pages_value arguments = pages_command_arguments(command);
        cli_option_walk walk = cli_begin_walk(&command->options);
        printf("        '%s')\n            _arguments -s -S : \\\n", command->name);
        for (const cli_option *option; (option = cli_next_option(&walk));)
            put_option(option);
        fputs("                '*", stdout);
        put_value(&arguments, command->arguments ? command->arguments : "word");
        fputs("'\n            ;;\n", stdout);
    }
}
