/* Topology figures: known surfaces, and random meshes compared with plain counting. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "io/openmesh/topology.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define MOST_VERTICES 16
#define MOST_FACES 64
#define MOST_CORNERS 512

/* A mesh that a test builds. */
typedef struct sample {
    double positions[3 * MOST_VERTICES];
    size_t start[MOST_FACES + 1];
    uint32_t corners[MOST_CORNERS];
    mesh_faces faces;
} sample;

static void sample_begin(sample *s, size_t vertices)
{
    memset(s, 0, sizeof *s);
    assert_true(vertices <= MOST_VERTICES);
    s->faces = (mesh_faces){
        .vertex_count = vertices, .positions = s->positions, .start = s->start, .corners = s->corners};
}

static void sample_add(sample *s, size_t count, const uint32_t *corners)
{
    const size_t first = s->start[s->faces.face_count];
    assert_true(s->faces.face_count < MOST_FACES && first + count <= MOST_CORNERS);
    for (size_t i = 0; i < count; i++)
        s->corners[first + i] = corners[i];
    s->start[++s->faces.face_count] = first + count;
}

#define ADD(s, ...)                                                                                          \
    sample_add((s), sizeof((uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t), (const uint32_t[]){__VA_ARGS__})

static mesh_topology topology_of(const mesh_faces *faces)
{
    mesh_topology topology;
    ffd_error error = {0};
    memset(&topology, 0xff, sizeof topology);
    const ffd_status status = ffd_topology_compute(faces, &topology, &error);
    if (status != FFD_OK)
        fail_msg("%s", error.message);
    return topology;
}

static void print_faces(const mesh_faces *faces)
{
    for (size_t f = 0; f < faces->face_count; f++) {
        print_error("face");
        for (size_t c = faces->start[f]; c < faces->start[f + 1]; c++)
            print_error(" %" PRIu32, faces->corners[c]);
        print_error("\n");
    }
}

static void assert_same(const mesh_topology *a, const mesh_topology *b, const mesh_faces *faces)
{
    const struct {
        const char *name;
        long long a, b;
    } rows[] = {
#define ROW(member) {#member, (long long)a->member, (long long)b->member}
        ROW(vertices),
        ROW(faces),
        ROW(edges),
        ROW(isolated_vertices),
        ROW(degenerate_faces),
        ROW(components),
        ROW(boundary_loops),
        ROW(boundary_edges),
        ROW(non_manifold_edges),
        ROW(non_manifold_vertices),
        ROW(euler),
#undef ROW
    };
    bool same = true;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].a != rows[i].b) {
            print_error("%s: %lld, expected %lld\n", rows[i].name, rows[i].a, rows[i].b);
            same = false;
        }
    if (!(fabs(a->area - b->area) <= 1e-12 * (1 + b->area))) {
        print_error("area: %.17g, expected %.17g\n", a->area, b->area);
        same = false;
    }
    if (!same) {
        print_faces(faces);
        fail();
    }
}

static void expect(const sample *s, mesh_topology expected)
{
    const mesh_topology got = topology_of(&s->faces);
    assert_same(&got, &expected, &s->faces);
}

/* Known surfaces */

static void place(sample *s, size_t vertex, double x, double y, double z)
{
    s->positions[3 * vertex] = x;
    s->positions[3 * vertex + 1] = y;
    s->positions[3 * vertex + 2] = z;
}

static void make_cube(sample *s, size_t face_count)
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    sample_begin(s, 8);
    for (unsigned v = 0; v < 8; v++)
        place(s, v, v & 1, v >> 1 & 1, v >> 2);
    for (size_t f = 0; f < face_count; f++)
        sample_add(s, 4, quads[f]);
}

static void a_cube_is_closed(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 6);
    expect(&s,
           (mesh_topology){.vertices = 8, .faces = 6, .edges = 12, .components = 1, .euler = 2, .area = 6});
}

