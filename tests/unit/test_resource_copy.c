/* test_resource_copy.c - copies of images that two processes make at once. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "mesh/resource/resource_copy.h"
#include <sys/stat.h>

static const char png[] = "\x89PNG\r\n\x1a\n";

/* What another process does between two looks at a copy. */
typedef struct other_process {
    bool finds;         /* there is a note, of the copy as it was before */
    const char *writes; /* what it puts in place of the copy; NULL: it removes it */
} other_process;

static bool find(void *context, const char *copy, hash128 *hash)
{
    const other_process *const other = context;
    *hash = ffd_hash("earlier", 7);
    if (other->writes)
        put("to/a.png", other->writes, strlen(other->writes));
    else
        assert_int_equal(unlink(copy), 0);
    return other->finds;
}

static ffd_status copy_beside(const other_process *other, ffd_error *error)
{
    put_text("a.png", png);
    put_text("to/a.png", "earlier");
    const copy_notes notes = {.find = find, .context = (void *)other};
    noted_copies noted = {.notes = &notes};
    const mesh_save_options options = {
        .path = in_folder("to/m.gltf"), .resources = FFD_RESOURCES_REFRESH, .noted = &noted};
    const resource_copier copier = {
        .mesh = {.file = in_folder("m.gltf")}, .from = folder, .to = in_folder("to"), .options = &options};
    const mesh_resource image = {.path = (char[]){"a.png"}, .kind = &ffd_resource_image};
    ffd_error refused = {0};
    const ffd_status status = ffd_resource_copy(&copier, &image, &refused, error);
    assert_int_equal(refused.status, FFD_OK);
    ffd_copies_free(&noted);
    return status;
}

/* What the other process has put there is what this one would have put there. */
static void a_copy_is_replaced_by_another_process(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("to"), 0777), 0);
    for (int finds = 0; finds < 2; finds++) {
        ffd_error error = {0};
        assert_int_equal(copy_beside(&(other_process){finds, png}, &error), FFD_OK);
        assert_int_equal(copy_beside(&(other_process){finds, NULL}, &error), FFD_OK);
        assert_int_equal(copy_beside(&(other_process){finds, "of others"}, &error), FFD_E_IO);
        assert_non_null(strstr(error.message, "is not the image to be copied there"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_is_replaced_by_another_process),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
