/* test_glob.c - patterns find the files that those of the C library find, and characters beyond ASCII. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/file/folder.h"
#include "base/file/glob.h"
#include "base/file/pattern.h"
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <glob.h>
#include <sys/stat.h>

/* Instead of that of the C library: a disk that fails after so many entries; 0: it does not. */
static int entries_left;

struct dirent *readdir(DIR *open)
{
    static struct dirent *(*next)(DIR *);
    if (!next)
        *(void **)&next = dlsym(RTLD_NEXT, sizeof(long) == 8 ? "readdir" : "readdir64");
    if (entries_left > 0 && --entries_left == 0) {
        errno = EIO;
        return NULL;
    }
    return next(open);
}

static bool matches(const char *pattern, const char *name)
{
    return ffd_pattern_matches(pattern, strlen(pattern), name);
}

static void characters_are_those_of_utf8(void **state)
{
    assert_true(matches("?.obj", "\u00e9.obj"));
    assert_true(matches("??.obj", "\u9f8d\u732b.obj"));
    assert_false(matches("?.obj", "\u9f8d\u732b.obj"));
    assert_true(matches("[\u0430-\u044f]*.obj", "\u043a\u043e\u0442.obj"));
    assert_false(matches("[!\u0430-\u044f]*.obj", "\u043a\u043e\u0442.obj"));
    assert_true(matches("?", "\U0001f431"));
    assert_true(matches("\U0001f431*", "\U0001f431.obj"));
    assert_true(matches("?"
                        "?",
                        "\xff\xe9")); /* no UTF-8: bytes */
    assert_true(matches("\xe9*", "\xe9\x9f"));
    assert_false(matches("[a-\U0010ffff]", "\xff"));
    (void)state;
}

/* Names and patterns of these pieces have what has a meaning in patterns at every place. */
static void draw_text(draw *d, const char *const *pieces, int count, int most, char text[64])
{
    *text = 0;
    for (int i = draw_int(d, 1, most); i > 0; i--)
        strcat(text, pieces[draw_int(d, 0, count - 1)]);
}

static void make_tree(draw *d)
{
    static const char *const pieces[] = {"a", "b", "c", "A", "B", "1",  "-", "[",
                                         "]", "!", ".", " ", "^", "\\", "*"};
    char name[64], path[160];
    for (int i = 0; i < 60; i++) {
        draw_text(d, pieces, sizeof pieces / sizeof *pieces, 3, name);
        const char *const below = i % 3 ? "" : "ab/";
        snprintf(path, sizeof path, "%s/%s%s", folder, below, name);
        FILE *const file = i % 10 == 1 ? NULL : fopen(path, "w");
        if (file)
            fclose(file);
        else
            mkdir(path, 0700); /* may be there */
    }
}

/* Makes several slashes one: how many of them a path has is as in the pattern, or as the C library likes. */
static char *squeeze(char *path)
{
    char *to = path;
    for (const char *from = path; *from; from++)
        if (!(from[0] == '/' && from[1] == '/'))
            *to++ = *from;
    *to = 0;
    return path;
}

/* Where the C library differs: a backslash that takes no character's meaning is one here, and nothing there;
   [.a.] and [=a=] mean nothing here; a file with a slash behind it is found there; and there "*?[!a]" does
   not match "a.". */
static bool is_different(const char *pattern)
{
    if (strstr(pattern, "[.") || strstr(pattern, "[=") || strstr(pattern, "*?") ||
        (strrchr(pattern, '[') && !strchr(strrchr(pattern, '['), ']')) || pattern[strlen(pattern) - 1] == '/')
        return true;
    for (const char *c = strchr(pattern, '\\'); c; c = strchr(c + 2, '\\'))
        if (c[1] == 0 || c[1] == '/')
            return true;
    return false;
}

