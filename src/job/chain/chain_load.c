#include "job/chain/chain_load.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/job_cache.h"
#include "job/chain/lattice_memory.h"
#include "job/chain/mesh_boxes.h"
#include "job/input/embedding_file.h"
#include "job/input/shown_box.h"
#include "lattice/file/lattice_source.h"
#include "lattice/file/lattice_time.h"
#include "lattice/file/spec_set.h"
#include "lattice/lattice.h"
#include "lattice/rest_hash.h"
#include <stdio.h>
#include <string.h>

/* Takes the lattice from the cache, if an earlier job has loaded the same file. */
static void borrow_lattice(const chain_files *files, lattice_chain *chain, size_t i)
{
    chain_link *const link = &chain->links[i];
    const char *const path = ffd_lattice_file(&files->lattices[i]);
    if (!chain->cache || files->set_count > 0 || files->time || files->made || !path ||
        !ffd_file_stamp(path, &link->stamp))
        return;
    link->path = path;
    ffd_job_cache_lend_lattice(chain->cache, link);
}

/* Fits the lattice to its box, unless the box depends on the job's mesh. */
static ffd_status fit(const chain_files *files, ffd_job_cache *cache, ffd_lattice *lattice,
                      path_list *box_files, bool *fitted, ffd_error *error)
{
    const bool names_meshes = ffd_lattice_get_mesh_count(lattice) > 0;
    mesh_boxes own = {0};
    fit_extent extent;
    ffd_status status = FFD_OK;
    *fitted = !ffd_lattice_needs_bounds(lattice);
    if (*fitted || (!names_meshes && !files->shared))
        return FFD_OK;
    *fitted = true;
    if (names_meshes)
        status = ffd_mesh_box_find(cache ? ffd_job_cache_mesh_boxes(cache) : &own, lattice, files->mesh,
                                   &extent, box_files, files->log, error);
    else
        extent = ffd_shown_box_extent(&files->shared->box);
    ffd_mesh_boxes_free(&own);
    return status ? status : ffd_lattice_fit_extent(lattice, &extent, error);
}

/* Adds to open the placeholders of a lattice that have no value, if it can be read once more. */
static void list_open(const chain_files *files, size_t i, bool *used, intern_table *open)
{
    const ffd_lattice_source *const lattice = &files->lattices[i];
    if (!lattice->object && !ffd_lattice_is_stream(lattice))
        ffd_lattice_list_open(lattice, files->set, files->set_count, used, open, NULL);
}

/* Replaces the message of a failure that is due to open placeholders in lattice i by one that names those of
   all lattices. */
static void name_open_placeholders(const chain_files *files, size_t i, bool *used, ffd_error *error)
{
    intern_table own = {0}, all = {0};
    list_open(files, i, used, &own);
    for (size_t k = 0; k < files->count && own.count; k++)
        list_open(files, k, used, &all);
    if (all.count > own.count)
        ffd_spec_describe_open(&all, error->message, sizeof error->message);
    ffd_intern_free(&own);
    ffd_intern_free(&all);
}

/* Copies the caller's lattice, charged to the job's memory budget. */
static ffd_status copy_object(const ffd_lattice *object, const double *time, memory_budget *memory,
                              ffd_lattice **lattice, ffd_error *error)
{
    TRY(object->spec ? ffd_lattice_memory_take(memory, object->spec, 0, error) : FFD_OK);
    TRY(ffd_lattice_copy(object, lattice, error));
    return time && ffd_lattice_has_keys(*lattice) ? ffd_lattice_set_time(*lattice, *time, error) : FFD_OK;
}

/* Takes a lattice that the caller has made. */
static ffd_status take_made(ffd_lattice **made, memory_budget *memory, ffd_lattice **lattice,
                            ffd_error *error)
{
    *lattice = *made;
    *made = NULL;
    return ffd_lattice_memory_take(memory, (*lattice)->spec, 0, error);
}

