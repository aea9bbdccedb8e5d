/* test_pass.c - a pass over a document: its arrays and figures, points outside, u,v,w from a file. */
#include "lattice/rest_hash.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/locator.h"
#include "job/chain/chain_load.h"
#include "job/input/embedding_file.h"
#include "job/pass/pass.h"
#include "job/pass/vertex_transform.h"
#include <ffd/deform.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PARTS 4
#define WHOLE VERTEX_TRANSFORMS /* exactly one tile */
#define MOST (2 * WHOLE + 452)
#define NUMBERED (MOST + WHOLE + 5) /* parts 0, 2 and 3; part 1 repeats part 0 */

/* A document of the test's own, which records its results. */
typedef struct cloud {
    mesh_document head;
    mesh_part parts[PARTS];
    double xyz[PARTS][3 * MOST];
} cloud;

static void read_positions(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                           size_t first, size_t count, double *xyz)
{
    (void)stream;
    (void)state;
    memcpy(xyz, ((const cloud *)document)->xyz[part] + 3 * first, 3 * count * sizeof *xyz);
}

static void write_positions(mesh_document *document, size_t part, mesh_stream stream, size_t first,
                            size_t count, const double *xyz, const uint8_t *changed)
{
    (void)stream;
    for (size_t i = 0; i < count; i++)
        if (changed[i])
            memcpy(((cloud *)document)->xyz[part] + 3 * (first + i), xyz + 3 * i, 3 * sizeof *xyz);
}

static const mesh_format cloud_format = {
    .name = "cloud", .read = read_positions, .write = write_positions, .largest_coordinate = 1e300};

/* Points in [-3, 3]^3, and a last part whose matrix is singular. */
static cloud *make_cloud(void)
{
    cloud *made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->head = (mesh_document){.format = &cloud_format, .parts = made->parts, .part_count = PARTS};
    for (size_t p = 0; p < PARTS; p++)
        for (size_t i = 0; i < 3 * MOST; i++)
            made->xyz[p][i] = (double)((i * 7919 + 13 * p) % 601) / 100 - 3;
    made->parts[0] = (mesh_part){.vertex_count = MOST, .identity = true};
    made->parts[1] = (mesh_part){.vertex_count = MOST, .identity = true, .repeats_positions = true};
    made->parts[2] = (mesh_part){.vertex_count = WHOLE,
                                 .linear = {2, 0, 0, 0, 0.5, 0, 0, 0, 1},
                                 .inverse = {0.5, 0, 0, 0, 2, 0, 0, 0, 1},
                                 .offset = {0, 0, 1}};
    made->parts[3] = (mesh_part){.vertex_count = 5, .linear = {1, 0, 0, 0, 1, 0, 0, 0, 0}, .singular = true};
    return made;
}

/* The position of vertex `number` in the scene; false in the part with the singular matrix. */
static bool place_of(const cloud *mesh, size_t number, double p[3])
{
    const size_t part = number < MOST ? 0 : number < MOST + WHOLE ? 2 : 3;
    const size_t first = part == 0 ? 0 : part == 2 ? MOST : MOST + WHOLE;
    memcpy(p, mesh->xyz[part] + 3 * (number - first), 3 * sizeof *p);
    ffd_part_transform(&mesh->head, part, number - first, 1, p);
    return part != 3;
}

#define BOX "\"size\":[5,4,4],\"rest\":{\"box\":{\"min\":[-2,-2,-2],\"max\":[2,2,2]}},"
#define BENT                                                                                                 \
    "\"size\":[2,2,3],\"rest\":{\"points\":[[-2,-2,-2],[2,-2,-2],[-2,2,-2],[2,2,-2],[-2,-2,0],[2.5,-2,0],"   \
    "[-2,2.5,0],[2,2,0],[-2,-2,2],[2,-2,2],[-2,2,2],[2,2,2.5]]},"
#define MOVES                                                                                                \
    "\"moves\":[{\"twist\":{\"axis\":\"z\",\"degrees\":30}},{\"at\":[0,0,0],\"by\":[0.25,-0.5,0.125]}]"

