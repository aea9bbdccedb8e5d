/* test_file.c - outputs that are complete or absent, and reading from any kind of path. */
#define _DEFAULT_SOURCE /* syscall */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/file_content.h"
#include "../support/test_folder.h"
#include "base/file/output.h"
#include "base/file/written_files.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Replaces the C library's function, like file systems that report an exceeded quota only on closing. */
static bool closing_fails;

int close(int fd)
{
    const long result = syscall(SYS_close, fd);
    if (!closing_fails)
        return (int)result;
    errno = EDQUOT;
    return -1;
}

static file_output *begin(const char *name, bool force)
{
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder(name), force, NULL), FFD_OK);
    return output;
}

static void files_load_and_folders_are_refused(void **state)
{
    file_input input;
    ffd_error error;
    put_text("empty", "");
    assert_int_equal(ffd_file_load(in_folder("empty"), &input, &error), FFD_OK);
    assert_int_equal(input.size, 0);
    assert_non_null(input.data);
    ffd_file_unload(&input);
    assert_int_equal(ffd_file_load(in_folder("none"), &input, &error), FFD_E_IO);
    assert_int_equal(ffd_file_load(folder, &input, &error), FFD_E_IO);
    assert_string_equal(error.message, "is a folder");
    assert_int_equal(ffd_file_load("/dev/null", &input, &error), FFD_OK);
    assert_int_equal(input.size, 0);
    ffd_file_unload(&input);
    (void)state;
}

/* Writes bytes that differ from place to place. Free the copy with free(). */
static char *put_bytes(const char *name, size_t size)
{
    char *const bytes = malloc(size);
    FILE *const file = fopen(in_folder(name), "wb");
    assert_non_null(bytes);
    assert_non_null(file);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (char)(i * 31 + i / 251);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return bytes;
}

static void check_loaded(size_t size, bool mapped)
{
    file_input loaded, map;
    char *const bytes = put_bytes("sized", size);
    assert_int_equal(ffd_file_load(in_folder("sized"), &loaded, NULL), FFD_OK);
    assert_int_equal(ffd_file_map(in_folder("sized"), &map, NULL), FFD_OK);
    assert_int_equal(loaded.mapped, mapped);
    assert_true(map.mapped);
    assert_int_equal(loaded.size, size);
    assert_int_equal(map.size, size);
    assert_memory_equal(loaded.data, bytes, size);
    assert_memory_equal(map.data, bytes, size);
    assert_memory_equal(loaded.identity, map.identity, sizeof map.identity);
    ffd_file_unload(&map);
    ffd_file_unload(&loaded);
    free(bytes);
}

/* Small files are read, except when a mapping is asked for. */
static void small_files_are_read_and_large_ones_mapped(void **state)
{
    enum { SMALL = 1 << 18 };
    check_loaded(1, false);
    check_loaded(65537, false);
    check_loaded(SMALL - 1, false);
    check_loaded(SMALL, true);
    check_loaded(SMALL + 1, true);
    (void)state;
}

/* Released pages come back when they are read. */
static void released_pages_are_there_when_read_again(void **state)
{
    enum { SIZE = 100000 };
    char *text = malloc(SIZE + 1);
    file_input input;
    assert_non_null(text);
    for (size_t i = 0; i < SIZE; i++)
        text[i] = (char)('a' + i % 23);
    text[SIZE] = 0;
    put_text("long", text);
    assert_int_equal(ffd_file_map(in_folder("long"), &input, NULL), FFD_OK);
    assert_memory_equal(input.data, text, SIZE);
    ffd_file_release_pages(&input, input.data + 1, SIZE - 1);
    ffd_file_release_pages(&input, input.data, SIZE);
    ffd_file_release_pages(&input, input.data + 5000, 10);
    ffd_file_release_pages(&input, input.data + SIZE, 0);
    assert_memory_equal(input.data, text, SIZE);
    ffd_file_unload(&input);
    file_input held = {.data = (unsigned char *)text, .size = SIZE}; /* not mapped: nothing to release */
    ffd_file_release_pages(&held, text, SIZE);
    assert_int_equal(text[SIZE - 1], 'a' + (SIZE - 1) % 23);
    free(text);
    (void)state;
}