static void an_open_box_has_one_boundary(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 5);
    expect(&s, (mesh_topology){.vertices = 8,
                               .faces = 5,
                               .edges = 12,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 4,
                               .euler = 1,
                               .area = 5});
}

static void a_tube_has_two_boundaries(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 6);
    memmove(s.corners, s.corners + 8, 16 * sizeof *s.corners); /* without the first two faces */
    s.faces.face_count = 4;
    expect(&s, (mesh_topology){.vertices = 8,
                               .faces = 4,
                               .edges = 12,
                               .components = 1,
                               .boundary_loops = 2,
                               .boundary_edges = 8,
                               .euler = 0,
                               .area = 4});
}

static void a_torus_has_euler_number_zero(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 16);
    for (uint32_t j = 0; j < 4; j++)
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t i1 = (i + 1) % 4, j1 = (j + 1) % 4;
            ADD(&s, i + 4 * j, i1 + 4 * j, i1 + 4 * j1, i + 4 * j1);
        }
    expect(&s, (mesh_topology){.vertices = 16, .faces = 16, .edges = 32, .components = 1, .euler = 0});
}

/* A ladder of quads whose last rung is attached upside down: both faces of one edge use it in the same
   direction. */
static void a_moebius_band_has_one_non_manifold_edge(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 10);
    for (uint32_t i = 0; i < 4; i++)
        ADD(&s, 2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2);
    ADD(&s, 8, 9, 0, 1);
    expect(&s, (mesh_topology){.vertices = 10,
                               .faces = 5,
                               .edges = 15,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 10,
                               .non_manifold_edges = 1,
                               .euler = 0});
}

static void faces_that_disagree_make_a_non_manifold_edge(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 4);
    ADD(&s, 0, 1, 2);
    ADD(&s, 0, 1, 3);
    expect(&s, (mesh_topology){.vertices = 4,
                               .faces = 2,
                               .edges = 5,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 4,
                               .non_manifold_edges = 1,
                               .euler = 1});
}

static void a_bow_tie_has_one_non_manifold_vertex(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 5);
    ADD(&s, 0, 1, 2);
    ADD(&s, 0, 3, 4);
    expect(&s, (mesh_topology){.vertices = 5,
                               .faces = 2,
                               .edges = 6,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 6,
                               .non_manifold_vertices = 1,
                               .euler = 1});
}

/* Two closed tetrahedra that share a vertex: half-edges cannot represent the faces of the second one
   there. */
static void solids_that_touch_share_a_non_manifold_vertex(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 7);
    for (uint32_t k = 0; k <= 3; k += 3) {
        ADD(&s, 0, 1 + k, 2 + k);
        ADD(&s, 0, 2 + k, 3 + k);
        ADD(&s, 0, 3 + k, 1 + k);
        ADD(&s, 3 + k, 2 + k, 1 + k);
    }
    expect(
        &s,
        (mesh_topology){
            .vertices = 7, .faces = 8, .edges = 12, .components = 1, .non_manifold_vertices = 1, .euler = 3});
}

static void three_faces_make_an_edge_non_manifold(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 5);
    place(&s, 1, 1, 0, 0);
    place(&s, 2, 0, 2, 0);
    place(&s, 3, 0, -2, 0);
    place(&s, 4, 0, 0, 2);
    ADD(&s, 0, 1, 2);
    ADD(&s, 1, 0, 3);
    ADD(&s, 0, 1, 4);
    expect(&s, (mesh_topology){.vertices = 5,
                               .faces = 3,
                               .edges = 7,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 6,
                               .non_manifold_edges = 1,
                               .non_manifold_vertices = 2,
                               .euler = 1,
                               .area = 3});
}

