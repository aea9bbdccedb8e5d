/* test_chain.c - several lattices on arrays: the bits of a job with these lattices, products that are
   differences and adjoint to each other, refusals, memory that runs out anywhere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "base/memory/memory.h"
#include <ffd/ffd.h>
#include <math.h>
#include <stdlib.h>

#define POINTS ((size_t)600)
#define LATTICES ((size_t)3)

/* A box, a volume that is curved at rest, and one with weights; they overlap. */
static const char *const rests[LATTICES] = {
    "\"size\":[5,4,6],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[0.5,1,1]}}",
    "\"size\":[3,6,3],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0.3,1],"
    "\"height\":2}}",
    "\"size\":[3,3,3],\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,0.5,1,1,1,1,2,1,1,1,1,1,3,1,1],"
    "\"rest\":{\"box\":{\"min\":[-0.5,-1,-1],\"max\":[1,1,1]}}",
};
#define MOVES                                                                                                \
    "{\"twist\":{\"axis\":\"z\",\"degrees\":25}},{\"at\":[-1,\"all\",\"all\"],\"by\":[0.1,0.05,-0.1]}"

typedef struct several {
    ffd_lattice *lattices[LATTICES];
    size_t sizes[LATTICES]; /* control points */
    double xyz[3 * POINTS];
    ffd_chain_desc desc;
} several;

static void fill_points(double *xyz, draw *d)
{
    for (size_t i = 0; i < 3 * POINTS; i++)
        xyz[i] = draw_int(d, 0, 20) == 0 ? draw_int(d, -1, 1) : draw_between(d, -1.2, 1.2);
    xyz[3 * 17 + 1] = (double)NAN;
}

static ffd_span span_of(void *data, ffd_number type)
{
    return (ffd_span){.data = data, .count = POINTS, .type = type};
}

static void begin(several *s, bool blocks, ffd_outside outside)
{
    draw d = {draw_seed()};
    fill_points(s->xyz, &d);
    for (size_t l = 0; l < LATTICES; l++) {
        size_t size[3];
        s->lattices[l] = make(rests[l], MOVES);
        ffd_lattice_get_size(s->lattices[l], size);
        s->sizes[l] = size[0] * size[1] * size[2];
    }
    ffd_chain_desc_init(&s->desc, sizeof s->desc);
    s->desc.lattices = (const ffd_lattice *const *)s->lattices;
    s->desc.count = LATTICES;
    s->desc.blocks = blocks;
    s->desc.points = span_of(s->xyz, FFD_FLOAT64);
    s->desc.outside = outside;
    s->desc.falloff = outside == FFD_OUTSIDE_EXTEND ? 0.3 : 0;
}

/* Takes the points off the faces of the boxes, where a step would take them to the other side. */
static void leave_faces(several *s)
{
    draw d = {draw_seed()};
    for (size_t i = 0; i < 3 * POINTS; i++)
        s->xyz[i] = isfinite(s->xyz[i]) ? draw_between(&d, -1.2, 1.2) : s->xyz[i];
}

static void end(several *s)
{
    for (size_t l = 0; l < LATTICES; l++)
        ffd_lattice_destroy(&s->lattices[l]);
}

static ffd_chain_embedding *embed(const several *s)
{
    ffd_chain_embedding *embedding;
    ffd_error error = {0};
    if (ffd_chain_embedding_create(&s->desc, NULL, &embedding, &error))
        fail_msg("%s", error.message);
    return embedding;
}

static void deform(const ffd_chain_embedding *embedding, const ffd_lattice *const *moved, ffd_span in,
                   ffd_span out)
{
    ffd_chain_deform_desc desc;
    ffd_error error = {0};
    ffd_chain_deform_desc_init(&desc, sizeof desc);
    desc.moved = moved;
    desc.in = in;
    desc.out = out;
    if (ffd_chain_embedding_deform(embedding, &desc, NULL, &error))
        fail_msg("%s", error.message);
}

