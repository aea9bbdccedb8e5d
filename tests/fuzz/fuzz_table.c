/* fuzz_table.c - a lattice in one of the formats that `ffd lattice convert` reads, which its first bytes
   choose. What is read is written as a table, and that is read as the same. */
#include "base/crc.h"
#include "base/little_endian.h"
#include "fuzz_target.h"
#include "io/deflate/inflate.h"
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

/* Points of a cage that does not tell how many stand along u, v and w. */
static bool is_in_a_row(const void *bytes, size_t size)
{
    return size >= 2 && memcmp(bytes, "v ", 2) == 0;
}

static ffd_status convert(const char *name, const void *bytes, size_t size, written_table *taken)
{
    ffd_author_desc desc;
    ffd_convert_desc how;
    ffd_error error;
    ffd_author_desc_init(&desc, sizeof desc);
    desc.lattice = (ffd_lattice_source){.path = name, .text = {bytes, size}};
    desc.output = "table.csv";
    desc.sink = take;
    desc.sink_user = taken;
    *taken = (written_table){NULL, 0};
    ffd_convert_desc_init(&how, sizeof how);
    if (is_in_a_row(bytes, size))
        how.size[0] = how.size[1] = how.size[2] = 2;
    else if (size % 2 && strstr(name, ".xyz"))
        how.order = FFD_ORDER_AUTO;
    const ffd_status status = ffd_lattice_convert_run(&desc, &how, &error);
    PROMISE(!status == (taken->bytes != NULL), "status %d, and %zu bytes", status, taken->size);
    PROMISE(!status || (error.status == status && error.message[0] && !strpbrk(error.message, "\r\n")),
            "status %d says '%s'", status, error.message);
    PROMISE(!status || status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_ARGUMENT ||
                status == FFD_E_UNSUPPORTED,
            "status %d: %s", status, error.message);
    return status;
}

/* The reader that the first bytes ask for. */
static const char *name_of(const uint8_t *data, size_t size)
{
    static const struct {
        const char *start, *name;
    } formats[] = {{"\x93", "points.npy"}, {"<", "points.vts"},     {"# vtk", "points.vtk"},
                   {"[", "points.prm"},    {"NDIME", "points.su2"}, {"FFD_", "points.su2"},
                   {"v ", "points.obj"},   {"# ffd", "points.obj"}, {"PK", "points.npz"},
                   {"{", "points.json"}};
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++)
        if (size >= strlen(formats[f].start) && memcmp(data, formats[f].start, strlen(formats[f].start)) == 0)
            return formats[f].name;
    return size && data[0] >= '0' && data[0] <= '9' ? "points.xyz" : "points.csv";
}

/* Whether a table may have numbers that control points cannot have, and a box can: from 1e300 on. */
static bool is_huge(const written_table *table)
{
    for (size_t i = 0; i + 4 <= table->size; i++)
        if (memcmp(table->bytes + i, "e+30", 4) == 0)
            return true;
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    written_table first, second;
    if (convert(name_of(data, size), size ? (const void *)data : "", size, &first))
        return 0;
    if (convert("table.csv", first.bytes, first.size, &second)) {
        PROMISE(is_huge(&first), "a table that was written is refused");
        free(first.bytes);
        return 0;
    }
    PROMISE(first.size == second.size && memcmp(first.bytes, second.bytes, first.size) == 0,
            "a table that was written and read is another");
    free(first.bytes);
    free(second.bytes);
    return 0;
}

/* The check sum of a member, as long as its data are whole. */
static uint32_t sum_of(const uint8_t *member, size_t packed, size_t size, bool is_deflated, uint32_t old)
{
    if (!is_deflated)
        return size == packed ? ffd_crc(0, member, size) : old;
    unsigned char *const room = malloc(size + 1);
    PROMISE(room, "no memory");
    const uint32_t sum = ffd_inflate(member, packed, true, room, size, NULL) ? old : ffd_crc(0, room, size);
    free(room);
    return sum;
}

/* Makes the check sums of a ZIP file right again: else nearly every mutation would end at them. */
static void mend_sums(uint8_t *data, size_t size)
{
    enum { ENTRY = 46, LOCAL = 30, MOST = 1 << 20 };
    for (size_t at = 0; at + ENTRY <= size; at++) {
        if (load_u32(data + at) != 0x02014b50)
            continue;
        const uint64_t local = load_u32(data + at + 42), packed = load_u32(data + at + 20);
        const uint32_t wanted = load_u32(data + at + 24);
        if (local + LOCAL > size || wanted > MOST)
            continue;
        const uint64_t first = local + LOCAL + (data[local + 26] | (unsigned)data[local + 27] << 8) +
                               (data[local + 28] | (unsigned)data[local + 29] << 8);
        if (first > size || packed > size - first)
            continue;
        store_u32(data + at + 16,
                  sum_of(data + first, (size_t)packed, wanted, data[at + 10] == 8, load_u32(data + at + 16)));
    }
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    const size_t changed = mutate_text(data, size, capacity, seed, ", #-+.e019\n\r\tijkxyz\xff\"<>=[]{}");
    if (changed > 2 && data[0] == 'P' && data[1] == 'K')
        mend_sums(data, changed);
    return changed;
}
