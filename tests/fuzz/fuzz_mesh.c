/* fuzz_mesh.c - each call on a mesh succeeds or reports an error, and what was saved opens again. */
#include "fuzz_mesh.h"
#include "base/vector/vec.h"
#include "check_animations.h"
#include "check_cells.h"
#include "check_changed.h"
#include "io/gltf/read/gltf_document.h"
#include "io/volume/volume_document.h"
#include "job/chain/chain_load.h"
#include "job/info.h"
#include "job/input/source.h"
#include "job/pass/chain_fit.h"
#include "job/pass/pass.h"
#include "mesh_trial.h"
#include "promise.h"
#include "work_folder.h"
#include <math.h>
#include <string.h>

/* Larger meshes only take longer. */
#define MOST_VERTICES 4096
/* What a position of a file may be off by, relative to the sizes it is made of: float32, there and back. */
#define POSITION_ERROR 1e-6
/* The same of quantized positions: the quantum of unsigned bytes that are not normalized. */
#define QUANTUM 1.0
/* Nothing is said of positions behind matrices that lose more digits. */
#define WORST_CONDITION 1e6

static const char rest[] =
    "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [3, 2, 2], \"rest\": {\"box\": "
    "{\"min\": [-2, -2, -2], \"max\": [2, 2, 2]}}, \"moves\": [";
static const char moves[] = "{\"at\": [1, \"all\", \"all\"], \"by\": [0.25, 0.5, -0.125]}, "
                            "{\"twist\": {\"axis\": \"x\", \"degrees\": 40}}";

static bool is_small(const mesh_document *document)
{
    size_t count = 0;
    for (size_t i = 0; i < document->part_count; i++)
        count += document->parts[i].vertex_count + document->parts[i].normal_count;
    return count <= MOST_VERTICES && document->part_count <= MOST_VERTICES;
}

static void check_description(const mesh_document *document)
{
    ffd_error error = {0};
    byte_buffer out = {0};
    json_text json;
    ffd_json_begin(&json, &out);
    ffd_json_object(&json, NULL, false);
    const ffd_status status = document->format->describe(document, &json, &error);
    PROMISE(status == FFD_OK, "cannot be described: %s", error.message);
    const ffd_status parts = ffd_info_parts(document, &json, &error);
    PROMISE(parts == FFD_OK || parts == FFD_E_INVALID, "the parts cannot be told: %s", error.message);
    ffd_json_end(&json, '}');
    PROMISE(!out.failed, "memory ran out");
    char *text;
    PROMISE(ffd_info_render(out.data, out.size, &text, &error) == FFD_OK, "cannot be told: %s",
            error.message);
    ffd_free(text);
    ffd_buffer_free(&out);
}

static void check_texture(const mesh_materials *materials, const mesh_texture *t)
{
    PROMISE(t->image >= MATERIAL_LOST || t->image < materials->image_count, "image %u of %zu", t->image,
            materials->image_count);
    PROMISE(t->wrap[0] <= TEXTURE_CLAMP && t->wrap[1] <= TEXTURE_CLAMP, "a wrap of %d and %d", t->wrap[0],
            t->wrap[1]);
}

static void check_material(const mesh_materials *materials, const mesh_material *m)
{
    for (int c = 0; c < 4; c++)
        PROMISE(m->color[c] >= 0 && m->color[c] <= 1, "a colour has %g", m->color[c]);
    PROMISE(m->name && m->alpha_cutoff >= 0 && isfinite(m->alpha_cutoff), "the cutoff %g", m->alpha_cutoff);
    PROMISE(m->alpha <= MATERIAL_BLEND, "the alpha mode %d", (int)m->alpha);
    for (int c = 0; c < 3; c++)
        PROMISE(m->emission[c] >= 0 && isfinite(m->emission[c]), "an emission has %g", m->emission[c]);
    check_texture(materials, &m->base);
    check_texture(materials, &m->glow);
    check_texture(materials, &m->opacity);
}

static void check_line(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    PROMISE(level == FFD_LOG_WARNING && *line && !strpbrk(line, "\r\n"), "the log says '%s'", line);
}

static void check_materials(mesh_document *document)
{
    const mesh_log log = {check_line, NULL};
    mesh_materials materials = {0};
    ffd_error error = {0};
    if (!document->format->list_materials)
        return;
    const ffd_status status = document->format->list_materials(document, &log, &materials, &error);
    PROMISE(status == FFD_OK || status == FFD_E_LIMIT, "the materials cannot be listed: %s", error.message);
    for (size_t i = 0; i < materials.count && !status; i++)
        check_material(&materials, &materials.list[i]);
    for (size_t i = 0; i < materials.image_count; i++)
        PROMISE(materials.images[i].name && materials.images[i].size >= 3, "an image of %zu bytes",
                materials.images[i].size);
    ffd_materials_free(&materials);
}