/* Takes the numbers at the end of a PLY. */
static ffd_status take_ply(void *user, const char *name, const void *bytes, size_t size)
{
    assert_string_equal(name, "out.ply");
    assert_true(size > 24 * POINTS);
    memcpy(user, (const char *)bytes + size - 24 * POINTS, 24 * POINTS);
    return FFD_OK;
}

/* Deforms a PLY of doubles by a job with these lattices, in memory. */
static void run_job(const several *s, double *out)
{
    static char bytes[400 + 24 * POINTS];
    ffd_lattice_source sources[LATTICES];
    ffd_deform_desc job;
    ffd_job_result done = {.struct_size = sizeof done};
    ffd_error error = {0};
    const int head = snprintf(bytes, 400,
                              "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty double x\n"
                              "property double y\nproperty double z\nend_header\n",
                              POINTS);
    memcpy(bytes + head, s->xyz, sizeof s->xyz);
    memset(sources, 0, sizeof sources);
    for (size_t l = 0; l < LATTICES; l++)
        sources[l].object = s->lattices[l];
    ffd_deform_desc_init(&job, sizeof job);
    job.input.path = "points.ply";
    job.input.bytes = (ffd_bytes){bytes, (size_t)head + sizeof s->xyz};
    job.lattices = sources;
    job.lattice_count = LATTICES;
    job.blocks = s->desc.blocks;
    job.outside = s->desc.outside;
    job.falloff = s->desc.falloff;
    job.output = "out.ply";
    job.sink = take_ply;
    job.sink_user = out;
    if (ffd_deform_run(&job, &done, &error))
        fail_msg("%s", error.message);
}

static void results_are_those_of_a_job(void **state)
{
    static several s;
    static double out[3 * POINTS], wanted[3 * POINTS];
    for (int kind = 0; kind < 4; kind++) {
        begin(&s, kind % 2 == 1, kind < 2 ? FFD_OUTSIDE_KEEP : FFD_OUTSIDE_EXTEND);
        ffd_chain_embedding *embedding = embed(&s);
        run_job(&s, wanted);
        deform(embedding, NULL, s.desc.points, span_of(out, FFD_FLOAT64));
        assert_memory_equal(out, wanted, sizeof out);
        /* Also where the lattices have other control points than the embedding's. */
        ffd_lattice *others[LATTICES];
        for (size_t l = 0; l < LATTICES; l++)
            others[l] = make(rests[l], "{\"by\":[0.1,-0.2,0.05]},{\"at\":[0,\"all\",0],\"by\":[0.05,0,0]}");
        deform(embedding, (const ffd_lattice *const *)others, s.desc.points, span_of(out, FFD_FLOAT64));
        for (size_t l = 0; l < LATTICES; l++) {
            ffd_lattice *const own = s.lattices[l];
            s.lattices[l] = others[l];
            others[l] = own;
        }
        run_job(&s, wanted);
        assert_memory_equal(out, wanted, sizeof out);
        for (size_t l = 0; l < LATTICES; l++)
            ffd_lattice_destroy(&others[l]);
        ffd_chain_embedding_destroy(&embedding);
        assert_null(embedding);
        end(&s);
    }
    (void)state;
}

/* Lattice 1 has its own control points: those of lattice 2 alone change, and u,v,w in it are known. */
static void points_are_looked_up_anew_behind_a_change(void **state)
{
    static several s;
    static double out[3 * POINTS], wanted[3 * POINTS];
    begin(&s, false, FFD_OUTSIDE_EXTEND);
    ffd_chain_embedding *embedding = embed(&s);
    for (size_t changed = 0; changed < LATTICES; changed++) {
        const ffd_lattice *moved[LATTICES] = {NULL};
        ffd_lattice *const other = make(rests[changed], "{\"by\":[0.1,-0.2,0.05]}"), *const own =
                                                                                         s.lattices[changed];
        moved[changed] = other;
        deform(embedding, moved, s.desc.points, span_of(out, FFD_FLOAT64));
        s.lattices[changed] = other;
        run_job(&s, wanted);
        s.lattices[changed] = own;
        assert_memory_equal(out, wanted, sizeof out);
        ffd_lattice *gone = other;
        ffd_lattice_destroy(&gone);
    }
    ffd_chain_embedding_destroy(&embedding);
    end(&s);
    (void)state;
}

