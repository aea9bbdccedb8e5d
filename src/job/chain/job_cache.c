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
    const ffd_lattice *lattice; /* one of ffd_job_cache.lattices that the locator refers to */
    ffd_locator *locator;
    bool used;
} kept_rest;

struct ffd_job_cache {
    bool only_lattices;
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
    cache_counts counts;
};

ffd_status ffd_job_cache_create(ffd_job_cache **cache, ffd_error *error)
{
    *cache = ffd_alloc_zero(1, sizeof **cache);
    return *cache ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_job_cache_create_for_lattices(ffd_job_cache **cache, ffd_error *error)
{
    TRY(ffd_job_cache_create(cache, error));
    (*cache)->only_lattices = true;
    return FFD_OK;
}

bool ffd_job_cache_holds_meshes(const ffd_job_cache *cache)
{
    return cache && !cache->only_lattices;
}

static void forget_mesh(ffd_job_cache *cache)
{
    ffd_source_close(&cache->document);
    cache->is_noted = false;
    ffd_free((char *)(uintptr_t)cache->source.path);
    cache->source.path = NULL;
    for (size_t i = 0; i < cache->only_count; i++)
        ffd_free(cache->only[i]);
    ffd_free(cache->only);
    cache->only = NULL;
    cache->only_count = 0;
    ffd_paths_free(&cache->files);
    ffd_free(cache->stamps);
    cache->stamps = NULL;
}

static void forget_locations(ffd_job_cache *cache)
{
    ffd_free(cache->locations);
    cache->locations = NULL;
    cache->is_located = false;
}

static void free_lattice(kept_lattice *kept)
{
    ffd_lattice_destroy(&kept->lattice);
    ffd_free(kept->path);
}

void ffd_job_cache_destroy(ffd_job_cache **cache)
{
    if (!cache || !*cache)
        return;
    forget_mesh(*cache);
    forget_locations(*cache);
    for (size_t i = 0; i < (*cache)->rest_count; i++)
        ffd_locator_destroy(&(*cache)->rests[i].locator);
    for (size_t i = 0; i < (*cache)->lattice_count; i++)
        free_lattice(&(*cache)->lattices[i]);
    ffd_mesh_boxes_free(&(*cache)->boxes);
    ffd_free((*cache)->rests);
    ffd_free((*cache)->lattices);
    ffd_free(*cache);
    *cache = NULL;
}

/* The mesh */

static bool same_source(const ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions)
{
    const ffd_source *const a = &cache->source, *const b = &desc->input;
    const hash128 rules = ffd_source_rules(b);
    if (strcmp(a->path, b->path) != 0 || a->format != b->format || a->space != b->space ||
        a->memory != b->memory || !ffd_hash_equal(&cache->rules, &rules) ||
        cache->only_positions != only_positions || cache->only_count != desc->only_count)
        return false;
    for (size_t i = 0; i < desc->only_count; i++)
        if (strcmp(cache->only[i], desc->only[i]) != 0)
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

mesh_document *ffd_job_cache_take_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions)
{
    if (!cache)
        return NULL;
    if (cache->document && leaves_mesh(desc) && same_source(cache, desc, only_positions) &&
        ffd_stamps_hold(cache->files.paths, cache->stamps, cache->files.count)) {
        mesh_document *const document = cache->document;
        cache->document = NULL;
        cache->has_state = cache->is_stamped;
        return document;
    }
    forget_mesh(cache);
    forget_locations(cache);
    return NULL;
}

static bool note_source(ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions)
{
    cache->source = desc->input;
    cache->source.allow_extensions = NULL;
    cache->rules = ffd_source_rules(&desc->input);
    cache->source.path = ffd_text_copy(desc->input.path);
    cache->only_positions = only_positions;
    cache->only = ffd_alloc_zero(desc->only_count, sizeof *cache->only);
    if (!cache->source.path || !cache->only)
        return false;
    for (; cache->only_count < desc->only_count; cache->only_count++) {
        cache->only[cache->only_count] = ffd_text_copy(desc->only[cache->only_count]);
        if (!cache->only[cache->only_count])
            return false;
    }
    return true;
}

/* stamp: of the mesh file, taken before it was opened. The files that it refers to are stamped here, right
   after that. */
static bool note_files(ffd_job_cache *cache, const ffd_source *source, const file_stamp *stamp,
                       const mesh_document *document)
{
    if (!stamp || ffd_source_files(source, document, &cache->files, NULL))
        return false;
    cache->stamps = ffd_alloc(cache->files.count, sizeof *cache->stamps);
    for (size_t i = 1; cache->stamps && i < cache->files.count; i++)
        if (!ffd_file_stamp(cache->files.paths[i], &cache->stamps[i]))
            return false;
    if (cache->stamps && cache->files.count > 0)
        cache->stamps[0] = *stamp;
    return cache->stamps;
}

void ffd_job_cache_describe_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions,
                                 const file_stamp *stamp, const mesh_document *document)
{
    if (!ffd_job_cache_holds_meshes(cache))
        return;
    forget_mesh(cache);
    cache->counts.reads++;
    cache->is_stamped = note_files(cache, &desc->input, stamp, document);
    if (cache->is_stamped)
        cache->state = ffd_hash(cache->stamps, cache->files.count * sizeof *cache->stamps);
    cache->has_state = cache->is_stamped && !desc->in_place;
    cache->is_noted = cache->is_stamped && leaves_mesh(desc) && note_source(cache, desc, only_positions);
}

