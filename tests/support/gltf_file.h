/* gltf_file.h - opens glTF from memory or from a folder, moves its vertices by a function, and saves it. */
#ifndef FFD_TESTS_GLTF_FILE_H
#define FFD_TESTS_GLTF_FILE_H

#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "io/gltf/gltf_format.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const mesh_format *const gltf = &ffd_gltf_format;

/* Opens bytes, which must outlive the document, as if they were the file `path`. */
static inline ffd_status open_bytes(const void *bytes, size_t size, const char *path, ffd_format format,
                                    ffd_space space, mesh_document **document, ffd_error *error)
{
    file_input input = {.data = bytes, .size = size};
    const ffd_source source = {.path = path, .format = format, .space = space};
    return ffd_format_open(gltf, &input, &source, document, error);
}

static inline ffd_status open_file(const char *path, ffd_space space, mesh_document **document,
                                   ffd_error *error)
{
    file_input input;
    const ffd_source source = {.path = path,
                               .format = ffd_path_has_ending(path, ".glb") ? FFD_FORMAT_GLB : FFD_FORMAT_GLTF,
                               .space = space};
    ffd_status status = ffd_file_load(path, &input, error);
    if (status)
        return status;
    status = ffd_format_open(gltf, &input, &source, document, error);
    if (status)
        ffd_file_unload(&input);
    return status;
}

/* Changes x,y,z of a vertex. place: its position in the scene. */
typedef void (*mover)(const double place[3], double xyz[3]);

static inline void stay(const double place[3], double xyz[3])
{
    (void)place;
    (void)xyz;
}

static inline void add_one(const double place[3], double xyz[3])
{
    (void)place;
    xyz[0] += 1;
}

/* Moves only vertices beyond x = 10. */
static inline void move_far(const double place[3], double xyz[3])
{
    if (place[0] >= 10)
        xyz[0] += 1;
}

static inline void move_positions(mesh_document *document, size_t part, mover move)
{
    for (size_t i = 0; i < document->parts[part].vertex_count; i++) {
        double xyz[3], place[3];
        const uint8_t changed = 1;
        gltf->read(document, part, MESH_POSITIONS, MESH_STORED, i, 1, xyz);
        memcpy(place, xyz, sizeof place);
        ffd_part_transform(document, part, i, 1, place);
        move(place, xyz);
        gltf->write(document, part, MESH_POSITIONS, i, 1, xyz, &changed);
    }
}

/* Moves all positions. attributes: also rotates the components of normals and tangents. */
static inline ffd_status deform(mesh_document *document, mover move, bool attributes, ffd_error *error)
{
    const ffd_status status = gltf->begin_results(document, &(mesh_results){.directions = attributes}, error);
    for (size_t part = 0; part < document->part_count && status == FFD_OK; part++) {
        const mesh_part *p = &document->parts[part];
        if (!p->repeats_positions)
            move_positions(document, part, move);
        for (size_t i = 0; i < p->vertex_count && attributes; i++) {
            double v[4];
            const uint8_t changed = 1;
            if (p->normal_count) {
                gltf->read(document, part, MESH_NORMALS, MESH_STORED, i, 1, v);
                const double turned[3] = {v[1], v[2], v[0]};
                gltf->write(document, part, MESH_NORMALS, i, 1, turned, &changed);
            }
            if (p->has_tangents) {
                gltf->read(document, part, MESH_TANGENTS, MESH_STORED, i, 1, v);
                const double turned[4] = {v[1], v[2], v[0], v[3]};
                gltf->write(document, part, MESH_TANGENTS, i, 1, turned, &changed);
            }
        }
    }
    return status;
}

static inline ffd_status save_with(mesh_document *document, const mesh_save_options *options,
                                   const mesh_log *log, ffd_error *error)
{
    file_output *output = NULL;
    ffd_status status = ffd_output_create(&output, error);
    if (status == FFD_OK)
        status = gltf->save(document, options, output, log, error);
    if (status == FFD_OK)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

static inline ffd_status save_to(mesh_document *document, const char *path, ffd_error *error)
{
    const mesh_save_options options = {.path = path, .force = true};
    return save_with(document, &options, NULL, error);
}

/* Returns a file as a string. Free it with free(). */
static inline char *load_text(const char *path)
{
    file_input input;
    assert_int_equal(ffd_file_load(path, &input, NULL), FFD_OK);
    char *text = calloc(input.size + 1, 1);
    assert_non_null(text);
    memcpy(text, input.data, input.size);
    ffd_file_unload(&input);
    return text;
}

/* Opens, describes, deforms and saves, as far as each step succeeds. */
static inline ffd_status run_all(const void *bytes, size_t size, const char *path, ffd_format format,
                                 ffd_space space, mover move, const char *output, ffd_error *error)
{
    mesh_document *document = NULL;
    mesh_faces faces = {0};
    byte_buffer text = {0};
    json_text json;
    ffd_status status = open_bytes(bytes, size, path, format, space, &document, error);
    if (status)
        return status;
    ffd_json_begin(&json, &text);
    ffd_json_object(&json, NULL, false);
    status = gltf->describe(document, &json, error);
    ffd_json_end(&json, '}');
    if (status == FFD_OK && text.failed)
        status = FFD_E_MEMORY;
    if (status == FFD_OK)
        status = gltf->faces(document, MESH_STORED, &faces, error);
    ffd_mesh_faces_free(&faces);
    if (status == FFD_OK || status == FFD_E_UNSUPPORTED || status == FFD_E_INVALID)
        status = gltf->check(document, error);
    if (status == FFD_OK)
        status = deform(document, move, true, error);
    if (status == FFD_OK)
        status = save_to(document, output, error);
    ffd_buffer_free(&text);
    gltf->close(document);
    return status;
}

#endif