static void add_link(lattice_chain *chain, const char *members)
{
    char text[2000];
    ffd_error error = {0};
    const int size = snprintf(text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s}", members);
    chain_link *links = ffd_realloc(chain->links, chain->count + 1, sizeof *links);
    assert_non_null(links);
    chain->links = links;
    links[chain->count] = (chain_link){0};
    if (ffd_lattice_parse(text, (size_t)size, "test", &links[chain->count++].lattice, &error) ||
        ffd_chain_prepare(chain, chain->count - 1, &error))
        fail_msg("%s %s", error.pointer, error.message);
}

/* The results of a pass. */
typedef struct outcome {
    cloud *mesh;
    double uvw[3 * NUMBERED], deformed[3 * NUMBERED], gradients[9 * NUMBERED];
    uint8_t statuses[NUMBERED];
    pass_totals totals;
} outcome;

static outcome *run_on(cloud *mesh, const lattice_chain *chain, const embedding_file *embedding, int threads)
{
    outcome *made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->mesh = mesh;
    const mesh_pass pass = {.document = &made->mesh->head,
                            .chain = chain,
                            .links = chain->count,
                            .threads = threads,
                            .embedding = embedding,
                            .write = true,
                            .uvw = made->uvw,
                            .statuses = made->statuses,
                            .deformed = made->deformed,
                            .gradients = made->gradients,
                            .determinants = true};
    assert_int_equal(ffd_pass_over_mesh(&pass, &made->totals, NULL), FFD_OK);
    made->totals.embed_seconds = made->totals.deform_seconds = 0;
    return made;
}

static outcome *run(const lattice_chain *chain, const embedding_file *embedding, int threads)
{
    return run_on(make_cloud(), chain, embedding, threads);
}

static void free_outcome(outcome *made)
{
    free(made->mesh);
    free(made);
}

static void assert_same(const outcome *a, const outcome *b)
{
    assert_memory_equal(a->uvw, b->uvw, sizeof a->uvw);
    assert_memory_equal(a->statuses, b->statuses, sizeof a->statuses);
    assert_memory_equal(a->deformed, b->deformed, sizeof a->deformed);
    assert_memory_equal(a->gradients, b->gradients, sizeof a->gradients);
    assert_memory_equal(a->mesh->xyz, b->mesh->xyz, sizeof a->mesh->xyz);
}

static double determinant(const double gradient[9])
{
    double f[9];
    for (int i = 0; i < 9; i++)
        f[i] = gradient[i] + (i % 4 == 0 ? 1 : 0);
    return mat_determinant(f);
}

/* Selects two thirds of part 0, including a vertex that is not finite and one at -0; nothing of part 2. */
static void select_some(cloud *mesh, uint8_t selected[MOST])
{
    for (size_t i = 0; i < MOST; i++)
        selected[i] = i % 3 != 1;
    mesh->parts[0].selected = selected;
    mesh->parts[2].skipped = true;
    mesh->xyz[0][3 * 4500 + 1] = NAN;
    mesh->xyz[0][3 * 9] = -0.0;
}

/* Selected vertices get the same results as without a selection, the others do not move; figures cover
   selected ones only. */