void ffd_job_cache_put_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc, mesh_document *document)
{
    if (cache && cache->is_noted && leaves_mesh(desc))
        cache->document = document;
    else
        ffd_source_close(&document);
}

void ffd_job_cache_begin_job(ffd_job_cache *cache, bool hash_output, kept_file *kept)
{
    cache->kept = kept;
    cache->hashes_output = hash_output;
    cache->has_output = false;
    cache->has_state = false;
}

bool ffd_job_cache_take_bytes(ffd_job_cache *cache, const char *path, const file_stamp *stamp,
                              file_input *input)
{
    return cache && ffd_kept_take(cache->kept, path, stamp, input);
}

bool ffd_job_cache_hashes_output(const ffd_job_cache *cache)
{
    return cache && cache->hashes_output;
}

void ffd_job_cache_put_output(ffd_job_cache *cache, const hash128 *hash)
{
    cache->has_output = true;
    cache->output = *hash;
}

bool ffd_job_cache_find_output(const ffd_job_cache *cache, hash128 *hash)
{
    if (cache->has_output)
        *hash = cache->output;
    return cache->has_output;
}

bool ffd_job_cache_find_state(const ffd_job_cache *cache, hash128 *state)
{
    if (!cache->has_state)
        return false;
    *state = cache->state;
    if (!ffd_stamps_hold(cache->files.paths, cache->stamps, cache->files.count))
        state->bytes[0] ^= 0xff; /* the job may have read a mix of old and new content */
    return true;
}

cache_counts ffd_job_cache_counts(const ffd_job_cache *cache)
{
    return cache->counts;
}

void ffd_job_cache_count_search(ffd_job_cache *cache)
{
    if (cache)
        cache->counts.searches++;
}

mesh_boxes *ffd_job_cache_mesh_boxes(ffd_job_cache *cache)
{
    return &cache->boxes;
}

/* Lattices and their rest volumes */

static kept_lattice *find_lattice(const ffd_job_cache *cache, const char *path, const file_stamp *stamp)
{
    for (size_t i = 0; cache && i < cache->lattice_count; i++) {
        kept_lattice *const kept = &cache->lattices[i];
        if (kept->path && strcmp(kept->path, path) == 0 && ffd_stamp_equal(&kept->stamp, stamp))
            return kept;
    }
    return NULL;
}

void ffd_job_cache_lend_lattice(const ffd_job_cache *cache, chain_link *link)
{
    kept_lattice *const kept = find_lattice(cache, link->path, &link->stamp);
    if (!kept)
        return;
    kept->used = true;
    link->lattice = kept->lattice;
    link->lattice_is_lent = true;
    link->rest = kept->rest;
    link->has_folds = kept->has_folds;
    link->folds = kept->folds;
}

static kept_rest *find_rest(const ffd_job_cache *cache, const hash128 *rest, ffd_isa isa)
{
    for (size_t i = 0; cache && i < cache->rest_count; i++)
        if (cache->rests[i].isa == isa && ffd_hash_equal(&cache->rests[i].hash, rest))
            return &cache->rests[i];
    return NULL;
}

void ffd_job_cache_lend_locator(const ffd_job_cache *cache, ffd_isa isa, chain_link *link)
{
    kept_rest *const found = find_rest(cache, &link->rest, isa);
    if (!found)
        return;
    found->used = true;
    link->locator = found->locator;
    link->locator_is_lent = true;
}

/* Moves the link's locator into the cache, unless it has one for the same rest volume. Returns whether the
   locator refers to the link's own lattice. Capacity for one more must be there. */
