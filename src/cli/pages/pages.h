/* pages.h - the parts of the man page and the shell completions that come from the tables of commands and
   options. Main header of the pages: declares man.c, bash.c, zsh.c. */
#ifndef FFD_CLI_PAGES_PAGES_H
#define FFD_CLI_PAGES_PAGES_H

/* Each function prints to stdout the lines that replace @NAME@ in a template (main.c). */

/* The version and its date. */
void pages_man_version(void);
/* The synopsis of every command. */
void pages_man_synopsis(void);
/* Every command with its options and examples. */
void pages_man_commands(void);

/* The names of the commands, for bash. */
void pages_bash_commands(void);
/* The options of each command. */
void pages_bash_options(void);
/* The values of options. */
void pages_bash_values(void);
/* Kinds of positional arguments. */
void pages_bash_arguments(void);

/* The commands with their summaries, for zsh. */
void pages_zsh_commands(void);
/* The options and arguments of each command. */
void pages_zsh_arguments(void);

#endif