static void float32_is_rounded_once(void **state)
{
    static several s;
    static double out[3 * POINTS];
    static float narrow[3 * POINTS], rounded[3 * POINTS];
    begin(&s, false, FFD_OUTSIDE_KEEP);
    for (size_t i = 0; i < 3 * POINTS; i++)
        narrow[i] = (float)s.xyz[i];
    s.desc.points = span_of(narrow, FFD_FLOAT32);
    ffd_chain_embedding *embedding = embed(&s);
    deform(embedding, NULL, s.desc.points, span_of(rounded, FFD_FLOAT32));
    deform(embedding, NULL, s.desc.points, span_of(out, FFD_FLOAT64));
    for (size_t i = 0; i < 3 * POINTS; i++)
        assert_true(rounded[i] == (float)out[i] || isnan(out[i]));
    ffd_chain_embedding_destroy(&embedding);
    end(&s);
    (void)state;
}

/* Both products, beside differences of the deformation and each other. */
static void products_are_differences(void **state)
{
    static several s;
    static double out[2][3 * POINTS], dx[3 * POINTS], dfdx[3 * POINTS];
    draw d = {draw_seed()};
    for (int kind = 0; kind < 4; kind++) {
        begin(&s, kind % 2 == 1, kind < 2 ? FFD_OUTSIDE_KEEP : FFD_OUTSIDE_EXTEND);
        leave_faces(&s);
        ffd_chain_embedding *embedding = embed(&s);
        double *dq[LATTICES], *dfdq[LATTICES], forward = 0, back = 0, size = 0;
        ffd_lattice *sides[2][LATTICES];
        const double step = 1e-6;
        for (size_t l = 0; l < LATTICES; l++) {
            dq[l] = ffd_alloc(s.sizes[l], 3 * sizeof(double));
            dfdq[l] = ffd_alloc(s.sizes[l], 3 * sizeof(double));
            double *const points = ffd_alloc(s.sizes[l], 3 * sizeof(double));
            for (size_t i = 0; i < 3 * s.sizes[l]; i++)
                dq[l][i] = draw_between(&d, -1, 1);
            for (int way = 0; way < 2; way++) {
                const double *const own = ffd_lattice_get_points(s.lattices[l], FFD_VOLUME_DEFORMED);
                for (size_t i = 0; i < 3 * s.sizes[l]; i++)
                    points[i] = own[i] + (way ? -step : step) * dq[l][i];
                assert_int_equal(ffd_lattice_copy(s.lattices[l], &sides[way][l], NULL), FFD_OK);
                assert_int_equal(ffd_lattice_set_points(sides[way][l], NULL, s.sizes[l], points, NULL),
                                 FFD_OK);
            }
            ffd_free(points);
        }
        for (int way = 0; way < 2; way++)
            deform(embedding, (const ffd_lattice *const *)sides[way], s.desc.points,
                   span_of(out[way], FFD_FLOAT64));
        assert_int_equal(
            ffd_chain_embedding_basis_times(embedding, (const double *const *)dq, dx, NULL, NULL), FFD_OK);
        size_t near = 0;
        for (size_t i = 0; i < POINTS; i++) {
            bool agrees = true;
            for (size_t c = 3 * i; c < 3 * i + 3; c++) {
                dfdx[c] = draw_between(&d, -1, 1);
                forward += dx[c] * dfdx[c];
                size += fabs(dx[c] * dfdx[c]);
                agrees = agrees && !(fabs((out[0][c] - out[1][c]) / (2 * step) - dx[c]) > 1e-6);
            }
            near += agrees;
        }
        /* A point may cross the border of a later lattice with the step, or a kink of its border. */
        assert_true(near + 4 >= POINTS);
        assert_int_equal(ffd_chain_embedding_basis_transposed(embedding, dfdx, dfdq, NULL, NULL), FFD_OK);
        for (size_t l = 0; l < LATTICES; l++)
            for (size_t i = 0; i < 3 * s.sizes[l]; i++)
                back += dfdq[l][i] * dq[l][i];
        assert_true(size > 1 && fabs(forward - back) < 1e-12 * size);
        ffd_chain_embedding_destroy(&embedding);
        for (size_t l = 0; l < LATTICES; l++) {
            ffd_free(dq[l]);
            ffd_free(dfdq[l]);
            ffd_lattice_destroy(&sides[0][l]);
            ffd_lattice_destroy(&sides[1][l]);
        }
        end(&s);
    }
    (void)state;
}

