/* Descriptions of the jobs that make lattices of lattices, as no option and no keyword of Python gives them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <ffd/author.h>
#include <ffd/job.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

/* Counts the files that a job writes. */
static ffd_status count_file(void *user, const char *name, const void *data, size_t size)
{
    (void)name;
    (void)data;
    *(int *)user += size > 0;
    return FFD_OK;
}

/* A NumPy array (64, 3) of the points of a grid, u fastest. */
static size_t make_array(unsigned char bytes[2048])
{
    static const char header[] = "{'descr': '<f8', 'fortran_order': False, 'shape': (64, 3), }";
    const size_t length = 118;
    memcpy(bytes, "\x93NUMPY\x01\x00", 8);
    bytes[8] = length;
    bytes[9] = 0;
    memset(bytes + 10, ' ', length);
    memcpy(bytes + 10, header, sizeof header - 1);
    bytes[10 + length - 1] = '\n';
    for (size_t i = 0; i < 64; i++) {
        const double point[3] = {(double)(i % 4), (double)(i / 4 % 4), (double)(i / 16)};
        memcpy(bytes + 128 + 24 * i, point, sizeof point);
    }
    return 128 + 64 * 24;
}

static void sizes_and_degrees_of_an_array(void **state)
{
    static const struct {
        size_t size[3];
        int degree[3];
        ffd_status status;
        const char *message;
    } cases[] = {
        {{4, 4, 4}, {0, 0, 0}, FFD_OK, ""},
        {{4, 4, 4}, {3, 0, 1}, FFD_OK, ""},
        {{2, 16, 2}, {0, 14, 0}, FFD_OK, ""},
        {{0, 0, 0}, {0, 0, 0}, FFD_E_ARGUMENT, "has 64 points in a row"},
        {{0, 4, 4}, {0, 0, 0}, FFD_E_ARGUMENT, "size is 0 along u"},
        {{4, 0, 4}, {0, 0, 0}, FFD_E_ARGUMENT, "size is 0 along v"},
        {{4, 16, 0}, {0, 0, 0}, FFD_E_ARGUMENT, "size is 0 along w"},
        {{4, 4, SIZE_MAX}, {0, 0, 0}, FFD_E_INVALID, "needs another number"},
        {{SIZE_MAX, SIZE_MAX, 64}, {0, 0, 0}, FFD_E_INVALID, "needs another number"},
        {{1, 8, 8}, {0, 0, 0}, FFD_E_INVALID, "has 1 control point along u"},
        {{4, 4, 4}, {-1, 0, 0}, FFD_E_ARGUMENT, "degree -1 along u"},
        {{4, 4, 4}, {0, 0, 15}, FFD_E_ARGUMENT, "degree 15 along w"},
        {{4, 4, 4}, {0, INT_MAX, 0}, FFD_E_ARGUMENT, "along v"},
    };
    unsigned char bytes[2048];
    const size_t size = make_array(bytes);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ffd_author_desc job;
        ffd_convert_desc convert;
        ffd_error error = {0};
        int files = 0;
        ffd_author_desc_init(&job, sizeof job);
        ffd_convert_desc_init(&convert, sizeof convert);
        job.lattice = (ffd_lattice_source){.path = "grid.npy", .text = {bytes, size}};
        job.output = "grid.json";
        job.sink = count_file;
        job.sink_user = &files;
        memcpy(convert.size, cases[i].size, sizeof convert.size);
        memcpy(convert.degree, cases[i].degree, sizeof convert.degree);
        assert_int_equal(ffd_lattice_convert_run(&job, &convert, &error), cases[i].status);
        assert_int_equal(files, cases[i].status == FFD_OK);
        if (cases[i].status)
            assert_non_null(strstr(error.message, cases[i].message));
    }
    (void)state;
}

static void continuities_of_a_seam(void **state)
{
    static const char text[] = "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": "
                               "{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}}}";
    static const int refused[] = {INT_MIN, -1, 3, 14, INT_MAX - 1, INT_MAX};
    ffd_lattice *lattice, *sealed;
    assert_int_equal(ffd_lattice_parse(text, sizeof text - 1, "a.json", &lattice, NULL), FFD_OK);
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        assert_int_equal(ffd_lattice_seal(lattice, refused[i], FFD_FACES_ALL, &sealed, NULL), FFD_E_ARGUMENT);
        assert_null(sealed);
    }
    assert_int_equal(ffd_lattice_seal(lattice, 2, FFD_FACES_ALL, &sealed, NULL), FFD_OK);
    ffd_lattice_destroy(&sealed);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_and_degrees_of_an_array),
        cmocka_unit_test(continuities_of_a_seam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
