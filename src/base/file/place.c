#define _XOPEN_SOURCE 700 /* realpath, lstat */
#include "base/file/place.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#ifdef _WIN32
#include "base/windows/names.h"
#endif
#include <string.h>

/* Folders that are remembered by device and inode, at most. */
#define MOST_KNOWN 4096

static bool is_link(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
}

static char *resolve(const char *path);

/* Resolves what a link leads to, though it is not there yet. */
static char *resolve_target(const char *path)
{
    char *const target = ffd_path_follow(path);
    char *const resolved = target && strcmp(target, path) != 0 ? resolve(target) : NULL;
    ffd_free(target);
    return resolved;
}

/* Resolves the folders and links that exist, and keeps the rest as it is written. Returns NULL if memory runs
   out. */
static char *resolve(const char *path)
{
    char *const whole = ffd_path_resolve(path);
    if (whole || strcmp(path, "/") == 0 || strcmp(path, ".") == 0)
        return whole;
    char *const led = is_link(path) ? resolve_target(path) : NULL;
    if (led)
        return led;
    char *const folder = ffd_path_folder(path), *const above = folder && strcmp(folder, path) != 0
                                                                   ? resolve(folder)
                                                                   : NULL;
    char *const joined = above ? ffd_path_join(above, ffd_path_name(path)) : NULL;
    char *const plain = joined ? ffd_path_normalize(joined) : NULL;
    ffd_free(folder);
    ffd_free(above);
    ffd_free(joined);
    return plain;
}

/* Replaces the path of a folder by the first one under which it was seen. */
static char *unify(file_places *places, char *resolved)
{
    struct stat info;
    uint32_t index;
    if (!resolved || stat(resolved, &info) != 0)
        return resolved;
    const uint64_t key[] = {(uint64_t)info.st_dev, (uint64_t)info.st_ino};
    const size_t count = places->known.count;
    if (count >= MOST_KNOWN && !ffd_intern_find(&places->known, key, sizeof key, &index))
        return resolved;
    char *const copy = ffd_text_copy(resolved);
    if (!copy ||
        !ffd_grow((void **)&places->resolved, &places->capacity, count + 1, sizeof *places->resolved) ||
        !ffd_intern(&places->known, key, sizeof key, &index)) {
        ffd_free(copy);
        return resolved;
    }
    if (index == count) {
        places->resolved[count] = copy;
        return resolved;
    }
    ffd_free(copy);
    char *const first = ffd_text_copy(places->resolved[index]);
    if (!first)
        return resolved;
    ffd_free(resolved);
    return first;
}

/* Returns the resolved path of a folder, borrowed until the next call; NULL if memory runs out. path: of
   `length` characters. */
static const char *find_folder(file_places *places, const char *path, size_t length)
{
    for (size_t i = 0; i < PLACE_FOLDERS; i++) {
        const place_folder *const known = &places->folders[i];
        if (known->path && strncmp(known->path, path, length) == 0 && known->path[length] == 0)
            return known->resolved;
    }
    char *const copy = ffd_alloc(length + 1, 1);
    if (!copy)
        return NULL;
    memcpy(copy, path, length);
    copy[length] = 0;
    char *const resolved = unify(places, resolve(length ? copy : "."));
    if (!resolved) {
        ffd_free(copy);
        return NULL;
    }
    place_folder *const made = &places->folders[places->next];
    places->next = (places->next + 1) % PLACE_FOLDERS;
    ffd_free(made->path);
    ffd_free(made->resolved);
    *made = (place_folder){copy, resolved};
    return resolved;
}

static hash128 hash_of(const char *folder, const char *name)
{
#ifdef _WIN32
    char *const small_folder = ffd_small_letters(folder), *const small_name = ffd_small_letters(name);
#else
    char *const small_folder = NULL, *const small_name = NULL;
#endif
    folder = small_folder ? small_folder : folder;
    name = small_name ? small_name : name;
    const hash_block blocks[] = {{folder, strlen(folder) + 1}, {name, strlen(name)}};
    const hash128 hash = ffd_hash_blocks(blocks, 2);
    free(small_folder);
    free(small_name);
    return hash;
}

/* *seen: the place as seen from the folder `base`. seen: may be NULL. */
static hash128 find_in(file_places *places, const char *path, const char *base, hash128 *seen)
{
    char *const target = is_link(path) ? resolve(path) : NULL;
    const char *const whole = target ? target : path;
    const char *const name = ffd_path_name(whole);
    size_t length = (size_t)(name - whole);
    while (length > 1 && ffd_is_separator(whole[length - 1]))
        length--;
    const char *const folder = find_folder(places, whole, length);
    char *const relative = seen && folder ? ffd_path_relative(base, folder) : NULL;
    if (seen)
        *seen = hash_of(relative ? relative : folder ? folder : "", name);
    const hash128 hash = hash_of(folder ? folder : "", name);
    ffd_free(relative);
    ffd_free(target);
    return hash;
}

hash128 ffd_place_both(file_places *places, const char *base, const char *path, hash128 *seen)
{
    file_places own = {0};
    const hash128 hash = find_in(places ? places : &own, path, base, seen);
    ffd_places_free(&own);
    return hash;
}

hash128 ffd_place_of(file_places *places, const char *path)
{
    return ffd_place_both(places, NULL, path, NULL);
}

hash128 ffd_place_relative(file_places *places, const char *base, const char *path)
{
    hash128 seen;
    ffd_place_both(places, base, path, &seen);
    return seen;
}

void ffd_places_free(file_places *places)
{
    for (size_t i = 0; i < PLACE_FOLDERS; i++) {
        ffd_free(places->folders[i].path);
        ffd_free(places->folders[i].resolved);
    }
    for (size_t i = 0; i < places->known.count; i++)
        ffd_free(places->resolved[i]);
    ffd_free(places->resolved);
    ffd_intern_free(&places->known);
    *places = (file_places){0};
}
