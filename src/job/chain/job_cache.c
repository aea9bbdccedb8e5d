#include "job/chain/job_cache.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "embed/locator.h"
#include "job/input/source.h"
#include <string.h>

/* An owned lattice: of a file, or one that a cached locator refers to. */
typedef struct kept_lattice {
    ffd_lattice *lattice;
    char *path; /* NULL: kept for a locator only */
    file_stamp stamp;
    hash128 rest;
    bool has_folds;
    ffd_folds folds;
    bool used; /* by the current job */
} kept_lattice;

/* A cached locator. */
typedef struct kept_rest {
    hash128 hash;
    ffd_isa isa;
    const ffd_lattice *lattice; /* one of ffd_share.lattices that the locator refers to */
    ffd_locator *locator;
    bool used;
} kept_rest;

struct ffd_share {
    bool only_lattices, is_of_job;
    mesh_document *document; /* NULL: none, or the current job has it */
    bool is_noted;           /* the following members describe the document: */
    ffd_source source; /* owns its path; its list of allowed extensions is dropped, rules has their hash */
    hash128 rules;
    bool only_positions;
    char **only; /* only_count entries */
    size_t only_count;
    path_list files;
    file_stamp *stamps; /* files.count entries */

    kept_lattice *lattices;
    kept_rest *rests;
    size_t lattice_count, lattice_capacity, rest_count, rest_capacity;

    mesh_boxes boxes;

    ffd_location *locations; /* of the vertices of the cached mesh, or of the last one */
    hash128 located;         /* hash of the rest volume that they are in */
    bool is_located;

    kept_file *kept; /* of the current job; borrowed */
    bool hashes_output, has_output;
    hash128 output;  /* hash of the output */
    bool has_state;  /* state holds for the current job's mesh: */
    hash128 state;   /* hash of the stamps of the noted or last mesh */
    bool is_stamped; /* state is known */
    share_counts counts;
};

ffd_status ffd_share_create(ffd_share **share, ffd_error *error)
{
    *share = ffd_alloc_zero(1, sizeof **share);
    return *share ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_share_create_for_lattices(ffd_share **share, ffd_error *error)
{
    const ffd_status status = ffd_share_create(share, error);
    if (!status)
        (*share)->only_lattices = true;
    return status;
}

ffd_status ffd_cache_create_for_job(ffd_share **share, ffd_error *error)
{
    const ffd_status status = ffd_share_create(share, error);
    if (!status)
        (*share)->is_of_job = true;
    return status;
}

bool ffd_cache_is_of_batch(const ffd_share *share)
{
    return share && !share->is_of_job;
}

bool ffd_cache_holds_meshes(const ffd_share *share)
{
    return share && !share->only_lattices;
}

static void forget_mesh(ffd_share *share)
{
    ffd_source_close(&share->document);
    share->is_noted = false;
    ffd_free((char *)(uintptr_t)share->source.path);
    share->source.path = NULL;
    for (size_t i = 0; i < share->only_count; i++)
        ffd_free(share->only[i]);
    ffd_free(share->only);
    share->only = NULL;
    share->only_count = 0;
    ffd_paths_free(&share->files);
    ffd_free(share->stamps);
    share->stamps = NULL;
}

static void forget_locations(ffd_share *share)
{
    ffd_free(share->locations);
    share->locations = NULL;
    share->is_located = false;
}

static void free_lattice(kept_lattice *kept)
{
    ffd_lattice_destroy(&kept->lattice);
    ffd_free(kept->path);
}

void ffd_share_destroy(ffd_share **share)
{
    if (!share || !*share)
        return;
    forget_mesh(*share);
    forget_locations(*share);
    for (size_t i = 0; i < (*share)->rest_count; i++)
        ffd_locator_destroy(&(*share)->rests[i].locator);
    for (size_t i = 0; i < (*share)->lattice_count; i++)
        free_lattice(&(*share)->lattices[i]);
    ffd_mesh_boxes_free(&(*share)->boxes);
    ffd_free((*share)->rests);
    ffd_free((*share)->lattices);
    ffd_free(*share);
    *share = NULL;
}

/* The mesh */

static bool same_source(const ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    const ffd_source *const a = &share->source, *const b = &desc->input;
    const hash128 rules = ffd_source_rules(b);
    if (strcmp(a->path, b->path) != 0 || a->format != b->format || a->space != b->space ||
        a->memory != b->memory || !ffd_hash_equal(&share->rules, &rules) ||
        share->only_positions != only_positions || share->only_count != desc->only_count)
        return false;
    for (size_t i = 0; i < desc->only_count; i++)
        if (strcmp(share->only[i], desc->only[i]) != 0)
            return false;
    return true;
}

/* A job that changes the document itself, or overwrites its file, leaves no mesh to reuse; nor does one in
   memory. */
static bool leaves_mesh(const ffd_deform_desc *desc)
{
    return !desc->as_morph && !desc->morphs && !desc->in_place && !desc->input.bytes.data &&
           !ffd_file_is_stream(desc->input.path);
}

mesh_document *ffd_cache_take_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    if (!share)
        return NULL;
    if (share->document && leaves_mesh(desc) && same_source(share, desc, only_positions) &&
        ffd_stamps_hold(share->files.paths, share->stamps, share->files.count)) {
        mesh_document *const document = share->document;
        share->document = NULL;
        share->has_state = share->is_stamped;
        return document;
    }
    forget_mesh(share);
    forget_locations(share);
    return NULL;
}