/* Returns the resident bytes of mapped files; 0 if the system does not tell. */
static size_t resident_bytes(void)
{
    FILE *const status = fopen("/proc/self/status", "r");
    char line[200];
    size_t kilobytes = 0;
    while (status && fgets(line, sizeof line, status))
        sscanf(line, "RssFile: %zu", &kilobytes);
    if (status)
        fclose(status);
    return kilobytes * 1024;
}

/* Pages that were read are released in large pieces, and come back when needed. */
static void releasing_in_pieces_bounds_memory(void **state)
{
    enum { SIZE = 20000000, STEP = 700001, PIECE = 1 << 23 };
    file_input input;
    size_t released = 0;
    const size_t before = resident_bytes();
    put_text("gone through", "");
    assert_int_equal(truncate(in_folder("gone through"), SIZE), 0);
    assert_int_equal(ffd_file_load(in_folder("gone through"), &input, NULL), FFD_OK);
    for (size_t at = 0; at < SIZE; at += STEP) {
        ffd_file_prefault(input.data + at, SIZE - at < STEP ? SIZE - at : STEP);
        assert_int_equal(input.data[at], 0);
        ffd_file_release_until(&input, input.data + at, &released);
        assert_int_equal(released, at / PIECE * PIECE);
        assert_true(before == 0 || resident_bytes() < before + PIECE + 4 * STEP);
    }
    ffd_file_release_until(&input, input.data, &released); /* never moves backwards */
    assert_int_equal(released, 2 * PIECE);
    assert_int_equal(input.data[0] | input.data[SIZE - 1], 0);
    ffd_file_unload(&input);
    (void)state;
}

static void no_file_outside_the_folder_is_loaded(void **state)
{
    file_input input;
    ffd_error error;
    assert_int_equal(mkdir(in_folder("model"), 0777), 0);
    put_text("secret.bin", "secret");
    put_text("model/a.bin", "inside");
    assert_int_equal(symlink("../secret.bin", in_folder("model/link.bin")), 0);
    size_t most = 10; /* too large to be read the second time */
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ffd_file_load_within(in_folder("model"), "a.bin", "m.gltf", &most, &input, &error),
                         FFD_OK);
        assert_int_equal(input.size, 6);
        assert_memory_equal(input.data, "inside", 6);
        assert_int_equal(input.mapped, i == 1);
        assert_int_equal(most, 4);
        ffd_file_unload(&input);
    }
    static const char *const refused[] = {"../secret.bin", "link.bin", "/etc/passwd", ".",
                                          "none.bin",      "../model"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        assert_int_equal(
            ffd_file_load_within(in_folder("model"), refused[i], "m.gltf", &most, &input, &error), FFD_E_IO);
        assert_string_equal(error.file, "m.gltf");
    }
    (void)state;
}

static void a_file_appears_only_when_committed(void **state)
{
    file_output *output = begin("new.txt", false);
    assert_int_equal(ffd_output_write(output, "hello", 5, NULL), FFD_OK);
    assert_false(ffd_file_exists(in_folder("new.txt")));
    assert_true(ffd_file_exists(in_folder(".new.txt.ffd-tmp")));
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_null(output);
    check_content("new.txt", "hello");
    assert_false(ffd_file_exists(in_folder(".new.txt.ffd-tmp")));
    (void)state;
}

/* Sizes around the limits for buffering and for direct writes, into two files of a set. */
static void pieces_of_any_size_are_written_whole(void **state)
{
    enum { HELD = 1 << 16, LARGEST = 3 * HELD + 1, PIECES = 60 };
    static const size_t sizes[] = {0, 1, 100, HELD - 1, HELD, HELD + 1, LARGEST};
    static const char *const names[] = {"pieces-a", "pieces-b"};
    unsigned char *bytes = malloc((size_t)LARGEST * PIECES);
    draw d = {draw_seed()};
    file_output *output;
    size_t size[2] = {0, 0};
    assert_non_null(bytes);
    for (size_t i = 0; i < (size_t)LARGEST * PIECES; i++)
        bytes[i] = (unsigned char)draw_number(&d);
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    for (int f = 0; f < 2; f++) {
        assert_int_equal(ffd_output_begin(output, in_folder(names[f]), true, NULL), FFD_OK);
        for (int piece = 0; piece < PIECES; piece++) {
            const size_t more = sizes[draw_int(&d, 0, sizeof sizes / sizeof *sizes - 1)];
            assert_int_equal(ffd_output_write(output, bytes + size[f], more, NULL), FFD_OK);
            size[f] += more;
        }
    }
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    for (int f = 0; f < 2; f++) {
        file_input input;
        assert_int_equal(ffd_file_load(in_folder(names[f]), &input, NULL), FFD_OK);
        assert_int_equal(input.size, size[f]);
        assert_memory_equal(input.data, bytes, size[f]);
        ffd_file_unload(&input);
        remove(in_folder(names[f]));
    }
    free(bytes);
    (void)state;
}

