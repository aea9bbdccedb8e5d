/* options.h - the options of a command: the same table parses them and prints their help. */
#ifndef FFD_CLI_OPTIONS_H
#define FFD_CLI_OPTIONS_H

#include <ffd/settings.h>
#include <stdbool.h>
#include <stddef.h>

/* What --memory does. */
#define CLI_MEMORY "memory for mesh and lattices, as 4G; default 100M (views: 400M) and 20 times their files"

/* What --threads does. */
#define CLI_THREADS "number of threads, 1 to 1024; never changes the output; default all usable processors"

/* What --isa does. */
#define CLI_ISA "instruction set; never changes the output; default auto"

/* What --timeout does. */
#define CLI_TIMEOUT "a job that takes longer ends with exit 7, and nothing is written"

/* What --time does. */
#define CLI_TIME "lattices that have keys as they are at T seconds, between their keys; default the first key"

/* What --strict does. */
#define CLI_STRICT "refuse what the format's specification calls an error even where its meaning is plain"

/* What --allow-extension does. */
#define CLI_ALLOW_EXTENSION                                                                                  \
    "read a glTF file that requires this extension although it is not known; repeatable"

/* What --snap does. */
#define CLI_SNAP                                                                                             \
    "a vertex no farther than D from the lattice (Dr: parts of its diagonal) is inside; default 0"

/* Faces that are held, everywhere. */
#define CLI_SEAM_VALUE "C0|C1|C2|none[:FACES]"
#define CLI_SEAM                                                                                             \
    "hold faces, to join the rest smoothly; FACES: u-,v+,.., all, or cut by the mesh, the default"

typedef struct cli_option cli_option;

/* Stores the option's value (NULL: it takes none) in the command's settings. Returns false after a complaint
   (cli_complain) about the value. */
typedef bool (*cli_setter)(void *settings, const cli_option *option, const char *value);

struct cli_option {
    const char *name; /* without dashes: "lattice" */
    char letter;      /* 'l', or 0 */
    /* The value's name in the help; NULL: the option takes none. Shells complete the words and kinds of files
       in it (cli/pages/value.h). */
    const char *value;
    const char *help;
    cli_setter set;
    size_t offset; /* of the field to set, for the common setters */
    /* Terminated by NULL. For cli_set_choice: names in the order of the enum; for others: the possible
       entries of a list. */
    const char *const *choices;
};

/* The options of a command, in arrays that end in an entry without a name. If two options have the same name
   or letter, the first one counts. */
typedef struct cli_table {
    const cli_option *first, *more, *base; /* more and base may be NULL */
    const char *output; /* where the output is named, of a command without -o; may be NULL */
} cli_table;

/* Position in a walk over a table. */
typedef struct cli_option_walk {
    const cli_table *options;
    const cli_option *at;
    int part;
} cli_option_walk;

/* Starts a walk over the options that count. */
cli_option_walk cli_begin_walk(const cli_table *options);

/* Returns the next option; NULL after the last. */
const cli_option *cli_next_option(cli_option_walk *walk);

/* Positional arguments, in order. */
typedef struct cli_words {
    const char **words;
    size_t count;
} cli_words;

/* Common setters, by the type of the field at offset. */

/* bool: set to true. */
bool cli_set_flag(void *settings, const cli_option *option, const char *value);
/* const char *: given once, and not empty. */
bool cli_set_text(void *settings, const cli_option *option, const char *value);
/* int: a number of threads. */
bool cli_set_count(void *settings, const cli_option *option, const char *value);
/* The room for a hint. */
#define CLI_HINT 60
/* Writes " (nearest: WORD)" if one of an option's choices is meant by a value, else nothing. */
void cli_hint_choice(const cli_option *option, const char *value, char hint[CLI_HINT]);

/* int: index into choices. */
bool cli_set_choice(void *settings, const cli_option *option, const char *value);
/* double: positive and finite. */
bool cli_set_positive(void *settings, const cli_option *option, const char *value);
/* A length; or, written with r behind it, a fraction of another length. */
typedef struct cli_distance {
    double value;
    bool is_relative;
} cli_distance;

/* cli_distance. */
bool cli_set_distance(void *settings, const cli_option *option, const char *value);
/* Sets a member of base to an option's value, as ffd_member_read does. */
bool cli_read(const ffd_member *member, void *base, const cli_option *option, const char *value);

/* Parses the whole text as a number. Returns false if it is not one. */
bool cli_parse_number(const char *text, double *value);

/* Sorts the arguments of a command (without its name) into settings and words. words->words needs capacity
   for count entries. Stops as soon as *help (a member of settings) becomes true. Returns false after a
   complaint. */
bool cli_parse(const cli_table *options, void *settings, const bool *help, int count, char **arguments,
               cli_words *words);

#if defined(__GNUC__) && !defined(__MINGW32__) /* whose __printf__ is that of Windows */
__attribute__((__format__(__printf__, 1, 2)))
#endif
/* Prints one line "ffd: ..." to stderr. */
void cli_complain(const char *format, ...);

/* Prints the options and their help, one a line. */
void cli_print_options(const cli_table *options);

#endif
