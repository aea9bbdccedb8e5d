#include "io/gltf/edit/gltf_edit.h"
#include "base/memory/memory.h"

size_t ffd_gltf_added_buffer(const gltf_document *d)
{
    return d->buffer_values.count > 0 && d->buffers[0].kind == BUFFER_BIN ? 0 : d->buffer_values.count;
}

/* Makes room for one more accessor of the model. */
static bool reserve(gltf_edit *edit)
{
    gltf_document *const d = edit->document;
    const size_t count = d->model.accessor_count, capacity = count + count / 2 + 1;
    if (count < edit->accessor_capacity)
        return true;
    gltf_accessor *const accessors = ffd_realloc(d->model.accessors, capacity, sizeof *accessors);
    d->model.accessors = accessors ? accessors : d->model.accessors;
    gltf_layout *const layouts = accessors ? ffd_realloc(d->layouts, capacity, sizeof *layouts) : NULL;
    d->layouts = layouts ? layouts : d->layouts;
    gltf_unpacked *const unpacked = layouts ? ffd_realloc(d->unpacked, capacity, sizeof *unpacked) : NULL;
    d->unpacked = unpacked ? unpacked : d->unpacked;
    edit->accessor_capacity = unpacked ? capacity : 0;
    return unpacked;
}

size_t ffd_gltf_add_zeros(gltf_edit *edit, uint64_t count, bool bounded)
{
    static const size_t size = 3 * sizeof(float);
    gltf_document *const d = edit->document;
    ffd_buffer_append(&edit->bounded, &bounded, sizeof bounded);
    if (edit->bounded.failed || !reserve(edit)) {
        edit->edits.failed = true;
        return GLTF_NONE;
    }
    const size_t index = d->model.accessor_count++;
    d->model.accessors[index] =
        (gltf_accessor){.view = -1, .count = count, .component = GLTF_FLOAT, .columns = 1, .rows = 3};
    d->layouts[index] = (gltf_layout){.element_size = size, .stride = size, .readable = true};
    d->unpacked[index] = (gltf_unpacked){0};
    return index;
}

void ffd_gltf_edit_free(gltf_edit *edit)
{
    ffd_buffer_free(&edit->bounded);
    ffd_buffer_free(&edit->accessors);
    ffd_buffer_free(&edit->bytes);
    ffd_free(edit->replaced.values);
    ffd_edits_free(&edit->edits);
}
