/* gltf_announce.c - log lines that summarize saving. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <stdlib.h>
#include <string.h>

#define NAMED 3 /* values that a message names */
#define POINTER_SIZE 256

/* Logs one line with a count. Single cases are logged as FFD_LOG_INFO where they are handled. */
static void warn(const gltf_saver *saver, size_t count, const char *one, const char *many)
{
    if (count > 0)
        ffd_log_line(saver->log, FFD_LOG_WARNING, "%zu %s", count, ffd_plural(count, one, many));
}

/* Logs what is not in any part. */
static void warn_of_rest(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    size_t unused = 0;
    for (size_t m = 0; m < d->model.mesh_count && d->space == FFD_SPACE_SCENE; m++)
        unused += !d->mesh_uses[m].is_used;
    warn(saver, d->instanced_node_count,
         "node with EXT_mesh_gpu_instancing is out of the lattice's reach: left as it is",
         "nodes with EXT_mesh_gpu_instancing are out of the lattice's reach: left as they are");
    warn(saver, d->nodes_outside_scene, "node with a mesh is not in the displayed scene: left as it is",
         "nodes with a mesh are not in the displayed scene: left as they are");
    warn(saver, d->details_shared,
         "use of a node by MSFT_lod is at another place than the first: the node is deformed for that one",
         "uses of nodes by MSFT_lod are at other places than the first: the nodes are deformed for that one");
    warn(saver, d->shapes_shared,
         "use of a node by a collider or trigger is at another place than where the node is shown or used "
         "first: "
         "the node is deformed for that one",
         "uses of nodes by colliders and triggers are at other places than where the nodes are shown or used "
         "first: the nodes are deformed for those");
    warn(saver, unused, "mesh is not used by any node: left as it is",
         "meshes are not used by any node: left as they are");
}

static size_t count_floats(const gltf_saver *saver)
{
    size_t count = 0;
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *version = &saver->plan.versions[saver->plan.appended[i]];
        count += version->accessor != GLTF_NONE &&
                 version->component != saver->document->model.accessors[version->accessor].component;
    }
    return count;
}

static size_t count_unpacked(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    size_t count = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        count += ffd_gltf_is_unpacked(saver, &d->model.primitives[i],
                                      saver->plan.base_uses[d->model.primitives[i].mesh]);
    return count;
}

void ffd_gltf_announce(const gltf_saver *saver)
{
    warn_of_rest(saver);
    warn(saver, saver->plan.change_count,
         "node gets a copy of its mesh, which is deformed differently under other nodes",
         "nodes get copies of their meshes, which are deformed differently under other nodes");
    warn(saver, count_floats(saver),
         "quantized accessor is stored as floats: its type cannot hold the results",
         "quantized accessors are stored as floats: their types cannot hold the results");
    warn(saver, count_unpacked(saver), "primitive is written uncompressed (Draco) because it is deformed",
         "primitives are written uncompressed (Draco) because they are deformed");
    warn(saver, saver->unpacking_count - saver->unpacked_accessor_count,
         "bufferView is written uncompressed (meshopt) because its content is deformed",
         "bufferViews are written uncompressed (meshopt) because their content is deformed");
}

static int compare_values(const void *a, const void *b)
{
    uint32_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

size_t ffd_gltf_warn_of_values(gltf_saver *saver, byte_buffer *values, const char *one, const char *many)
{
    const size_t size = values->size / sizeof(uint32_t);
    size_t count = 0;
    uint32_t last = JSON_NONE;
    byte_buffer names = {0};
    saver->edits.failed = saver->edits.failed || values->failed;
    if (size == 0 || saver->edits.failed)
        return 0;
    qsort(values->data, size, sizeof(uint32_t), compare_values);
    for (size_t i = 0; i < size; i++) {
        uint32_t value;
        char pointer[POINTER_SIZE];
        memcpy(&value, values->data + i * sizeof value, sizeof value);
        if (value == last)
            continue;
        last = value;
        if (count++ >= NAMED)
            continue;
        ffd_json_tree_pointer(&saver->document->tree, value, pointer, sizeof pointer);
        ffd_buffer_format(&names, "%s%s", count > 1 ? ", " : "", pointer);
    }
    if (count > NAMED)
        ffd_buffer_format(&names, " and %zu more", count - NAMED);
    char *const text = ffd_buffer_finish(&names);
    saver->edits.failed = saver->edits.failed || !text;
    if (text)
        ffd_log_line(saver->log, FFD_LOG_WARNING, "%zu %s: %s", count, ffd_plural(count, one, many), text);
    ffd_free(text);
    return count;
}
