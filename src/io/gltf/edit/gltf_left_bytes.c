#include "io/gltf/edit/gltf_left_bytes.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/edit/gltf_byte_runs.h"
#include "io/gltf/edit/gltf_morph_reuse.h"
#include "io/gltf/read/gltf_view_users.h"
#include <inttypes.h>

/* Adds the bytes that something uses. Returns false if memory runs out. */
static bool add_used(const gltf_document *d, const unsigned char *users, gltf_byte_runs *kept)
{
    bool *const views = ffd_alloc_zero(d->model.view_count, sizeof *views);
    if (!views)
        return false;
    ffd_gltf_mark_other_views(d, views);
    for (size_t v = 0; v < d->model.view_count; v++)
        if (views[v])
            ffd_gltf_add_view_bytes(d, v, kept);
    ffd_free(views);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (users[a] > 0)
            ffd_gltf_add_accessor_bytes(d, a, kept);
    return true;
}

bool ffd_gltf_count_left_bytes(const gltf_document *d, const bool *dropped, const unsigned char *users,
                               uint64_t *bytes)
{
    gltf_byte_runs left = {0}, kept = {0};
    *bytes = 0;
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (dropped[a] && users[a] == 0)
            ffd_gltf_add_accessor_bytes(d, a, &left);
    const bool counted = (left.count == 0 && !left.failed) ||
                         (add_used(d, users, &kept) && ffd_gltf_count_bytes_without(d, &left, &kept, bytes));
    ffd_free(left.runs);
    ffd_free(kept.runs);
    return counted;
}

ffd_status ffd_gltf_warn_of_left(const gltf_document *d, const unsigned char *before, size_t count,
                                 const char *name, const mesh_log *log, uint64_t *bytes, ffd_error *error)
{
    char shown[80];
    uint64_t left = 0;
    unsigned char *const users = ffd_gltf_count_users(d, NULL);
    bool *const dropped = ffd_alloc_zero(d->model.accessor_count, sizeof *dropped);
    for (size_t a = 0; a < count && dropped; a++)
        dropped[a] = before[a] > 0;
    const bool counted = users && dropped && ffd_gltf_count_left_bytes(d, dropped, users, &left);
    ffd_free(users);
    ffd_free(dropped);
    if (!counted)
        return ffd_fail_memory(error);
    *bytes += left;
    ffd_name_shown(name, shown, sizeof shown);
    if (left > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " bytes that only the old morph target \"%s\" used stay in the file", left,
                     shown);
    return FFD_OK;
}
