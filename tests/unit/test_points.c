/* test_points.c - arrays of points in memory: the results are exactly those of a job on a file; also parts,
   strides, derivatives, serialization, refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/memory/hash.h"
#include "base/memory/memory.h"
#include <ffd/ffd.h>
#include <math.h>

#define POINTS ((size_t)3000)

/* Rest volumes for each of the three methods of inversion, including rational and closed ones. */
static const char *const rests[] = {
    "\"size\":[5,4,6],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[5,5,5],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1],\"spacing\":\"uniform\"}}",
    "\"size\":[3,6,3],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0.3,1],"
    "\"height\":2}}",
    "\"size\":[3,3,3],\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,0.5,1,1,1,1,2,1,1,1,1,1,3,1,1],"
    "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
};
#define RESTS (sizeof rests / sizeof *rests)
#define MOVES                                                                                                \
    "{\"twist\":{\"axis\":\"z\",\"degrees\":40}},{\"at\":[-1,\"all\",\"all\"],\"by\":[0.3,0.1,-0.2]},"       \
    "{\"at\":[0,0,0],\"by\":[0,0,0.1]}"

static ffd_lattice *lattice_of(size_t i, const char *moves)
{
    return make(rests[i], moves);
}

/* Points in and around the volumes, some on faces, one not finite. */
static void fill_points(double *xyz, draw *d)
{
    for (size_t i = 0; i < 3 * POINTS; i++)
        xyz[i] = draw_int(d, 0, 20) == 0 ? draw_int(d, -1, 1) : draw_between(d, -1.2, 1.2);
    xyz[3 * 17 + 1] = (double)NAN;
}

static void narrow(const double *from, float *to)
{
    for (size_t i = 0; i < 3 * POINTS; i++)
        to[i] = (float)from[i];
}

static ffd_span span_of(void *data, ffd_number type)
{
    return (ffd_span){.data = data, .count = POINTS, .type = type};
}

static size_t size_of(ffd_number type)
{
    return type == FFD_FLOAT32 ? sizeof(float) : sizeof(double);
}

static ffd_embedding *embed(const ffd_lattice *lattice, ffd_span points, ffd_outside outside, double falloff)
{
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    ffd_error error = {0};
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = points;
    desc.outside = outside;
    desc.falloff = falloff;
    if (ffd_embedding_create(&desc, NULL, &embedding, &error))
        fail_msg("%s", error.message);
    return embedding;
}

static void deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in, ffd_span out)
{
    ffd_error error = {0};
    if (ffd_embedding_deform(embedding, moved, in, out, NULL, NULL, &error))
        fail_msg("%s", error.message);
}

