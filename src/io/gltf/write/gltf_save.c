/* gltf_save.c - writes a document with its results. */
#include "base/little_endian.h"
#include "base/text/base64.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <inttypes.h>
#include <string.h>

static ffd_status put(const gltf_saver *saver, const void *bytes, size_t size, ffd_error *error)
{
    if (!saver->document->is_present)
        ffd_file_prefault(bytes, size);
    return ffd_output_write(saver->output, bytes, size, error);
}

static ffd_status put_padding(const gltf_saver *saver, size_t size, char with, ffd_error *error)
{
    char bytes[4];
    memset(bytes, with, sizeof bytes);
    return put(saver, bytes, size, error);
}

static size_t edit_size(const gltf_saver *saver, const json_edit *edit)
{
    return edit->buffer == EDIT_NO_BUFFER
               ? edit->text_size
               : ffd_base64_length(ffd_gltf_content_size(saver, (size_t)edit->buffer));
}

/* Returns the offset of the JSON: a GLB must not have a byte order mark. */
static size_t json_begin(const gltf_saver *saver)
{
    return saver->binary == saver->document->binary ? 0 : saver->document->tree.values[0].begin;
}

/* Returns the size of the JSON up to `end` with its edits. */
static size_t json_size(const gltf_saver *saver, size_t end)
{
    size_t size = end - json_begin(saver);
    for (size_t i = 0; i < saver->edits.count; i++) {
        const json_edit *edit = &saver->edits.edits[i];
        size = size - (edit->end - edit->begin) + edit_size(saver, edit);
    }
    return size;
}

static ffd_status put_json(const gltf_saver *saver, size_t end, ffd_error *error)
{
    const char *text = saver->document->tree.text;
    size_t at = json_begin(saver);
    for (size_t i = 0; i < saver->edits.count; i++) {
        const json_edit *edit = &saver->edits.edits[i];
        TRY(put(saver, text + at, edit->begin - at, error));
        if (edit->buffer != EDIT_NO_BUFFER)
            TRY(ffd_gltf_write_content(saver, (size_t)edit->buffer, true, error));
        else if (edit->text_size > 0)
            TRY(put(saver, saver->edits.pool.data + edit->text, edit->text_size, error));
        at = edit->end;
    }
    return put(saver, text + at, end - at, error);
}

/* Returns where a GLB's old JSON text ends. If its size changes, its padding is left out: the new text needs
   its own, and the two would add up from run to run. */
static size_t json_end(const gltf_saver *saver)
{
    const json_tree *tree = &saver->document->tree;
    size_t end = tree->size;
    if (saver->binary != saver->document->binary)
        return tree->values[0].end;
    if (json_size(saver, end) == end)
        return end;
    while (end > tree->values[0].end && tree->text[end - 1] == ' ')
        end--;
    return end;
}

static ffd_status put_chunk_header(const gltf_saver *saver, uint64_t size, uint32_t type, ffd_error *error)
{
    unsigned char header[GLB_CHUNK_HEADER_SIZE];
    store_u32(header, (uint32_t)size);
    store_u32(header + 4, type);
    return put(saver, header, sizeof header, error);
}

/* The sizes of a GLB to write; sizes of chunks include their padding. */
typedef struct glb_sizes {
    size_t json_end, json; /* old text; new text */
    bool has_bin, own_bin; /* whether there is a BIN chunk; whether it is the first buffer */
    size_t bin, rest;
    uint64_t json_chunk, bin_chunk, total; /* with padding */
} glb_sizes;

static glb_sizes measure_glb(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    glb_sizes sizes = {.json_end = json_end(saver), .rest = d->glb.end - d->glb.rest_begin};
    sizes.json = json_size(saver, sizes.json_end);
    sizes.json_chunk = d->binary && sizes.json == d->tree.size ? sizes.json : ffd_gltf_align(sizes.json);
    sizes.own_bin = saver->buffer_count > 0 && saver->buffers[0].kind == BUFFER_BIN;
    sizes.has_bin = sizes.own_bin || d->glb.has_bin;
    sizes.bin = sizes.own_bin ? ffd_gltf_content_size(saver, 0) : d->glb.bin_size;
    sizes.bin_chunk = d->binary && sizes.bin == d->glb.bin_size ? sizes.bin : ffd_gltf_align(sizes.bin);
    sizes.total = GLB_HEADER_SIZE + GLB_CHUNK_HEADER_SIZE + sizes.json_chunk + sizes.rest +
                  (sizes.has_bin ? GLB_CHUNK_HEADER_SIZE + sizes.bin_chunk : 0);
    return sizes;
}

static ffd_status put_bin(const gltf_saver *saver, const glb_sizes *sizes, ffd_error *error)
{
    const gltf_document *d = saver->document;
    TRY(put_chunk_header(saver, sizes->bin_chunk, GLB_CHUNK_BIN, error));
    if (!sizes->own_bin)
        return put(saver, d->input.data + d->glb.bin_begin, d->glb.bin_size, error);
    TRY(ffd_gltf_write_content(saver, 0, false, error));
    return put_padding(saver, sizes->bin_chunk - sizes->bin, 0, error);
}

