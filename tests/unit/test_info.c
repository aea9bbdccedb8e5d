/* The output of `ffd info` for meshes and lattices, as JSON and as text, and `ffd lattice new`. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/json_facts.h"
#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "job/info.h"
#include <ffd/job.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static ffd_info_desc describe(const char *path, bool json)
{
    ffd_info_desc desc;
    ffd_info_desc_init(&desc, sizeof desc);
    desc.file.path = path;
    desc.json = json;
    return desc;
}

/* Returns the JSON for a file in the folder, freed by the caller. */
static json_facts *info_of(const char *name)
{
    const ffd_info_desc desc = describe(in_folder(name), true);
    char *text = NULL;
    ffd_error error = {0};
    if (ffd_info_run(&desc, &text, &error) != FFD_OK)
        fail_msg("%s: %s", error.pointer, error.message);
    json_facts *const json = facts_read(text, strlen(text));
    assert_string_equal(text + strlen(text) - 2, "}\n");
    ffd_free(text);
    assert_text(json, facts_member(json, "format"), "ffd-info");
    assert_true(facts_number(json, facts_member(json, "version")) == 1);
    assert_text(json, facts_member(json, "file"), in_folder(name));
    return json;
}

static char *text_of(const char *name)
{
    const ffd_info_desc desc = describe(in_folder(name), false);
    char *text = NULL;
    ffd_error error = {0};
    if (ffd_info_run(&desc, &text, &error) != FFD_OK)
        fail_msg("%s: %s", error.pointer, error.message);
    return text;
}

static ffd_status failure_of(ffd_source source, ffd_error *error)
{
    char *text = (char *)"untouched";
    ffd_info_desc desc = describe(NULL, true);
    desc.file = source;
    memset(error, 0, sizeof *error);
    const ffd_status status = ffd_info_run(&desc, &text, error);
    assert_null(text);
    return status;
}

static void assert_number(const json_facts *json, const char *names, double expected)
{
    if (!facts_is(json, names, JSON_NUMBER))
        fail_msg("%s is not a number", names);
    const double number = facts_number(json, facts_member(json, names));
    if (!(fabs(number - expected) <= 1e-14 * fabs(expected)))
        fail_msg("%s is %.17g, not %.17g", names, number, expected);
}

static void assert_word(const json_facts *json, const char *names, const char *expected)
{
    if (!facts_is(json, names, JSON_STRING))
        fail_msg("%s is not a string", names);
    assert_text(json, facts_member(json, names), expected);
}

static void assert_none(const json_facts *json, const char *names)
{
    if (!facts_is(json, names, JSON_NULL))
        fail_msg("%s is not null", names);
}

static void assert_vector(const json_facts *json, const char *names, double x, double y, double z)
{
    const double expected[3] = {x, y, z};
    if (!facts_is(json, names, JSON_ARRAY) || json->tree.values[facts_member(json, names)].count != 3)
        fail_msg("%s is not a vector", names);
    for (size_t i = 0; i < 3; i++) {
        const double number = facts_number_at(json, names, i);
        if (!(fabs(number - expected[i]) <= 1e-14 * fabs(expected[i])))
            fail_msg("%s[%zu] is %.17g, not %.17g", names, i, number, expected[i]);
    }
}

/* A document of the test's own */

typedef struct fake_document {
    mesh_document head;
    mesh_part parts[2];
    double xyz[2][9];
    ffd_status faces_status;
} fake_document;

static void fake_read(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                      size_t first, size_t count, double *xyz)
{
    (void)stream;
    (void)state;
    memcpy(xyz, ((const fake_document *)document)->xyz[part] + 3 * first, 3 * count * sizeof *xyz);
}

static ffd_status fake_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    (void)document;
    (void)error;
    ffd_json_string(json, "maker", "tests");
    return FFD_OK;
}

static ffd_status fake_faces(const mesh_document *document, mesh_state state, mesh_faces *faces,
                             ffd_error *error)
{
    const fake_document *fake = (const fake_document *)document;
    (void)state;
    if (fake->faces_status != FFD_OK)
        return ffd_fail(error, fake->faces_status, "these faces are too odd");
    *faces = (mesh_faces){.vertex_count = 3, .face_count = 1, .lines = 4};
    faces->positions = ffd_alloc(9, sizeof(double));
    faces->start = ffd_alloc_zero(2, sizeof(size_t));
    faces->corners = ffd_alloc(3, sizeof(uint32_t));
    assert_true(faces->positions && faces->start && faces->corners);
    memcpy(faces->positions, fake->xyz[0], 9 * sizeof(double));
    faces->start[1] = 3;
    for (uint32_t i = 0; i < 3; i++)
        faces->corners[i] = i;
    return FFD_OK;
}

