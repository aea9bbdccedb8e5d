/* gltf_unpack.c - writes compressed data decompressed if any of it changed. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_views.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"

#define DRACO "KHR_draco_mesh_compression"

bool ffd_gltf_is_unpacked(const gltf_saver *saver, const gltf_primitive *primitive, size_t use)
{
    const gltf_document *d = saver->document;
    if (ffd_gltf_draco_value(d, primitive) == JSON_NONE)
        return false;
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        const int accessor = primitive->accessor[s];
        if (accessor >= 0 && d->layouts[accessor].packing == GLTF_DRACO &&
            ffd_gltf_version_at(d, &saver->plan, primitive, (gltf_semantic)s, use) != GLTF_NONE)
            return true;
    }
    return false;
}

/* Whether an attribute has another accessor in the output. */
static bool is_redirected(const gltf_saver *saver, const gltf_primitive *primitive, size_t use,
                          uint32_t attribute)
{
    const gltf_document *d = saver->document;
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        const size_t version = ffd_gltf_version_at(d, &saver->plan, primitive, (gltf_semantic)s, use);
        if (version != GLTF_NONE && ffd_json_tree_key_is(&d->tree, attribute, ffd_gltf_semantic_names[s]))
            return saver->plan.versions[version].output != saver->plan.versions[version].accessor;
    }
    return false;
}

static void add_unpacking(gltf_saver *saver, size_t *index, gltf_unpacking unpacking)
{
    if (*index != GLTF_NONE)
        return;
    *index = saver->unpacking_count;
    saver->unpackings[saver->unpacking_count++] = unpacking;
}

/* Returns the buffer with the bytes of a view, compressed or not. */
static size_t stored_in(const gltf_document *d, size_t view)
{
    double buffer = d->model.views[view].buffer;
    ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, ffd_gltf_meshopt_value(d, view), "buffer"),
                         &buffer);
    return (size_t)buffer;
}

static void unpack_accessor(gltf_saver *saver, size_t a, bool indices)
{
    const gltf_document *d = saver->document;
    const gltf_unpacked *unpacked = &d->unpacked[a];
    add_unpacking(saver, &saver->accessor_unpackings[a],
                  (gltf_unpacking){.view = GLTF_NONE,
                                   .accessor = a,
                                   .indices = indices,
                                   .bytes = unpacked->bytes,
                                   .size = unpacked->size,
                                   .buffer = stored_in(d, unpacked->view)});
}

/* Lists all accessors that a primitive reads from its compressed data for one use. */
static void unpack_primitive(gltf_saver *saver, const gltf_primitive *primitive, size_t use)
{
    const gltf_document *d = saver->document;
    const int indices = primitive->indices;
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive->value, "attributes");
    for (uint32_t v = ffd_json_tree_first(&d->tree, attributes); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        double number = 0;
        ffd_json_tree_number(&d->tree, v, &number);
        if (d->layouts[(size_t)number].packing == GLTF_DRACO && !is_redirected(saver, primitive, use, v))
            unpack_accessor(saver, (size_t)number, false);
    }
    if (indices >= 0 && d->layouts[indices].packing == GLTF_DRACO)
        unpack_accessor(saver, (size_t)indices, true);
}

static void unpack_mesh(gltf_saver *saver, size_t mesh, size_t use)
{
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(saver->document, mesh, p));)
        if (ffd_gltf_is_unpacked(saver, p, use))
            unpack_primitive(saver, p, use);
}

static void unpack_view(gltf_saver *saver, size_t view)
{
    const gltf_document *d = saver->document;
    add_unpacking(saver, &saver->view_unpackings[view],
                  (gltf_unpacking){.view = view,
                                   .accessor = GLTF_NONE,
                                   .bytes = d->decoded_views[view],
                                   .size = (size_t)d->model.views[view].length,
                                   .buffer = stored_in(d, view)});
}