/* file_size: of a lattice taken from the cache. */
static ffd_status load_lattice(const chain_files *files, bool *used, size_t i, uint64_t file_size,
                               memory_budget *memory, ffd_lattice **lattice, ffd_error *error)
{
    const spec_settings settings = {.values = files->set,
                                    .used = used,
                                    .count = files->set_count,
                                    .time = files->time,
                                    .may_be_open = files->rest_only,
                                    .derives = files->derives};
    const ffd_lattice_source *const source = &files->lattices[i];
    const ffd_status status = files->made ? take_made(&files->made[i], memory, lattice, error)
                              : source->object
                                  ? copy_object(source->object, files->time, memory, lattice, error)
                              : *lattice ? ffd_lattice_memory_take(memory, (*lattice)->spec, file_size, error)
                                         : ffd_lattice_memory_load(source, &settings, memory, lattice, error);
    if (status == FFD_E_INVALID && !files->rest_only && error)
        name_open_placeholders(files, i, used, error);
    if (status)
        ffd_fail_name_file(error, files->lattices[i].path);
    return status;
}

static ffd_status load_link(const chain_files *files, bool *used, lattice_chain *chain, size_t i,
                            ffd_error *error)
{
    chain_link *link = &chain->links[i];
    bool fitted = false;
    ffd_status status;
    TRY_END(load_lattice(files, used, i, link->stamp.size, &chain->memory, &link->lattice, error));
    TRY_END(fit(files, chain->cache, link->lattice, &link->box_files, &fitted, error));
    if (fitted)
        TRY_END(ffd_chain_prepare(chain, i, error));
end:
    if (status)
        ffd_fail_name_file(error, files->lattices[i].path);
    return status;
}

/* Refuses a time where no lattice has keys. */
static ffd_status refuse_time(const chain_files *files, bool has_keys, ffd_error *error)
{
    return !files->time || has_keys
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_ARGUMENT, files->lattices[0].path,
                               "%s keys: {time} is for lattices that have \"keys\"",
                               files->count == 1 ? "has no" : "neither this nor another lattice has");
}

/* Refuses the values that no lattice has a placeholder for, all in one message. */
static ffd_status refuse_unused(const chain_files *files, const bool *used, ffd_error *error)
{
    char names[300] = "";
    size_t count = 0, length = 0;
    for (size_t i = 0; i < files->set_count; i++) {
        if (used[i])
            continue;
        if (length < sizeof names - 80)
            length += (size_t)snprintf(names + length, sizeof names - length, "%s{\"$\": \"%.50s\"}",
                                       count ? ", " : "", files->set[i].name);
        else
            memcpy(names + length, ", ...", sizeof ", ...");
        count++;
    }
    return count == 0 ? FFD_OK
                      : ffd_fail_file(error, FFD_E_INVALID, files->lattices[0].path,
                                      CHAIN_NO_PLACEHOLDER "%s %s ({set})", count == 1 ? "" : "s", names);
}

void ffd_chain_free(lattice_chain *chain)
{
    for (size_t i = 0; i < chain->count; i++) {
        if (!chain->links[i].locator_is_lent)
            ffd_locator_destroy(&chain->links[i].locator);
        if (!chain->links[i].lattice_is_lent)
            ffd_lattice_destroy(&chain->links[i].lattice);
        ffd_lattice_destroy(&chain->links[i].sealed);
        ffd_paths_free(&chain->links[i].box_files);
    }
    ffd_free(chain->links);
    ffd_free(chain->boxes);
    ffd_free(chain->seams);
    ffd_box_tree_free(&chain->tree);
    *chain = (lattice_chain){0};
}

static memory_budget budget_of(const chain_files *files)
{
    return ffd_budget_make(files->mesh ? files->mesh->memory : 0);
}

ffd_status ffd_chain_check_count(size_t count, ffd_error *error)
{
    if (count > FFD_LATTICES_MOST)
        return ffd_fail(error, FFD_E_LIMIT, "a job has at most %d lattices, not %zu", FFD_LATTICES_MOST,
                        count);
    return FFD_OK;
}

static ffd_status check_count(const chain_files *files, ffd_error *error)
{
    if (files->count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no lattice is given");
    return ffd_chain_check_count(files->count, error);
}

ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_job_cache *cache, lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){.memory = budget_of(files), .outside = *outside, .isa = isa, .cache = cache};
    TRY(check_count(files, error));
    bool *const used = ffd_alloc_zero(files->set_count, sizeof *used);
    chain->links = ffd_alloc_zero(files->count, sizeof *chain->links);
    bool has_keys = false;
    ffd_status status;
    TRY_END(used && chain->links ? FFD_OK : ffd_fail_memory(error));
    chain->count = files->count;
    for (size_t i = 0; i < chain->count; i++)
        borrow_lattice(files, chain, i);
    ffd_job_cache_evict_lattices(cache);
    for (size_t i = 0; i < chain->count; i++) {
        TRY_END(load_link(files, used, chain, i, error));
        has_keys = has_keys || ffd_lattice_has_keys(chain->links[i].lattice);
    }
    TRY_END(refuse_time(files, has_keys, error));
    TRY_END(refuse_unused(files, used, error));
