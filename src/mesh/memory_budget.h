/* memory_budget.h - the memory that a document may take: a short file must not be able to take any amount. */
#ifndef FFD_MESH_MEMORY_BUDGET_H
#define FFD_MESH_MEMORY_BUDGET_H

#include "base/fail.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a document may take, in bytes. */
typedef struct memory_budget {
    uint64_t most;
    uint64_t taken; /* may be more: what is taken for the bytes of files is not refused */
    uint64_t asked; /* by the user */
    bool is_shared; /* with another document of the same files: they are allowed for already */
} memory_budget;

/* The budget of a document without files: 100 MB, or `asked` if that is more, the program itself included. */
memory_budget ffd_budget_make(uint64_t asked);
/* Adds a file: 20 times its size is allowed, and of that kept_per_byte times its size is taken. */
void ffd_budget_add_file(memory_budget *budget, uint64_t size, uint64_t kept_per_byte);
/* The budget of a document of one file, beside whose bytes its numbers are kept, and again when they have
   moved. text: the numbers are text, which may be shorter than they are. */
memory_budget ffd_budget_for_file(uint64_t size, bool text, uint64_t asked);
/* Bytes that are allowed in all. */
uint64_t ffd_budget_most(const memory_budget *budget);
/* Bytes that are left. */
uint64_t ffd_budget_left(const memory_budget *budget);
/* Whether count * size bytes fit in. Errors: FFD_E_LIMIT. */
ffd_status ffd_budget_check(const memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error);
/* Takes them, for as long as the document is open. Errors: FFD_E_LIMIT; nothing is taken then. */
ffd_status ffd_budget_take(memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error);
/* Returns to the budget what was taken so. */
void ffd_budget_return(memory_budget *budget, uint64_t count, uint64_t size);
/* Returns how many of the threads (at least 1) the budget allows if each takes size bytes. */
int ffd_budget_threads(const memory_budget *budget, int threads, uint64_t size);

#ifdef __cplusplus
}
#endif

#endif
