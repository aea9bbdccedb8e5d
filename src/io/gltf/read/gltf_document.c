#include "io/gltf/read/gltf_document.h"
#include "base/memory/memory.h"
#include <math.h>
#include <stdio.h>

void ffd_gltf_splat_name(size_t attribute, char name[GLTF_SPLAT_NAME])
{
    static const char prefix[] = "KHR_gaussian_splatting";
    if (attribute < GLTF_SPLAT_HARMONICS) {
        snprintf(name, GLTF_SPLAT_NAME, "%s:%s", prefix,
                 attribute == GLTF_SPLAT_ROTATION ? "ROTATION" : "SCALE");
        return;
    }
    size_t degree = 1, coefficient = attribute - GLTF_SPLAT_HARMONICS;
    for (; coefficient > 2 * degree; degree++)
        coefficient -= 2 * degree + 1;
    snprintf(name, GLTF_SPLAT_NAME, "%s:SH_DEGREE_%zu_COEF_%zu", prefix, degree, coefficient);
}

const char *const ffd_gltf_semantic_names[GLTF_DEFORMED] = {"POSITION", "NORMAL", "TANGENT"};

uint32_t ffd_gltf_extension(const gltf_document *d, uint32_t value, const char *extension)
{
    return ffd_json_tree_member(&d->tree, ffd_json_tree_member(&d->tree, value, "extensions"), extension);
}

bool ffd_gltf_has_extension(const gltf_document *d, uint32_t value, const char *extension)
{
    return ffd_gltf_extension(d, value, extension) != JSON_NONE;
}

size_t ffd_gltf_index(const gltf_document *d, uint32_t value, size_t count)
{
    double number;
    const bool found = ffd_json_tree_number(&d->tree, value, &number) && number >= 0 &&
                       number < (double)count && floor_of(number) >= number;
    return found ? (size_t)number : GLTF_NONE;
}

size_t ffd_gltf_node(const gltf_document *d, uint32_t value)
{
    return ffd_gltf_index(d, value, d->model.node_count);
}

uint32_t ffd_gltf_first(const gltf_document *d, uint32_t object, const char *key)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, object, key);
    const bool is_array = array != JSON_NONE && d->tree.values[array].kind == JSON_ARRAY;
    return is_array ? ffd_json_tree_first(&d->tree, array) : JSON_NONE;
}

void ffd_gltf_free_result(gltf_stream *stream)
{
    ffd_free(stream->result);
    ffd_free(stream->filled);
    ffd_free(stream->bounds);
    stream->result = NULL;
    stream->filled = NULL;
    stream->bounds = NULL;
}

/* Documents whose files have fewer bytes together keep the pages of their mmap: finding a page again in the
   page cache takes a fifth of the time of writing it, and a document that is kept for many jobs would do so
   in each. */
#define MOST_KEPT ((size_t)1 << 25)

void ffd_gltf_choose_pages(gltf_document *d)
{
    size_t left = MOST_KEPT;
    d->keeps_pages = d->input.size <= left;
    left -= d->keeps_pages ? d->input.size : 0;
    for (size_t i = 0; i < d->buffer_values.count && d->keeps_pages; i++) {
        const size_t size = d->buffers[i].kind == BUFFER_FILE ? d->buffers[i].file.size : 0;
        d->keeps_pages = size <= left;
        left -= d->keeps_pages ? size : 0;
    }
}

void ffd_gltf_forget(const gltf_document *d)
{
    if (d->keeps_pages)
        return;
    ffd_file_release_pages(&d->input, d->input.data, d->input.size);
    for (size_t i = 0; i < d->buffer_values.count; i++)
        if (d->buffers[i].kind == BUFFER_FILE)
            ffd_file_release_pages(&d->buffers[i].file, d->buffers[i].file.data, d->buffers[i].file.size);
}

void ffd_gltf_forget_bytes(const gltf_document *d, const gltf_buffer *buffer, size_t offset, size_t size)
{
    const file_input *input = buffer->kind == BUFFER_FILE ? &buffer->file : &d->input;
    const bool in_file = buffer->kind == BUFFER_FILE || buffer->kind == BUFFER_BIN;
    if (in_file && offset < buffer->size && !d->keeps_pages)
        ffd_file_release_pages(input, buffer->data + offset,
                               size < buffer->size - offset ? size : buffer->size - offset);
}

void ffd_gltf_forget_elements(const gltf_document *d, size_t accessor, size_t first, size_t count)
{
    const gltf_layout *layout = &d->layouts[accessor];
    const int view = d->model.accessors[accessor].view;
    if (layout->data && layout->packing == GLTF_PLAIN && view >= 0)
        ffd_gltf_forget_bytes(d, &d->buffers[d->model.views[view].buffer],
                              layout->begin + first * layout->stride, count * layout->stride);
}

ffd_status ffd_gltf_note_flaw(gltf_document *d, uint32_t value, ffd_error *error, const char *format,
                              va_list arguments)
{
    char pointer[sizeof error->pointer];
    if (ffd_flaw_repeats(&d->base.flaws, format))
        return FFD_OK;
    ffd_json_tree_pointer(&d->tree, value, pointer, sizeof pointer);
    return ffd_flaw_note(&d->base.flaws, d->name, ffd_json_tree_line(&d->tree, value), pointer, error, format,
                         arguments);
}

ffd_status ffd_gltf_flaw(gltf_document *d, uint32_t value, ffd_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const ffd_status status = ffd_gltf_note_flaw(d, value, error, format, arguments);
    va_end(arguments);
    return status;
}