/* False: refused. */
static bool take_faces(const mesh_document *document, mesh_faces *faces)
{
    ffd_error error = {0};
    memset(faces, 0, sizeof *faces);
    const ffd_status status = document->format->faces(document, MESH_STORED, faces, &error);
    if (status) {
        trial_refusal(status, &error);
        return false;
    }
    PROMISE(faces->face_count == 0 || faces->start[0] == 0, "the first face starts at %zu", faces->start[0]);
    for (size_t f = 0; f < faces->face_count; f++) {
        PROMISE(faces->start[f] <= faces->start[f + 1], "face %zu ends before it starts", f);
        for (size_t c = faces->start[f]; c < faces->start[f + 1]; c++)
            PROMISE(faces->corners[c] < faces->vertex_count, "face %zu has vertex %u of %zu", f,
                    faces->corners[c], faces->vertex_count);
    }
    return true;
}

/* Corners of an STL at one position are joined: those that were still are, and others may be now. */
static bool are_same_corners(ffd_format format, const mesh_faces *before, const mesh_faces *after)
{
    const size_t count = before->start[before->face_count];
    if (format != FFD_FORMAT_STL)
        return !memcmp(before->corners, after->corners, count * sizeof *before->corners);
    for (size_t c = 0; c < count; c++)
        if (after->corners[c] != after->corners[before->corners[c]])
            return false;
    return true;
}

static void check_same_faces(const trial *of, const mesh_faces *before, const mesh_document *document)
{
    mesh_faces after;
    PROMISE(take_faces(document, &after), "the faces of what was saved are refused");
    PROMISE(before->vertex_count == after.vertex_count && before->face_count == after.face_count,
            "%zu vertices and %zu faces became %zu and %zu", before->vertex_count, before->face_count,
            after.vertex_count, after.face_count);
    PROMISE(before->face_count == 0 || trial_is_gltf(of->format) ||
                (!memcmp(before->start, after.start, (before->face_count + 1) * sizeof *before->start) &&
                 are_same_corners(of->format, before, &after)),
            "the faces changed");
    ffd_mesh_faces_free(&after);
}

static void load_output(const trial *of, file_input *saved)
{
    char path[WORK_PATH];
    ffd_error error;
    work_path(of->output, path);
    PROMISE(ffd_file_load(path, saved, &error) == FFD_OK, "%s", error.message);
}

/* Where nothing moves the file stays as it is, but for the names of its buffers. */
static void check_empty_move(trial *of, const uint8_t *data, size_t size)
{
    uint64_t moved;
    file_input saved;
    mesh_document *const document = trial_open_again(of, of->input, data, size);
    work_path("empty.json", of->lattice);
    if (!trial_deform(of, document, &moved))
        return;
    PROMISE(moved == 0, "%llu vertices moved in an empty move", (unsigned long long)moved);
    load_output(of, &saved);
    mesh_document *const again = trial_open_again(of, of->output, saved.data, saved.size);
    again->format->close(again);
    const bool same = saved.size == size && !memcmp(saved.data, data, size);
    ffd_file_unload(&saved);
    PROMISE(work_clear("out") > 1 || same, "an empty move changed the file");
}

/* The largest sum of a row's sizes. */
static double norm_of(const double m[9])
{
    double most = 0;
    for (int r = 0; r < 3; r++)
        most = fmax(most, fabs(m[3 * r]) + fabs(m[3 * r + 1]) + fabs(m[3 * r + 2]));
    return most;
}

/* How much more than its rounding a part's matrices make of an error; HUGE_VAL: nothing can be said. */
static double condition_of(const mesh_part *part)
{
    if (part->identity)
        return 1;
    if (part->singular || part->skinned)
        return HUGE_VAL;
    return norm_of(part->linear) * norm_of(part->inverse);
}

/* A flat mesh stays flat. */
static size_t dimensions_of(const trial *of, const mesh_document *document)
{
    return of->format == FFD_FORMAT_SU2 ? ffd_volume_of(document)->dimensions : 3;
}

static void check_part(const trial *of, const mesh_document *document, size_t part_index,
                       const double *expected)
{
    const double quantum = of->is_quantized ? QUANTUM : 0;
    const mesh_part *const part = &document->parts[part_index];
    const double condition = condition_of(part);
    const double size = part->identity ? 1 : norm_of(part->linear);
    const double offset = part->identity ? 0 : vec_length(part->offset);
    for (size_t v = 0; v < part->vertex_count && condition < WORST_CONDITION; v++) {
        double p[3], placed[3];
        document->format->read(document, part_index, MESH_POSITIONS, MESH_STORED, v, 1, p);
        memcpy(placed, p, sizeof p);
        ffd_part_transform(document, part_index, v, 1, placed);
        const double error =
            condition * (POSITION_ERROR * (size * vec_length(p) + offset + 1) + quantum * size);
        for (size_t a = 0; a < dimensions_of(of, document); a++)
            PROMISE(!(fabs(placed[a] - expected[3 * v + a]) > error),
                    "vertex %zu of part %zu has %c %.17g, not %.17g", v, part_index, "xyz"[a], placed[a],
                    expected[3 * v + a]);
    }
}

/* The vertices of what was saved are where the lattice brings those of the file. */
static void check_positions(const trial *of, const mesh_document *document, const double *expected)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (!document->parts[i].repeats_positions) {
            check_part(of, document, i, expected);
            expected += 3 * document->parts[i].vertex_count;
        }
}

