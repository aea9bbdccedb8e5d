/* gltf_make_plan.c - makes the plan of saving. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_users.h"
#include "io/gltf/write/gltf_plan.h"
#include <stdlib.h>
#include <string.h>

#define EMPTY_HASH 0xcbf29ce484222325u

/* An attribute of a part whose content changed. */
typedef struct candidate {
    size_t accessor, order;
    uint64_t hash;
    const float *values;
    size_t components, size; /* components per element; size of all values in bytes */
} candidate;

static bool is_changed(const gltf_document *d, size_t part, const gltf_stream *stream)
{
    for (size_t i = 0; i < d->mesh_parts[part].vertex_count; i++) {
        float original[4];
        const size_t components = stream->components;
        ffd_gltf_original(d, stream->accessor, i, components, original);
        if (memcmp(original, stream->result + components * i, components * sizeof *original) != 0)
            return true;
    }
    return false;
}

/* Mixes a word into a hash, like FNV-1a. */
static uint64_t mix(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x100000001b3u;
    return hash ^ hash >> 29;
}

static uint64_t hash_words(const float *values, size_t count)
{
    uint64_t hash = EMPTY_HASH;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        hash = mix(hash, bits);
    }
    return hash;
}

static int compare_sizes(size_t a, size_t b)
{
    return (a > b) - (a < b);
}

static int compare_candidates(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    if (x->accessor != y->accessor)
        return compare_sizes(x->accessor, y->accessor);
    if (x->hash != y->hash)
        return x->hash < y->hash ? -1 : 1;
    return compare_sizes(x->order, y->order);
}

static int compare_versions(const void *a, const void *b)
{
    return compare_sizes(((const gltf_version *)a)->order, ((const gltf_version *)b)->order);
}

static size_t list_candidates(const gltf_document *d, candidate *candidates)
{
    size_t count = 0;
    for (size_t i = 0; i < ffd_gltf_part_count(d); i++)
        for (size_t s = 0; s < GLTF_DEFORMED; s++) {
            const gltf_stream *stream = &d->parts[i].streams[s];
            const size_t values = stream->components * d->mesh_parts[i].vertex_count;
            if (!stream->result || !is_changed(d, i, stream))
                continue;
            candidates[count++] =
                (candidate){stream->accessor, i * GLTF_DEFORMED + s, 0,
                            stream->result,   stream->components,    values * sizeof *stream->result};
        }
    if (count == 0)
        return 0;
    /* Most accessors have one candidate, which needs no hash. */
    qsort(candidates, count, sizeof *candidates, compare_candidates);
    for (size_t i = 0; i < count; i++)
        if ((i > 0 && candidates[i - 1].accessor == candidates[i].accessor) ||
            (i + 1 < count && candidates[i + 1].accessor == candidates[i].accessor))
            candidates[i].hash =
                hash_words(candidates[i].values, candidates[i].size / sizeof *candidates[i].values);
    qsort(candidates, count, sizeof *candidates, compare_candidates);
    return count;
}

/* Makes one version of all candidates with equal content. */
static void join_candidates(const candidate *candidates, size_t count, gltf_plan *plan)
{
    for (size_t i = 0; i < count; i++) {
        const candidate *c = &candidates[i];
        gltf_version *last = plan->version_count ? &plan->versions[plan->version_count - 1] : NULL;
        const bool same = last && last->accessor == c->accessor && last->components == c->components &&
                          memcmp(last->values, c->values, c->size) == 0;
        if (!same)
            plan->versions[plan->version_count++] = (gltf_version){.accessor = c->accessor,
                                                                   .values = c->values,
                                                                   .components = c->components,
                                                                   .order = c->order,
                                                                   .output = GLTF_NONE};
        /* Until the versions are sorted, their order identifies them. */
        plan->part_versions[c->order] = plan->versions[plan->version_count - 1].order;
    }
}

static void choose_component(const gltf_document *d, gltf_version *version)
{
    const gltf_accessor *accessor = &d->model.accessors[version->accessor];
    const bool fits = ffd_gltf_fits(accessor, version->values, version->components * (size_t)accessor->count);
    version->component = fits ? accessor->component : GLTF_FLOAT;
}

/* Adds a version for each of the edit's contents, which are all different. */
static void add_contents(const gltf_edit *edit, gltf_plan *plan)
{
    for (size_t i = 0; i < edit->content_count; i++) {
        const gltf_content *const content = &edit->contents[i];
        gltf_version *const made = &plan->versions[plan->version_count];
        *made = (gltf_version){.accessor = content->accessor,
                               .values = content->values,
                               .width = content->width,
                               .count = content->count,
                               .needed = true,
                               .component = GLTF_FLOAT,
                               .output = GLTF_NONE};
        plan->content_versions[i] = plan->version_count++;
    }
}