/* Deforms a PLY with these points by a job. */
static void deform_file(const ffd_lattice *lattice, const void *points, ffd_number type, ffd_outside outside,
                        double falloff, void *result)
{
    const size_t size = 3 * POINTS * size_of(type);
    char head[200];
    const int length =
        snprintf(head, sizeof head,
                 "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty %s x\n"
                 "property %s y\nproperty %s z\nend_header\n",
                 POINTS, type == FFD_FLOAT32 ? "float" : "double", type == FFD_FLOAT32 ? "float" : "double",
                 type == FFD_FLOAT32 ? "float" : "double");
    FILE *file = fopen(in_folder("in.ply"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(head, 1, (size_t)length, file), (size_t)length);
    assert_int_equal(fwrite(points, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    ffd_error error = {0};
    if (ffd_lattice_save(lattice, in_folder("l.json"), true, &error))
        fail_msg("%s", error.message);
    const ffd_lattice_source lattices[] = {{.path = in_folder("l.json")}};
    ffd_deform_desc desc;
    ffd_job_result done = {.struct_size = sizeof done};
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = in_folder("in.ply");
    desc.output = in_folder("out.ply");
    desc.force = true;
    desc.lattices = lattices;
    desc.lattice_count = 1;
    desc.outside = outside;
    desc.falloff = falloff;
    if (ffd_deform_run(&desc, &done, &error))
        fail_msg("%s", error.message);
    file = fopen(in_folder("out.ply"), "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, length, SEEK_SET), 0);
    assert_int_equal(fread(result, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void arrays_become_what_files_become(void **state)
{
    static double xyz[3 * POINTS], from_file[3 * POINTS], from_array[3 * POINTS];
    static float narrow_xyz[3 * POINTS];
    static const struct treatment {
        ffd_outside outside;
        double falloff;
    } treatments[] = {{FFD_OUTSIDE_KEEP, 0}, {FFD_OUTSIDE_EXTEND, 0}, {FFD_OUTSIDE_EXTEND, 0.15}};
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    narrow(xyz, narrow_xyz);
    for (size_t r = 0; r < RESTS; r++)
        for (size_t t = 0; t < 3; t++)
            for (int type = FFD_FLOAT64; type <= FFD_FLOAT32; type++) {
                if (is_memory_checked() &&
                    (r + t + (size_t)type) %
                        (is_under_valgrind() ? 6 : 3)) /* each combined with some of the others */
                    continue;
                void *const points = type == FFD_FLOAT32 ? (void *)narrow_xyz : xyz;
                ffd_lattice *rest = lattice_of(r, ""), *moved = lattice_of(r, MOVES);
                ffd_embedding *embedding = embed(rest, span_of(points, (ffd_number)type),
                                                 treatments[t].outside, treatments[t].falloff);
                deform(embedding, moved, span_of(points, (ffd_number)type),
                       span_of(from_array, (ffd_number)type));
                deform_file(moved, points, (ffd_number)type, treatments[t].outside, treatments[t].falloff,
                            from_file);
                if (memcmp(from_file, from_array, 3 * POINTS * size_of((ffd_number)type)) != 0)
                    fail_msg("rest %zu, treatment %zu, type %d: other bits", r, t, type);
                assert_memory_not_equal(from_array, points, 3 * POINTS * size_of((ffd_number)type));
                ffd_embedding_destroy(&embedding);
                ffd_lattice_destroy(&rest);
                ffd_lattice_destroy(&moved);
            }
    (void)state;
}

static void threads_and_instructions_change_no_bit(void **state)
{
    static double xyz[3 * POINTS], first[3 * POINTS], again[3 * POINTS], gradients[9 * POINTS],
        others[9 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t r = 0; r < RESTS; r += (size_t)stride(2)) {
        ffd_lattice *rest = lattice_of(r, ""), *moved = lattice_of(r, MOVES);
        const ffd_span in = span_of(xyz, FFD_FLOAT64);
        ffd_embedding *embedding = embed(rest, in, FFD_OUTSIDE_EXTEND, 0);
        ffd_run_options run;
        ffd_run_options_init(&run, sizeof run);
        run.threads = 1;
        run.isa = FFD_ISA_SCALAR;
        assert_int_equal(
            ffd_embedding_deform(embedding, moved, in, span_of(first, FFD_FLOAT64), gradients, &run, NULL),
            FFD_OK);
        for (int isa = FFD_ISA_SSE2; isa <= FFD_ISA_NEON; isa++) {
            if (!ffd_isa_available((ffd_isa)isa))
                continue;
            run.threads = isa;
            run.isa = (ffd_isa)isa;
            assert_int_equal(
                ffd_embedding_deform(embedding, moved, in, span_of(again, FFD_FLOAT64), others, &run, NULL),
                FFD_OK);
            assert_memory_equal(first, again, sizeof first);
            assert_memory_equal(gradients, others, sizeof gradients);
        }
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&rest);
        ffd_lattice_destroy(&moved);
    }
    (void)state;
}

static void nothing_moved_keeps_every_bit(void **state)
{
    static double xyz[3 * POINTS], out[3 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t r = 0; r < RESTS; r++) {
        ffd_lattice *rest = lattice_of(r, "");
        ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_EXTEND, 0);
        deform(embedding, rest, span_of(xyz, FFD_FLOAT64), span_of(out, FFD_FLOAT64));
        assert_memory_equal(xyz, out, sizeof xyz);
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&rest);
    }
    (void)state;
}

/* Records of 5 numbers in reverse order, with z before y before x. */
static void strides_lead_to_the_same_points(void **state)
{
    static double xyz[3 * POINTS], out[3 * POINTS], records[5 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < POINTS; i++)
        for (size_t c = 0; c < 3; c++)
            records[5 * (POINTS - 1 - i) + 3 - c] = xyz[3 * i + c];
    const ffd_span strided = {.data = records + 5 * (POINTS - 1) + 3,
                              .count = POINTS,
                              .type = FFD_FLOAT64,
                              .stride = -5 * (ptrdiff_t)sizeof(double),
                              .step = -(ptrdiff_t)sizeof(double)};
    ffd_lattice *rest = lattice_of(0, ""), *moved = lattice_of(0, MOVES);
    ffd_embedding *plain = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_KEEP, 0);
    ffd_embedding *other = embed(rest, strided, FFD_OUTSIDE_KEEP, 0);
    assert_memory_equal(ffd_embedding_get_uvw(plain), ffd_embedding_get_uvw(other), sizeof xyz);
    deform(plain, moved, span_of(xyz, FFD_FLOAT64), span_of(out, FFD_FLOAT64));
    deform(other, moved, strided, strided);
    for (size_t i = 0; i < POINTS; i++)
        for (size_t c = 0; c < 3; c++)
            assert_memory_equal(&records[5 * (POINTS - 1 - i) + 3 - c], &out[3 * i + c], sizeof(double));
    for (size_t i = 0; i < POINTS; i++)
        assert_true(records[5 * i] == 0 && records[5 * i + 4] == 0);
    ffd_embedding_destroy(&plain);
    ffd_embedding_destroy(&other);
    ffd_lattice_destroy(&rest);
    ffd_lattice_destroy(&moved);
    (void)state;
}

/* All points that move are listed as affected, and deforming these alone gives the same results. */
static void the_affected_points_are_all_that_move(void **state)
{
    static double xyz[3 * POINTS], all[3 * POINTS], some[3 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t r = 0; r < RESTS; r += (size_t)stride(2)) {
        ffd_lattice *moved = lattice_of(r, "");
        size_t size[3], point, count;
        uint32_t *vertices;
        const double offset[3] = {0.1, -0.2, 0.05};
        ffd_lattice_get_size(moved, size);
        ffd_embedding *embedding = embed(moved, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_EXTEND, 0.1);
        point = draw_number(&d) % (size[0] * size[1] * size[2]);
        assert_int_equal(ffd_lattice_set_offsets(moved, &point, 1, offset, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_affected(embedding, &point, 1, &vertices, &count, NULL), FFD_OK);
        deform(embedding, moved, span_of(xyz, FFD_FLOAT64), span_of(all, FFD_FLOAT64));
        memcpy(some, xyz, sizeof some);
        assert_int_equal(ffd_embedding_deform_some(embedding, moved, vertices, count,
                                                   span_of(xyz, FFD_FLOAT64), span_of(some, FFD_FLOAT64),
                                                   NULL, NULL, NULL),
                         FFD_OK);
        assert_memory_equal(all, some, sizeof all);
        assert_true(count > 0);
        ffd_free(vertices);
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&moved);
    }
    (void)state;
}

/* dX/dQ times displacements is the displacement, the transposed product is its adjoint, and the stored matrix
   agrees with both. */
static void the_basis_is_the_derivative(void **state)
{
    static double xyz[3 * POINTS], out[3 * POINTS], dx[3 * POINTS], dfdx[3 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t r = 0; r < RESTS; r += (size_t)stride(2)) {
        ffd_lattice *rest = lattice_of(r, ""), *moved = lattice_of(r, MOVES);
        size_t size[3];
        ffd_lattice_get_size(moved, size);
        const size_t n = size[0] * size[1] * size[2];
        double *const dfdq = ffd_alloc(n, 3 * sizeof *dfdq), forward = 0, backward = 0;
        const double *const dq = ffd_lattice_get_offsets(moved);
        ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_EXTEND, 0.1);
        ffd_csr matrix;
        deform(embedding, moved, span_of(xyz, FFD_FLOAT64), span_of(out, FFD_FLOAT64));
        assert_int_equal(ffd_embedding_basis_times(embedding, NULL, dq, dx, NULL, NULL), FFD_OK);
        for (size_t i = 0; i < 3 * POINTS; i++) {
            dfdx[i] = draw_between(&d, -1, 1);
            if (isfinite(xyz[i]))
                assert_true(fabs(out[i] - xyz[i] - dx[i]) < 1e-14);
        }
        assert_int_equal(ffd_embedding_basis_transposed(embedding, NULL, dfdx, dfdq, NULL, NULL), FFD_OK);
        for (size_t i = 0; i < 3 * POINTS; i++)
            forward += dx[i] * dfdx[i];
        for (size_t i = 0; i < 3 * n; i++)
            backward += dfdq[i] * dq[i];
        assert_true(fabs(forward - backward) < 1e-9 * (1 + fabs(forward)));
        assert_int_equal(ffd_embedding_basis(embedding, NULL, &matrix, NULL, NULL), FFD_OK);
        assert_int_equal(matrix.rows, POINTS);
        assert_int_equal(matrix.columns, n);
        for (size_t i = 0; i < POINTS; i++) {
            double sum[3] = {0, 0, 0};
            for (size_t e = matrix.starts[i]; e < matrix.starts[i + 1]; e++) {
                assert_true(e == matrix.starts[i] || matrix.indices[e] > matrix.indices[e - 1]);
                assert_true(matrix.values[e] != 0);
                for (size_t c = 0; c < 3; c++)
                    sum[c] += matrix.values[e] * dq[3 * (size_t)matrix.indices[e] + c];
            }
            assert_memory_equal(sum, dx + 3 * i, sizeof sum);
        }
        ffd_csr_free(&matrix);
        ffd_free(dfdq);
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&rest);
        ffd_lattice_destroy(&moved);
    }
    (void)state;
}

static void bytes_bring_an_embedding_back(void **state)
{
    static double xyz[3 * POINTS], out[3 * POINTS], again[3 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    ffd_lattice *rest = lattice_of(2, ""), *moved = lattice_of(2, MOVES), *other = lattice_of(0, "");
    ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_EXTEND, 0.3), *back;
    void *bytes;
    size_t size;
    assert_int_equal(ffd_embedding_save(embedding, &bytes, &size, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_load(bytes, size, moved, &back, NULL), FFD_OK);
    deform(embedding, moved, span_of(xyz, FFD_FLOAT64), span_of(out, FFD_FLOAT64));
    deform(back, moved, span_of(xyz, FFD_FLOAT64), span_of(again, FFD_FLOAT64));
    assert_memory_equal(out, again, sizeof out);
    ffd_embedding_destroy(&back);
    assert_int_equal(ffd_embedding_load(bytes, size, other, &back, NULL), FFD_E_INVALID);
    for (int i = 0; i < 200; i++) {
        const size_t at = draw_bits(&d) % size, cut = draw_bits(&d) % size;
        ((unsigned char *)bytes)[at] ^= 4;
        assert_int_equal(ffd_embedding_load(bytes, size, rest, &back, NULL), FFD_E_INVALID);
        assert_null(back);
        ((unsigned char *)bytes)[at] ^= 4;
        assert_int_equal(ffd_embedding_load(bytes, cut, rest, &back, NULL), FFD_E_INVALID);
    }
    ffd_free(bytes);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    ffd_lattice_destroy(&moved);
    ffd_lattice_destroy(&other);
    (void)state;
}

/* Bytes that somebody has made may have a hash that fits: a point that follows the border has no u,v,w. */
static void points_of_forged_bytes_are_placed_once(void **state)
{
    static double xyz[3 * POINTS];
    enum { HEAD = 80, POINT = 24 }; /* bytes before u,v,w of the first point; of one u,v,w */
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    ffd_lattice *rest = lattice_of(0, "");
    ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_EXTEND, 0), *back;
    unsigned char *bytes;
    size_t size;
    assert_int_equal(ffd_embedding_save(embedding, (void **)&bytes, &size, NULL), FFD_OK);
    const size_t content = size - sizeof(hash128);
    for (size_t i = 0; i < POINTS; i++) {
        const double place[3] = {0.5, 0.5, 0.5};
        assert_memory_equal(bytes + HEAD + POINT * i, ffd_embedding_get_uvw(embedding) + 3 * i, POINT);
        memcpy(bytes + HEAD + POINT * i, place, POINT);
    }
    const hash128 hash = ffd_hash(bytes, content);
    memcpy(bytes + content, &hash, sizeof hash);
    assert_int_equal(ffd_embedding_load(bytes, size, rest, &back, NULL), FFD_E_INVALID);
    assert_null(back);
    ffd_free(bytes);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    (void)state;
}

static bool stop(void *user, double done)
{
    ++*(int *)user;
    assert_true(done > 0 && done <= 1);
    return false;
}

static void progress_can_cancel(void **state)
{
    enum { TILES = 4, MANY = TILES * 4096 };
    static double xyz[3 * POINTS], many[3 * MANY];
    int calls = 0;
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < 3 * MANY; i++)
        many[i] = xyz[i % (3 * POINTS)];
    ffd_lattice *rest = lattice_of(0, "");
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    ffd_run_options run;
    ffd_run_options_init(&run, sizeof run);
    ffd_embedding_desc_init(&desc, sizeof desc);
    run.threads = 1;
    run.progress = stop;
    run.user = &calls;
    desc.lattice = rest;
    desc.points = span_of(xyz, FFD_FLOAT64);
    assert_int_equal(ffd_embedding_create(&desc, &run, &embedding, NULL), FFD_E_CANCELLED);
    assert_null(embedding);
    assert_int_equal(calls, 1);
    /* Even if other threads finish before the caller's starts. */
    run.threads = TILES;
    desc.points = (ffd_span){.data = many, .count = MANY, .type = FFD_FLOAT64};
    for (int i = 0; i < repetitions(100); i++) {
        calls = 0;
        assert_int_equal(ffd_embedding_create(&desc, &run, &embedding, NULL), FFD_E_CANCELLED);
        assert_int_equal(calls, 1);
    }
    ffd_lattice_destroy(&rest);
    (void)state;
}

