/* options.h - the options of a command: one table from which words are parsed and help is printed. */
#ifndef FFD_CLI_OPTIONS_H
#define FFD_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

/* The mesh formats, for help and complaints. */
#define CLI_FORMATS "obj, gltf, glb, vrm, ply, off or stl"

/* What --memory does. */
#define CLI_MEMORY "memory for mesh and lattices, as 4G; default 100M (views: 400M) and 20 times their files"

/* What --strict does. */
#define CLI_STRICT "refuse what the format's specification calls an error even where its meaning is plain"

/* What --allow-extension does. */
#define CLI_ALLOW_EXTENSION                                                                                  \
    "read a glTF file that requires this extension although it is not known; repeatable"

/* What --snap does. */
#define CLI_SNAP                                                                                             \
    "a vertex no farther than D from the lattice (Dr: parts of its diagonal) is inside; default 0"

typedef struct cli_option cli_option;

/* Takes the option's value (NULL where it has none) into the command's settings. Returns false after having
   said what is wrong with the value (cli_complain). */
typedef bool (*cli_setter)(void *settings, const cli_option *option, const char *value);

struct cli_option {
    const char *name; /* "lattice", without the dashes */
    char letter;      /* 'l', or 0 */
    /* The name of the value in the help; NULL: the option takes none. Shells complete what words and
       names of files they know in it (cli/pages/value.h). */
    const char *value;
    const char *help;
    cli_setter set;
    size_t offset; /* of the field that set fills, for the common setters */
    /* Ended by NULL. Of cli_set_choice: names in the order of the enum; of others: what a list may hold. */
    const char *const *choices;
};

/* The options of a command, in parts that end with a name of NULL. Of options with one name, or one letter,
   the first counts. */
typedef struct cli_table {
    const cli_option *first, *more, *base; /* more and base may be NULL */
    /* Called for every option that was set; or NULL. */
    bool (*note)(void *settings, const cli_option *option, const char *value);
} cli_table;

/* The way through the parts of a table. */
typedef struct cli_option_walk {
    const cli_table *options;
    const cli_option *at;
    int part;
} cli_option_walk;

/* Begins a walk over the options that count. */
cli_option_walk cli_begin_walk(const cli_table *options);

/* The next option that counts; NULL after the last. */
const cli_option *cli_next_option(cli_option_walk *walk);

/* Positional arguments, in their order. */
typedef struct cli_words {
    const char **words;
    size_t count;
} cli_words;

/* Common setters, each for a kind of field at offset. */

/* Sets a bool to true. */
bool cli_set_flag(void *settings, const cli_option *option, const char *value);
/* A const char *, given once and not empty. */
bool cli_set_text(void *settings, const cli_option *option, const char *value);
/* An int: a number of threads. */
bool cli_set_count(void *settings, const cli_option *option, const char *value);
/* An int: the index into choices. */
bool cli_set_choice(void *settings, const cli_option *option, const char *value);
/* An ffd_format. */
bool cli_set_format(void *settings, const cli_option *option, const char *value);
/* A double, positive and finite. */
bool cli_set_positive(void *settings, const cli_option *option, const char *value);
/* A length, or with r after it a part of another one. */
typedef struct cli_distance {
    double value;
    bool is_relative;
} cli_distance;

/* A cli_distance. */
bool cli_set_distance(void *settings, const cli_option *option, const char *value);
/* A uint64_t: bytes, as 700M or 4G. */
bool cli_set_bytes(void *settings, const cli_option *option, const char *value);

/* The whole text as a number. */
bool cli_parse_number(const char *text, double *value);

/* Sorts the arguments of a command (without its name) into settings and words. words->words must have space
   for count entries. Stops where *help (a field of settings) becomes true: what follows is not looked at.
   False after a complaint. */
bool cli_parse(const cli_table *options, void *settings, const bool *help, int count, char **arguments,
               cli_words *words);

#ifdef __GNUC__
__attribute__((__format__(__printf__, 1, 2)))
#endif
/* Prints one line "ffd: ..." to stderr. */
void cli_complain(const char *format, ...);

/* From now on a complaint goes to text, without "ffd: "; NULL: to stderr again. */
void cli_capture(char *text, size_t capacity);

/* Prints the options and their help, one a line. */
void cli_print_options(const cli_table *options);

#endif
