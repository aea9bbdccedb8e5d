/* test_older_callers.c - callers compiled with an older header, with shorter structs: nothing is written
   beyond their size, and missing members have defaults. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/locations.h"
#include "../support/test_folder.h"
#include <ffd/ffd.h>

#define BEHIND 0x5a

/* A struct of which the caller knows the first `known` bytes; the bytes behind are checked. */
#define OLDER(type, name, known_bytes)                                                                       \
    union {                                                                                                  \
        type as;                                                                                             \
        unsigned char bytes[sizeof(type) + 64];                                                              \
    } name;                                                                                                  \
    const size_t name##_known = (known_bytes);                                                               \
    memset(name.bytes, BEHIND, sizeof name.bytes)

static void guarded(const unsigned char *bytes, size_t known, size_t size)
{
    for (size_t i = known; i < size; i++)
        if (bytes[i] != BEHIND)
            fail_msg("byte %zu of %zu was written; the caller knows %zu", i, size, known);
}

#define GUARDED(name) guarded(name.bytes, name##_known, sizeof name.bytes)

static const char cube[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
static const char lattice[] =
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":[0,0,"
    "0],\"max\":[1,1,1]}},\"moves\":[{\"by\":[0,0,1]}]}";

static void fill_folder(void)
{
    put_text("a.obj", cube);
    put_text("l.json", lattice);
}

static void jobs_of_older_callers_run(void **state)
{
    fill_folder();
    char input[100], output[100], file[100];
    strcpy(input, in_folder("a.obj"));
    strcpy(output, in_folder("b.obj"));
    strcpy(file, in_folder("l.json"));
    const ffd_lattice_source lattices[] = {{.path = file}};
    OLDER(ffd_deform_desc, desc, offsetof(ffd_deform_desc, depfile));
    OLDER(ffd_job_result, result, offsetof(ffd_job_result, seconds));
    ffd_deform_desc_init(&desc.as, desc_known);
    GUARDED(desc);
    assert_int_equal(desc.as.struct_size, desc_known);
    desc.as.input.path = input;
    desc.as.output = output;
    desc.as.lattices = lattices;
    desc.as.lattice_count = 1;
    result.as.struct_size = result_known;
    assert_int_equal(ffd_deform_run(&desc.as, &result.as, NULL), FFD_OK);
    GUARDED(desc);
    GUARDED(result);
    assert_int_equal(result.as.struct_size, result_known);
    assert_int_equal(result.as.vertices, 3);
    assert_int_equal(result.as.moved, 3);
    assert_int_equal(ffd_check_run(&desc.as, &result.as, NULL), FFD_OK);
    GUARDED(result);
    (void)state;
}

static void comparisons_of_older_callers_run(void **state)
{
    fill_folder();
    char input[100];
    strcpy(input, in_folder("a.obj"));
    OLDER(ffd_compare_desc, desc, offsetof(ffd_compare_desc, log));
    OLDER(ffd_comparison, comparison, offsetof(ffd_comparison, first));
    ffd_compare_desc_init(&desc.as, desc_known);
    GUARDED(desc);
    desc.as.a.path = desc.as.b.path = input;
    comparison.as.struct_size = comparison_known;
    assert_int_equal(ffd_compare_run(&desc.as, &comparison.as, NULL), FFD_OK);
    GUARDED(comparison);
    assert_true(comparison.as.equal);
    (void)state;
}

static void descriptions_of_older_callers_are_enough(void **state)
{
    fill_folder();
    char input[100], output[100], file[100], *text;
    strcpy(input, in_folder("a.obj"));
    strcpy(output, in_folder("new.json"));
    strcpy(file, in_folder("l.json"));
    OLDER(ffd_info_desc, info, offsetof(ffd_info_desc, log));
    ffd_info_desc_init(&info.as, info_known);
    GUARDED(info);
    info.as.file.path = input;
    assert_int_equal(ffd_info_run(&info.as, &text, NULL), FFD_OK);
    ffd_free(text);
    OLDER(ffd_embed_desc, embed, offsetof(ffd_embed_desc, set));
    ffd_embed_desc_init(&embed.as, embed_known);
    GUARDED(embed);
    char npy[100];
    strcpy(npy, in_folder("e.npy"));
    embed.as.input.path = input;
    embed.as.lattice.path = file;
    embed.as.output = npy;
    assert_int_equal(ffd_embed_run(&embed.as, NULL, NULL), FFD_OK);
    OLDER(ffd_lattice_desc, round, offsetof(ffd_lattice_desc, principal));
    ffd_lattice_desc_init(&round.as, round_known);
    GUARDED(round);
    OLDER(ffd_lattice_new_desc, made, offsetof(ffd_lattice_new_desc, log));
    ffd_lattice_new_desc_init(&made.as, made_known);
    GUARDED(made);
    const ffd_source meshes[] = {{.path = input}};
    made.as.meshes = meshes;
    made.as.mesh_count = 1;
    made.as.lattice = &round.as;
    made.as.output = output;
    assert_int_equal(ffd_lattice_new_run(&made.as, NULL), FFD_OK);
    (void)state;
}

static ffd_lattice *parsed(void)
{
    ffd_lattice *made = NULL;
    assert_int_equal(ffd_lattice_parse(lattice, sizeof lattice - 1, "l.json", &made, NULL), FFD_OK);
    return made;
}

static void folds_of_older_callers_are_found(void **state)
{
    ffd_lattice *made = parsed();
    OLDER(ffd_folds, folds, offsetof(ffd_folds, witness));
    folds.as.struct_size = folds_known;
    assert_int_equal(ffd_folds_find(made, 1, &folds.as, NULL), FFD_OK);
    GUARDED(folds);
    assert_int_equal(folds.as.struct_size, folds_known);
    assert_int_equal(folds.as.verdict, FFD_FOLDS_NONE);
    assert_int_equal(folds.as.cells, 1);
    folds.as.struct_size = sizeof folds.as + 8;
    assert_int_equal(ffd_folds_find(made, 1, &folds.as, NULL), FFD_E_ARGUMENT);
    GUARDED(folds);
    ffd_lattice_destroy(&made);
    (void)state;
}

/* More points than a batch; every other one is outside, except for the snap. */
#define POINTS 700
static void locations_of_older_callers_are_found(void **state)
{
    ffd_lattice *made = parsed();
    ffd_locator *locator = NULL;
    assert_int_equal(ffd_locator_create(made, &locator, NULL), FFD_OK);
    static double xyz[3 * POINTS], rounding[3 * POINTS];
    static ffd_location now[POINTS];
    const size_t known = offsetof(ffd_location, leaves);
    static unsigned char older[POINTS * sizeof(ffd_location)];
    for (size_t i = 0; i < POINTS; i++)
        for (int a = 0; a < 3; a++) {
            xyz[3 * i + a] = i % 2 && !a ? 1 + 1e-3 : (double)i / POINTS;
            rounding[3 * i + a] = i % 6 == 3 ? 1e-2 : 0;
        }
    ffd_border_allowance allowance = {sizeof allowance, rounding, 0};
    memset(older, BEHIND, sizeof older);
    assert_int_equal(ffd_locator_locate(locator, xyz, POINTS, &allowance, now, sizeof *now, NULL), FFD_OK);
    assert_int_equal(
        ffd_locator_locate(locator, xyz, POINTS, &allowance, (ffd_location *)(void *)older, known, NULL),
        FFD_OK);
    for (size_t i = 0; i < POINTS; i++) {
        assert_int_equal(now[i].status, i % 2 && i % 6 != 3 ? FFD_VERTEX_OUTSIDE : FFD_VERTEX_INSIDE);
        ffd_location then = {.leaves = now[i].leaves};
        memcpy(&then, older + known * i, known);
        assert_true(same_locations(&then, &now[i]));
    }
    guarded(older, known * POINTS, sizeof older);
    const size_t bad[] = {0, 3, sizeof *now + 8};
    for (size_t b = 0; b < 3; b++)
        assert_int_equal(ffd_locator_locate(locator, xyz, 1, NULL, now, bad[b], NULL), FFD_E_ARGUMENT);
    allowance.struct_size++;
    assert_int_equal(ffd_locator_locate(locator, xyz, 1, &allowance, now, sizeof *now, NULL), FFD_E_ARGUMENT);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&made);
    (void)state;
}