/* The gradients of all lattices together. */
static void gradients_are_differences(void **state)
{
    static several s;
    static double to[2][3 * POINTS], moved_points[3 * POINTS], gradients[9 * POINTS];
    const double step = 1e-6;
    for (int kind = 0; kind < 4; kind++) {
        begin(&s, kind % 2 == 1, kind < 2 ? FFD_OUTSIDE_KEEP : FFD_OUTSIDE_EXTEND);
        leave_faces(&s);
        ffd_chain_embedding *embedding = embed(&s);
        ffd_chain_deform_desc desc;
        ffd_chain_deform_desc_init(&desc, sizeof desc);
        desc.in = s.desc.points;
        desc.out = span_of(moved_points, FFD_FLOAT64);
        desc.gradients = gradients;
        assert_int_equal(ffd_chain_embedding_deform(embedding, &desc, NULL, NULL), FFD_OK);
        ffd_chain_embedding_destroy(&embedding);
        size_t near = 0;
        for (size_t c = 0; c < 3; c++) {
            for (int way = 0; way < 2; way++) {
                for (size_t i = 0; i < POINTS; i++)
                    s.xyz[3 * i + c] += way ? -2 * step : step;
                embedding = embed(&s);
                deform(embedding, NULL, s.desc.points, span_of(to[way], FFD_FLOAT64));
                ffd_chain_embedding_destroy(&embedding);
            }
            for (size_t i = 0; i < POINTS; i++) {
                s.xyz[3 * i + c] += step;
                for (size_t r = 0; r < 3; r++)
                    near += !(fabs((to[0][3 * i + r] - to[1][3 * i + r]) / (2 * step) - (r == c) -
                                   gradients[9 * i + 3 * r + c]) > 1e-5);
            }
        }
        assert_true(near + 9 * 6 >= 9 * POINTS);
        end(&s);
    }
    (void)state;
}

static void bounds_are_those_of_the_moved_points(void **state)
{
    static several s;
    static double out[3 * POINTS];
    double min[3], max[3];
    begin(&s, true, FFD_OUTSIDE_KEEP);
    ffd_chain_embedding *embedding = embed(&s);
    deform(embedding, NULL, s.desc.points, span_of(out, FFD_FLOAT64));
    assert_int_equal(ffd_chain_embedding_bounds(embedding, s.desc.points, min, max, NULL, NULL), FFD_OK);
    for (size_t c = 0; c < 3; c++) {
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (size_t i = 0; i < POINTS; i++)
            if (i != 17) {
                least = fmin(least, out[3 * i + c]);
                most = fmax(most, out[3 * i + c]);
            }
        assert_true(min[c] == least && max[c] == most);
    }
    ffd_chain_embedding_destroy(&embedding);
    end(&s);
    (void)state;
}

#define MANY ((size_t)9000)

