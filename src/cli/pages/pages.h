/* pages.h - what the man page and the shells' completions say of the tables of commands and options. */
#ifndef FFD_CLI_PAGES_PAGES_H
#define FFD_CLI_PAGES_PAGES_H

/* Each prints the lines that stand in a template for @NAME@ (main.c) to stdout. */
void pages_man_version(void);
void pages_man_synopsis(void);
void pages_man_commands(void);

void pages_bash_commands(void);
void pages_bash_options(void);
void pages_bash_values(void);
void pages_bash_arguments(void);

void pages_zsh_commands(void);
void pages_zsh_arguments(void);

#endif