/* In small and large pieces, some of which are buffered. */
static void an_output_is_hashed_as_it_is_written(void **state)
{
    enum { SIZE = 300000 };
    unsigned char *bytes = malloc(SIZE);
    hash128 hash, expected;
    assert_non_null(bytes);
    for (size_t i = 0; i < SIZE; i++)
        bytes[i] = (unsigned char)(i * i >> 5);
    expected = ffd_hash(bytes, SIZE);
    for (size_t piece = 1000; piece <= 100000; piece *= 10) {
        file_output *output;
        assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
        assert_false(ffd_output_hash_value(output, &hash));
        ffd_output_hash(output);
        assert_false(ffd_output_hash_value(output, &hash)); /* no file was begun yet */
        assert_int_equal(ffd_output_begin(output, in_folder("hashed"), true, NULL), FFD_OK);
        for (size_t at = 0; at < SIZE; at += piece)
            assert_int_equal(ffd_output_write(output, bytes + at, piece, NULL), FFD_OK);
        assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
        assert_true(ffd_output_hash_value(output, &hash));
        assert_true(ffd_hash_equal(&hash, &expected));
        /* With two files, the hash of one would not describe the output. */
        assert_int_equal(ffd_output_begin(output, in_folder("beside"), true, NULL), FFD_OK);
        assert_false(ffd_output_hash_value(output, &hash));
        ffd_output_destroy(&output);
    }
    remove(in_folder("hashed"));
    free(bytes);
    (void)state;
}

/* Returns the next free file descriptor. If it is greater than before, a file was left open. */
static int next_descriptor(void)
{
    const int fd = open("/dev/null", O_RDONLY);
    assert_true(fd >= 0);
    close(fd);
    return fd;
}