static void only_selected_vertices_move_and_are_counted(void **state)
{
    (void)state;
    static uint8_t selected[MOST];
    lattice_chain chain = {0};
    add_link(&chain, BOX "\"moves\":[{\"by\":[0,0.5,-8]}]");
    add_link(&chain, BENT MOVES);
    cloud *all = make_cloud(), *some = make_cloud();
    select_some(some, selected);
    select_some(all, selected);
    all->parts[0].selected = NULL;
    all->parts[2].skipped = false;
    cloud *const before = malloc(sizeof *before);
    assert_non_null(before);
    *before = *some;
    outcome *whole = run_on(all, &chain, NULL, 2), *made = run_on(some, &chain, NULL, 2);
    ffd_bounds rest = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}}, deformed = rest;
    uint64_t vertices = 0, moved = 0, outside = 0, first_outside = UINT64_MAX;
    for (size_t i = 0; i < NUMBERED; i++) {
        double p[3];
        const size_t part = i < MOST ? 0 : i < MOST + WHOLE ? 2 : 3, at = part ? 0 : 3 * i;
        const bool chosen = part == 3 || (part == 0 && selected[i]);
        place_of(before, i, p);
        if (!chosen) {
            const double zeros[9] = {0};
            assert_true(isnan(made->uvw[3 * i]) && made->statuses[i] == FFD_VERTEX_OUTSIDE);
            assert_memory_equal(made->deformed + 3 * i, p, sizeof p);
            assert_memory_equal(made->gradients + 9 * i, zeros, sizeof zeros);
            continue;
        }
        vertices++;
        assert_memory_equal(made->uvw + 3 * i, whole->uvw + 3 * i, 3 * sizeof(double));
        assert_int_equal(made->statuses[i], whole->statuses[i]);
        assert_memory_equal(made->deformed + 3 * i, whole->deformed + 3 * i, 3 * sizeof(double));
        assert_memory_equal(made->gradients + 9 * i, whole->gradients + 9 * i, 9 * sizeof(double));
        outside += made->statuses[i] == FFD_VERTEX_OUTSIDE;
        first_outside = made->statuses[i] == FFD_VERTEX_OUTSIDE && i < first_outside ? i : first_outside;
        if (part == 0)
            moved += made->mesh->xyz[0][at] != before->xyz[0][at] ||
                     made->mesh->xyz[0][at + 1] != before->xyz[0][at + 1] ||
                     made->mesh->xyz[0][at + 2] != before->xyz[0][at + 2];
        for (int a = 0; a < 3 && vec_is_finite(p); a++) {
            const double now = part == 3 ? NAN : made->deformed[3 * i + (size_t)a];
            rest.min[a] = fmin(rest.min[a], p[a]);
            rest.max[a] = fmax(rest.max[a], p[a]);
            deformed.min[a] = fmin(deformed.min[a], now);
            deformed.max[a] = fmax(deformed.max[a], now);
        }
    }
    for (size_t i = 0; i < MOST; i++)
        if (!selected[i])
            assert_memory_equal(made->mesh->xyz[0] + 3 * i, before->xyz[0] + 3 * i, 3 * sizeof(double));
        else
            assert_memory_equal(made->mesh->xyz[0] + 3 * i, whole->mesh->xyz[0] + 3 * i, 3 * sizeof(double));
    assert_memory_equal(made->mesh->xyz[2], before->xyz[2], sizeof before->xyz[2]);
    assert_int_equal(made->totals.vertices, vertices);
    assert_int_equal(made->totals.counts[FFD_VERTEX_OUTSIDE], outside);
    assert_int_equal(made->totals.first_outside, first_outside);
    assert_int_equal(made->totals.counts[FFD_VERTEX_INVALID], 1);
    assert_int_equal(made->totals.first_invalid, 4500);
    assert_true(made->totals.moved > 1000 && moved - made->totals.moved <= 1); /* NaN differs from NaN */
    for (int a = 0; a < 3; a++) {
        assert_true(made->totals.before.min[a] == rest.min[a] && made->totals.before.max[a] == rest.max[a]);
        assert_true(made->totals.after.min[a] <= deformed.min[a] &&
                    made->totals.after.max[a] >= deformed.max[a]);
    }
    free(before);
    free_outcome(whole);
    free_outcome(made);
    ffd_chain_free(&chain);
}

/* The first vertex that overflows the file's number type is reported; vertices that stay may be anywhere. */
static void the_first_vertex_too_large_to_store_is_named(void **state)
{
    (void)state;
    lattice_chain chain = {0};
    add_link(&chain, BOX "\"moves\":[{\"by\":[0,0.5,0]}]");
    for (int round = 0; round < 3; round++) {
        cloud *mesh = make_cloud();
        cloud *const before = malloc(sizeof *before);
        assert_non_null(before);
        mesh->head.largest_coordinate = round == 0 ? 2.25 : round == 1 ? 2.4875 : 1e9;
        *before = *mesh;
        outcome *made = run_on(mesh, &chain, NULL, 2);
        uint64_t first = UINT64_MAX;
        for (size_t i = 0; i < MOST + WHOLE && first == UINT64_MAX; i++)
            for (size_t a = 0; a < 3; a++) {
                const size_t part = i < MOST ? 0 : 2, at = 3 * (i - (part ? MOST : 0)) + a;
                if (mesh->xyz[part][at] != before->xyz[part][at] &&
                    fabs(mesh->xyz[part][at]) > mesh->head.largest_coordinate)
                    first = i;
            }
        assert_true(made->totals.first_overflow == first && (first < UINT64_MAX) == (round < 2));
        free(before);
        free_outcome(made);
    }
    ffd_chain_free(&chain);
}

