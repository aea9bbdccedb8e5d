/* fuzz_table.c - a lattice as an array, which begins with the bytes of one, or as a table. What is read is
   written as a table, and that is read as the same. */
#include "fuzz_target.h"
#include "mutate_text.h"
#include "promise.h"
#include <ffd/job.h>
#include <stdlib.h>
#include <string.h>

typedef struct written_table {
    char *bytes;
    size_t size;
} written_table;

static ffd_status take(void *user, const char *name, const void *bytes, size_t size)
{
    written_table *const taken = user;
    (void)name;
    taken->bytes = malloc(size);
    PROMISE(taken->bytes, "no memory");
    memcpy(taken->bytes, bytes, size);
    taken->size = size;
    return FFD_OK;
}

static ffd_status convert(const char *name, const void *bytes, size_t size, written_table *taken)
{
    ffd_lattice_convert_desc desc;
    ffd_error error;
    ffd_lattice_convert_desc_init(&desc, sizeof desc);
    desc.lattice = (ffd_lattice_source){.path = name, .text = {bytes, size}};
    desc.output = "table.csv";
    desc.sink = take;
    desc.sink_user = taken;
    *taken = (written_table){NULL, 0};
    const ffd_status status = ffd_lattice_convert_run(&desc, &error);
    PROMISE(!status == (taken->bytes != NULL), "status %d, and %zu bytes", status, taken->size);
    PROMISE(!status || (error.status == status && error.message[0] && !strpbrk(error.message, "\r\n")),
            "status %d says '%s'", status, error.message);
    PROMISE(!status || status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_ARGUMENT,
            "status %d: %s", status, error.message);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    written_table first, second;
    const bool is_array = size > 0 && data[0] == 0x93;
    if (convert(is_array ? "points.npy" : "points.csv", size ? (const void *)data : "", size, &first))
        return 0;
    PROMISE(!convert("table.csv", first.bytes, first.size, &second), "a table that was written is refused");
    PROMISE(first.size == second.size && memcmp(first.bytes, second.bytes, first.size) == 0,
            "a table that was written and read is another");
    free(first.bytes);
    free(second.bytes);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_text(data, size, capacity, seed, ", #-+.e019\n\r\tijkxyz\xff");
}
