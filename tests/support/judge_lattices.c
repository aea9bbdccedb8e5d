/* judge_lattices.c - reads many lattice files in one process. A line on stdin names a file and, after tabs,
   values of placeholders: FILE[<tab>NAME=VALUE]... A line on stdout gives the exit code of `ffd info` and, if
   it is not 0, the reason. */
#include <ffd/ffd.h>
#include <stdio.h>
#include <string.h>

#define MOST_VALUES 16

static void judge(char *line)
{
    ffd_setting values[MOST_VALUES];
    bool used[MOST_VALUES] = {false};
    size_t count = 0;
    ffd_lattice *lattice = NULL;
    ffd_error error;
    char words[2048] = "";
    for (char *tab = strchr(line, '\t'); tab && count < MOST_VALUES; tab = strchr(tab, '\t')) {
        *tab++ = 0;
        char *const equals = strchr(tab, '=');
        if (!equals)
            break;
        *equals = 0;
        values[count++] = (ffd_setting){tab, equals + 1};
        tab = equals + 1;
    }
    const ffd_status status = ffd_lattice_load_set(line, values, count, used, &lattice, &error);
    if (status)
        ffd_error_format(&error, words, sizeof words);
    printf("%d %s\n", ffd_status_exit_code(status), words);
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    char line[8192];
    while (fgets(line, sizeof line, stdin)) {
        line[strcspn(line, "\n")] = 0;
        judge(line);
    }
    return 0;
}