static ffd_status make_versions(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    const size_t most = ffd_gltf_part_count(d) * GLTF_DEFORMED;
    const size_t contents = d->edit->content_count;
    candidate *candidates = ffd_alloc(most, sizeof *candidates);
    size_t *indices = ffd_alloc(most, sizeof *indices);
    plan->versions = ffd_alloc(most + contents, sizeof *plan->versions);
    plan->content_versions = ffd_alloc(contents, sizeof *plan->content_versions);
    plan->part_versions = ffd_alloc(most, sizeof *plan->part_versions);
    ffd_status status = FFD_OK;
    if (!candidates || !indices || !plan->versions || !plan->part_versions || !plan->content_versions)
        TRY_END(ffd_fail_memory(error));
    for (size_t i = 0; i < most; i++)
        plan->part_versions[i] = GLTF_NONE;
    join_candidates(candidates, list_candidates(d, candidates), plan);
    if (plan->version_count > 0)
        qsort(plan->versions, plan->version_count, sizeof *plan->versions, compare_versions);
    for (size_t i = 0; i < plan->version_count; i++) {
        indices[plan->versions[i].order] = i;
        choose_component(d, &plan->versions[i]);
    }
    for (size_t i = 0; i < most; i++)
        if (plan->part_versions[i] != GLTF_NONE)
            plan->part_versions[i] = indices[plan->part_versions[i]];
    add_contents(d->edit, plan);
end:
    ffd_free(candidates);
    ffd_free(indices);
    return status;
}

static bool same_mesh(const gltf_document *d, const gltf_plan *plan, size_t mesh, size_t a, size_t b)
{
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        for (size_t s = 0; s < gltf_slot_count(p); s++)
            if (ffd_gltf_version_at(d, plan, p, s, a) != ffd_gltf_version_at(d, plan, p, s, b))
                return false;
    return true;
}

typedef struct variant {
    uint64_t hash;
    size_t use;
} variant;

static uint64_t hash_mesh(const gltf_document *d, const gltf_plan *plan, size_t mesh, size_t use)
{
    uint64_t hash = EMPTY_HASH;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        for (size_t s = 0; s < gltf_slot_count(p); s++)
            hash = mix(hash, ffd_gltf_version_at(d, plan, p, s, use));
    return hash;
}

static int compare_variants(const void *a, const void *b)
{
    const variant *x = a, *y = b;
    if (x->hash != y->hash)
        return x->hash < y->hash ? -1 : 1;
    return compare_sizes(x->use, y->use);
}

static int compare_changes(const void *a, const void *b)
{
    return compare_sizes(((const gltf_node_change *)a)->node, ((const gltf_node_change *)b)->node);
}

/* Finds the nodes that need copies of a mesh. variants: room for all nodes of the mesh. */
static void split_mesh(const gltf_document *d, size_t mesh, variant *variants, gltf_plan *plan)
{
    const gltf_mesh_uses *uses = &d->mesh_uses[mesh];
    const size_t base = uses->used_outside_scene && d->space == FFD_SPACE_SCENE ? GLTF_NONE : 0;
    plan->base_uses[mesh] = base;
    size_t count = 0;
    for (size_t use = 0; use < uses->node_count; use++)
        if (use != base && !same_mesh(d, plan, mesh, base, use))
            variants[count++] = (variant){hash_mesh(d, plan, mesh, use), use};
    if (count == 0)
        return;
    qsort(variants, count, sizeof *variants, compare_variants);
    for (size_t i = 0; i < count; i++) {
        const bool joined = i > 0 && variants[i].hash == variants[i - 1].hash &&
                            same_mesh(d, plan, mesh, plan->copies[plan->copy_count - 1].use, variants[i].use);
        if (!joined)
            plan->copies[plan->copy_count++] = (gltf_mesh_copy){mesh, variants[i].use};
        plan->changes[plan->change_count++] =
            (gltf_node_change){uses->nodes[variants[i].use], plan->copies[plan->copy_count - 1].use};
    }
}

static int compare_copies(const void *a, const void *b)
{
    return compare_sizes(((const gltf_mesh_copy *)a)->use, ((const gltf_mesh_copy *)b)->use);
}

/* Sorts a mesh's copies by their first nodes, so that the order does not depend on hashes. */
static void order_copies(gltf_plan *plan, size_t first_copy, size_t first_change)
{
    if (plan->copy_count == first_copy)
        return;
    qsort(plan->copies + first_copy, plan->copy_count - first_copy, sizeof *plan->copies, compare_copies);
    for (size_t i = first_change; i < plan->change_count; i++) {
        gltf_node_change *change = &plan->changes[i];
        const gltf_mesh_copy key = {.use = change->copy};
        const gltf_mesh_copy *found = bsearch(&key, plan->copies + first_copy, plan->copy_count - first_copy,
                                              sizeof *plan->copies, compare_copies);
        change->copy = (size_t)(found - plan->copies);
    }
    qsort(plan->changes + first_change, plan->change_count - first_change, sizeof *plan->changes,
          compare_changes);
}

