/* memory_budget.h - limits the memory of a document, because a short file can ask for any amount. */
#ifndef FFD_MESH_MEMORY_BUDGET_H
#define FFD_MESH_MEMORY_BUDGET_H

#include "base/fail.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The budget for a picture or a page is at least this unless the user has set one: a view holds all that a
   mesh shows, and a short file may show many instances. */
#define LEAST_VIEW_MEMORY ((uint64_t)400000000)

/* The memory that a document may use, in bytes. */
typedef struct memory_budget {
    uint64_t most;
    uint64_t taken; /* may exceed the limit, because the bytes of files themselves are never refused */
    uint64_t asked; /* limit that the user has set */
} memory_budget;

/* Makes the budget of a document without files: 100 MB, or `asked` if that is more, including the program
   itself. */
memory_budget ffd_budget_make(uint64_t asked);
/* Adds a file: raises the limit by 20 times its size, and takes kept_per_byte times its size. */
void ffd_budget_add_file(memory_budget *budget, uint64_t size, uint64_t kept_per_byte);
/* Makes the budget of a document of one file, which keeps the bytes of the file, its numbers, and the moved
   numbers. text: the numbers are text, which may be shorter than binary numbers. */
memory_budget ffd_budget_for_file(uint64_t size, bool text, uint64_t asked);
/* Returns the limit in bytes. */
uint64_t ffd_budget_most(const memory_budget *budget);
/* Returns the remaining bytes. */
uint64_t ffd_budget_left(const memory_budget *budget);
/* Checks that count * size bytes are available. Errors: FFD_E_LIMIT. */
ffd_status ffd_budget_check(const memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error);
/* Takes count * size bytes for as long as the document is open. Errors: FFD_E_LIMIT; nothing is taken
   then. */
ffd_status ffd_budget_take(memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error);
/* Leaves no more than these bytes, if more were left. */
void ffd_budget_keep(memory_budget *budget, uint64_t bytes);
/* Gives back bytes that were taken. */
void ffd_budget_return(memory_budget *budget, uint64_t count, uint64_t size);
/* Returns how many of the threads the budget allows if each needs size bytes; at least 1. */
int ffd_budget_threads(const memory_budget *budget, int threads, uint64_t size);

#ifdef __cplusplus
}
#endif

#endif