static bool rises(void *user, double done)
{
    double *const last = user;
    assert_true(done > *last && done <= 1);
    *last = done;
    return true;
}

static void progress_of_a_basis_ends_at_1(void **state)
{
    enum { MANY = 3 * 4096 };
    static double xyz[3 * POINTS], many[3 * MANY];
    double last = 0;
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < 3 * MANY; i++)
        many[i] = xyz[i % (3 * POINTS)];
    ffd_lattice *rest = lattice_of(0, "");
    ffd_embedding *embedding =
        embed(rest, (ffd_span){.data = many, .count = MANY, .type = FFD_FLOAT64}, FFD_OUTSIDE_KEEP, 0);
    ffd_csr matrix;
    ffd_run_options run;
    ffd_run_options_init(&run, sizeof run);
    run.threads = 1;
    run.progress = rises;
    run.user = &last;
    assert_int_equal(ffd_embedding_basis(embedding, NULL, &matrix, &run, NULL), FFD_OK);
    assert_true(last == 1);
    ffd_csr_free(&matrix);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    (void)state;
}

static void what_cannot_be_is_refused(void **state)
{
    static double xyz[3 * POINTS];
    static float out[3 * POINTS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    ffd_lattice *rest = lattice_of(0, ""), *other = lattice_of(1, "");
    ffd_lattice *huge = make(rests[0], "{\"by\":[1e300,0,0]}");
    ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_KEEP, 0), *none;
    const ffd_span in = span_of(xyz, FFD_FLOAT64);
    ffd_span bad = in;
    ffd_error error;
    const uint32_t unsorted[] = {3, 2}, beyond[] = {POINTS};
    assert_int_equal(ffd_embedding_deform(embedding, other, in, in, NULL, NULL, &error), FFD_E_INVALID);
    assert_int_equal(ffd_embedding_deform(embedding, huge, in, span_of(out, FFD_FLOAT32), NULL, NULL, &error),
                     FFD_E_INVALID);
    assert_non_null(strstr(error.message, "float32"));
    bad.count = POINTS - 1;
    assert_int_equal(ffd_embedding_deform(embedding, rest, bad, in, NULL, NULL, &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_embedding_deform(embedding, rest, in, bad, NULL, NULL, &error), FFD_E_ARGUMENT);
    bad = in;
    bad.data = NULL;
    assert_int_equal(ffd_embedding_deform(embedding, rest, bad, in, NULL, NULL, &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_embedding_deform_some(embedding, rest, unsorted, 2, in, in, NULL, NULL, &error),
                     FFD_E_ARGUMENT);
    assert_int_equal(ffd_embedding_deform_some(embedding, rest, beyond, 1, in, in, NULL, NULL, &error),
                     FFD_E_ARGUMENT);
    ffd_embedding_desc desc;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = rest;
    desc.points = in;
    desc.outside = FFD_OUTSIDE_ERROR;
    assert_int_equal(ffd_embedding_create(&desc, NULL, &none, &error), FFD_E_EMBEDDING);
    assert_non_null(strstr(error.message, "point "));
    desc.struct_size = sizeof desc + 8;
    assert_int_equal(ffd_embedding_create(&desc, NULL, &none, &error), FFD_E_ARGUMENT);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    ffd_lattice_destroy(&other);
    ffd_lattice_destroy(&huge);
    (void)state;
}

static void weights_of_a_basis_are_positive(void **state)
{
    static double xyz[3 * POINTS], product[3 * POINTS];
    ffd_lattice *rest = lattice_of(0, "");
    ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_KEEP, 0);
    const double wrong[] = {0, -1, (double)NAN, (double)INFINITY};
    double weights[5 * 4 * 6], dq[3 * 5 * 4 * 6] = {0};
    for (size_t i = 0; i < sizeof weights / sizeof *weights; i++)
        weights[i] = 1;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        ffd_csr matrix;
        ffd_error error;
        weights[7] = wrong[i];
        assert_int_equal(ffd_embedding_basis(embedding, weights, &matrix, NULL, &error), FFD_E_INVALID);
        assert_non_null(strstr(error.message, "control point 7 "));
        assert_null(matrix.values);
        assert_int_equal(ffd_embedding_basis_times(embedding, weights, dq, product, NULL, &error),
                         FFD_E_INVALID);
        assert_int_equal(ffd_embedding_basis_transposed(embedding, weights, xyz, dq, NULL, &error),
                         FFD_E_INVALID);
    }
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    (void)state;
}