static void check(const char *text)
{
    char pattern[256];
    glob_t wanted = {0};
    path_list found = {0};
    snprintf(pattern, sizeof pattern, "%s/%s", folder, text + (*text == '/'));
    const int result = glob(pattern, GLOB_NOSORT, NULL, &wanted);
    assert_true(result == 0 || result == GLOB_NOMATCH);
    assert_int_equal(ffd_glob(pattern, &found, NULL), FFD_OK);
    for (size_t k = 0; k < wanted.gl_pathc; k++)
        squeeze(wanted.gl_pathv[k]);
    for (size_t i = 0, k; i < found.count; i++) {
        squeeze(found.paths[i]);
        for (k = 0; k < wanted.gl_pathc && strcmp(found.paths[i], wanted.gl_pathv[k]) != 0;)
            k++;
        if (k == wanted.gl_pathc)
            fail_msg("%s finds %s, which glob() does not", pattern, found.paths[i]);
    }
    if (found.count != wanted.gl_pathc)
        fail_msg("%s finds %zu files, and glob() %zu", pattern, found.count, wanted.gl_pathc);
    for (size_t i = 1; i < found.count; i++)
        assert_true(strcmp(found.paths[i - 1], found.paths[i]) < 0);
    globfree(&wanted);
    ffd_paths_free(&found);
}

static void patterns_find_what_those_of_the_c_library_find(void **state)
{
    static const char *const pieces[] = {"a",
                                         "b",
                                         "A",
                                         "1",
                                         "-",
                                         "*",
                                         "*",
                                         "?",
                                         "[",
                                         "]",
                                         "!",
                                         "^",
                                         ".",
                                         "\\",
                                         "/",
                                         "//",
                                         "[a",
                                         "b]",
                                         "[!a]",
                                         "[]-a]",
                                         "[a-c]",
                                         "*/",
                                         "?",
                                         " ",
                                         "[[",
                                         "a*",
                                         "ab/",
                                         ".*",
                                         "[^",
                                         "[[:alpha:]]",
                                         "[[:upper:]1]",
                                         "{a,b}",
                                         "~"};
    draw d = {draw_seed()};
    char pattern[64 * 12];
    (void)state;
    assert_int_equal(mkdir(in_folder("ab"), 0700), 0);
    make_tree(&d);
    for (int i = repetitions(4000); i > 0; i--) {
        draw_text(&d, pieces, sizeof pieces / sizeof *pieces, 4, pattern);
        if (!is_different(squeeze(pattern)))
            check(pattern);
    }
    check("a*/");
    check("*/*");
    check("");
}

static void a_list_that_a_disk_breaks_off_is_an_error(void **state)
{
    static const char *const names[] = {"disk/1.obj", "disk/2.obj", "disk/3.obj", "disk/4.obj"};
    path_list found = {0};
    ffd_error error;
    (void)state;
    assert_int_equal(mkdir(in_folder("disk"), 0700), 0);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        fclose(fopen(in_folder(names[i]), "w"));
    char made[256], pattern[256];
    snprintf(made, sizeof made, "%s", in_folder("disk"));
    snprintf(pattern, sizeof pattern, "%s", in_folder("disk/*.obj"));
    assert_int_equal(ffd_folder_list(made, &found, &error), FFD_OK);
    assert_int_equal(found.count, 6); /* with . and .. */
    for (int left = 1; left <= 7; left++) {
        entries_left = left;
        assert_int_equal(ffd_folder_list(made, &found, &error), FFD_E_IO);
        entries_left = left;
        assert_int_equal(ffd_folder_walk(made, &found, &error), FFD_E_IO);
        entries_left = left;
        assert_int_equal(ffd_glob(pattern, &found, &error), FFD_E_IO);
        assert_non_null(strstr(error.message, "to its end"));
    }
    entries_left = 0;
    ffd_paths_free(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(characters_are_those_of_utf8),
        cmocka_unit_test_setup(patterns_find_what_those_of_the_c_library_find, make_folder),
        cmocka_unit_test_teardown(a_list_that_a_disk_breaks_off_is_an_error, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