/* Each vertex alone, with the library's own functions. */
static void every_vertex_gets_what_the_library_gives_it_alone(void **state)
{
    (void)state;
    lattice_chain chain = {0};
    add_link(&chain, BENT MOVES);
    cloud *mesh = make_cloud();
    outcome *made = run(&chain, NULL, 2);
    double least = HUGE_VAL, most = -HUGE_VAL;
    size_t inside = 0;
    assert_int_equal(ffd_mesh_vertex_count(&mesh->head), NUMBERED);
    for (size_t i = 0; i < NUMBERED; i++) {
        double p[3], delta[3] = {0}, gradient[9] = {0};
        ffd_location found;
        const bool kept = !place_of(mesh, i, p);
        assert_int_equal(ffd_locator_find(chain.links[0].locator, p, 1, &found, NULL), FFD_OK);
        if (kept) {
            for (size_t k = 0; k < 9; k++)
                assert_true(isnan(made->gradients[9 * i + k]) && isnan(made->deformed[3 * i + k % 3]));
            continue;
        }
        if (found.status == FFD_VERTEX_INSIDE) {
            inside++;
            ffd_displacement(chain.links[0].lattice, found.uvw, delta, gradient);
            least = fmin(least, determinant(gradient));
            most = fmax(most, determinant(gradient));
        }
        for (size_t a = 0; a < 3; a++)
            assert_true(made->deformed[3 * i + a] == p[a] + delta[a]);
        for (size_t k = 0; k < 9; k++)
            assert_true(made->gradients[9 * i + k] == gradient[k]);
    }
    assert_true(inside > 500 && inside < NUMBERED - 500);
    assert_true(made->totals.det_min == least && made->totals.det_max == most && least < most);
    assert_int_equal(made->totals.transforms_singular, 5);
    free_outcome(made);
    free(mesh);
    ffd_chain_free(&chain);
}

/* Two links: the second acts on the results of the first, F = F2 F1. */
static void gradients_of_a_chain_multiply(void **state)
{
    (void)state;
    lattice_chain chain = {0};
    add_link(&chain, BOX MOVES);
    add_link(&chain, "\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-9,-9,-9],\"max\":[9,9,9]}},\"moves\":["
                     "{\"matrix\":[2,0,0,0,0,1,0.5,0,0,0,1,0,0,0,0,1]}]");
    const lattice_chain one = {.links = chain.links, .count = 1, .outside = chain.outside};
    const double second[9] = {2, 0, 0, 0, 1, 0.5, 0, 0, 1};
    outcome *first = run(&one, NULL, 1), *both = run(&chain, NULL, 1);
    for (size_t i = 0; i < MOST; i++) {
        double f[9], expected[9], place[3];
        for (size_t k = 0; k < 9; k++)
            f[k] = first->gradients[9 * i + k] + (k % 4 == 0 ? 1 : 0);
        mat_multiply(second, f, expected);
        mat_apply(second, first->deformed + 3 * i, place);
        for (size_t k = 0; k < 9; k++)
            assert_true(fabs(both->gradients[9 * i + k] + (k % 4 == 0 ? 1 : 0) - expected[k]) <= 1e-13);
        for (size_t a = 0; a < 3; a++)
            assert_true(fabs(both->deformed[3 * i + a] - place[a]) <= 1e-13);
    }
    free_outcome(first);
    free_outcome(both);
    ffd_chain_free(&chain);
}

