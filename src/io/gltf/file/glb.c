#include "io/gltf/file/glb.h"
#include "base/little_endian.h"
#include "base/text/words.h"

bool ffd_glb_is(const unsigned char *data, size_t size)
{
    return size >= 4 && load_u32(data) == GLB_MAGIC;
}

typedef struct glb_chunk {
    size_t begin, size;
    uint32_t type;
} glb_chunk;

/* Reads the header of the chunk at *at, and advances *at past the chunk. */
static ffd_status read_chunk(const unsigned char *data, size_t end, const char *name, size_t *at,
                             glb_chunk *chunk, ffd_error *error)
{
    if (end - *at < GLB_CHUNK_HEADER_SIZE)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "GLB: the header of the chunk at byte %zu is cut off", *at);
    chunk->begin = *at + GLB_CHUNK_HEADER_SIZE;
    chunk->size = load_u32(data + *at);
    chunk->type = load_u32(data + *at + 4);
    if (chunk->size > end - chunk->begin)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "GLB: the chunk at byte %zu states a size of %zu, but only %zu %s", *at,
                             chunk->size, end - chunk->begin,
                             ffd_plural(end - chunk->begin, "byte follows", "bytes follow"));
    *at = chunk->begin + chunk->size;
    return FFD_OK;
}

ffd_status ffd_glb_parse(const unsigned char *data, size_t size, const char *name, glb_layout *layout,
                         ffd_error *error)
{
    *layout = (glb_layout){0};
    if (!ffd_glb_is(data, size))
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "is not a GLB file: it does not start with \"glTF\"");
    if (size < GLB_HEADER_SIZE)
        return ffd_fail_file(error, FFD_E_INVALID, name, "GLB: the file has %zu bytes, less than its header",
                             size);
    const uint32_t version = load_u32(data + 4);
    if (version != GLB_VERSION)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, name, "GLB: the version is %lu, only 2 is known",
                             (unsigned long)version);
    layout->end = load_u32(data + 8);
    if (layout->end > size || layout->end < GLB_HEADER_SIZE)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "GLB: the header states a size of %zu, the file has %zu bytes", layout->end,
                             size);

    glb_chunk chunk = {0};
    size_t at = GLB_HEADER_SIZE;
    TRY(read_chunk(data, layout->end, name, &at, &chunk, error));
    if (chunk.type != GLB_CHUNK_JSON)
        return ffd_fail_file(error, FFD_E_INVALID, name, "GLB: the first chunk has type 0x%08lx, not JSON",
                             (unsigned long)chunk.type);
    layout->json_begin = chunk.begin;
    layout->json_size = chunk.size;
    layout->rest_begin = at;
    layout->uneven = chunk.size % 4 ? chunk.begin : 0;
    for (bool first = true; at < layout->end; first = false) {
        TRY(read_chunk(data, layout->end, name, &at, &chunk, error));
        if (layout->uneven == 0 && chunk.size % 4)
            layout->uneven = chunk.begin;
        layout->more_bins += !first && chunk.type == GLB_CHUNK_BIN;
        if (!first || chunk.type != GLB_CHUNK_BIN)
            continue;
        layout->has_bin = true;
        layout->bin_begin = chunk.begin;
        layout->bin_size = chunk.size;
        layout->rest_begin = at;
    }
    return FFD_OK;
}