/* Where the moved lattice brings the vertices of the file; NULL: refused. */
static double *deformed_positions(const trial *of, const uint8_t *data, size_t size)
{
    const ffd_lattice_source lattices[] = {{.path = of->lattice}};
    lattice_chain chain = {0};
    ffd_error error;
    pass_totals totals;
    mesh_document *document = trial_open_again(of, of->input, data, size);
    PROMISE(ffd_chain_load(&(chain_files){.lattices = lattices, .count = 1}, &(chain_outside){0},
                           FFD_ISA_AUTO, NULL, &chain, &error) == FFD_OK &&
                ffd_chain_fit(&chain, document, 1, NULL, &error) == FFD_OK,
            "no lattice");
    double *const deformed = malloc((size_t)ffd_mesh_vertex_count(document) * 3 * sizeof *deformed + 1);
    const mesh_pass pass = {
        .document = document, .chain = &chain, .links = 1, .threads = 1, .deformed = deformed};
    PROMISE(deformed && ffd_pass_over_mesh(&pass, &totals, &error) == FFD_OK, "no pass");
    ffd_chain_free(&chain);
    ffd_source_close(&document);
    return deformed;
}

static void check_move(trial *of, const uint8_t *data, size_t size, const mesh_faces *faces)
{
    uint64_t moved;
    file_input saved;
    mesh_document *document = trial_open_again(of, of->input, data, size);
    work_path("moves.json", of->lattice);
    if (trial_deform(of, document, &moved)) {
        double *const expected = deformed_positions(of, data, size);
        load_output(of, &saved);
        document = trial_open_again(of, of->output, saved.data, saved.size);
        check_description(document);
        check_cells(document);
        /* In the scene meshes may have become several, whose vertices have other numbers. */
        if (!trial_is_gltf(of->format) || of->space == FFD_SPACE_MESH)
            check_positions(of, document, expected);
        check_same_faces(of, faces, document);
        ffd_source_close(&document);
        ffd_file_unload(&saved);
        free(expected);
    }
    work_clear("out");
}

static void prepare_files(void)
{
    static bool prepared;
    char text[1024];
    if (prepared)
        return;
    prepared = true;
    work_write("m.png", "\x89PNG\r\n\x1a\n", 8);
    work_write("empty.json", text, (size_t)snprintf(text, sizeof text, "%s]}", rest));
    work_write("moves.json", text, (size_t)snprintf(text, sizeof text, "%s%s]}", rest, moves));
}

static bool is_quantized(const mesh_document *document)
{
    const gltf_document *const d = ffd_gltf_of(document);
    for (size_t i = 0; i < document->part_count; i++) {
        const size_t accessor = d->parts[i].streams[GLTF_POSITION].accessor;
        if (d->model.accessors[accessor].component != GLTF_FLOAT)
            return true;
    }
    return false;
}

static void run(trial *of, const uint8_t *data, size_t size)
{
    mesh_faces faces;
    ffd_error error = {0};
    mesh_document *document = trial_open(of, of->input, data, size, NULL, &error);
    if (!document)
        return;
    check_description(document);
    check_materials(document);
    if (trial_is_gltf(of->format) && of->space == FFD_SPACE_SCENE)
        check_animations(document);
    of->is_quantized = trial_is_gltf(of->format) && is_quantized(document);
    check_cells(document);
    const bool goes_on = is_small(document) && take_faces(document, &faces);
    ffd_source_close(&document);
    if (!goes_on)
        return;
    check_empty_move(of, data, size);
    check_move(of, data, size, &faces);
    check_changed(of, data, size);
    ffd_mesh_faces_free(&faces);
}

void fuzz_mesh(ffd_format format, const uint8_t *data, size_t size)
{
    trial of = {.format = format, .input = "m", .output = "out/m"};
    if (format == FFD_FORMAT_FOAM)
        of.output = "o"; /* beside the faces */
    const uint8_t *const end = format == FFD_FORMAT_GLTF && size > 0 ? memchr(data, 0, size) : NULL;
    prepare_files();
    if (end) {
        work_write("m.bin", end + 1, size - (size_t)(end + 1 - data));
        size = (size_t)(end - data);
    }
    run(&of, data, size);
    if (trial_is_gltf(format)) {
        of.rig = FFD_RIG_FOLLOW;
        run(&of, data, size);
        of.rig = FFD_RIG_KEEP;
    }
    of.space = FFD_SPACE_MESH;
    of.normals = trial_is_gltf(format) ? FFD_NORMALS_TRANSFORM : FFD_NORMALS_KEEP;
    run(&of, data, size);
}

void fuzz_library(const uint8_t *data, size_t size)
{
    static const char text[] = "mtllib m.mtl\nv 0 0 0\n";
    const trial of = {.format = FFD_FORMAT_OBJ};
    prepare_files();
    work_write("m.mtl", data, size);
    mesh_document *document = trial_open_again(&of, "m", (const uint8_t *)text, sizeof text - 1);
    check_materials(document);
    ffd_source_close(&document);
}