/* Faces with fewer than three different corners are counted separately; equal neighbours are one corner. */
static void degenerate_faces_are_counted_apart(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 6);
    sample_add(&s, 0, NULL);
    ADD(&s, 3);
    ADD(&s, 3, 4);
    ADD(&s, 3, 3, 3, 3);
    ADD(&s, 3, 4, 3, 4);
    ADD(&s, 0, 0, 1, 1, 2, 2, 0);
    expect(&s, (mesh_topology){.vertices = 6,
                               .faces = 1,
                               .edges = 3,
                               .isolated_vertices = 3,
                               .degenerate_faces = 5,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 3,
                               .euler = 1});
}

/* A square ring as one face, cut along 0-4: the cut is used twice, so it is not a boundary. */
static void a_cut_within_one_face_is_no_boundary(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 8);
    for (uint32_t k = 0; k < 2; k++) {
        const double r = k ? 1 : 2;
        place(&s, 4 * k, -r, -r, 0);
        place(&s, 4 * k + 1, r, -r, 0);
        place(&s, 4 * k + 2, r, r, 0);
        place(&s, 4 * k + 3, -r, r, 0);
    }
    ADD(&s, 0, 1, 2, 3, 0, 4, 7, 6, 5, 4);
    expect(&s, (mesh_topology){.vertices = 8,
                               .faces = 1,
                               .edges = 9,
                               .components = 1,
                               .boundary_loops = 2,
                               .boundary_edges = 8,
                               .euler = 0,
                               .area = 12});
}

static void a_mesh_without_faces_has_only_vertices(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 0);
    expect(&s, (mesh_topology){0});
    const mesh_faces nothing = {0};
    const mesh_topology got = topology_of(&nothing), expected = {0};
    assert_same(&got, &expected, &nothing);
    sample_begin(&s, 4);
    expect(&s, (mesh_topology){.vertices = 4, .isolated_vertices = 4});
}

/* Vertices that repeat others do not count; a vertex that no face uses does. */
static void repeated_vertices_are_not_counted(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 7);
    s.positions[3 * 1] = s.positions[3 * 2 + 1] = 1;
    ADD(&s, 0, 1, 2);
    ADD(&s, 0, 2, 1); /* 3, 4 and 5 in the file */
    s.faces.repeated = 3;
    expect(&s, (mesh_topology){.vertices = 4,
                               .isolated_vertices = 1,
                               .faces = 2,
                               .edges = 3,
                               .components = 1,
                               .euler = 2,
                               .area = 1});
}

static void a_concave_polygon_far_away_has_its_area(void **state)
{
    (void)state;
    sample s;
    sample_begin(&s, 12); /* an L of area 3, and unused vertices */
    static const double corners[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (size_t i = 0; i < 6; i++)
        place(&s, i, corners[i][0] + 1e6, corners[i][1], -1e6);
    ADD(&s, 0, 1, 2, 3, 4, 5);
    expect(&s, (mesh_topology){.vertices = 12,
                               .faces = 1,
                               .edges = 6,
                               .isolated_vertices = 6,
                               .components = 1,
                               .boundary_loops = 1,
                               .boundary_edges = 6,
                               .euler = 1,
                               .area = 3});
}

static void separate_parts_are_separate_components(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 6);
    s.faces.vertex_count = 11;
    ADD(&s, 8, 9, 10);
    expect(&s, (mesh_topology){.vertices = 11,
                               .faces = 7,
                               .edges = 15,
                               .components = 2,
                               .boundary_loops = 1,
                               .boundary_edges = 3,
                               .euler = 3,
                               .area = 6});
}

