#include "base/file/file_users.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

/* The key of a file and one of its users. */
typedef struct user_pair {
    hash128 file, user;
} user_pair;

/* Returns the entry of a file, which is added if it is new; NULL: memory ran out. */
static used_file *find_entry(file_users *users, const hash128 *file)
{
    uint32_t index;
    const size_t count = users->known.count;
    if (!ffd_grow((void **)&users->files, &users->capacity, count + 1, sizeof *users->files) ||
        !ffd_intern(&users->known, file, sizeof *file, &index))
        return NULL;
    if (index == count)
        users->files[index] = (used_file){0};
    return &users->files[index];
}

ffd_status ffd_users_add(file_users *users, const char *file, const char *user, ffd_error *error)
{
    const user_pair pair = {ffd_place_of(&users->places, file), ffd_place_of(&users->places, user)};
    const size_t before = users->pairs.count;
    used_file *const known = find_entry(users, &pair.file);
    uint32_t index;
    if (!known || !ffd_intern(&users->pairs, &pair, sizeof pair, &index))
        return ffd_fail_memory(error);
    if (index < before)
        return FFD_OK;
    if (known->count < USERS_NAMED) {
        known->names[known->count] = ffd_text_copy(user);
        known->places[known->count] = pair.user;
        if (!known->names[known->count])
            return ffd_fail_memory(error);
    }
    known->count++;
    return FFD_OK;
}

ffd_status ffd_users_find(file_users *users, const char *file, const char *except, size_t *count, bool *by_it,
                          path_list *names, ffd_error *error)
{
    uint32_t index;
    *count = 0;
    *by_it = false;
    if (users->known.count == 0)
        return FFD_OK;
    const user_pair pair = {ffd_place_of(&users->places, file), ffd_place_of(&users->places, except)};
    if (!ffd_intern_find(&users->known, &pair.file, sizeof pair.file, &index))
        return FFD_OK;
    const used_file *const known = &users->files[index];
    *by_it = ffd_intern_find(&users->pairs, &pair, sizeof pair, &index);
    *count = known->count - *by_it;
    for (size_t i = 0, named = 0; names && i < USERS_NAMED && i < known->count && named + 1 < USERS_NAMED;
         i++)
        if (!ffd_hash_equal(&known->places[i], &pair.user)) {
            TRY(ffd_paths_add(names, known->names[i], error));
            named++;
        }
    return FFD_OK;
}

void ffd_users_free(file_users *users)
{
    for (size_t i = 0; i < users->known.count; i++)
        for (size_t k = 0; k < USERS_NAMED; k++)
            ffd_free(users->files[i].names[k]);
    ffd_free(users->files);
    ffd_intern_free(&users->known);
    ffd_intern_free(&users->pairs);
    ffd_places_free(&users->places);
    *users = (file_users){0};
}