static const mesh_format fake_format = {
    .name = "fake", .read = fake_read, .describe = fake_describe, .faces = fake_faces};

static fake_document make_fake(void)
{
    fake_document fake = {.head = {.format = &fake_format, .part_count = 2, .budget = ffd_budget_make(0)},
                          .parts = {{.vertex_count = 3, .identity = true, .normal_count = 3},
                                    {.vertex_count = 3,
                                     .linear = {2, 0, 0, 0, 0, 1, 0, 1, 0},
                                     .offset = {10, 0, 0},
                                     .has_tangents = true}},
                          .xyz = {{0, 0, 0, 4, 0, 0, 0, 3, 0}, {1, 7, 0, NAN, 0, 0, 0, 0, INFINITY}}};
    return fake;
}

static ffd_status fake_info(fake_document *fake, json_facts **json, ffd_error *error)
{
    byte_buffer out = {0};
    json_text writer;
    fake->head.parts = fake->parts;
    ffd_json_begin(&writer, &out);
    ffd_json_object(&writer, NULL, false);
    const ffd_status status = ffd_info_document(&fake->head, &writer, error);
    *json = NULL;
    if (status == FFD_OK) {
        ffd_json_end(&writer, '}');
        *json = facts_read(out.data, out.size);
    }
    ffd_buffer_free(&out);
    return status;
}

static void a_document_is_summed_up_over_its_parts(void **state)
{
    (void)state;
    fake_document fake = make_fake();
    json_facts *json;
    assert_int_equal(fake_info(&fake, &json, NULL), FFD_OK);
    assert_word(json, "mesh_format", "fake");
    assert_number(json, "parts", 2);
    assert_number(json, "vertices", 6);
    assert_number(json, "not_finite", 2);
    assert_number(json, "normals", 3);
    assert_number(json, "tangents", 3);
    assert_vector(json, "bounds.min", 0, 0, 0);
    assert_vector(json, "bounds.max", 12, 3, 7);
    assert_word(json, "contents.maker", "tests");
    assert_number(json, "topology.area", 6);
    assert_number(json, "topology.lines", 4);
    assert_number(json, "topology.boundary_edges", 3);
    facts_free(json);
}

static void repeated_positions_count_once(void **state)
{
    (void)state;
    fake_document fake = make_fake();
    fake.parts[1].repeats_positions = true;
    json_facts *json;
    assert_int_equal(fake_info(&fake, &json, NULL), FFD_OK);
    assert_number(json, "vertices", 3);
    assert_number(json, "not_finite", 0);
    assert_vector(json, "bounds.max", 4, 3, 0);
    facts_free(json);
}

static void unsupported_faces_leave_topology_unknown(void **state)
{
    (void)state;
    fake_document fake = make_fake();
    fake.faces_status = FFD_E_UNSUPPORTED;
    json_facts *json;
    assert_int_equal(fake_info(&fake, &json, NULL), FFD_OK);
    assert_none(json, "topology");
    assert_word(json, "topology_unknown", "these faces are too odd");
    assert_number(json, "vertices", 6);
    facts_free(json);

    ffd_error error = {0};
    fake.faces_status = FFD_E_INVALID;
    assert_int_equal(fake_info(&fake, &json, &error), FFD_E_INVALID);
    assert_string_equal(error.message, "these faces are too odd");
}

static void no_finite_vertex_means_no_bounds(void **state)
{
    (void)state;
    fake_document fake = make_fake();
    fake.parts[0].vertex_count = 0;
    fake.xyz[1][0] = -INFINITY;
    json_facts *json;
    assert_int_equal(fake_info(&fake, &json, NULL), FFD_OK);
    assert_number(json, "not_finite", 3);
    assert_none(json, "bounds");
    facts_free(json);
}

/* The text */

static char *rendered(const char *json)
{
    char *text = NULL;
    ffd_error error = {0};
    if (ffd_info_render(json, strlen(json), &text, &error) != FFD_OK)
        fail_msg("%s", error.message);
    return text;
}

