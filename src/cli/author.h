/* author.h - what the commands that make a lattice of a lattice share. */
#ifndef FFD_CLI_AUTHOR_H
#define FFD_CLI_AUTHOR_H

#include "cli/command.h"
#include "cli/member.h"

/* Set by cli_author_options. Each command's settings begin with it. */
typedef struct cli_author {
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    ffd_source *meshes;  /* mesh_count meshes, freed by cli_author_end */
    size_t mesh_count;
    const char *output;
    cli_logging logging;
    bool help;
} cli_author;

extern const cli_option cli_author_options[];

/* Returns what is wrong with the options and words, or NULL. */
const char *cli_author_mistake(const cli_author *author, const cli_words *words);
/* Whether the formats of all meshes are known; complains if not. Gives the meshes the options for reading. */
bool cli_author_prepare(cli_author *author);
/* Describes the job, with the command's own log. */
ffd_author_desc cli_author_describe(const cli_author *author, const char *lattice);
/* Frees the memory of options. */
void cli_author_end(cli_author *author);

#endif