static bool keep_rest(ffd_job_cache *cache, chain_link *link, ffd_isa isa)
{
    if (!link->locator || link->locator_is_lent || find_rest(cache, &link->rest, isa))
        return false;
    kept_rest *const rest = &cache->rests[cache->rest_count++];
    *rest = (kept_rest){link->rest, isa, link->lattice, link->locator, true};
    link->locator = NULL;
    return true;
}

/* Capacity for one more lattice and locator must be there. */
static void keep_link(ffd_job_cache *cache, chain_link *link, ffd_isa isa)
{
    const bool is_scanned = keep_rest(cache, link, isa);
    const bool is_of_file = link->path && link->lattice && !ffd_lattice_needs_bounds(link->lattice);
    if (link->lattice_is_lent) {
        kept_lattice *const kept = find_lattice(cache, link->path, &link->stamp);
        kept->has_folds = link->has_folds;
        kept->folds = link->folds;
    }
    if (link->lattice_is_lent || (!is_scanned && !is_of_file))
        return;
    cache->lattices[cache->lattice_count++] =
        (kept_lattice){.lattice = link->lattice,
                       .path = is_of_file ? ffd_text_copy(link->path) : NULL,
                       .stamp = link->stamp,
                       .rest = link->rest,
                       .has_folds = link->has_folds,
                       .folds = link->folds,
                       .used = true};
    link->lattice = NULL;
}

static bool has_searcher(const ffd_job_cache *cache, const ffd_lattice *lattice)
{
    for (size_t i = 0; i < cache->rest_count; i++)
        if (cache->rests[i].lattice == lattice)
            return true;
    return false;
}

void ffd_job_cache_evict_lattices(ffd_job_cache *cache)
{
    size_t count = 0;
    for (size_t i = 0; cache && i < cache->lattice_count; i++) {
        if (cache->lattices[i].used || has_searcher(cache, cache->lattices[i].lattice))
            cache->lattices[count++] = cache->lattices[i];
        else
            free_lattice(&cache->lattices[i]);
    }
    if (cache)
        cache->lattice_count = count;
}

/* Frees the locators that the current job did not use. If no meshes are cached, jobs are not retried when
   cached data makes them reach a limit; so a locator that earlier jobs have brought near its limit is freed
   too. */
static void forget_rests(ffd_job_cache *cache)
{
    size_t count = 0;
    for (size_t i = 0; i < cache->rest_count; i++) {
        if (cache->rests[i].used &&
            !(cache->only_lattices && ffd_locator_is_strained(cache->rests[i].locator)))
            cache->rests[count++] = cache->rests[i];
        else
            ffd_locator_destroy(&cache->rests[i].locator);
    }
    cache->rest_count = count;
}

/* Ends the loans of the current job. */
static void take_back(ffd_job_cache *cache)
{
    for (size_t i = 0; i < cache->rest_count; i++)
        cache->rests[i].used = false;
    for (size_t i = 0; i < cache->lattice_count; i++)
        cache->lattices[i].used = false;
}

void ffd_job_cache_put_chain(ffd_job_cache *cache, lattice_chain *chain)
{
    if (!cache)
        return;
    if (ffd_grow((void **)&cache->rests, &cache->rest_capacity, cache->rest_count + chain->count,
                 sizeof *cache->rests) &&
        ffd_grow((void **)&cache->lattices, &cache->lattice_capacity, cache->lattice_count + chain->count,
                 sizeof *cache->lattices))
        for (size_t i = 0; i < chain->count; i++)
            keep_link(cache, &chain->links[i], chain->isa);
    forget_rests(cache);
    ffd_job_cache_evict_lattices(cache);
    take_back(cache);
}

/* Locations */

ffd_location *ffd_job_cache_locations(ffd_job_cache *cache, mesh_document *document, bool taken,
                                      const hash128 *rest, bool *filled)
{
    *filled = false;
    if (!ffd_job_cache_holds_meshes(cache))
        return NULL;
    if (taken && cache->is_located && ffd_hash_equal(&cache->located, rest)) {
        *filled = true;
        return cache->locations;
    }
    const uint64_t count = ffd_mesh_vertex_count(document);
    cache->is_located = false;
    cache->located = *rest;
    if (taken && cache->locations)
        return cache->locations; /* of the same vertices, for another volume: reuse the memory */
    forget_locations(cache);
    if (ffd_budget_take(&document->budget, count, sizeof *cache->locations, NULL))
        return NULL;
    cache->locations = ffd_alloc((size_t)count, sizeof *cache->locations);
    if (!cache->locations)
        ffd_budget_return(&document->budget, count, sizeof *cache->locations);
    return cache->locations;
}

void ffd_job_cache_locations_filled(ffd_job_cache *cache)
{
    if (cache && cache->locations)
        cache->is_located = true;
}