/* A cone of many faces: its tip needs several half-edge vertices, which must not show in the figures. */
static void the_tip_of_a_large_fan_is_one_vertex(void **state)
{
    (void)state;
    enum { RIM = 20000 };
    double *positions = ffd_alloc_zero(3 * (RIM + 1), sizeof *positions);
    size_t *start = ffd_alloc_zero(RIM + 1, sizeof *start);
    uint32_t *corners = ffd_alloc_zero(3 * RIM, sizeof *corners);
    assert_true(positions && start && corners);
    for (uint32_t i = 0; i < RIM; i++) {
        start[i + 1] = 3 * (size_t)(i + 1);
        corners[3 * i + 1] = 1 + i;
        corners[3 * i + 2] = 1 + (i + 1) % RIM;
    }
    mesh_faces faces = {.vertex_count = RIM + 1,
                        .face_count = RIM,
                        .positions = positions,
                        .start = start,
                        .corners = corners};
    const mesh_topology got = topology_of(&faces);
    const mesh_topology expected = {.vertices = RIM + 1,
                                    .faces = RIM,
                                    .edges = 2 * RIM,
                                    .components = 1,
                                    .boundary_loops = 1,
                                    .boundary_edges = RIM,
                                    .euler = 1};
    faces.face_count = got.edges == expected.edges ? RIM : 0; /* limits the output of a failure */
    assert_same(&got, &expected, &faces);
    ffd_mesh_faces_free(&faces);
    assert_null(faces.positions);
    assert_int_equal(faces.vertex_count, 0);
    ffd_mesh_faces_free(&faces);
}

/* Plain counting, for small meshes. */

typedef struct counts {
    int uses[MOST_VERTICES][MOST_VERTICES]; /* [a][b]: faces that run from a to b */
    size_t vertices;
} counts;

static int uses_of(const counts *c, size_t a, size_t b)
{
    return c->uses[a][b] + c->uses[b][a];
}

/* The face's corners without equal neighbours; 0 if fewer than 3 are different. */
static size_t clean_corners(const mesh_faces *faces, size_t face, uint32_t clean[MOST_CORNERS])
{
    size_t count = 0, different = 0;
    const size_t first = faces->start[face], last = faces->start[face + 1];
    for (size_t i = first; i < last; i++) {
        bool known = false;
        for (size_t k = first; k < i; k++)
            known = known || faces->corners[k] == faces->corners[i];
        different += !known;
        const size_t before = i == first ? last - 1 : i - 1;
        if (faces->corners[i] != faces->corners[before])
            clean[count++] = faces->corners[i];
    }
    return different < 3 ? 0 : count;
}

/* The number of connected sets of marked vertices, with the pairs in joined as connections. */
static size_t count_sets(bool joined[MOST_VERTICES][MOST_VERTICES], const bool marked[MOST_VERTICES])
{
    bool reached[MOST_VERTICES] = {false};
    size_t sets = 0;
    for (size_t seed = 0; seed < MOST_VERTICES; seed++) {
        if (!marked[seed] || reached[seed])
            continue;
        sets++;
        reached[seed] = true;
        for (bool grew = true; grew;) {
            grew = false;
            for (size_t a = 0; a < MOST_VERTICES; a++)
                for (size_t b = 0; b < MOST_VERTICES; b++)
                    if ((joined[a][b] || joined[b][a]) && reached[a] && !reached[b])
                        grew = reached[b] = true;
        }
    }
    return sets;
}

static bool vertex_is_manifold(const mesh_faces *faces, const counts *c, size_t vertex)
{
    bool joined[MOST_VERTICES][MOST_VERTICES] = {{false}}, neighbour[MOST_VERTICES] = {false};
    for (size_t v = 0; v < c->vertices; v++) {
        neighbour[v] = uses_of(c, vertex, v) > 0;
        if (uses_of(c, vertex, v) > 2)
            return false;
    }
    for (size_t f = 0; f < faces->face_count; f++) {
        uint32_t clean[MOST_CORNERS];
        const size_t count = clean_corners(faces, f, clean);
        for (size_t i = 0; i < count; i++)
            if (clean[i] == vertex)
                joined[clean[(i + count - 1) % count]][clean[(i + 1) % count]] = true;
    }
    return count_sets(joined, neighbour) <= 1;
}

