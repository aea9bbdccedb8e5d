/* work_folder.h - the folder of a fuzz target's run for files that must be on disk: lattices, external
   buffers, outputs. Made once, removed at the program's end. */
#ifndef FFD_TESTS_FUZZ_WORK_FOLDER_H
#define FFD_TESTS_FUZZ_WORK_FOLDER_H

#include <stddef.h>

/* Room for a path in the folder. */
#define WORK_PATH 128

/* The path of a file in the folder, which is made where it is not there. */
void work_path(const char *name, char path[WORK_PATH]);
void work_write(const char *name, const void *bytes, size_t size);
/* Removes the files in a folder of the folder. Returns how many there were. */
size_t work_clear(const char *name);

#endif