ffd_status ffd_gltf_list_unpackings(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const size_t views = d->model.view_count, accessors = d->model.accessor_count;
    saver->view_unpackings = ffd_alloc(views, sizeof *saver->view_unpackings);
    saver->accessor_unpackings = ffd_alloc(accessors, sizeof *saver->accessor_unpackings);
    saver->unpackings = ffd_alloc(views + accessors, sizeof *saver->unpackings);
    if (!saver->view_unpackings || !saver->accessor_unpackings || !saver->unpackings)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < views; v++)
        saver->view_unpackings[v] = GLTF_NONE;
    for (size_t a = 0; a < accessors; a++)
        saver->accessor_unpackings[a] = GLTF_NONE;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        unpack_mesh(saver, m, saver->plan.base_uses[m]);
    for (size_t i = 0; i < saver->plan.copy_count; i++)
        unpack_mesh(saver, saver->plan.copies[i].mesh, saver->plan.copies[i].use);
    for (size_t a = 0; a < accessors; a++)
        if (saver->plan.in_place[a] != GLTF_NONE && d->layouts[a].packing == GLTF_DRACO)
            unpack_accessor(saver, a, false);
    saver->unpacked_accessor_count = saver->unpacking_count;
    for (size_t a = 0; a < accessors; a++)
        if (saver->plan.in_place[a] != GLTF_NONE && d->layouts[a].packing == GLTF_MESHOPT)
            unpack_view(saver, (size_t)d->model.accessors[a].view);
    return FFD_OK;
}

void ffd_gltf_free_unpackings(gltf_saver *saver)
{
    for (size_t i = 0; i < saver->unpacking_count; i++)
        ffd_free(saver->unpackings[i].own);
    ffd_free(saver->view_unpackings);
    ffd_free(saver->accessor_unpackings);
    ffd_free(saver->unpackings);
}

/* Removes extensions from an object, and the member "extensions" itself if none are left. */
static void remove_extensions(const json_tree *tree, uint32_t object, const char *const *names, size_t count,
                              json_edits *edits)
{
    const uint32_t extensions = ffd_json_tree_member(tree, object, "extensions");
    uint32_t gone[2];
    size_t gone_count = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t extension = ffd_json_tree_member(tree, extensions, names[i]);
        if (extension != JSON_NONE)
            gone[gone_count++] = extension;
    }
    if (gone_count == 0)
        return;
    if (gone_count == tree->values[extensions].count)
        ffd_edits_remove(edits, tree, object, &extensions, 1);
    else
        ffd_edits_remove(edits, tree, extensions, gone, gone_count);
}

void ffd_gltf_edit_compression(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits)
{
    static const char *const names[] = {DRACO};
    const gltf_document *d = saver->document;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));) {
        if (!ffd_gltf_is_unpacked(saver, p, use))
            continue;
        remove_extensions(&d->tree, p->value, names, 1, edits);
        ffd_log_line(saver->log, FFD_LOG_INFO,
                     "primitive %zu of mesh %zu is written uncompressed (it was " DRACO
                     ") because it is deformed",
                     p->index, mesh);
    }
}

static void set_number(const json_tree *tree, uint32_t object, const char *key, size_t index,
                       json_edits *edits)
{
    const uint32_t member = ffd_json_tree_member(tree, object, key);
    const uint32_t inside = tree->values[object].begin + 1;
    if (member == JSON_NONE)
        ffd_edits_format(edits, inside, inside, "\"%s\":%zu,", key, index);
    else
        ffd_edits_format(edits, tree->values[member].begin, tree->values[member].end, "%zu", index);
}

static void edit_view(gltf_saver *saver, const gltf_unpacking *unpacking)
{
    static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
    const gltf_document *d = saver->document;
    const uint32_t view = d->view_values.values[unpacking->view];
    set_number(&d->tree, view, "buffer", unpacking->buffer, &saver->edits);
    set_number(&d->tree, view, "byteOffset", unpacking->offset, &saver->edits);
    remove_extensions(&d->tree, view, names, 2, &saver->edits);
    ffd_log_line(saver->log, FFD_LOG_INFO,
                 "bufferView %zu is written uncompressed (it was %s) because its content is deformed",
                 unpacking->view, ffd_gltf_has_extension(d, view, names[0]) ? names[0] : names[1]);
}

