/* replay.c - runs a fuzz target without a fuzzer: over every file of the folders named, and over mutations
   of each.

       replay FOLDER...
   FFD_SEED and FFD_CASES (mutations of a file) make other and longer runs; FFD_DUMP=FILE keeps the input that
   is being run there. */
#include "../support/repetitions.h"
#include "fuzz_target.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BYTES ((size_t)1 << 16)
/* With the address sanitizer the fuzz targets themselves run thousands more. */
#define MUTATIONS (FFD_SANITIZED ? 1 : 12)
/* Mutations of mutations: this many in a row from one file, then from the file again. */
#define MUTATIONS_DEEP 4

static uint64_t setting(const char *name, uint64_t otherwise)
{
    const char *const text = getenv(name);
    if (!text || !*text)
        return otherwise;
    char *end;
    errno = 0;
    const uint64_t value = strtoull(text, &end, 10);
    if (*end || errno) {
        fprintf(stderr, "%s=%s is not a whole number\n", name, text);
        exit(2);
    }
    return value;
}

static void run(const uint8_t *data, size_t size)
{
    const char *const dump = getenv("FFD_DUMP");
    FILE *const file = dump && *dump ? fopen(dump, "wb") : NULL;
    if (file) {
        fwrite(data, 1, size, file);
        fclose(file);
    }
    /* A block of its own size, so that reading past the end is seen. */
    uint8_t *const copy = malloc(size > 0 ? size : 1);
    if (!copy)
        exit(1);
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

static void run_file(const char *folder, const char *name, uint8_t *data, size_t *runs)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *const file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(1);
    }
    const size_t size = fread(data, 1, MOST_BYTES, file);
    fclose(file);
    printf("%s\n", path);
    fflush(stdout);
    run(data, size);
    const uint64_t seed = setting("FFD_SEED", 1), count = setting("FFD_CASES", MUTATIONS);
    uint8_t *const mutant = data + MOST_BYTES;
    size_t mutant_size = 0;
    for (uint64_t i = 0; i < count; i++) {
        if (i % MUTATIONS_DEEP == 0) {
            memcpy(mutant, data, size);
            mutant_size = size;
        }
        mutant_size = fuzz_mutate(mutant, mutant_size, MOST_BYTES, seed * UINT64_C(1000003) + i);
        run(mutant, mutant_size);
    }
    *runs += 1 + (size_t)count;
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

int main(int argc, char **argv)
{
    uint8_t *const data = malloc(2 * MOST_BYTES);
    size_t runs = 0;
    if (!data)
        return 1;
    printf("FFD_SEED=%llu\n", (unsigned long long)setting("FFD_SEED", 1));
    for (int i = 1; i < argc; i++) {
        struct dirent **entries;
        const int count = scandir(argv[i], &entries, is_visible, alphasort);
        if (count < 0) {
            perror(argv[i]);
            return 1;
        }
        for (int e = 0; e < count; e++) {
            run_file(argv[i], entries[e]->d_name, data, &runs);
            free(entries[e]);
        }
        free(entries);
    }
    free(data);
    printf("%zu inputs run\n", runs);
    return runs == 0;
}
