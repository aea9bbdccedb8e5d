/* test_share.c - a mesh that is kept for the next job is not taken for one that has changed. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "job/share.h"
#include "job/source.h"
#include <time.h>

static const char one[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                  other[] = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";

static mesh_document *opened(const ffd_deform_desc *desc)
{
    mesh_document *document;
    assert_int_equal(ffd_source_open(&desc->input, 1, &document, NULL), FFD_OK);
    return document;
}

/* Waits until files that are written have another time. */
static void let_time_pass(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

/* Keeps the mesh as a job does that had opened it when its file had this stamp. */
static void keep(ffd_share *share, const ffd_deform_desc *desc, const file_stamp *stamp)
{
    mesh_document *const document = opened(desc);
    ffd_share_note_mesh(share, desc, false, stamp, document);
    ffd_share_keep_mesh(share, desc, document);
}

static bool takes(ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    mesh_document *document = ffd_share_take_mesh(share, desc, only_positions);
    const bool taken = document != NULL;
    ffd_source_close(&document);
    return taken;
}

static void test_mesh(void **state)
{
    ffd_share *share;
    ffd_deform_desc desc, differs;
    file_stamp stamp;
    assert_int_equal(ffd_share_create(&share, NULL), FFD_OK);
    ffd_deform_desc_init(&desc);
    put_text("m.obj", one);
    desc.input.path = in_folder("m.obj");
    assert_true(ffd_file_stamp(desc.input.path, &stamp));

    assert_false(takes(share, &desc, false));
    keep(share, &desc, &stamp);
    assert_true(takes(share, &desc, false));
    assert_false(takes(share, &desc, false)); /* it was taken and not given back */

    keep(share, &desc, &stamp);
    assert_false(takes(share, &desc, true));
    keep(share, &desc, &stamp);
    differs = desc;
    differs.input.memory = 1 << 30;
    assert_false(takes(share, &differs, false));
    keep(share, &desc, &stamp);
    differs = desc;
    differs.as_morph = "name"; /* would change the document itself */
    assert_false(takes(share, &differs, false));

    /* The same size, a moment later. */
    keep(share, &desc, &stamp);
    let_time_pass();
    put_text("m.obj", other);
    assert_false(takes(share, &desc, false));
    /* Changed between the stamp and the opening, or while the job read it. */
    keep(share, &desc, &stamp);
    assert_false(takes(share, &desc, false));
    ffd_share_destroy(&share);
    (void)state;
}

static void test_selection(void **state)
{
    static const char *const only[] = {"group:a"}, *const others[] = {"group:b"};
    ffd_share *share;
    ffd_deform_desc desc;
    file_stamp stamp;
    assert_int_equal(ffd_share_create(&share, NULL), FFD_OK);
    ffd_deform_desc_init(&desc);
    put_text("g.obj", "g a\nv 0 0 0\ng b\nv 1 0 0\n");
    desc.input.path = in_folder("g.obj");
    desc.only = only;
    desc.only_count = 1;
    assert_true(ffd_file_stamp(desc.input.path, &stamp));
    keep(share, &desc, &stamp);
    assert_true(takes(share, &desc, false));
    keep(share, &desc, &stamp);
    desc.only = others;
    assert_false(takes(share, &desc, false));
    ffd_share_destroy(&share);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_selection),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