static ffd_status split_meshes(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    size_t nodes = 0, most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        nodes += d->mesh_uses[m].node_count;
        most = d->mesh_uses[m].node_count > most ? d->mesh_uses[m].node_count : most;
    }
    variant *variants = ffd_alloc(most, sizeof *variants);
    gltf_use_group *groups = ffd_alloc(most + 1, sizeof *groups);
    size_t *order = ffd_alloc(most + 1, sizeof *order);
    plan->base_uses = ffd_alloc(d->model.mesh_count, sizeof *plan->base_uses);
    plan->copies = ffd_alloc(nodes, sizeof *plan->copies);
    plan->changes = ffd_alloc(nodes, sizeof *plan->changes);
    ffd_status status = FFD_OK;
    if (!variants || !groups || !order || !plan->base_uses || !plan->copies || !plan->changes)
        TRY_END(ffd_fail_memory(error));
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const size_t first_copy = plan->copy_count, first_change = plan->change_count;
        split_mesh(d, m, variants, plan);
        order_copies(plan, first_copy, first_change);
        ffd_gltf_join_uses(d, m, first_copy, first_change, plan, groups, order);
    }
end:
    ffd_free(variants);
    ffd_free(groups);
    ffd_free(order);
    return status;
}

/* Marks what a use of a mesh or of its copy needs: versions, or in original[a] the original content of
   accessor a. */
static void mark_mesh(const gltf_document *d, gltf_plan *plan, size_t mesh, size_t use, bool *original)
{
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        for (size_t s = 0; s < gltf_slot_count(p); s++) {
            const int accessor = gltf_slot_accessor(p, s);
            const size_t version = ffd_gltf_version_at(d, plan, p, s, use);
            if (version != GLTF_NONE)
                plan->versions[version].needed = true;
            else if (accessor >= 0)
                original[accessor] = true;
        }
}

/* Whether the version can overwrite the accessor's bytes (decoded, if they are compressed). Sparse accessors
   do not have bytes for all elements. */
static bool can_overwrite(const gltf_document *d, const gltf_version *version)
{
    const gltf_accessor *accessor = &d->model.accessors[version->accessor];
    const bool has_bytes = accessor->view >= 0 || d->layouts[version->accessor].packing == GLTF_DRACO;
    return has_bytes && !accessor->sparse.present && version->component == accessor->component;
}

static ffd_status choose_in_place(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    bool *original = ffd_alloc_zero(d->model.accessor_count, sizeof *original);
    plan->in_place = ffd_alloc(d->model.accessor_count, sizeof *plan->in_place);
    if (!original || !plan->in_place) {
        ffd_free(original);
        return ffd_fail_memory(error);
    }
    for (size_t m = 0; m < d->model.mesh_count; m++)
        mark_mesh(d, plan, m, plan->base_uses[m], original);
    for (size_t i = 0; i < plan->copy_count; i++)
        mark_mesh(d, plan, plan->copies[i].mesh, plan->copies[i].use, original);
    ffd_gltf_mark_other_users(d, original);
    if (ffd_gltf_follows(d))
        ffd_gltf_mark_rig_originals(d, &d->edit->rig, original);
    else
        ffd_gltf_mark_rig_users(d, &d->replaced, original);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        plan->in_place[a] = GLTF_NONE;
    for (size_t v = plan->version_count; v-- > 0;) {
        gltf_version *version = &plan->versions[v];
        if (!version->needed || version->accessor == GLTF_NONE || original[version->accessor])
            continue;
        if (can_overwrite(d, version))
            plan->in_place[version->accessor] = v;
        version->rebinds = ffd_gltf_is_added(d, version->accessor);
        original[version->accessor] =
            original[version->accessor] || version->rebinds; /* only one version per accessor */
    }
    ffd_free(original);
    return FFD_OK;
}

static ffd_status append_rest(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    plan->appended = ffd_alloc(plan->version_count, sizeof *plan->appended);
    if (!plan->appended)
        return ffd_fail_memory(error);
    size_t added = 0;
    for (size_t v = 0; v < plan->version_count; v++) {
        gltf_version *version = &plan->versions[v];
        if (version->accessor != GLTF_NONE && plan->in_place[version->accessor] == v) {
            version->output = version->accessor;
        } else if (version->needed) {
            version->output = version->rebinds ? version->accessor : ffd_gltf_accessor_end(d) + added++;
            plan->appended[plan->appended_count++] = v;
        }
    }
    return FFD_OK;
}

ffd_status ffd_gltf_make_plan(const gltf_document *d, gltf_plan *plan, ffd_error *error)
{
    *plan = (gltf_plan){0};
    ffd_status status;
    TRY_END(make_versions(d, plan, error));
    TRY_END(split_meshes(d, plan, error));
    TRY_END(choose_in_place(d, plan, error));
    TRY_END(ffd_gltf_resolve_overlaps(d, plan, error));
    TRY_END(append_rest(d, plan, error));
end:
    if (status)
        ffd_gltf_free_plan(plan);
    return status;
}