/* Newell's sums over the projections. */
static double polygon_area(const mesh_faces *faces, const uint32_t *corners, size_t count)
{
    long double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const double *p = faces->positions + 3 * corners[i],
                     *q = faces->positions + 3 * corners[(i + 1) % count];
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, d = (a + 2) % 3;
            sum[a] += ((long double)p[b] - q[b]) * ((long double)p[d] + q[d]);
        }
    }
    return (double)(sqrtl(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / 2);
}

static mesh_topology plain_count(const mesh_faces *faces)
{
    mesh_topology t = {.vertices = faces->vertex_count};
    counts c = {.vertices = faces->vertex_count};
    for (size_t f = 0; f < faces->face_count; f++) {
        uint32_t clean[MOST_CORNERS];
        const size_t count = clean_corners(faces, f, clean);
        for (size_t i = 0; i < count; i++)
            c.uses[clean[i]][clean[(i + 1) % count]]++;
        t.faces += count > 0;
        t.degenerate_faces += count == 0;
        t.area += polygon_area(faces, clean, count);
    }
    bool joined[MOST_VERTICES][MOST_VERTICES] = {{false}}, used[MOST_VERTICES] = {false};
    bool rim[MOST_VERTICES][MOST_VERTICES] = {{false}}, on_rim[MOST_VERTICES] = {false};
    for (size_t a = 0; a < c.vertices; a++)
        for (size_t b = 0; b < a; b++) {
            const int uses = uses_of(&c, a, b);
            if (uses == 0)
                continue;
            t.edges++;
            joined[a][b] = used[a] = used[b] = true;
            t.non_manifold_edges += uses > 2 || (uses == 2 && c.uses[a][b] != 1);
            if (uses > 1)
                continue;
            t.boundary_edges++;
            rim[a][b] = on_rim[a] = on_rim[b] = true;
        }
    t.components = count_sets(joined, used);
    t.boundary_loops = count_sets(rim, on_rim);
    for (size_t v = 0; v < c.vertices; v++) {
        t.isolated_vertices += !used[v];
        t.non_manifold_vertices += !vertex_is_manifold(faces, &c, v);
    }
    t.euler = (long long)(t.vertices - t.isolated_vertices) - (long long)t.edges + (long long)t.faces;
    return t;
}

static uint64_t random_state;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((random_state >> 33) % limit);
}

/* Arbitrary corners. */
static void make_wild(sample *s)
{
    sample_begin(s, 1 + random_below(MOST_VERTICES));
    const uint32_t faces = random_below(30), most = 1 + random_below(8);
    for (uint32_t f = 0; f < faces; f++) {
        uint32_t corners[8];
        const uint32_t count = random_below(most + 1);
        for (uint32_t i = 0; i < count; i++)
            corners[i] = random_below((uint32_t)s->faces.vertex_count);
        sample_add(s, count, corners);
    }
}

/* Part of a 4x4 torus grid in random order, with some faces reversed and some vertices merged: almost a
   surface. */
static void make_near_surface(sample *s)
{
    sample_begin(s, 16);
    uint32_t merged[16], order[16];
    for (uint32_t i = 0; i < 16; i++) {
        merged[i] = random_below(12) == 0 ? random_below(16) : i;
        const uint32_t k = random_below(i + 1);
        order[i] = order[k];
        order[k] = i;
    }
    const uint32_t turned = random_below(4) + 1, faces = 1 + random_below(16);
    for (uint32_t f = 0; f < faces; f++) {
        const uint32_t i = order[f] % 4, j = order[f] / 4, i1 = (i + 1) % 4, j1 = (j + 1) % 4;
        uint32_t q[4] = {merged[i + 4 * j], merged[i1 + 4 * j], merged[i1 + 4 * j1], merged[i + 4 * j1]};
        if (random_below(turned + 2) == 0) {
            const uint32_t swap = q[1];
            q[1] = q[3];
            q[3] = swap;
        }
        if (random_below(3)) {
            sample_add(s, 4, q);
            continue;
        }
        ADD(s, q[0], q[1], q[2]);
        ADD(s, q[0], q[2], q[3]);
    }
}