static void threads_change_nothing(void **state)
{
    static several s;
    static double xyz[3 * MANY], out[2][3 * MANY], dx[2][3 * MANY], back[2][LATTICES][3 * 200];
    draw d = {draw_seed()};
    for (size_t i = 0; i < 3 * MANY; i++)
        xyz[i] = draw_between(&d, -1.2, 1.2);
    for (int blocks = 0; blocks < 2; blocks++) {
        begin(&s, blocks, FFD_OUTSIDE_EXTEND);
        s.desc.points = (ffd_span){.data = xyz, .count = MANY};
        for (int way = 0; way < 2; way++) {
            ffd_run_options options;
            ffd_chain_deform_desc desc;
            ffd_chain_embedding *embedding;
            const double *dq[LATTICES];
            double *dfdq[LATTICES];
            ffd_run_options_init(&options, sizeof options);
            options.threads = way ? 4 : 1;
            ffd_chain_deform_desc_init(&desc, sizeof desc);
            desc.in = s.desc.points;
            desc.out = (ffd_span){.data = out[way], .count = MANY};
            for (size_t l = 0; l < LATTICES; l++) {
                assert_true(s.sizes[l] <= 200);
                dq[l] = ffd_lattice_get_offsets(s.lattices[l]);
                dfdq[l] = back[way][l];
            }
            assert_int_equal(ffd_chain_embedding_create(&s.desc, &options, &embedding, NULL), FFD_OK);
            assert_int_equal(ffd_chain_embedding_deform(embedding, &desc, &options, NULL), FFD_OK);
            assert_int_equal(ffd_chain_embedding_basis_times(embedding, dq, dx[way], &options, NULL), FFD_OK);
            assert_int_equal(ffd_chain_embedding_basis_transposed(embedding, xyz, dfdq, &options, NULL),
                             FFD_OK);
            ffd_chain_embedding_destroy(&embedding);
        }
        assert_memory_equal(out[0], out[1], sizeof out[0]);
        assert_memory_equal(dx[0], dx[1], sizeof dx[0]);
        assert_memory_equal(back[0], back[1], sizeof back[0]);
        end(&s);
    }
    (void)state;
}

static void overlapping_blocks_are_told(void **state)
{
    static several s;
    size_t pair[2];
    for (int blocks = 0; blocks < 2; blocks++) {
        begin(&s, blocks, FFD_OUTSIDE_KEEP);
        ffd_chain_embedding *embedding = embed(&s);
        assert_int_equal(ffd_chain_embedding_get_overlaps(embedding, pair), blocks ? 3 : 0);
        assert_true(pair[0] == 0 && pair[1] == (size_t)blocks);
        ffd_chain_embedding_destroy(&embedding);
        end(&s);
    }
    (void)state;
}

static void refused(const several *s, ffd_status status, const char *words)
{
    ffd_chain_embedding *embedding = NULL;
    ffd_error error = {0};
    assert_int_equal(ffd_chain_embedding_create(&s->desc, NULL, &embedding, &error), status);
    assert_null(embedding);
    if (!strstr(error.message, words))
        fail_msg("%s", error.message);
}