static void json_becomes_aligned_text(void **state)
{
    (void)state;
    char *text =
        rendered("{\"format\": \"ffd-info\", \"version\": 1, \"file\": \"a\\u001b.obj\", \"long_name\": -0.5,"
                 "\"bounds\": {\"min\": [0, 0.1, -2], \"max\": null}, \"flat\": true, \"none\": [],"
                 "\"empty\": {}, \"n\\u00e4me\": [\"x y\", \"z\"],"
                 "\"nodes\": [{\"deep\": {\"w\": 123456789012345680000}}, [1, 2]]}");
    assert_string_equal(text, "file       a?.obj\n"
                              "long name  -0.5\n"
                              "bounds\n"
                              "  min      0 0.1 -2\n"
                              "  max      none\n"
                              "flat       yes\n"
                              "none       none\n"
                              "empty      none\n"
                              "n\xc3\xa4me       x y, z\n"
                              "nodes\n"
                              "  0\n"
                              "    deep\n"
                              "      w    123456789012345683968\n"
                              "  1        1 2\n");
    ffd_free(text);
}

/* Files */

static const char cube[] = "o cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 2\nv 1 0 2\nv 0 1 2\nv 1 1 2\n"
                           "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

static void an_obj_file_is_described(void **state)
{
    (void)state;
    put_text("cube.obj", cube);
    json_facts *json = info_of("cube.obj");
    assert_word(json, "kind", "mesh");
    assert_word(json, "mesh_format", "OBJ");
    assert_number(json, "vertices", 8);
    assert_vector(json, "bounds.min", 0, 0, 0);
    assert_vector(json, "bounds.max", 1, 1, 2);
    assert_number(json, "topology.faces", 6);
    assert_number(json, "topology.edges", 12);
    assert_number(json, "topology.components", 1);
    assert_number(json, "topology.boundary_loops", 0);
    assert_number(json, "topology.euler", 2);
    assert_number(json, "topology.area", 10);
    assert_true(facts_is(json, "contents", JSON_OBJECT));
    facts_free(json);
}

/* Checks that a fact has a line: the name, indented, two or more spaces, and the value. */
static void assert_told(const char *text, const char *line_name, const char *value)
{
    for (const char *line = text; *line; line = strchr(line, '\n') + 1) {
        const size_t length = strlen(line_name);
        if (strncmp(line, line_name, length) != 0 || strncmp(line + length, "  ", 2) != 0)
            continue;
        const char *end = strchr(line, '\n'), *start = line + length;
        while (*start == ' ')
            start++;
        if ((size_t)(end - start) == strlen(value) && strncmp(start, value, strlen(value)) == 0)
            return;
    }
    fail_msg("no line \"%s  %s\" in\n%s", line_name, value, text);
}

static void an_obj_file_is_described_as_text(void **state)
{
    (void)state;
    put_text("cube.obj", cube);
    char *text = text_of("cube.obj");
    assert_told(text, "file", in_folder("cube.obj"));
    assert_told(text, "kind", "mesh");
    assert_told(text, "vertices", "8");
    assert_told(text, "  max", "1 1 2");
    assert_told(text, "  boundary loops", "0");
    assert_told(text, "  euler", "2");
    assert_null(strstr(text, "ffd-info"));
    ffd_free(text);
}

static void names_that_are_not_utf8_are_shown_as_utf8(void **state)
{
    (void)state;
    put_text("caf\xe9.obj", "v 0 0 0\n");
    for (int json = 0; json < 2; json++) {
        const ffd_info_desc desc = describe(in_folder("caf\xe9.obj"), json);
        char *text = NULL;
        assert_int_equal(ffd_info_run(&desc, &text, NULL), FFD_OK);
        assert_non_null(strstr(text, "/caf\xef\xbf\xbd.obj"));
        ffd_free(text);
    }
}