end:
    ffd_free(used);
    if (status)
        ffd_chain_free(chain);
    return status;
}

ffd_status ffd_chain_load_lattices(const chain_files *files, memory_budget *memory, ffd_lattice **lattices,
                                   path_list *box_files, ffd_error *error)
{
    bool *const used = ffd_alloc_zero(files->set_count, sizeof *used), fitted, has_keys = false;
    size_t loaded = 0;
    ffd_status status;
    memset(lattices, 0, files->count * sizeof *lattices);
    TRY_END(used ? FFD_OK : ffd_fail_memory(error));
    for (; loaded < files->count; loaded++) {
        TRY_END(load_lattice(files, used, loaded, 0, memory, &lattices[loaded], error));
        TRY_END(fit(files, NULL, lattices[loaded], box_files, &fitted, error));
        has_keys = has_keys || ffd_lattice_has_keys(lattices[loaded]);
    }
    TRY_END(refuse_time(files, has_keys, error));
    TRY_END(refuse_unused(files, used, error));
end:
    ffd_free(used);
    if (status && loaded < files->count)
        ffd_fail_name_file(error, files->lattices[loaded].path);
    for (size_t i = 0; status && i < files->count; i++)
        ffd_lattice_destroy(&lattices[i]);
    return status;
}

ffd_status ffd_chain_check(const chain_files *files, ffd_error *error)
{
    memory_budget memory = budget_of(files);
    bool has_keys = false;
    bool *const used = ffd_alloc_zero(files->set_count, sizeof *used);
    ffd_status status;
    TRY_END(used ? check_count(files, error) : ffd_fail_memory(error));
    for (size_t i = 0; i < files->count; i++) {
        ffd_lattice *lattice = NULL;
        TRY_END(load_lattice(files, used, i, 0, &memory, &lattice, error));
        has_keys = has_keys || ffd_lattice_has_keys(lattice);
        ffd_lattice_destroy(&lattice);
    }
    TRY_END(refuse_time(files, has_keys, error));
    TRY_END(refuse_unused(files, used, error));
end:
    ffd_free(used);
    return status;
}

lattice_chain ffd_chain_link_alone(const lattice_chain *whole, size_t link)
{
    lattice_chain alone = *whole;
    alone.links = &whole->links[link];
    alone.count = 1;
    alone.blocks = false;
    alone.boxes = NULL;
    alone.seams = NULL;
    alone.seam_count = 0;
    alone.tree = (box_tree){0};
    return alone;
}

void ffd_chain_end_alone(lattice_chain *alone)
{
    ffd_free(alone->boxes);
    ffd_free(alone->seams);
    ffd_box_tree_free(&alone->tree);
}

/* Hashes the rest volume and its search method. The same volume may be searched as a box or by its points,
   with weights of 1 or without weights, and u,v,w then differ in the last bits. */
static hash128 hash_rest(const ffd_lattice *lattice)
{
    const bool is_box = lattice->form == REST_BOX_AFFINE;
    const double way[] = {is_box, lattice->rest_weights != NULL};
    const hash128 parts[] = {ffd_rest_hash(lattice), ffd_hash_doubles(way, 2),
                             ffd_hash_doubles(lattice->origin, is_box ? 3 : 0),
                             ffd_hash_doubles(lattice->frame, is_box ? 9 : 0)};
    return ffd_hash(parts, sizeof parts);
}

ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error)
{
    chain_link *made = &chain->links[link];
    ffd_status status = FFD_OK;
    if (chain->cache) {
        if (!made->lattice_is_lent)
            made->rest = hash_rest(made->lattice);
        ffd_job_cache_lend_locator(chain->cache, chain->isa, made);
    }
    made->snap = chain->outside.snap * (chain->outside.snap_is_relative ? made->lattice->diagonal : 1);
    if (!made->locator)
        status = ffd_locator_create_for(made->lattice, chain->isa, &made->locator, error);
    if (status || !chain->outside.extend)
        return status;
    made->falloff = chain->outside.falloff;
    return ffd_locator_border(made->locator, &made->border, error);
}

bool ffd_link_searches(const chain_link *link)
{
    return link->locator->method == METHOD_GENERAL;
}
