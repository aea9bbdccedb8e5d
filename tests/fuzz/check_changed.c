/* check_changed.c - uses open documents after the bytes of their files were changed. */
#include "check_changed.h"
#include "../support/repetitions.h"
#include "fuzz_target.h"
#include "io/formats.h"
#include "job/info.h"
#include "job/input/source.h"
#include "mesh/difference.h"
#include "mesh/mixed_faces.h"
#include "mesh/selector.h"
#include "promise.h"
#include <string.h>

/* Changed copies of one file. */
#define COPIES (FFD_SANITIZED ? 2 : 4)
/* Room for what a change adds. */
#define ADDED 4096
/* The name of a file that is mapped. */
#define MAPPED "mapped"

static void allow_refusal(ffd_status status, const ffd_error *error)
{
    if (status)
        trial_refusal(status, error);
}

/* The sum of the bytes is the seed, so that an input is changed alike in every run. */
static uint64_t seed_of(const uint8_t *data, size_t size)
{
    uint64_t sum = size;
    for (size_t i = 0; i < size; i++)
        sum = sum * 31 + data[i];
    return sum;
}

/* A mutation of the bytes, cut to their size; freed by the caller. */
static uint8_t *mutation_of(const uint8_t *data, size_t size, uint64_t seed)
{
    uint8_t *const mutant = malloc(size + ADDED);
    PROMISE(mutant, "no memory");
    memcpy(mutant, data, size);
    const size_t mutant_size = fuzz_mutate(mutant, size, size + ADDED, seed);
    if (mutant_size < size)
        memcpy(mutant + mutant_size, data + mutant_size, size - mutant_size);
    return mutant;
}

/* Formats that are read again and again are in a block of the exact size, so that the sanitizer sees reads
   past its end. Of a glTF only what is mapped can change. */
static mesh_document *open_mapped(const trial *of, const uint8_t *data, size_t size)
{
    char path[WORK_PATH];
    file_input input;
    ffd_error error = {0};
    mesh_document *document;
    work_write(MAPPED, data, size);
    work_path(MAPPED, path);
    const ffd_source source = {.path = path, .format = of->format, .space = of->space};
    PROMISE(!ffd_file_map(path, &input, &error), "%s", error.message);
    PROMISE(!ffd_format_open(ffd_format_table(of->format), &input, &source, &document, &error), "%s",
            error.message);
    return document;
}

static void describe(const mesh_document *document)
{
    ffd_error error = {0};
    byte_buffer out = {0};
    json_text json;
    ffd_json_begin(&json, &out);
    ffd_json_object(&json, NULL, false);
    allow_refusal(document->format->describe(document, &json, &error), &error);
    allow_refusal(ffd_info_parts(document, &json, &error), &error);
    ffd_buffer_free(&out);
}

static void take_normals(const mesh_document *document, const mesh_faces *faces)
{
    ffd_error error = {0};
    const size_t count = faces->start ? faces->start[faces->face_count] : 0;
    uint32_t *const normals = malloc(count * sizeof *normals + 1);
    PROMISE(normals, "no memory");
    if (document->format->corner_normals && document->part_count > 0 && document->parts->normal_count > 0)
        allow_refusal(document->format->corner_normals(document, faces, normals, &error), &error);
    free(normals);
}

/* The faces, twice: once all, once those of every other vertex. */
static void take_faces(const mesh_document *document)
{
    ffd_error error = {0};
    mesh_faces faces = {0};
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    uint8_t *const bytes = malloc(count + 1);
    PROMISE(bytes, "no memory");
    for (size_t i = 0; i < count; i++)
        bytes[i] = i & 1;
    ffd_status status = document->format->faces(document, MESH_STORED, &faces, &error);
    allow_refusal(status, &error);
    if (!status)
        take_normals(document, &faces);
    ffd_mesh_faces_free(&faces);
    const vertex_marks marks = {bytes, 1, count};
    status = document->format->mixed_faces(document, MESH_STORED, &marks, &faces, &error);
    allow_refusal(status, &error);
    ffd_mesh_faces_free(&faces);
    free(bytes);
}

static void compare(const mesh_document *document)
{
    ffd_error error = {0};
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    ffd_difference_begin(&comparison, 0, 0);
    allow_refusal(document->format->compare(document, document, &comparison, &error), &error);
}

static void convert(const mesh_document *document)
{
    ffd_error error = {0};
    mesh_model model = {.wants_details = true};
    allow_refusal(document->format->model(document, MESH_STORED, &model, &error), &error);
    ffd_model_free(&model);
}

/* Selects what a file without names has: its faces before any `g`. */
static void select_group(mesh_document *document)
{
    static const mesh_selector selector = {SELECT_GROUP, "default", sizeof "default" - 1, "only"};
    ffd_error error = {0};
    if (document->format->selectors && document->format->selectors->kinds & SELECTOR_BIT(SELECT_GROUP))
        (void)document->format->selectors->select(document, &selector, 1, &error);
}

static void use(const trial *of, mesh_document *document, uint64_t seed)
{
    ffd_error error = {0};
    uint64_t moved;
    if (seed % 3 == 2)
        select_group(document);
    if (seed & 4)
        allow_refusal(ffd_mesh_mark_used(document, &error), &error);
    describe(document);
    take_faces(document);
    compare(document);
    convert(document);
    (void)trial_deform(of, document, &moved);
    work_clear("out");
}

static void change_and_use(const trial *of, const uint8_t *data, size_t size, uint64_t seed)
{
    uint8_t *const mutant = mutation_of(data, size, seed);
    unsigned char *block = NULL;
    ffd_error error = {0};
    const bool is_mapped = trial_is_gltf(of->format);
    mesh_document *const document =
        is_mapped ? open_mapped(of, data, size) : trial_open(of, of->input, data, size, &block, &error);
    PROMISE(document, "%s is refused: %s: %s", of->input, error.pointer, error.message);
    if (seed % 3 == 1)
        select_group(document);
    if (is_mapped)
        work_write(MAPPED, mutant, size);
    else
        memcpy(block, mutant, size);
    free(mutant);
    use(of, document, seed);
}

void check_changed(const trial *of, const uint8_t *data, size_t size)
{
    const uint64_t seed = seed_of(data, size);
    for (uint64_t i = 0; i < COPIES; i++)
        change_and_use(of, data, size, seed + i);
}