static bool note_source(ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    share->source = desc->input;
    share->source.allow_extensions = NULL;
    share->rules = ffd_source_rules(&desc->input);
    share->source.path = ffd_text_copy(desc->input.path);
    share->only_positions = only_positions;
    share->only = ffd_alloc_zero(desc->only_count, sizeof *share->only);
    if (!share->source.path || !share->only)
        return false;
    for (; share->only_count < desc->only_count; share->only_count++) {
        share->only[share->only_count] = ffd_text_copy(desc->only[share->only_count]);
        if (!share->only[share->only_count])
            return false;
    }
    return true;
}

/* stamp: of the mesh file, taken before it was opened. The files that it refers to are stamped here, right
   after that. */
static bool note_files(ffd_share *share, const ffd_source *source, const file_stamp *stamp,
                       const mesh_document *document)
{
    if (!stamp || ffd_source_files(source, document, &share->files, NULL))
        return false;
    share->stamps = ffd_alloc(share->files.count, sizeof *share->stamps);
    for (size_t i = 1; share->stamps && i < share->files.count; i++)
        if (!ffd_file_stamp(share->files.paths[i], &share->stamps[i]))
            return false;
    if (share->stamps && share->files.count > 0)
        share->stamps[0] = *stamp;
    return share->stamps;
}

void ffd_cache_describe_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions,
                             const file_stamp *stamp, const mesh_document *document)
{
    if (!ffd_cache_holds_meshes(share))
        return;
    forget_mesh(share);
    share->counts.reads++;
    share->is_stamped = note_files(share, &desc->input, stamp, document);
    if (share->is_stamped)
        share->state = ffd_hash(share->stamps, share->files.count * sizeof *share->stamps);
    share->has_state = share->is_stamped && !desc->in_place;
    share->is_noted = share->is_stamped && leaves_mesh(desc) && note_source(share, desc, only_positions);
}

void ffd_cache_put_mesh(ffd_share *share, const ffd_deform_desc *desc, mesh_document *document)
{
    if (share && share->is_noted && leaves_mesh(desc))
        share->document = document;
    else
        ffd_source_close(&document);
}

void ffd_cache_begin_job(ffd_share *share, bool hash_output, kept_file *kept)
{
    share->kept = kept;
    share->hashes_output = hash_output;
    share->has_output = false;
    share->has_state = false;
}

bool ffd_cache_take_bytes(ffd_share *share, const char *path, const file_stamp *stamp, file_input *input)
{
    return share && ffd_kept_take(share->kept, path, stamp, input);
}

bool ffd_cache_hashes_output(const ffd_share *share)
{
    return share && share->hashes_output;
}

void ffd_cache_put_output(ffd_share *share, const hash128 *hash)
{
    share->has_output = true;
    share->output = *hash;
}

bool ffd_cache_find_output(const ffd_share *share, hash128 *hash)
{
    if (share->has_output)
        *hash = share->output;
    return share->has_output;
}

bool ffd_cache_find_state(const ffd_share *share, hash128 *state)
{
    if (!share->has_state)
        return false;
    *state = share->state;
    if (!ffd_stamps_hold(share->files.paths, share->stamps, share->files.count))
        state->bytes[0] ^= 0xff; /* the job may have read a mix of old and new content */
    return true;
}

share_counts ffd_cache_counts(const ffd_share *share)
{
    return share->counts;
}

void ffd_cache_count_search(ffd_share *share)
{
    if (share)
        share->counts.searches++;
}

mesh_boxes *ffd_cache_mesh_boxes(ffd_share *share)
{
    return &share->boxes;
}

/* Lattices and their rest volumes */

static kept_lattice *find_lattice(const ffd_share *share, const char *path, const file_stamp *stamp)
{
    for (size_t i = 0; share && i < share->lattice_count; i++) {
        kept_lattice *const kept = &share->lattices[i];
        if (kept->path && strcmp(kept->path, path) == 0 && ffd_stamp_equal(&kept->stamp, stamp))
            return kept;
    }
    return NULL;
}

void ffd_cache_lend_lattice(const ffd_share *share, chain_link *link)
{
    kept_lattice *const kept = find_lattice(share, link->path, &link->stamp);
    if (!kept)
        return;
    kept->used = true;
    link->lattice = kept->lattice;
    link->lattice_is_lent = true;
    link->rest = kept->rest;
    link->has_folds = kept->has_folds;
    link->folds = kept->folds;
}

static kept_rest *find_rest(const ffd_share *share, const hash128 *rest, ffd_isa isa)
{
    for (size_t i = 0; share && i < share->rest_count; i++)
        if (share->rests[i].isa == isa && ffd_hash_equal(&share->rests[i].hash, rest))
            return &share->rests[i];
    return NULL;
}