static void a_dropped_output_leaves_the_old_file(void **state)
{
    const int next = next_descriptor();
    put_text("old.txt", "old");
    file_output *output = begin("old.txt", true);
    assert_int_equal(ffd_output_write(output, "newer", 5, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_int_equal(next_descriptor(), next);
    check_content("old.txt", "old");
    assert_false(ffd_file_exists(in_folder(".old.txt.ffd-tmp")));
    (void)state;
}

static void targets_that_cannot_be_written_are_refused(void **state)
{
    file_output *output;
    ffd_error error;
    put_text("there.txt", "there");
    assert_int_equal(ffd_output_create(&output, &error), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("there.txt"), false, &error), FFD_E_EXISTS);
    assert_int_equal(ffd_output_begin(output, folder, true, &error), FFD_E_IO);
    assert_int_equal(ffd_output_begin(output, in_folder("no/folder.txt"), true, &error), FFD_E_IO);
    ffd_output_destroy(&output);
    assert_int_equal(ffd_output_check(in_folder("there.txt"), false, &error), FFD_E_EXISTS);
    assert_int_equal(ffd_output_check(in_folder("there.txt"), true, &error), FFD_OK);
    assert_int_equal(ffd_output_check(in_folder("no/folder.txt"), true, &error), FFD_E_IO);
    assert_int_equal(ffd_output_check("-", false, &error), FFD_OK);
    check_content("there.txt", "there");
    (void)state;
}

/* Checks that a path is refused with this message, before any work. */
static void check_refused(const char *path, const char *message)
{
    file_output *output;
    ffd_error error;
    assert_int_equal(ffd_output_check(path, true, &error), FFD_E_IO);
    assert_string_equal(error.message, message);
    assert_int_equal(ffd_output_create(&output, &error), FFD_OK);
    assert_int_equal(ffd_output_begin(output, path, true, &error), FFD_E_IO);
    assert_string_equal(error.message, message);
    ffd_output_destroy(&output);
}

/* None of these is opened, or waited for. */
static void pipes_and_links_to_nothing_are_refused(void **state)
{
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    assert_int_equal(symlink("nowhere", in_folder("dangling")), 0);
    check_refused(in_folder("pipe"), "is a pipe, not a file (- writes to standard output)");
    check_refused(in_folder("dangling"), "is a link that leads to no file");
    assert_false(ffd_file_exists(in_folder("nowhere")));
    (void)state;
}

static void an_output_that_appears_is_not_replaced(void **state)
{
    static const char *const links[] = {NULL, "appeared.other"};
    for (int forced = 0; forced < 2; forced++)
        for (int i = 0; i < 2; i++) {
            ffd_error error;
            file_output *output = begin("appeared.txt", forced);
            assert_int_equal(ffd_output_write(output, "ours", 4, NULL), FFD_OK);
            if (links[i])
                assert_int_equal(symlink(links[i], in_folder("appeared.txt")), 0);
            else
                put_text("appeared.txt", "somebody's");
            const ffd_status status = ffd_output_commit(output, &error);
            ffd_output_destroy(&output);
            assert_int_equal(status, forced ? FFD_OK : FFD_E_EXISTS);
            if (forced)
                check_content("appeared.txt", "ours");
            else
                assert_string_equal(error.message, "exists already (force overwrites it)");
            if (!forced && !links[i])
                check_content("appeared.txt", "somebody's");
            assert_false(ffd_file_exists(in_folder("appeared.other")));
            assert_false(ffd_file_exists(in_folder(".appeared.txt.ffd-tmp")));
            assert_int_equal(unlink(in_folder("appeared.txt")), 0);
        }
    (void)state;
}

/* A temporary file of a killed run is taken over; one of a running program is not. */
static void a_leftover_is_taken_over_but_not_a_locked_one(void **state)
{
    ffd_error error;
    put_text(".locked.txt.ffd-tmp", "left by a run that was killed, and longer than what comes now");
    file_output *first = begin("locked.txt", false), *second;
    assert_int_equal(ffd_output_create(&second, &error), FFD_OK);
    assert_int_equal(ffd_output_begin(second, in_folder("locked.txt"), false, &error), FFD_E_IO);
    assert_string_equal(error.message, "is being written by another run");
    ffd_output_destroy(&second);
    assert_int_equal(ffd_output_write(first, "done", 4, &error), FFD_OK);
    assert_int_equal(ffd_output_commit(first, &error), FFD_OK);
    ffd_output_destroy(&first);
    check_content("locked.txt", "done");
    (void)state;
}

static void permissions_and_links_are_kept(void **state)
{
    struct stat info;
    put_text("mode.txt", "old");
    assert_int_equal(chmod(in_folder("mode.txt"), 0640), 0);
    assert_int_equal(symlink("mode.txt", in_folder("link.txt")), 0);
    file_output *output = begin("link.txt", true);
    assert_int_equal(ffd_output_write(output, "new", 3, NULL), FFD_OK);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    check_content("mode.txt", "new");
    assert_int_equal(stat(in_folder("mode.txt"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_int_equal(lstat(in_folder("link.txt"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    (void)state;
}

/* A leftover file gets the mode of its target. */
static void a_leftover_gets_the_mode_of_its_target(void **state)
{
    struct stat info;
    put_text(".fresh.txt.ffd-tmp", "left");
    assert_int_equal(chmod(in_folder(".fresh.txt.ffd-tmp"), 0400), 0);
    const mode_t mask = umask(027);
    file_output *output = begin("fresh.txt", false);
    umask(mask);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_int_equal(stat(in_folder("fresh.txt"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    check_content("fresh.txt", "");
    /* Something that is not a regular file is not a leftover. */
    assert_int_equal(mkfifo(in_folder(".fresh.txt.ffd-tmp"), 0600), 0);
    const int reader = open(in_folder(".fresh.txt.ffd-tmp"), O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("fresh.txt"), true, NULL), FFD_E_IO);
    ffd_output_destroy(&output);
    close(reader);
    assert_int_equal(unlink(in_folder(".fresh.txt.ffd-tmp")), 0);
    (void)state;
}

static struct timespec time_of(const char *name)
{
    struct stat info;
    assert_int_equal(stat(in_folder(name), &info), 0);
    return info.st_mtim;
}

/* Writes two files, which are kept if both are equal. replaced: for each, whether it was replaced. */
static void keep_equal(const char *a, const char *b, bool *replaced)
{
    static const struct timespec old[2] = {{.tv_sec = 1000}, {.tv_sec = 1000}};
    static const char *const names[] = {"keep-a.txt", "keep-b.txt"};
    const char *const texts[] = {a, b};
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    ffd_output_keep_equal(output);
    for (int i = 0; i < 2; i++) {
        utimensat(AT_FDCWD, in_folder(names[i]), old, 0);
        assert_int_equal(ffd_output_begin(output, in_folder(names[i]), true, NULL), FFD_OK);
        assert_int_equal(ffd_output_write(output, texts[i], strlen(texts[i]), NULL), FFD_OK);
    }
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    for (int i = 0; i < 2; i++) {
        check_content(names[i], texts[i]);
        replaced[i] = time_of(names[i]).tv_sec != 1000;
    }
    assert_false(ffd_file_exists(in_folder(".keep-a.txt.ffd-tmp")));
}

static void equal_outputs_leave_the_old_files(void **state)
{
    enum { LARGE = 9000000 };
    char *text = malloc(LARGE + 1);
    bool replaced[2];
    assert_non_null(text);
    memset(text, 'x', LARGE);
    text[LARGE] = 0;
    keep_equal(text, "", replaced);
    assert_true(replaced[0] && replaced[1]);
    keep_equal(text, "", replaced);
    assert_true(!replaced[0] && !replaced[1]);
    text[LARGE - 1] = 'y'; /* a difference of one byte in one file */
    keep_equal(text, "", replaced);
    assert_true(replaced[0] && replaced[1]);
    keep_equal(text, "z", replaced);
    assert_true(replaced[0] && replaced[1]);
    assert_int_equal(unlink(in_folder("keep-b.txt")), 0);
    keep_equal(text, "z", replaced);
    assert_true(replaced[0] && replaced[1]);
    free(text);
    (void)state;
}

/* Several files appear together, including large ones of many blocks. */
static void files_of_a_set_are_all_committed(void **state)
{
    enum { SIZE = 1000003 };
    unsigned char *bytes = malloc(SIZE);
    assert_non_null(bytes);
    for (int i = 0; i < SIZE; i++)
        bytes[i] = (unsigned char)(i * 7);
    put_text("set.gltf", "old");
    file_output *output = begin("set.bin", false);
    for (int i = 0; i < SIZE; i += 1000)
        assert_int_equal(ffd_output_write(output, bytes + i, SIZE - i < 1000 ? SIZE - i : 1000, NULL),
                         FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("set.gltf"), true, NULL), FFD_OK);
    assert_int_equal(ffd_output_write(output, "new", 3, NULL), FFD_OK);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    file_input input;
    assert_int_equal(ffd_file_load(in_folder("set.bin"), &input, NULL), FFD_OK);
    assert_int_equal(input.size, SIZE);
    assert_memory_equal(input.data, bytes, SIZE);
    ffd_file_unload(&input);
    check_content("set.gltf", "new");
    free(bytes);
    (void)state;
}

static void new_folders_go_unless_committed(void **state)
{
    (void)state;
    for (int commit = 0; commit < 2; commit++) {
        file_output *output;
        assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
        assert_int_equal(ffd_output_folder(output, in_folder("new"), NULL), FFD_OK);
        assert_int_equal(ffd_output_folder(output, in_folder("new/a/b"), NULL), FFD_OK);
        assert_int_equal(ffd_output_begin(output, in_folder("new/a/b/file"), false, NULL), FFD_OK);
        if (commit)
            assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
        ffd_output_destroy(&output);
        assert_int_equal(ffd_file_exists(in_folder("new")), commit);
    }
    /* An existing folder is kept. */
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_folder(output, in_folder("new/a/c"), NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_false(ffd_file_exists(in_folder("new/a/c")));
    assert_true(ffd_file_exists(in_folder("new/a/b/file")));
}

/* Another job, which fails, has made the folder and removes it because it is empty. */
static void folders_that_others_remove_are_made_again(void **state)
{
    (void)state;
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(mkdir(in_folder("others"), 0777), 0);
    assert_int_equal(ffd_output_folder(output, in_folder("others/a"), NULL), FFD_OK);
    assert_int_equal(rmdir(in_folder("others/a")), 0);
    assert_int_equal(rmdir(in_folder("others")), 0);
    assert_int_equal(ffd_output_begin(output, in_folder("others/a/file"), false, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_false(ffd_file_exists(in_folder("others")));
}

static void a_full_disk_is_reported(void **state)
{
    file_output *output;
    ffd_error error;
    if (!ffd_file_exists("/dev/full"))
        skip();
    assert_int_equal(ffd_output_create(&output, &error), FFD_OK);
    assert_int_equal(ffd_output_begin(output, "/dev/full", false, &error), FFD_OK);
    assert_int_equal(ffd_output_write(output, "x", 1, &error), FFD_OK);
    assert_int_equal(ffd_output_commit(output, &error), FFD_E_IO);
    ffd_output_destroy(&output);
    (void)state;
}

/* Writing is confirmed (close) before the old file is replaced. */
static void a_failed_close_leaves_the_old_file(void **state)
{
    ffd_error error;
    put_text("late.txt", "old");
    file_output *output = begin("late.txt", true);
    assert_int_equal(ffd_output_write(output, "new", 3, NULL), FFD_OK);
    closing_fails = true;
    const ffd_status status = ffd_output_commit(output, &error);
    closing_fails = false;
    ffd_output_destroy(&output);
    assert_int_equal(status, FFD_E_IO);
    assert_string_equal(error.file, in_folder("late.txt"));
    check_content("late.txt", "old");
    assert_false(ffd_file_exists(in_folder(".late.txt.ffd-tmp")));
    (void)state;
}

static void write_file(const char *name, bool force, written_files *written, ffd_status expected)
{
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    ffd_output_record(output, written);
    assert_int_equal(ffd_output_begin(output, in_folder(name), force, NULL), expected);
    if (expected == FFD_OK) {
        assert_int_equal(ffd_output_write(output, name, strlen(name), NULL), FFD_OK);
        assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    }
    ffd_output_destroy(&output);
}

/* A written file is recognized under any name that leads to it; a file that others have put in its place is
   not. */
static void written_files_are_known_by_any_name(void **state)
{
    written_files written = {0};
    char link_path[4096];
    put_text("w-before", "");
    for (int i = 0; i < 100; i++) {
        char name[16];
        snprintf(name, sizeof name, "w%d", i);
        assert_false(ffd_written_holds(&written, in_folder(name)));
        write_file(name, false, &written, FFD_OK);
        assert_true(ffd_written_holds(&written, in_folder(name)));
    }
    for (int i = 0; i < 100; i++) {
        char name[16];
        snprintf(name, sizeof name, "./w%d", i);
        assert_true(ffd_written_holds(&written, in_folder(name)));
        write_file(name, true, &written, FFD_E_EXISTS);
    }
    assert_false(ffd_written_holds(&written, in_folder("w-before")));
    assert_false(ffd_written_holds(&written, in_folder("w-none")));

    snprintf(link_path, sizeof link_path, "%s", in_folder("w-link"));
    assert_int_equal(link(in_folder("w7"), link_path), 0);
    assert_true(ffd_written_holds(&written, link_path));
    assert_int_equal(unlink(in_folder("w7")), 0);
    assert_false(
        ffd_written_holds(&written, link_path)); /* the name it was written under has no file any more */
    write_file("w7", false, &written, FFD_OK);
    assert_true(ffd_written_holds(&written, in_folder("w7")));
    ffd_written_free(&written);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_load_and_folders_are_refused),
        cmocka_unit_test(small_files_are_read_and_large_ones_mapped),
        cmocka_unit_test(released_pages_are_there_when_read_again),
        cmocka_unit_test(releasing_in_pieces_bounds_memory),
        cmocka_unit_test(no_file_outside_the_folder_is_loaded),
        cmocka_unit_test(a_file_appears_only_when_committed),
        cmocka_unit_test(pieces_of_any_size_are_written_whole),
        cmocka_unit_test(an_output_is_hashed_as_it_is_written),
        cmocka_unit_test(a_dropped_output_leaves_the_old_file),
        cmocka_unit_test(targets_that_cannot_be_written_are_refused),
        cmocka_unit_test(pipes_and_links_to_nothing_are_refused),
        cmocka_unit_test(an_output_that_appears_is_not_replaced),
        cmocka_unit_test(a_leftover_is_taken_over_but_not_a_locked_one),
        cmocka_unit_test(permissions_and_links_are_kept),
        cmocka_unit_test(a_leftover_gets_the_mode_of_its_target),
        cmocka_unit_test(equal_outputs_leave_the_old_files),
        cmocka_unit_test(files_of_a_set_are_all_committed),
        cmocka_unit_test(written_files_are_known_by_any_name),
        cmocka_unit_test(new_folders_go_unless_committed),
        cmocka_unit_test(folders_that_others_remove_are_made_again),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(a_failed_close_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
