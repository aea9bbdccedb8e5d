#include "io/gltf/edit/gltf_rig.h"
#include "base/memory/hash.h"
#include "base/memory/memory.h"

ffd_status ffd_gltf_make_elements(gltf_rig *rig, gltf_rig_content *content, ffd_error *error)
{
    const size_t size = content->width * sizeof *content->values;
    const ffd_status status = ffd_budget_take(rig->budget, content->count, size, error);
    content->values = status ? NULL : ffd_alloc(content->count, size);
    if (!status && !content->values) {
        ffd_budget_return(rig->budget, content->count, size);
        return ffd_fail_memory(error);
    }
    return status;
}

void ffd_gltf_free_elements(gltf_rig *rig, gltf_rig_content *content)
{
    if (content->values)
        ffd_budget_return(rig->budget, content->count, content->width * sizeof *content->values);
    ffd_free(content->values);
    content->values = NULL;
}

size_t ffd_gltf_add_content(gltf_rig *rig, gltf_rig_content *content)
{
    const hash_block blocks[] = {
        {&content->accessor, sizeof content->accessor},
        {&content->count, sizeof content->count},
        {content->values, content->count * content->width * sizeof *content->values}};
    const hash128 hash = ffd_hash_blocks(blocks, 3);
    uint32_t index = 0;
    const bool known = ffd_intern(&rig->known, &hash, sizeof hash, &index);
    if (known && index < rig->content_count) {
        ffd_gltf_free_elements(rig, content);
        return index;
    }
    if (!known || !ffd_grow((void **)&rig->contents, &rig->content_capacity, rig->content_count + 1,
                            sizeof *rig->contents)) {
        ffd_gltf_free_elements(rig, content);
        return GLTF_NONE;
    }
    rig->contents[rig->content_count] = *content;
    return rig->content_count++;
}

static void mark(size_t accessor, bool *used)
{
    if (accessor != GLTF_NONE)
        used[accessor] = true;
}

static void mark_animation(const gltf_animation *animation, const gltf_rig_animation *change, bool *used)
{
    for (size_t s = 0; s < animation->sampler_count; s++) {
        mark(animation->samplers[s].input, used);
        if (!change->contents || change->contents[s] == GLTF_NONE)
            mark(animation->samplers[s].output, used);
    }
    for (size_t i = 0; i < change->copy_count; i++)
        if (change->copies[i].content == GLTF_NONE)
            mark(animation->samplers[change->copies[i].sampler].output, used);
}

void ffd_gltf_mark_rig_originals(const gltf_document *d, bool *used)
{
    for (size_t s = 0; s < d->skin_values.count; s++)
        if (d->skins[s].inverse_bind >= 0 && d->rig->skin_contents[s] == GLTF_NONE)
            used[d->skins[s].inverse_bind] = true;
    for (size_t a = 0; a < d->rig->animations.count; a++)
        mark_animation(&d->rig->animations.list[a], &d->rig->changes[a], used);
}

void ffd_gltf_free_rig(gltf_document *d)
{
    gltf_rig *const rig = d->rig;
    if (!rig)
        return;
    for (size_t i = 0; i < rig->content_count; i++)
        ffd_gltf_free_elements(rig, &rig->contents[i]);
    for (size_t a = 0; rig->changes && a < rig->animations.count; a++) {
        ffd_free(rig->changes[a].contents);
        ffd_free(rig->changes[a].channels);
        ffd_free(rig->changes[a].copies);
    }
    ffd_gltf_free_animations(d, &rig->animations);
    ffd_intern_free(&rig->known);
    ffd_free(rig->changes);
    ffd_free(rig->contents);
    ffd_free(rig->skin_contents);
    ffd_free(rig->world);
    ffd_free(rig->motions);
    ffd_free(rig->nodes);
    ffd_free(rig);
    d->rig = NULL;
    for (size_t i = 0; d->mesh_parts && i < d->base.part_count; i++)
        d->mesh_parts[i].carried = false;
}