/* index: that of its new bufferView. */
static void edit_accessor(gltf_saver *saver, const gltf_unpacking *unpacking, size_t index)
{
    const gltf_document *d = saver->document;
    const uint32_t accessor = d->accessor_values.values[unpacking->accessor];
    set_number(&d->tree, accessor, "bufferView", index, &saver->edits);
    if (ffd_json_tree_member(&d->tree, accessor, "byteOffset") != JSON_NONE)
        set_number(&d->tree, accessor, "byteOffset", 0, &saver->edits);
    /* The stated bounds are from before the compression, which may have rounded the values. */
    if (saver->plan.in_place[unpacking->accessor] == GLTF_NONE)
        ffd_gltf_edit_unpacked_bounds(saver, unpacking, &saver->edits);
}

void ffd_gltf_edit_unpackings(gltf_saver *saver)
{
    const size_t first = ffd_gltf_view_end(saver->document) + saver->plan.appended_count;
    for (size_t i = 0; i < saver->unpacking_count; i++)
        if (saver->unpackings[i].view != GLTF_NONE)
            edit_view(saver, &saver->unpackings[i]);
        else
            edit_accessor(saver, &saver->unpackings[i], first + i);
}

void ffd_gltf_write_unpacked_views(const gltf_saver *saver, byte_buffer *text)
{
    const gltf_document *d = saver->document;
    for (size_t i = 0; i < saver->unpacked_accessor_count; i++) {
        const gltf_unpacking *unpacking = &saver->unpackings[i];
        const gltf_layout *layout = &d->layouts[unpacking->accessor];
        ffd_buffer_format(text, "%s{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu",
                          text->size > 0 ? "," : "", unpacking->buffer, unpacking->offset, unpacking->size);
        if (layout->stride > layout->element_size)
            ffd_buffer_format(text, ",\"byteStride\":%zu", layout->stride);
        ffd_buffer_text(text, unpacking->indices ? ",\"target\":34963}" : ",\"target\":34962}");
    }
}

static bool has_draco(const gltf_saver *saver, size_t mesh, size_t use)
{
    const gltf_document *d = saver->document;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        if (ffd_gltf_draco_value(d, p) != JSON_NONE && !ffd_gltf_is_unpacked(saver, p, use))
            return true;
    return false;
}

bool ffd_gltf_lost_draco(gltf_saver *saver)
{
    bool lost = saver->unpacked_accessor_count > 0;
    for (size_t m = 0; m < saver->document->model.mesh_count && lost; m++)
        lost = !has_draco(saver, m, saver->plan.base_uses[m]);
    for (size_t i = 0; i < saver->plan.copy_count && lost; i++)
        lost = !has_draco(saver, saver->plan.copies[i].mesh, saver->plan.copies[i].use);
    return lost;
}

/* Whether the extension is no longer used. A fallback buffer stays, and with it the extension. */
static bool lost_meshopt(const gltf_saver *saver, const char *name)
{
    const gltf_document *d = saver->document;
    bool had = false;
    for (size_t v = 0; v < d->model.view_count; v++) {
        if (!ffd_gltf_has_extension(d, d->view_values.values[v], name))
            continue;
        if (saver->view_unpackings[v] == GLTF_NONE)
            return false;
        had = true;
    }
    for (size_t b = 0; b < d->buffer_values.count; b++)
        if (ffd_gltf_has_extension(d, d->buffer_values.values[b], name))
            return false;
    return had;
}

bool ffd_gltf_lost_ext_meshopt(gltf_saver *saver)
{
    return lost_meshopt(saver, "EXT_meshopt_compression");
}

bool ffd_gltf_lost_khr_meshopt(gltf_saver *saver)
{
    return lost_meshopt(saver, "KHR_meshopt_compression");
}