static void sizes_that_cannot_be_are_refused(void **state)
{
    fill_folder();
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = 0};
    ffd_error error;
    ffd_deform_desc_init(&desc, sizeof desc);
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "ffd_job_result"));
    result.struct_size = sizeof result + 1;
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "older than the caller's header"));
    result.struct_size = sizeof result;
    desc.struct_size = sizeof desc + 1;
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_ARGUMENT);
    assert_int_equal(result.status, FFD_E_ARGUMENT);
    ffd_jacobian_desc derivative;
    ffd_jacobian_result matrix = {.struct_size = sizeof matrix + 1};
    ffd_jacobian_desc_init(&derivative, sizeof derivative);
    assert_int_equal(ffd_jacobian_run(&derivative, &matrix, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "ffd_jacobian_result"));
    (void)state;
}

/* Structs that callers put in arrays or in other structs never change size. */
static void other_structs_have_their_size(void **state)
{
    if (sizeof(void *) == 8) {
        assert_int_equal(sizeof(ffd_error), 1808);
        assert_int_equal(sizeof(ffd_span), 40);
        assert_int_equal(sizeof(ffd_csr), 40);
        assert_int_equal(sizeof(ffd_setting), 16);
        assert_int_equal(sizeof(ffd_bounds), 48);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_of_older_callers_run),
        cmocka_unit_test(comparisons_of_older_callers_run),
        cmocka_unit_test(descriptions_of_older_callers_are_enough),
        cmocka_unit_test(folds_of_older_callers_are_found),
        cmocka_unit_test(locations_of_older_callers_are_found),
        cmocka_unit_test(sizes_that_cannot_be_are_refused),
        cmocka_unit_test(other_structs_have_their_size),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
