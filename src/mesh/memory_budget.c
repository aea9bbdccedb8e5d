#include "mesh/memory_budget.h"
#include "base/spelling.h"

#define MEGABYTE ((uint64_t)1000000)
#define LEAST (100 * MEGABYTE)
#define BYTES_PER_BYTE 20

/* Bytes of the program itself before it reads a file. */
#define PROGRAM (16 * MEGABYTE)

/* Bytes that are kept for each byte of a file: the byte itself, plus twice 24 bytes for each vector, which
   takes at least six characters ("0 0 0") or 12 bytes. */
#define KEPT_OF_TEXT 9
#define KEPT_OF_FLOATS 5

static uint64_t add(uint64_t a, uint64_t b, uint64_t times)
{
    return times && b > (UINT64_MAX - a) / times ? UINT64_MAX : a + b * times;
}

/* Not more than this machine can address: what was taken fits a size_t. */
uint64_t ffd_budget_most(const memory_budget *budget)
{
    const uint64_t most = budget->asked > budget->most ? budget->asked : budget->most;
    return most < SIZE_MAX ? most : SIZE_MAX;
}

memory_budget ffd_budget_make(uint64_t asked)
{
    return (memory_budget){.most = LEAST, .taken = PROGRAM, .asked = asked};
}

void ffd_budget_add_file(memory_budget *budget, uint64_t size, uint64_t kept_per_byte)
{
    budget->most = add(budget->most, size, BYTES_PER_BYTE);
    budget->taken = add(budget->taken, size, kept_per_byte);
}

memory_budget ffd_budget_for_file(uint64_t size, bool text, uint64_t asked)
{
    memory_budget budget = ffd_budget_make(asked);
    ffd_budget_add_file(&budget, size, text ? KEPT_OF_TEXT : KEPT_OF_FLOATS);
    return budget;
}

uint64_t ffd_budget_left(const memory_budget *budget)
{
    const uint64_t most = ffd_budget_most(budget);
    return most > budget->taken ? most - budget->taken : 0;
}

ffd_status ffd_budget_check(const memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error)
{
    if (size == 0 || count <= ffd_budget_left(budget) / size)
        return FFD_OK;
    return ffd_fail(error, FFD_E_LIMIT, "needs more than the %llu MB of memory %s",
                    (unsigned long long)(ffd_budget_most(budget) / MEGABYTE),
                    ffd_budget_most(budget) < SIZE_MAX ? SPELLED("allowed ({input.memory} raises this)")
                                                       : "that a program with addresses of 32 bits holds");
}

ffd_status ffd_budget_take(memory_budget *budget, uint64_t count, uint64_t size, ffd_error *error)
{
    TRY(ffd_budget_check(budget, count, size, error));
    budget->taken += count * size; /* at most what was left */
    return FFD_OK;
}

void ffd_budget_keep(memory_budget *budget, uint64_t bytes)
{
    if (ffd_budget_left(budget) > bytes)
        budget->taken = ffd_budget_most(budget) - bytes;
}

void ffd_budget_return(memory_budget *budget, uint64_t count, uint64_t size)
{
    budget->taken -= count * size;
}

int ffd_budget_threads(const memory_budget *budget, int threads, uint64_t size)
{
    const uint64_t most = ffd_budget_left(budget) / size;
    return threads <= 1 || most <= 1 ? 1 : most < (uint64_t)threads ? (int)most : threads;
}
