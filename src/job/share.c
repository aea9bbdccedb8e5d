#include "job/share.h"
#include "base/memory.h"
#include "base/path.h"
#include "embed/locator.h"
#include "job/pass.h"
#include "job/source.h"
#include <string.h>

/* A rest volume and what it is searched with. */
typedef struct kept_rest {
    hash128 hash;
    ffd_isa isa;
    ffd_lattice *lattice; /* which the locator looks at */
    ffd_locator *locator;
    bool used; /* by the job under way */
} kept_rest;

struct ffd_share {
    mesh_document *document; /* NULL: none, or in a job's hands */
    bool is_noted;           /* what follows is known of it */
    ffd_source source;       /* its path is owned */
    bool only_positions;
    char **only; /* only_count */
    size_t only_count;
    path_list files;
    file_stamp *stamps; /* files.count */

    kept_rest *rests;
    size_t rest_count;

    ffd_location *locations; /* of the vertices of the mesh that is kept, or was last */
    hash128 located;         /* in the rest volume with this hash */
    bool is_located;
};

ffd_status ffd_share_create(ffd_share **share, ffd_error *error)
{
    *share = ffd_alloc_zero(1, sizeof **share);
    return *share ? FFD_OK : ffd_fail_memory(error);
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

static void free_rest(kept_rest *rest)
{
    ffd_locator_destroy(&rest->locator);
    ffd_lattice_destroy(&rest->lattice);
}

void ffd_share_destroy(ffd_share **share)
{
    if (!share || !*share)
        return;
    forget_mesh(*share);
    forget_locations(*share);
    for (size_t i = 0; i < (*share)->rest_count; i++)
        free_rest(&(*share)->rests[i]);
    ffd_free((*share)->rests);
    ffd_free(*share);
    *share = NULL;
}

/* The mesh */

static bool same_source(const ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    const ffd_source *const a = &share->source, *const b = &desc->input;
    if (strcmp(a->path, b->path) != 0 || a->format != b->format || a->space != b->space ||
        a->memory != b->memory || share->only_positions != only_positions ||
        share->only_count != desc->only_count)
        return false;
    for (size_t i = 0; i < desc->only_count; i++)
        if (strcmp(share->only[i], desc->only[i]) != 0)
            return false;
    return true;
}

static bool is_unchanged(const ffd_share *share)
{
    for (size_t i = 0; i < share->files.count; i++) {
        file_stamp now;
        if (!ffd_file_stamp(share->files.paths[i], &now) || !ffd_stamp_equal(&now, &share->stamps[i]))
            return false;
    }
    return true;
}

/* What changes the document itself, or its file, leaves nothing for the next job. */
static bool leaves_mesh(const ffd_deform_desc *desc)
{
    return !desc->as_morph && !desc->in_place && !ffd_file_is_stream(desc->input.path);
}

mesh_document *ffd_share_take_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    if (!share)
        return NULL;
    if (share->document && leaves_mesh(desc) && same_source(share, desc, only_positions) &&
        is_unchanged(share)) {
        mesh_document *const document = share->document;
        share->document = NULL;
        return document;
    }
    forget_mesh(share);
    forget_locations(share);
    return NULL;
}

static bool note_source(ffd_share *share, const ffd_deform_desc *desc, bool only_positions)
{
    share->source = desc->input;
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

/* Its own stamp is from before it was opened; those of the files that it refers to were taken right behind
 * that.
 */
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

void ffd_share_note_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions,
                         const file_stamp *stamp, const mesh_document *document)
{
    if (!share)
        return;
    forget_mesh(share);
    share->is_noted = leaves_mesh(desc) && note_source(share, desc, only_positions) &&
                      note_files(share, &desc->input, stamp, document);
}

void ffd_share_keep_mesh(ffd_share *share, const ffd_deform_desc *desc, mesh_document *document)
{
    if (share && share->is_noted && leaves_mesh(desc))
        share->document = document;
    else
        ffd_source_close(&document);
}

/* Rest volumes */

static kept_rest *find_rest(const ffd_share *share, const hash128 *rest, ffd_isa isa)
{
    for (size_t i = 0; share && i < share->rest_count; i++)
        if (share->rests[i].isa == isa && ffd_hash_equal(&share->rests[i].hash, rest))
            return &share->rests[i];
    return NULL;
}

ffd_locator *ffd_share_find_locator(const ffd_share *share, const hash128 *rest, ffd_isa isa)
{
    kept_rest *const found = find_rest(share, rest, isa);
    if (!found)
        return NULL;
    found->used = true;
    return found->locator;
}

void ffd_share_keep_chain(ffd_share *share, lattice_chain *chain)
{
    kept_rest *kept = share ? ffd_alloc(share->rest_count + chain->count, sizeof *kept) : NULL;
    size_t count = 0;
    if (!kept)
        return;
    for (size_t i = 0; i < share->rest_count; i++) {
        if (share->rests[i].used)
            kept[count++] = share->rests[i];
        else
            free_rest(&share->rests[i]);
    }
    ffd_free(share->rests);
    share->rests = kept;
    share->rest_count = count;
    for (size_t i = 0; i < chain->count; i++) {
        chain_link *const link = &chain->links[i];
        if (!link->locator || link->locator_is_lent || find_rest(share, &link->rest, chain->isa))
            continue;
        kept[share->rest_count++] = (kept_rest){link->rest, chain->isa, link->lattice, link->locator, false};
        link->lattice = NULL;
        link->locator = NULL;
    }
    for (size_t i = 0; i < share->rest_count; i++)
        kept[i].used = false;
}

/* Locations */

ffd_location *ffd_share_locations(ffd_share *share, mesh_document *document, bool taken, const hash128 *rest,
                                  bool *filled)
{
    *filled = false;
    if (!share)
        return NULL;
    if (taken && share->is_located && ffd_hash_equal(&share->located, rest)) {
        *filled = true;
        return share->locations;
    }
    const uint64_t count = ffd_pass_vertex_count(document);
    share->is_located = false;
    share->located = *rest;
    if (taken && share->locations)
        return share->locations; /* of the same vertices, in another volume */
    forget_locations(share);
    if (ffd_room_take(&document->room, count, sizeof *share->locations, NULL))
        return NULL;
    share->locations = ffd_alloc((size_t)count, sizeof *share->locations);
    if (!share->locations)
        ffd_room_return(&document->room, count, sizeof *share->locations);
    return share->locations;
}

void ffd_share_located(ffd_share *share)
{
    if (share && share->locations)
        share->is_located = true;
}
