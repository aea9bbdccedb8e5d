/* main.c - generates the man page and the shell completions: prints a template in which each line @NAME@ is
   replaced by text from the tables of commands and options. The build calls it as `ffd-pages TEMPLATE`; it is
   not installed. */
#include "cli/pages/pages.h"
#include <stdio.h>
#include <string.h>

static const struct {
    const char *line;
    void (*print)(void);
} parts[] = {
    {"@man-version@\n", pages_man_version},       {"@man-synopsis@\n", pages_man_synopsis},
    {"@man-commands@\n", pages_man_commands},     {"@bash-commands@\n", pages_bash_commands},
    {"@bash-options@\n", pages_bash_options},     {"@bash-values@\n", pages_bash_values},
    {"@bash-arguments@\n", pages_bash_arguments}, {"@zsh-commands@\n", pages_zsh_commands},
    {"@zsh-arguments@\n", pages_zsh_arguments},
};
enum { PARTS = sizeof parts / sizeof *parts };

/* Returns 0 for an unknown part. */
static int print_line(const char *line)
{
    if (line[0] != '@') {
        fputs(line, stdout);
        return 1;
    }
    for (int i = 0; i < PARTS; i++)
        if (strcmp(parts[i].line, line) == 0) {
            parts[i].print();
            return 1;
        }
    return 0;
}

int main(int argc, char **argv)
{
    char line[1024];
    FILE *template = argc == 2 ? fopen(argv[1], "r") : NULL;
    if (!template) {
        fprintf(stderr, "usage: ffd-pages TEMPLATE\n");
        return 2;
    }
    while (fgets(line, sizeof line, template))
        if (!print_line(line)) {
            fprintf(stderr, "ffd-pages: %s: unknown part %s", argv[1], line);
            return 1;
        }
    fclose(template);
    return fflush(stdout) || ferror(stdout) ? 1 : 0;
}
