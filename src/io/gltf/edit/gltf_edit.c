#include "io/gltf/edit/gltf_edit.h"
#include "base/memory/hash.h"
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

ffd_status ffd_gltf_make_elements(gltf_edit *edit, gltf_content *content, ffd_error *error)
{
    const size_t size = content->width * sizeof *content->values;
    content->values = NULL;
    TRY(ffd_budget_take(&edit->document->base.budget, content->count, size, error));
    content->values = ffd_alloc(content->count, size);
    if (content->values)
        return FFD_OK;
    ffd_budget_return(&edit->document->base.budget, content->count, size);
    return ffd_fail_memory(error);
}

void ffd_gltf_free_elements(gltf_edit *edit, gltf_content *content)
{
    if (content->values)
        ffd_budget_return(&edit->document->base.budget, content->count,
                          content->width * sizeof *content->values);
    ffd_free(content->values);
    content->values = NULL;
}

size_t ffd_gltf_add_content(gltf_edit *edit, gltf_content *content)
{
    const hash_block blocks[] = {
        {&content->accessor, sizeof content->accessor},
        {&content->count, sizeof content->count},
        {content->values, content->count * content->width * sizeof *content->values}};
    const hash128 hash = ffd_hash_blocks(blocks, 3);
    uint32_t index = 0;
    const bool known = ffd_intern(&edit->known, &hash, sizeof hash, &index);
    if (known && index < edit->content_count) {
        ffd_gltf_free_elements(edit, content);
        return index;
    }
    if (!known || !ffd_grow((void **)&edit->contents, &edit->content_capacity, edit->content_count + 1,
                            sizeof *edit->contents)) {
        ffd_gltf_free_elements(edit, content);
        return GLTF_NONE;
    }
    edit->contents[edit->content_count] = *content;
    return edit->content_count++;
}

ffd_status ffd_gltf_make_edit(gltf_document *d, ffd_error *error)
{
    d->edit = ffd_alloc_zero(1, sizeof *d->edit);
    if (!d->edit)
        return ffd_fail_memory(error);
    d->edit->document = d;
    return FFD_OK;
}

void ffd_gltf_clear_edit(gltf_document *d)
{
    gltf_edit *const edit = d->edit;
    ffd_gltf_free_rig(d, &edit->rig);
    for (size_t i = 0; i < edit->content_count; i++)
        ffd_gltf_free_elements(edit, &edit->contents[i]);
    ffd_intern_free(&edit->known);
    ffd_free(edit->contents);
    ffd_buffer_free(&edit->bounded);
    ffd_buffer_free(&edit->accessors);
    ffd_buffer_free(&edit->bytes);
    ffd_edits_free(&edit->edits);
    *edit = (gltf_edit){.document = d};
    ffd_free(d->replaced.values);
    d->replaced = (gltf_values){0};
}

void ffd_gltf_free_edit(gltf_document *d)
{
    if (d->edit)
        ffd_gltf_clear_edit(d);
    ffd_free(d->edit);
}