static void without_gradients_there_are_no_determinants(void **state)
{
    (void)state;
    lattice_chain chain = {0};
    add_link(&chain, BOX MOVES);
    cloud *mesh = make_cloud();
    pass_totals totals;
    const mesh_pass pass = {.document = &mesh->head, .chain = &chain, .links = 1, .threads = 1};
    assert_int_equal(ffd_pass_over_mesh(&pass, &totals, NULL), FFD_OK);
    assert_true(totals.det_min > totals.det_max);
    free(mesh);
    ffd_chain_free(&chain);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const members[] = {BOX MOVES, BENT MOVES};
    for (int i = 0; i < 4; i += stride(3)) {
        lattice_chain chain = {.outside = {.extend = i >= 2, .falloff = 1.5}};
        add_link(&chain, members[i % 2]);
        outcome *one = run(&chain, NULL, 1);
        for (int threads = 2; threads < 6; threads += stride(4)) {
            outcome *more = run(&chain, NULL, threads);
            assert_same(one, more);
            assert_memory_equal(&one->totals, &more->totals, sizeof one->totals);
            free_outcome(more);
        }
        free_outcome(one);
        ffd_chain_free(&chain);
    }
}

static double distance_to_box(const double p[3])
{
    double away[3];
    for (int a = 0; a < 3; a++)
        away[a] = fmax(fabs(p[a]) - 2, 0);
    return vec_length(away);
}

/* A box that is translated: outside, the same displacement, faded. */
static void points_outside_stay_or_follow_with_falloff(void **state)
{
    (void)state;
    static const double falloffs[] = {0, 1.25, 100};
    for (int f = -1; f < 3; f++) {
        const double falloff = f < 0 ? 0 : falloffs[f];
        lattice_chain chain = {.outside = {.extend = f >= 0, .falloff = falloff}};
        add_link(&chain, BOX "\"moves\":[{\"by\":[0,0.5,-8]}]");
        cloud *mesh = make_cloud();
        outcome *made = run(&chain, NULL, 2);
        uint64_t outside = 0, extended = 0;
        for (size_t i = 0; i < NUMBERED; i++) {
            double p[3], weight = 1;
            const bool kept = !place_of(mesh, i, p);
            const double distance = distance_to_box(p), s = falloff > 0 ? distance / falloff : 0;
            if (distance > 0) {
                outside++;
                weight = f < 0 || s >= 1 ? 0 : 1 - s * s * s * (10 - 15 * s + 6 * s * s);
                extended += weight > 0;
            }
            assert_int_equal(made->statuses[i], distance > 0 ? FFD_VERTEX_OUTSIDE : FFD_VERTEX_INSIDE);
            if (kept)
                continue;
            assert_true(made->deformed[3 * i] == p[0]);
            assert_true(fabs(made->deformed[3 * i + 1] - p[1] - 0.5 * weight) <= 1e-14);
            assert_true(fabs(made->deformed[3 * i + 2] - p[2] + 8 * weight) <= 1e-13);
            if (weight == 0)
                assert_memory_equal(made->deformed + 3 * i, p, sizeof p);
        }
        assert_int_equal(made->totals.counts[FFD_VERTEX_OUTSIDE], outside);
        assert_int_equal(made->totals.outside_all, outside);
        assert_int_equal(made->totals.extended, extended);
        assert_true(f != 1 || (extended > 100 && extended < outside - 100));
        assert_true(f == 1 || extended == (f < 0 ? 0 : outside));
        free_outcome(made);
        free(mesh);
        ffd_chain_free(&chain);
    }
}

/* A file */

static void write_embedding(const lattice_chain *chain, const double *uvw, const uint8_t *statuses,
                            embedding_file *file)
{
    cloud *mesh = make_cloud();
    hash128 positions;
    file_output *output;
    const hash128 rest = ffd_rest_hash(chain->links[0].lattice);
    assert_int_equal(ffd_embedding_hash_positions(&mesh->head, 1, &positions, NULL), FFD_OK);
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("e.npy"), true, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_write(output, uvw, statuses, NUMBERED, &positions, &rest, NULL), FFD_OK);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_int_equal(ffd_embedding_reuse(&(ffd_embedding_source){.path = in_folder("e.npy")}, &mesh->head,
                                         chain->links[0].lattice, 0, 1, file, NULL),
                     FFD_OK);
    free(mesh);
}

