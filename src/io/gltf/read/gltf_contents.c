#include "io/gltf/read/gltf_contents.h"
#include "base/memory/memory.h"
#include "io/text/content.h"

static void mark_view(const gltf_document *d, int view, bool *is_read)
{
    if (view >= 0 && (size_t)view < d->model.view_count)
        is_read[view] = true;
}

/* Whether a bufferView that is not read as numbers begins where its buffer does. */
static bool begins_with_other(const gltf_document *d, size_t buffer, const bool *is_read)
{
    for (size_t i = 0; i < d->model.view_count; i++) {
        const gltf_view *const view = &d->model.views[i];
        if (!is_read[i] && view->offset == 0 && view->buffer >= 0 && (size_t)view->buffer == buffer)
            return true;
    }
    return false;
}

ffd_status ffd_gltf_check_contents(const gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    bool *is_read = ffd_alloc_zero(d->model.view_count, sizeof *is_read);
    if (!is_read)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->model.accessor_count; i++) {
        const gltf_accessor *const accessor = &d->model.accessors[i];
        mark_view(d, accessor->view, is_read);
        mark_view(d, accessor->sparse.present ? accessor->sparse.indices_view : -1, is_read);
        mark_view(d, accessor->sparse.present ? accessor->sparse.values_view : -1, is_read);
    }
    for (size_t i = 0; i < d->buffer_values.count && status == FFD_OK; i++) {
        const gltf_buffer *const buffer = &d->buffers[i];
        const content_kind *const kind =
            buffer->data ? ffd_content_sure_kind(buffer->data, buffer->size) : NULL;
        /* Each buffer that names one file maps it anew, and would keep the pages that were looked at. */
        ffd_file_release_pages(&buffer->file, buffer->file.data, buffer->file.size);
        const uint32_t value = d->buffer_values.values[i], uri = ffd_json_span_member(&d->tree, value, "uri");
        if (!kind || (!kind->is_stand_in && begins_with_other(d, i, is_read)))
            continue;
        if (buffer->path)
            status = ffd_json_span_fail(&d->tree, uri, d->name, FFD_E_INVALID, error,
                                        "the buffer \"%s\" seems to be %s", buffer->path, kind->name);
        else
            status = ffd_json_span_fail(&d->tree, uri == JSON_NONE ? value : uri, d->name, FFD_E_INVALID,
                                        error, "the buffer seems to be %s", kind->name);
    }
    ffd_free(is_read);
    return status;
}
