/* man.c - the parts of the man page, in the language of mdoc(7). */
#include "cli/commands.h"
#include "cli/pages/pages.h"
#include <stdio.h>
#include <string.h>

/* Escapes text: hyphens stay ASCII, so that they can be copied, and no line begins a request. */
static void put_text(const char *text, size_t length)
{
    if (length && (*text == '.' || *text == '\''))
        fputs("\\&", stdout);
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\\')
            fputs("\\e", stdout);
        else if (text[i] == '-')
            fputs("\\-", stdout);
        else
            putchar(text[i]);
    }
}

/* Writes each line of text as a line of input, breaking long ones between words. */
static void put_paragraph(const char *text, size_t length)
{
    enum { WIDTH = 70 };
    while (length > WIDTH) {
        size_t cut = WIDTH;
        while (cut && text[cut] != ' ')
            cut--;
        if (!cut)
            break;
        put_text(text, cut);
        putchar('\n');
        text += cut + 1;
        length -= cut + 1;
    }
    put_text(text, length);
    putchar('\n');
}

void pages_man_version(void)
{
    printf(".Os ffd %s\n", ffd_version());
}

/* Finds the next line of a synopsis, without "usage:" and leading spaces. Returns its length; 0 after the
   last. */
static size_t next_line(const char **rest, const char **line)
{
    *line = *rest + strspn(*rest, " ");
    if (strncmp(*line, "usage: ", 7) == 0)
        *line += 7;
    const size_t length = strcspn(*line, "\n");
    *rest = *line + length + ((*line)[length] == '\n');
    return length;
}

static bool is_usage(const char *line)
{
    return strncmp(line, "ffd ", 4) == 0;
}

/* Prints the lines of the synopsis that are usage, or the other ones. */
static void put_lines(const char *synopsis, bool usage)
{
    const char *line;
    for (size_t length; (length = next_line(&synopsis, &line));)
        if (is_usage(line) == usage) {
            /* Do not break or hyphenate a command line. */
            fputs(usage ? ".br\n.nh\n" : ".Pp\n", stdout);
            put_paragraph(line, length);
        }
}

void pages_man_synopsis(void)
{
    for (int i = 0; cli_commands[i]; i++)
        put_lines(cli_commands[i]->synopsis, true);
}

static void put_option(const cli_option *option)
{
    fputs(".It ", stdout);
    if (option->letter)
        printf("Fl %c , ", option->letter);
    fputs("Fl \\-", stdout);
    put_text(option->name, strlen(option->name));
    if (option->value) {
        fputs(" Ar ", stdout);
        put_text(option->value, strlen(option->value));
    }
    putchar('\n');
    put_paragraph(option->help, strlen(option->help));
}

static void put_examples(const cli_example *example)
{
    for (; example && example->line; example++) {
        fputs(".Pp\n", stdout);
        put_text(example->what, strlen(example->what));
        fputs(":\n.Dl ", stdout);
        put_text(example->line, strlen(example->line));
        putchar('\n');
    }
}

static void put_command(const cli_command *command)
{
    cli_option_walk walk = cli_begin_walk(&command->options);
    printf(".Ss ffd %s\n", command->name);
    put_paragraph(command->summary, strlen(command->summary));
    put_lines(command->synopsis, false);
    fputs(".Bl -tag -width Ds\n", stdout);
    for (const cli_option *option; (option = cli_next_option(&walk));)
        put_option(option);
    fputs(".El\n", stdout);
    put_examples(command->examples);
}

void pages_man_commands(void)
{
    for (int i = 0; cli_commands[i]; i++)
        put_command(cli_commands[i]);
}
