/* program_words.h - the arguments of a program on Windows. The library shows this one function beside the
   public ones: a program that is linked with it begins with it. */
#ifndef FFD_BASE_FILE_PROGRAM_WORDS_H
#define FFD_BASE_FILE_PROGRAM_WORDS_H

/* Returns the words of the command line in UTF-8, the program first, NULL behind the last one: words with *
   or ? outside of quotes are replaced by the files that they match, if there are any. *count: how many. They
   are there until the program ends. NULL: memory ran out. */
char **ffd_program_words(int *count);

#endif