static void unknown_absent_and_broken_files_are_refused(void **state)
{
    (void)state;
    ffd_error error;
    put_text("a.txt", "");
    put_text("bad.json", "{\"format\": \"ffd-lattice\", \"version\": 1, \"sise\": [4, 4, 4]}");
    assert_int_equal(failure_of((ffd_source){.path = in_folder("a.txt")}, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, ".txt"));
    assert_int_equal(failure_of((ffd_source){.path = "-"}, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.file, "");
    assert_int_equal(failure_of((ffd_source){.path = in_folder("absent.obj")}, &error), FFD_E_IO);
    assert_int_equal(failure_of((ffd_source){.path = in_folder("absent.json")}, &error), FFD_E_IO);
    assert_string_equal(error.file, in_folder("absent.json"));
    assert_int_equal(failure_of((ffd_source){.path = in_folder("bad.json")}, &error), FFD_E_INVALID);
    assert_string_equal(error.file, in_folder("bad.json"));
}

/* Lattices */

#define LATTICE "{\"format\": \"ffd-lattice\", \"version\": 1, "

static void a_box_lattice_is_described(void **state)
{
    (void)state;
    put_text("box.json",
             LATTICE "\"size\": [4, 5, 3], \"knots\": [\"clamped\", \"open\", [0, 0, 0, 2, 2, 2]],"
                     "\"rest\": {\"box\": {\"min\": [0, 0, 0], \"max\": [3, 2, 6]}},"
                     "\"moves\": [{\"at\": [0, \"all\", 0], \"by\": [-3, 0, -4]}]}");
    json_facts *json = info_of("box.json");
    assert_word(json, "kind", "lattice");
    assert_vector(json, "size", 4, 5, 3);
    assert_vector(json, "degree", 3, 3, 2);
    static const char *const knots[] = {"clamped", "open", "list"};
    for (size_t a = 0; a < 3; a++)
        assert_text(json, ffd_json_tree_element(&json->tree, facts_member(json, "knots"), a), knots[a]);
    assert_true(facts_number_at(json, "domain.w", 1) == 2);
    assert_number(json, "control_points", 60);
    assert_word(json, "rest", "box");
    assert_true(facts_is(json, "rational", JSON_FALSE));
    assert_vector(json, "rest_bounds.min", 0, -1,
                  0); /* open: the outer layers are one spacing outside the box */
    assert_vector(json, "rest_bounds.max", 3, 3, 6);
    assert_vector(json, "deformed_bounds.min", -3, -1, -4);
    assert_number(json, "diagonal", sqrt(61));
    assert_number(json, "moved", 5);
    assert_number(json, "largest_move", 5);
    assert_true(facts_is(json, "weights_moved", JSON_FALSE));
    assert_word(json, "inversion", "affine");
    facts_free(json);

    char *text = text_of("box.json");
    assert_told(text, "knots", "clamped, open, list");
    assert_told(text, "  w", "0 2");
    assert_told(text, "largest move", "5");
    assert_told(text, "rational", "no");
    ffd_free(text);
}

static void a_cylinder_lattice_is_described(void **state)
{
    (void)state;
    put_text("cylinder.json", LATTICE
             "\"size\": [3, 8, 4], \"rest\": {\"cylinder\": {\"center\": [0, 0, 0], \"axis\": [0, 0, 1],"
             "\"radius\": [1, 2], \"height\": 4, \"angle\": [0, 360]}}}");
    json_facts *json = info_of("cylinder.json");
    assert_word(json, "rest", "cylinder");
    assert_text(json, ffd_json_tree_element(&json->tree, facts_member(json, "knots"), 1), "closed");
    assert_number(json, "moved", 0);
    assert_number(json, "largest_move", 0);
    assert_word(json, "inversion", "general");
    facts_free(json);
}

static void a_rational_lattice_of_points_is_described(void **state)
{
    (void)state;
    put_text("points.json", LATTICE
             "\"size\": [2, 2, 2], \"rest\": {\"points\": [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],"
             "[0,1,1],[1,1,1]]}, \"weights\": [1,1,1,1,1,1,1,2], \"deformed\": {\"weights\": "
             "[1,1,1,1,1,1,1,3]}}");
    json_facts *json = info_of("points.json");
    assert_word(json, "rest", "points");
    assert_vector(json, "degree", 1, 1, 1);
    assert_true(facts_is(json, "rational", JSON_TRUE));
    assert_true(facts_is(json, "weights_moved", JSON_TRUE));
    assert_number(json, "moved", 1);
    assert_number(json, "largest_move", 0);
    facts_free(json);
}

static void a_lattice_awaiting_its_mesh_has_no_bounds(void **state)
{
    (void)state;
    put_text("mesh.json", LATTICE "\"size\": [4, 4, 4], \"rest\": {\"box\": \"mesh\"},"
                                  "\"moves\": [{\"by\": [1, 0, 0]}, {\"by\": [0, 1, 0]}]}");
    json_facts *json = info_of("mesh.json");
    assert_word(json, "rest", "mesh");
    assert_number(json, "control_points", 64);
    assert_number(json, "moves", 2);
    assert_none(json, "rest_bounds");
    assert_none(json, "deformed_bounds");
    assert_none(json, "moved");
    assert_none(json, "inversion");
    facts_free(json);
    ffd_free(text_of("mesh.json"));
}

/* A lattice without volume is still described. */
static void a_lattice_without_volume_is_described(void **state)
{
    (void)state;
    put_text("flat.json",
             LATTICE "\"size\": [2, 2, 2], \"rest\": {\"points\": [[0,0,0],[1,0,0],[0,1,0],[1,1,0],"
                     "[0,0,0],[1,0,0],[0,1,0],[1,1,0]]}}");
    json_facts *json = info_of("flat.json");
    assert_none(json, "inversion");
    assert_true(facts_is(json, "inversion_unknown", JSON_STRING));
    assert_vector(json, "rest_bounds.max", 1, 1, 0);
    facts_free(json);
}

/* Makes a lattice with a margin of 0.5 round one mesh. */
static ffd_status new_lattice(const char *mesh, const char *output, bool force, ffd_error *error)
{
    const ffd_source source = {.path = mesh};
    ffd_lattice_desc lattice;
    ffd_lattice_new_desc desc;
    ffd_lattice_desc_init(&lattice, sizeof lattice);
    lattice.margin[0] = lattice.margin[1] = lattice.margin[2] = 0.5;
    ffd_lattice_new_desc_init(&desc, sizeof desc);
    desc.meshes = &source;
    desc.mesh_count = 1;
    desc.lattice = &lattice;
    desc.output = output;
    desc.force = force;
    return ffd_lattice_new_run(&desc, error);
}

static void a_new_lattice_fits_its_mesh_and_margin(void **state)
{
    (void)state;
    char mesh[128], output[128];
    ffd_error error = {0};
    put_text("cube.obj", cube);
    snprintf(mesh, sizeof mesh, "%s", in_folder("cube.obj"));
    snprintf(output, sizeof output, "%s", in_folder("new.json"));
    assert_int_equal(new_lattice(mesh, output, false, &error), FFD_OK);
    json_facts *json = info_of("new.json");
    assert_word(json, "rest", "box");
    assert_vector(json, "size", 4, 4, 4);
    assert_vector(json, "rest_bounds.min", -0.5, -0.5, -1);
    assert_vector(json, "rest_bounds.max", 1.5, 1.5, 3);
    assert_number(json, "moved", 0);
    assert_word(json, "inversion", "affine");
    facts_free(json);

    assert_int_equal(new_lattice(mesh, output, false, &error), FFD_E_EXISTS);
    assert_int_equal(new_lattice(mesh, output, true, &error), FFD_OK);
    assert_int_equal(new_lattice(mesh, mesh, true, &error), FFD_E_ARGUMENT);
    put_text("empty.obj", "# nothing\n");
    snprintf(mesh, sizeof mesh, "%s", in_folder("empty.obj"));
    assert_int_equal(new_lattice(mesh, in_folder("none.json"), false, &error), FFD_E_INVALID);
    assert_string_equal(error.file, mesh);
    assert_int_equal(access(in_folder("none.json"), F_OK), -1);
}

static void each_failed_allocation_is_reported(void **state)
{
    (void)state;
    put_text("cube.obj", cube);
    const ffd_info_desc desc = describe(in_folder("cube.obj"), false);
    long failures = 0;
    for (;; failures++) {
        char *text = NULL;
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        const ffd_status status = ffd_info_run(&desc, &text, &error);
        ffd_alloc_fail_after(-1);
        ffd_free(text);
        if (status == FFD_OK)
            break;
        assert_int_equal(status, FFD_E_MEMORY);
        assert_null(text);
    }
    assert_true(failures > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_document_is_summed_up_over_its_parts),
        cmocka_unit_test(repeated_positions_count_once),
        cmocka_unit_test(unsupported_faces_leave_topology_unknown),
        cmocka_unit_test(no_finite_vertex_means_no_bounds),
        cmocka_unit_test(json_becomes_aligned_text),
        cmocka_unit_test(an_obj_file_is_described),
        cmocka_unit_test(an_obj_file_is_described_as_text),
        cmocka_unit_test(names_that_are_not_utf8_are_shown_as_utf8),
        cmocka_unit_test(unknown_absent_and_broken_files_are_refused),
        cmocka_unit_test(a_box_lattice_is_described),
        cmocka_unit_test(a_cylinder_lattice_is_described),
        cmocka_unit_test(a_rational_lattice_of_points_is_described),
        cmocka_unit_test(a_lattice_awaiting_its_mesh_has_no_bounds),
        cmocka_unit_test(a_lattice_without_volume_is_described),
        cmocka_unit_test(a_new_lattice_fits_its_mesh_and_margin),
        cmocka_unit_test(each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