static void random_meshes_match_plain_counting(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 6000; seed += is_memory_checked() ? 19 : 1) {
        sample s;
        random_state = seed * 0x9e3779b97f4a7c15u;
        if (seed % 2)
            make_wild(&s);
        else
            make_near_surface(&s);
        for (size_t i = 0; i < 3 * s.faces.vertex_count; i++)
            s.positions[i] = (double)random_below(2001) / 1000 - 1;
        const mesh_topology got = topology_of(&s.faces), expected = plain_count(&s.faces);
        if (memcmp(&got, &expected, offsetof(mesh_topology, area)) != 0)
            print_error("seed %" PRIu64 "\n", seed);
        assert_same(&got, &expected, &s.faces);
    }
    print_message("seeds 1 to 6000\n");
}

static void a_face_with_an_unknown_vertex_is_refused(void **state)
{
    (void)state;
    sample s;
    mesh_topology topology;
    ffd_error error = {0};
    sample_begin(&s, 3);
    ADD(&s, 0, 1, 3);
    assert_int_equal(ffd_topology_compute(&s.faces, &topology, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, "a face names vertex 3 of 3");
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 6);
    ADD(&s, 0, 1, 2);
    long failures = 0;
    for (;; failures++) {
        mesh_topology topology;
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        const ffd_status status = ffd_topology_compute(&s.faces, &topology, &error);
        ffd_alloc_fail_after(-1);
        if (status == FFD_OK)
            break;
        assert_int_equal(status, FFD_E_MEMORY);
        assert_int_equal(error.status, FFD_E_MEMORY);
    }
    assert_true(failures > 5);
}

/* OpenMesh would print complaints on standard error. */
static void nothing_is_written_to_standard_error(void **state)
{
    (void)state;
    sample s;
    make_cube(&s, 6);
    ADD(&s, 0, 1, 2);
    ADD(&s, 0, 1, 7);
    FILE *caught = tmpfile();
    const int kept = dup(STDERR_FILENO);
    assert_true(caught && kept >= 0);
    dup2(fileno(caught), STDERR_FILENO);
    topology_of(&s.faces);
    for (random_state = 7; random_below(100);) {
        make_near_surface(&s);
        topology_of(&s.faces);
    }
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    fseek(caught, 0, SEEK_END);
    assert_int_equal(ftell(caught), 0);
    fclose(caught);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_closed),
        cmocka_unit_test(an_open_box_has_one_boundary),
        cmocka_unit_test(a_tube_has_two_boundaries),
        cmocka_unit_test(a_torus_has_euler_number_zero),
        cmocka_unit_test(a_moebius_band_has_one_non_manifold_edge),
        cmocka_unit_test(faces_that_disagree_make_a_non_manifold_edge),
        cmocka_unit_test(a_bow_tie_has_one_non_manifold_vertex),
        cmocka_unit_test(solids_that_touch_share_a_non_manifold_vertex),
        cmocka_unit_test(three_faces_make_an_edge_non_manifold),
        cmocka_unit_test(degenerate_faces_are_counted_apart),
        cmocka_unit_test(a_cut_within_one_face_is_no_boundary),
        cmocka_unit_test(a_mesh_without_faces_has_only_vertices),
        cmocka_unit_test(repeated_vertices_are_not_counted),
        cmocka_unit_test(a_concave_polygon_far_away_has_its_area),
        cmocka_unit_test(separate_parts_are_separate_components),
        cmocka_unit_test(the_tip_of_a_large_fan_is_one_vertex),
        cmocka_unit_test(random_meshes_match_plain_counting),
        cmocka_unit_test(a_face_with_an_unknown_vertex_is_refused),
        cmocka_unit_test(every_failed_allocation_is_reported),
        cmocka_unit_test(nothing_is_written_to_standard_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
