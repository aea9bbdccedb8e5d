#include "io/gltf/model/gltf_names.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <stdio.h>
#include <string.h>

/* A use of a mesh by a node. */
typedef struct mesh_use {
    size_t mesh, use; /* GLTF_NONE: no use */
} mesh_use;

/* Returns the part of the positions of a primitive of the use. */
static size_t position_part(const gltf_document *d, mesh_use at, size_t primitive)
{
    return ffd_gltf_instances(d, at.mesh, primitive)[at.use].part[GLTF_POSITION];
}

static mesh_use find_use(const gltf_document *d, size_t part)
{
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t n = 0; n < d->mesh_uses[m].node_count; n++)
            for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++)
                if (position_part(d, (mesh_use){m, n}, p) == part)
                    return (mesh_use){m, n};
    return (mesh_use){GLTF_NONE, GLTF_NONE};
}

/* Counts and clears the marks of a part. first: the number of its first vertex. */
static uint64_t count_part(const gltf_document *d, size_t part, size_t first, uint8_t *marks)
{
    uint64_t count = 0;
    for (size_t i = 0; i < d->mesh_parts[part].vertex_count; i++) {
        count += marks[first + i] != 0;
        marks[first + i] = 0;
    }
    return count;
}

static uint64_t count_use(const gltf_document *d, mesh_use at, const size_t *first, uint8_t *marks)
{
    uint64_t count = 0;
    for (size_t p = 0; p < d->model.meshes[at.mesh].primitive_count; p++)
        if (position_part(d, at, p) != GLTF_NONE)
            count += count_part(d, position_part(d, at, p), first[position_part(d, at, p)], marks);
    return count;
}

/* Writes "node:NAME". Returns false if the element has no name. */
static bool write_name(const gltf_document *d, const char *array, const char *kind, size_t number, char *name,
                       size_t capacity)
{
    uint32_t value = ffd_json_span_first(&d->tree, ffd_json_span_member(&d->tree, 0, array));
    for (size_t i = 0; i < number && value != JSON_NONE; i++)
        value = ffd_json_span_after(&d->tree, value);
    const uint32_t member = value == JSON_NONE ? JSON_NONE : ffd_json_span_member(&d->tree, value, "name");
    if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
        return false;
    char *const text = ffd_json_span_string(&d->tree, member, NULL);
    const bool named = text && *text;
    if (named) {
        const size_t begun = (size_t)snprintf(name, capacity, "%s:", kind);
        ffd_name_shown(text, name + begun, capacity - begun);
    }
    ffd_free(text);
    return named;
}

uint64_t ffd_gltf_name_part(const mesh_document *document, uint64_t vertex, uint8_t *marks, char *name,
                            size_t capacity)
{
    const gltf_document *d = ffd_gltf_of(document);
    size_t *first, part = 0;
    *name = 0;
    if (ffd_parts_number(document, &first, NULL))
        return 0; /* without memory the result has no name, which is not worth a failure */
    while (d->mesh_parts[part].repeats_positions || vertex >= first[part] + d->mesh_parts[part].vertex_count)
        part++;
    const mesh_use at = find_use(d, part);
    uint64_t count = 0;
    if (at.mesh != GLTF_NONE) {
        const size_t *const nodes = d->mesh_uses[at.mesh].nodes;
        if ((nodes && write_name(d, "nodes", "node", nodes[at.use], name, capacity)) ||
            write_name(d, "meshes", "mesh", at.mesh, name, capacity))
            count = count_use(d, at, first, marks);
    }
    ffd_free(first);
    return count;
}
