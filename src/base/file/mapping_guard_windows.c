/* mapping_guard_windows.c - ffd_guard_inputs for Windows. */
#include <ffd/program.h>

/* Windows lets nobody truncate a file that is mapped. */
void ffd_guard_inputs(void) {}