static void what_is_wrong_is_refused(void **state)
{
    static several s;
    static double out[3 * POINTS];
    begin(&s, false, FFD_OUTSIDE_KEEP);
    ffd_lattice *unfitted, *const own = s.lattices[1], *const first = s.lattices[0];
    ffd_error error;
    assert_int_equal(parse("\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\"}", "", &unfitted, &error), FFD_OK);
    s.lattices[1] = unfitted;
    refused(&s, FFD_E_ARGUMENT, "no control points yet");
    s.lattices[1] = NULL;
    refused(&s, FFD_E_ARGUMENT, "there is no lattice");
    s.lattices[1] = own;
    s.desc.count = 0;
    refused(&s, FFD_E_ARGUMENT, "no lattice is given");
    s.desc.count = 1025;
    refused(&s, FFD_E_LIMIT, "at most 1024 lattices, not 1025");
    s.desc.count = LATTICES;
    s.desc.falloff = 1;
    refused(&s, FFD_E_ARGUMENT, "falloff 1 needs outside");
    s.desc.falloff = 0;
    s.desc.outside = FFD_OUTSIDE_ERROR;
    refused(&s, FFD_E_EMBEDDING, "is outside of all lattices");
    s.desc.outside = FFD_OUTSIDE_KEEP;
    ffd_chain_embedding *embedding = embed(&s);
    s.desc.start = embedding;
    s.desc.snap = 0.1;
    refused(&s, FFD_E_INVALID, "is of other points, settings or lattices");
    s.desc.snap = 0;
    s.desc.blocks = true;
    refused(&s, FFD_E_INVALID, "is of other points, settings or lattices");
    s.desc.blocks = false;
    s.lattices[0] = s.lattices[1];
    refused(&s, FFD_E_INVALID, "is of other points, settings or lattices");
    s.lattices[0] = first;
    ffd_chain_embedding *again = embed(&s);
    assert_memory_equal(ffd_chain_embedding_get_uvw(again), ffd_chain_embedding_get_uvw(embedding),
                        sizeof s.xyz);
    ffd_chain_embedding_destroy(&again);
    s.desc.start = NULL;
    ffd_chain_deform_desc desc;
    ffd_chain_deform_desc_init(&desc, sizeof desc);
    const ffd_lattice *const moved[] = {s.lattices[0], s.lattices[2], NULL};
    desc.moved = moved;
    desc.in = s.desc.points;
    desc.out = span_of(out, FFD_FLOAT64);
    assert_int_equal(ffd_chain_embedding_deform(embedding, &desc, NULL, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "lattice 1: the embedding is of another lattice"));
    desc.moved = NULL;
    desc.out.count--;
    assert_int_equal(ffd_chain_embedding_deform(embedding, &desc, NULL, &error), FFD_E_ARGUMENT);
    desc.out.count++;
    desc.struct_size++;
    assert_int_equal(ffd_chain_embedding_deform(embedding, &desc, NULL, &error), FFD_E_ARGUMENT);
    ffd_chain_embedding_destroy(&embedding);
    ffd_lattice_destroy(&unfitted);
    end(&s);
    (void)state;
}

static void memory_may_run_out_anywhere(void **state)
{
    static several s;
    static double out[3 * POINTS];
    for (int kind = 0; kind < 2; kind++) {
        begin(&s, kind == 1, FFD_OUTSIDE_EXTEND);
        s.desc.points.count = 20;
        double *dfdq[LATTICES] = {NULL};
        for (int call = 0; call < 5; call++) {
            ffd_status status = FFD_E_MEMORY;
            ffd_chain_embedding *embedding = call > 0 ? embed(&s) : NULL;
            ffd_chain_deform_desc desc;
            ffd_chain_deform_desc_init(&desc, sizeof desc);
            desc.in = s.desc.points;
            desc.out = (ffd_span){.data = out, .count = 20};
            desc.moved = (const ffd_lattice *const *)s.lattices;
            for (long fails = 0; status != FFD_OK; fails += fails < 300 ? 1 : 37) {
                double min[3], max[3];
                ffd_alloc_fail_after(fails);
                status =
                    call == 0   ? ffd_chain_embedding_create(&s.desc, NULL, &embedding, NULL)
                    : call == 1 ? ffd_chain_embedding_deform(embedding, &desc, NULL, NULL)
                    : call == 2 ? ffd_chain_embedding_bounds(embedding, s.desc.points, min, max, NULL, NULL)
                    : call == 3 ? ffd_chain_embedding_basis_times(embedding, (const double *const *)dfdq, out,
                                                                  NULL, NULL)
                                : ffd_chain_embedding_basis_transposed(embedding, s.xyz, dfdq, NULL, NULL);
                ffd_alloc_fail_after(-1);
                assert_true(status == FFD_OK || status == FFD_E_MEMORY);
                assert_true((embedding != NULL) == (call > 0 || status == FFD_OK));
            }
            ffd_chain_embedding_destroy(&embedding);
        }
        end(&s);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_are_those_of_a_job),
        cmocka_unit_test(points_are_looked_up_anew_behind_a_change),
        cmocka_unit_test(float32_is_rounded_once),
        cmocka_unit_test(products_are_differences),
        cmocka_unit_test(gradients_are_differences),
        cmocka_unit_test(bounds_are_those_of_the_moved_points),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(overlapping_blocks_are_told),
        cmocka_unit_test(what_is_wrong_is_refused),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