void ffd_cache_lend_locator(const ffd_share *share, ffd_isa isa, chain_link *link)
{
    kept_rest *const found = find_rest(share, &link->rest, isa);
    if (!found)
        return;
    found->used = true;
    link->locator = found->locator;
    link->locator_is_lent = true;
}

/* Moves the link's locator into the cache, unless it has one for the same rest volume. Returns whether the
   locator refers to the link's own lattice. Capacity for one more must be there. */
static bool keep_rest(ffd_share *share, chain_link *link, ffd_isa isa)
{
    if (!link->locator || link->locator_is_lent || find_rest(share, &link->rest, isa))
        return false;
    kept_rest *const rest = &share->rests[share->rest_count++];
    *rest = (kept_rest){link->rest, isa, link->lattice, link->locator, true};
    link->locator = NULL;
    return true;
}

/* Capacity for one more lattice and locator must be there. */
static void keep_link(ffd_share *share, chain_link *link, ffd_isa isa)
{
    const bool is_looked_at = keep_rest(share, link, isa);
    const bool is_of_file = link->path && link->lattice && !ffd_lattice_needs_bounds(link->lattice);
    if (link->lattice_is_lent) {
        kept_lattice *const kept = find_lattice(share, link->path, &link->stamp);
        kept->has_folds = link->has_folds;
        kept->folds = link->folds;
    }
    if (link->lattice_is_lent || (!is_looked_at && !is_of_file))
        return;
    share->lattices[share->lattice_count++] =
        (kept_lattice){.lattice = link->lattice,
                       .path = is_of_file ? ffd_text_copy(link->path) : NULL,
                       .stamp = link->stamp,
                       .rest = link->rest,
                       .has_folds = link->has_folds,
                       .folds = link->folds,
                       .used = true};
    link->lattice = NULL;
}

static bool has_searcher(const ffd_share *share, const ffd_lattice *lattice)
{
    for (size_t i = 0; i < share->rest_count; i++)
        if (share->rests[i].lattice == lattice)
            return true;
    return false;
}

void ffd_cache_evict_lattices(ffd_share *share)
{
    size_t count = 0;
    for (size_t i = 0; share && i < share->lattice_count; i++) {
        if (share->lattices[i].used || has_searcher(share, share->lattices[i].lattice))
            share->lattices[count++] = share->lattices[i];
        else
            free_lattice(&share->lattices[i]);
    }
    if (share)
        share->lattice_count = count;
}

/* Frees the locators that the current job did not use. If no meshes are cached, jobs are not retried when
   cached data makes them reach a limit; so a locator that earlier jobs have brought near its limit is freed
   too. */
static void forget_rests(ffd_share *share)
{
    size_t count = 0;
    for (size_t i = 0; i < share->rest_count; i++) {
        if (share->rests[i].used &&
            !(share->only_lattices && ffd_locator_is_strained(share->rests[i].locator)))
            share->rests[count++] = share->rests[i];
        else
            ffd_locator_destroy(&share->rests[i].locator);
    }
    share->rest_count = count;
}

/* Ends the loans of the current job. */
static void take_back(ffd_share *share)
{
    for (size_t i = 0; i < share->rest_count; i++)
        share->rests[i].used = false;
    for (size_t i = 0; i < share->lattice_count; i++)
        share->lattices[i].used = false;
}

void ffd_cache_put_chain(ffd_share *share, lattice_chain *chain)
{
    if (!share)
        return;
    if (ffd_grow((void **)&share->rests, &share->rest_capacity, share->rest_count + chain->count,
                 sizeof *share->rests) &&
        ffd_grow((void **)&share->lattices, &share->lattice_capacity, share->lattice_count + chain->count,
                 sizeof *share->lattices))
        for (size_t i = 0; i < chain->count; i++)
            keep_link(share, &chain->links[i], chain->isa);
    forget_rests(share);
    ffd_cache_evict_lattices(share);
    take_back(share);
}

/* Locations */

ffd_location *ffd_cache_locations(ffd_share *share, mesh_document *document, bool taken, const hash128 *rest,
                                  bool *filled)
{
    *filled = false;
    if (!ffd_cache_holds_meshes(share))
        return NULL;
    if (taken && share->is_located && ffd_hash_equal(&share->located, rest)) {
        *filled = true;
        return share->locations;
    }
    const uint64_t count = ffd_mesh_vertex_count(document);
    share->is_located = false;
    share->located = *rest;
    if (taken && share->locations)
        return share->locations; /* of the same vertices, for another volume: reuse the memory */
    forget_locations(share);
    if (ffd_budget_take(&document->budget, count, sizeof *share->locations, NULL))
        return NULL;
    share->locations = ffd_alloc((size_t)count, sizeof *share->locations);
    if (!share->locations)
        ffd_budget_return(&document->budget, count, sizeof *share->locations);
    return share->locations;
}

void ffd_cache_locations_filled(ffd_share *share)
{
    if (share && share->locations)
        share->is_located = true;
}
