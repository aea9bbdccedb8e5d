/* test_folder.h - a temporary folder for a test. */
#ifndef FFD_TESTS_TEST_FOLDER_H
#define FFD_TESTS_TEST_FOLDER_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/ffd-test-XXXXXX";

static inline int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* Removes files, which may be missing, and the folder. Fails if a test has left anything else in it. */
static inline int remove_files(const char *const *paths, size_t count)
{
    for (size_t i = 0; i < count; i++)
        unlink(paths[i]);
    return rmdir(folder);
}

/* Returns a path in the folder, valid during the next seven calls. */
static inline const char *in_folder(const char *name)
{
    static char path[8][200];
    static int turn;
    turn = (turn + 1) % 8;
    assert_true(snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name) < (int)sizeof path[turn]);
    return path[turn];
}

/* Writes a file into the folder. */
static inline void put(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static inline void put_text(const char *name, const char *text)
{
    put(name, text, strlen(text));
}

#endif
