/* test_place.c - the place that a path leads to: one for all its names, before and after the file and its
   folders are made. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/file/place.h"
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

static file_places places;

static bool same(const char *a, const char *b)
{
    char first[PATH_MAX];
    snprintf(first, sizeof first, "%s", in_folder(a));
    const hash128 x = ffd_place_of(NULL, first), y = ffd_place_of(NULL, in_folder(b));
    const hash128 kept_x = ffd_place_of(&places, first), kept_y = ffd_place_of(&places, in_folder(b));
    const bool is_same = ffd_hash_equal(&x, &y);
    assert_int_equal(is_same, ffd_hash_equal(&kept_x, &kept_y));
    return is_same;
}

static void names_of_one_file(void **state)
{
    char target[PATH_MAX];
    assert_int_equal(mkdir(in_folder("sub"), 0777), 0);
    snprintf(target, sizeof target, "%s", in_folder("sub"));
    assert_int_equal(symlink(target, in_folder("link")), 0);
    for (int there = 0; there < 2; there++) {
        assert_true(same("o", "./o") && same("o", "sub/../o") && same("sub/o", "link/o"));
        assert_false(same("o", "sub/o") || same("o", "p") || same("o", "O"));
        put_text("o", "x");
        put_text("sub/o", "y");
    }
    snprintf(target, sizeof target, "%s", in_folder("o"));
    assert_int_equal(symlink(target, in_folder("other")), 0);
    assert_true(same("other", "o"));
    /* Links to what is not there yet: a file, by way of another link, and a folder; and links in a circle. */
    assert_int_equal(symlink("sub/later", in_folder("early")), 0);
    assert_int_equal(symlink("early", in_folder("earlier")), 0);
    assert_int_equal(symlink("sub/new", in_folder("folder")), 0);
    assert_int_equal(symlink("round", in_folder("circle")), 0);
    assert_int_equal(symlink("circle", in_folder("round")), 0);
    assert_true(same("early", "sub/later") && same("earlier", "sub/later") && same("folder/o", "sub/new/o"));
    assert_false(same("circle", "round"));
    assert_false(same("none/o", "o"));
    (void)state;
}

/* A run may make the folders of its outputs while it goes on. */
static void a_place_stays_when_its_folders_are_made(void **state)
{
    file_places kept = {0};
    const hash128 before = ffd_place_of(&kept, in_folder("new/./deep/o")),
                  alone = ffd_place_of(NULL, in_folder("new/deep/o"));
    assert_true(ffd_hash_equal(&before, &alone));
    assert_true(same("new/deep/o", "new/x/../deep//o"));
    assert_int_equal(mkdir(in_folder("new"), 0777), 0);
    assert_int_equal(mkdir(in_folder("new/deep"), 0777), 0);
    put_text("new/deep/o", "x");
    assert_true(same("new/deep/o", "sub/../new/deep/o"));
    const hash128 after = ffd_place_of(NULL, in_folder("new/deep/o")),
                  later = ffd_place_of(&kept, in_folder("new/deep/o"));
    assert_true(ffd_hash_equal(&before, &after) && ffd_hash_equal(&before, &later));
    ffd_places_free(&kept);
    (void)state;
}

static void names_without_a_folder_are_in_the_current_one(void **state)
{
    char old[PATH_MAX], whole[PATH_MAX];
    assert_non_null(getcwd(old, sizeof old));
    snprintf(whole, sizeof whole, "%s", in_folder("q"));
    assert_int_equal(chdir(in_folder("")), 0);
    const hash128 short_name = ffd_place_of(NULL, "q"), long_name = ffd_place_of(NULL, whole),
                  new_folder = ffd_place_of(NULL, "n/q");
    snprintf(whole, sizeof whole, "%s", in_folder("n/q"));
    const hash128 long_folder = ffd_place_of(NULL, whole);
    assert_int_equal(chdir(old), 0);
    assert_true(ffd_hash_equal(&short_name, &long_name) && ffd_hash_equal(&new_folder, &long_folder));
    (void)state;
}

static int remove_all(void **state)
{
    ffd_places_free(&places);
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_one_file),
        cmocka_unit_test(a_place_stays_when_its_folders_are_made),
        cmocka_unit_test(names_without_a_folder_are_in_the_current_one),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_all);
}