static ffd_status put_glb(const gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const glb_sizes sizes = measure_glb(saver);
    if (sizes.total > UINT32_MAX)
        return ffd_fail_file(error, FFD_E_LIMIT, saver->options->path,
                             "would have %" PRIu64 " bytes, but a GLB holds at most 4294967295", sizes.total);
    unsigned char header[GLB_HEADER_SIZE];
    store_u32(header, GLB_MAGIC);
    store_u32(header + 4, GLB_VERSION);
    store_u32(header + 8, (uint32_t)sizes.total);
    TRY(put(saver, header, sizeof header, error));
    TRY(put_chunk_header(saver, sizes.json_chunk, GLB_CHUNK_JSON, error));
    TRY(put_json(saver, sizes.json_end, error));
    TRY(put_padding(saver, sizes.json_chunk - sizes.json, ' ', error));
    if (sizes.has_bin)
        TRY(put_bin(saver, &sizes, error));
    if (d->binary)
        TRY(put(saver, d->input.data + d->glb.rest_begin, sizes.rest, error));
    /* Bytes beyond the stated length are kept only if nothing else changes. */
    const bool still = saver->plan.version_count == 0 && !d->edit->any;
    if (d->binary && still)
        TRY(put(saver, d->input.data + d->glb.end, d->input.size - d->glb.end, error));
    return FFD_OK;
}

static bool overwrites(const gltf_saver *saver)
{
    return saver->options->force || saver->in_place;
}

static ffd_status put_buffer_files(const gltf_saver *saver, ffd_error *error)
{
    for (size_t b = 0; b < saver->document->buffer_values.count; b++) {
        if (!saver->buffers[b].target)
            continue;
        TRY(ffd_output_begin(saver->output, saver->buffers[b].target, overwrites(saver), error));
        TRY(ffd_gltf_write_content(saver, b, false, error));
    }
    return FFD_OK;
}

/* Returns by how many bytes the files of the output are larger than those of the input; 0: they are not. */
static uint64_t count_growth(const gltf_saver *saver)
{
    const gltf_document *const d = saver->document;
    uint64_t before = d->input.size, after;
    if (saver->binary)
        after = measure_glb(saver).total;
    else
        after = json_size(saver, d->binary ? d->tree.values[0].end : d->tree.size);
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        if (d->buffers[b].kind == BUFFER_FILE)
            before += d->buffers[b].size;
        if (saver->buffers[b].kind == BUFFER_FILE)
            after += ffd_gltf_content_size(saver, b);
    }
    return after > before ? after - before : 0;
}

static ffd_status put_files(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const char *path = saver->options->path;
    TRY(ffd_gltf_bring_images(saver, error));
    if (ffd_edits_failed(&saver->edits))
        return ffd_fail_memory(error);
    ffd_edits_sort(&saver->edits);
    if (saver->options->animated)
        saver->options->animated->bytes = count_growth(saver);
    if (!saver->output)
        return FFD_OK;
    TRY(put_buffer_files(saver, error));
    TRY(ffd_output_begin(saver->output, path, overwrites(saver), error));
    if (saver->binary)
        return put_glb(saver, error);
    return put_json(saver, d->binary ? d->tree.values[0].end : d->tree.size, error);
}

static void warn_of_chunks(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    if (d->binary && !saver->binary && d->glb.rest_begin < d->glb.end)
        ffd_log_line(saver->log, FFD_LOG_WARNING,
                     "the GLB's further chunks (%zu bytes) are left out: a .gltf cannot hold them",
                     d->glb.end - d->glb.rest_begin);
}

ffd_status ffd_gltf_save_results(mesh_document *document, const mesh_save_options *options,
                                 file_output *output, const mesh_log *log, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    ffd_gltf_complete_results((gltf_document *)document);
    gltf_saver saver = {.document = d, .options = options, .output = output, .log = log};
    saver.binary = options->format == FFD_FORMAT_AUTO ? d->binary : options->format == FFD_FORMAT_GLB;
    saver.in_place = !ffd_output_is_stream(options->path) && !ffd_file_is_stream(d->path) &&
                     ffd_save_meets(options, d->path, options->path);
    ffd_edits_join(&saver.edits, &d->edit->edits);
    ffd_edits_sort(&d->edit->edits);
    ffd_status status;
    TRY_END(ffd_gltf_make_plan(d, &saver.plan, error));
    TRY_END(ffd_gltf_make_content(&saver, error));
    ffd_gltf_choose_buffer_kinds(&saver);
    warn_of_chunks(&saver);
    TRY_END(ffd_gltf_make_edits(&saver, error));
    TRY_END(ffd_gltf_name_buffers(&saver, error));
    ffd_gltf_announce(&saver);
    TRY_END(put_files(&saver, error));
end:
    ((gltf_document *)document)->is_present = status == FFD_OK && d->keeps_pages;
    ffd_gltf_free_content(&saver);
    ffd_gltf_free_sparse(&saver);
    ffd_gltf_free_unpackings(&saver);
    ffd_gltf_free_plan(&saver.plan);
    ffd_edits_free(&saver.edits);
    ffd_buffer_free(&saver.left);
    return status;
}