/* A caller with an older header: nothing is written beyond its struct, and missing members have defaults. */
static void shorter_structs_of_older_callers_do(void **state)
{
    struct old_run {
        size_t struct_size;
        int threads, isa;
        uint64_t behind;
    } run = {.behind = 0x5a5a5a5a5a5a5a5a};
    const size_t known = offsetof(struct old_run, behind);
    static double xyz[3 * POINTS];
    ffd_lattice *rest = lattice_of(0, "");
    ffd_run_options_init((ffd_run_options *)(void *)&run, known);
    assert_int_equal(run.struct_size, known);
    assert_true(run.behind == 0x5a5a5a5a5a5a5a5a);
    ffd_embedding *embedding = embed(rest, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_KEEP, 0);
    assert_int_equal(ffd_embedding_deform(embedding, rest, span_of(xyz, FFD_FLOAT64),
                                          span_of(xyz, FFD_FLOAT64), NULL,
                                          (const ffd_run_options *)(const void *)&run, NULL),
                     FFD_OK);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&rest);
    (void)state;
}

static void normals_follow_as_one_by_one(void **state)
{
    static double xyz[3 * POINTS], out[3 * POINTS], gradients[9 * POINTS], normals[3 * POINTS],
        carried[3 * POINTS];
    size_t collapsed = 1;
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < 3 * POINTS; i++)
        normals[i] = draw_between(&d, -1, 1);
    ffd_lattice *moved = lattice_of(0, MOVES);
    ffd_embedding *embedding = embed(moved, span_of(xyz, FFD_FLOAT64), FFD_OUTSIDE_KEEP, 0);
    assert_int_equal(ffd_embedding_deform(embedding, moved, span_of(xyz, FFD_FLOAT64),
                                          span_of(out, FFD_FLOAT64), gradients, NULL, NULL),
                     FFD_OK);
    assert_int_equal(ffd_normals_deform(gradients, span_of(normals, FFD_FLOAT64),
                                        span_of(carried, FFD_FLOAT64), &collapsed, NULL, NULL),
                     FFD_OK);
    assert_int_equal(collapsed, 0);
    for (size_t i = 0; i < POINTS; i++) {
        double one[3], tangent[3];
        ffd_deform_normal(gradients + 9 * i, normals + 3 * i, one);
        assert_memory_equal(one, carried + 3 * i, sizeof one);
        ffd_deform_tangent(gradients + 9 * i, xyz + 3 * i, one, tangent);
        memcpy(out + 3 * i, tangent, sizeof tangent);
    }
    assert_int_equal(ffd_tangents_deform(gradients, span_of(carried, FFD_FLOAT64), span_of(xyz, FFD_FLOAT64),
                                         span_of(normals, FFD_FLOAT64), NULL, NULL, NULL),
                     FFD_OK);
    assert_memory_equal(out, normals, sizeof out);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&moved);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_become_what_files_become),
        cmocka_unit_test(threads_and_instructions_change_no_bit),
        cmocka_unit_test(nothing_moved_keeps_every_bit),
        cmocka_unit_test(strides_lead_to_the_same_points),
        cmocka_unit_test(the_affected_points_are_all_that_move),
        cmocka_unit_test(the_basis_is_the_derivative),
        cmocka_unit_test(bytes_bring_an_embedding_back),
        cmocka_unit_test(points_of_forged_bytes_are_placed_once),
        cmocka_unit_test(progress_can_cancel),
        cmocka_unit_test(progress_of_a_basis_ends_at_1),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(weights_of_a_basis_are_positive),
        cmocka_unit_test(shorter_structs_of_older_callers_do),
        cmocka_unit_test(normals_follow_as_one_by_one),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