static void u_v_w_of_a_file_give_what_a_search_gives(void **state)
{
    (void)state;
    static const char *const members[] = {BOX MOVES, BENT MOVES};
    for (int i = 0; i < 4; i += stride(3)) {
        embedding_file file;
        lattice_chain chain = {.outside = {.extend = i >= 2, .falloff = 1.5}};
        add_link(&chain, members[i % 2]);
        outcome *searched = run(&chain, NULL, 1);
        write_embedding(&chain, searched->uvw, searched->statuses, &file);
        outcome *reused = run(&chain, &file, 2);
        assert_same(searched, reused);
        const pass_totals *a = &searched->totals, *b = &reused->totals;
        assert_memory_equal(a->counts, b->counts, sizeof a->counts);
        assert_true(a->extended == b->extended && a->det_min == b->det_min && a->det_max == b->det_max);
        assert_int_equal(b->evaluations, 0);
        assert_true(sqrt(b->residual_square_max) <= 1e-15);
        free_outcome(searched);
        free_outcome(reused);
        ffd_embedding_close(&file);
        ffd_chain_free(&chain);
    }
}

/* A forged file with valid hashes may contain any u,v,w. */
static void forged_u_v_w_stay_within_the_domain(void **state)
{
    (void)state;
    static const double values[] = {-1, 2, 1e300, -1e300, 0.5, NAN, HUGE_VAL, 1e-320};
    static const char *const members[] = {
        BOX MOVES,
        "\"size\":[4,6,4],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":[0,0,1],\"radius\":[1,2],"
        "\"height\":3}}," MOVES};
    double *uvw = ffd_alloc(NUMBERED, 3 * sizeof *uvw);
    uint8_t *statuses = ffd_alloc(NUMBERED, 1);
    assert_true(uvw && statuses);
    for (size_t i = 0; i < NUMBERED; i++) {
        statuses[i] = (uint8_t)(i % 5);
        for (size_t a = 0; a < 3; a++)
            uvw[3 * i + a] = values[(i / 5 + (a + 1) * (i / 40)) %
                                    (i % 5 == FFD_VERTEX_INSIDE || i % 5 == FFD_VERTEX_MULTIPLE ? 5 : 8)];
    }
    for (int l = 0; l < 2; l++) {
        embedding_file file;
        lattice_chain chain = {.outside = {.extend = true}};
        add_link(&chain, members[l]);
        write_embedding(&chain, uvw, statuses, &file);
        outcome *made = run(&chain, &file, 2);
        double lo[3], hi[3];
        ffd_lattice_get_domain(chain.links[0].lattice, lo, hi);
        for (size_t i = 0; i < NUMBERED; i++) {
            const bool given =
                i % 5 != FFD_VERTEX_OUTSIDE && i % 5 != FFD_VERTEX_INVALID && vec_is_finite(uvw + 3 * i);
            assert_int_equal(made->statuses[i], i % 5);
            for (size_t a = 0; a < 3; a++) {
                const double u = made->uvw[3 * i + a];
                assert_true(given ? u >= lo[a] && u <= hi[a] : isnan(u));
            }
            if (i < MOST + WHOLE)
                assert_true(vec_is_finite(made->deformed + 3 * i));
        }
        free_outcome(made);
        ffd_embedding_close(&file);
        ffd_chain_free(&chain);
    }
    ffd_free(uvw);
    ffd_free(statuses);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_vertex_gets_what_the_library_gives_it_alone),
        cmocka_unit_test(only_selected_vertices_move_and_are_counted),
        cmocka_unit_test(the_first_vertex_too_large_to_store_is_named),
        cmocka_unit_test(gradients_of_a_chain_multiply),
        cmocka_unit_test(without_gradients_there_are_no_determinants),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(points_outside_stay_or_follow_with_falloff),
        cmocka_unit_test(u_v_w_of_a_file_give_what_a_search_gives),
        cmocka_unit_test(forged_u_v_w_stay_within_the_domain),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
