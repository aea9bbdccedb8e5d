#include "mesh/resource/copy_notes.h"
#include "base/file/cache_folder.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* A note: a word, the hash in 32 digits, and the copy's path. */
#define WORD "ffd-copy 2\n"
#define DIGITS "%016" PRIx64 "%016" PRIx64
enum { NOTE = sizeof WORD - 1 + 33 };

/* Its name: a word, and digits. */
#define NAME "copy-"
enum { NAME_SIZE = sizeof NAME - 1 + 32, CLEANED_SIZE = sizeof NAME - 1 + 2 };

static void format_note(const hash128 *hash, char note[NOTE + 1])
{
    snprintf(note, NOTE + 1, WORD DIGITS "\n", load_u64(hash->bytes), load_u64(hash->bytes + 8));
}

/* Returns the path of a copy's note; NULL: there is no folder, or memory runs out. */
static char *note_of(const char *copy)
{
    const hash128 place = ffd_place_of(NULL, copy);
    char name[NAME_SIZE + 1];
    snprintf(name, sizeof name, NAME DIGITS, load_u64(place.bytes), load_u64(place.bytes + 8));
    char *const folder = ffd_cache_folder(), *const path = folder ? ffd_path_join(folder, name) : NULL;
    ffd_free(folder);
    return path;
}

/* Returns the path in a note; NULL: there is no note, or memory runs out. Freed with ffd_free. */
static char *read_note(const char *path, hash128 *hash)
{
    file_input bytes;
    char note[NOTE + 1] = "";
    uint64_t halves[2];
    if (!ffd_file_exists(path) || ffd_file_load(path, &bytes, NULL))
        return NULL;
    char *const copy = bytes.size > NOTE ? ffd_alloc_zero(bytes.size - NOTE + 1, 1) : NULL;
    if (copy) {
        memcpy(note, bytes.data, NOTE);
        memcpy(copy, bytes.data + NOTE, bytes.size - NOTE);
    }
    ffd_file_unload(&bytes);
    if (sscanf(note, WORD "%16" SCNx64 "%16" SCNx64, &halves[0], &halves[1]) != 2) {
        ffd_free(copy);
        return NULL;
    }
    store_u64(hash->bytes, halves[0]);
    store_u64(hash->bytes + 8, halves[1]);
    return copy;
}

static bool find_note(void *context, const char *copy, hash128 *hash)
{
    char *const path = note_of(copy), *const noted = path ? read_note(path, hash) : NULL;
    (void)context;
    ffd_free(path);
    ffd_free(noted);
    return noted;
}

static ffd_status write_note(const char *path, const char *copy, const hash128 *hash)
{
    char note[NOTE + 1];
    file_output *output = NULL;
    ffd_status status;
    format_note(hash, note);
    char *const folder = ffd_path_folder(path);
    TRY_END(ffd_output_create(&output, NULL));
    TRY_END(folder ? ffd_output_folder(output, folder, NULL) : FFD_E_MEMORY);
    TRY_END(ffd_output_begin(output, path, true, NULL));
    TRY_END(ffd_output_write(output, note, NOTE, NULL));
    TRY_END(ffd_output_write(output, copy, strlen(copy), NULL));
    TRY_END(ffd_output_commit(output, NULL));
end:
    ffd_output_destroy(&output);
    ffd_free(folder);
    return status;
}

/* Removes a note if its copy is gone, or it is not whole. */
static void clean_note(const char *path)
{
    hash128 hash;
    char *const copy = read_note(path, &hash);
    if (!copy || !ffd_file_exists(copy))
        ffd_cache_remove(path);
    ffd_free(copy);
}

/* Removes the notes of copies that are gone, among those whose names begin as that of the new note: one in
   256, so that with many new notes each old one is examined now and then. */
static void clean_notes(const char *new_note)
{
    path_list names = {0};
    char *const folder = ffd_path_folder(new_note);
    const ffd_status status = folder ? ffd_folder_list(folder, &names, NULL) : FFD_E_MEMORY;
    for (size_t i = 0; !status && i < names.count; i++) {
        const char *const name = names.paths[i];
        if (strncmp(name, ffd_path_name(new_note), CLEANED_SIZE) != 0 || strlen(name) != NAME_SIZE)
            continue;
        char *const path = ffd_path_join(folder, name);
        if (path)
            clean_note(path);
        ffd_free(path);
    }
    ffd_paths_free(&names);
    ffd_free(folder);
}

static void put_note(void *context, const char *copy, const hash128 *hash)
{
    hash128 old;
    char *const path = note_of(copy), *const whole = ffd_path_resolve(copy);
    char *const noted = path ? read_note(path, &old) : NULL;
    (void)context;
    if (path && whole && !(noted && ffd_hash_equal(&old, hash))) {
        write_note(path, whole, hash);
        if (!noted)
            clean_notes(path);
    }
    ffd_free(noted);
    ffd_free(whole);
    ffd_free(path);
}

const copy_notes ffd_copy_notes_of_user = {find_note, put_note, NULL};

ffd_status ffd_copies_add(noted_copies *noted, const char *copy, const void *bytes, size_t size,
                          ffd_error *error)
{
    if (!ffd_grow((void **)&noted->hashes, &noted->capacity, noted->copies.count + 1, sizeof *noted->hashes))
        return ffd_fail_memory(error);
    noted->hashes[noted->copies.count] = ffd_hash(bytes, size);
    return ffd_paths_add(&noted->copies, copy, error);
}

bool ffd_copies_are_own(const noted_copies *noted, const char *copy)
{
    hash128 hash;
    file_input bytes;
    if (!noted->notes->find(noted->notes->context, copy, &hash) || ffd_file_load(copy, &bytes, NULL))
        return false;
    const hash128 found = ffd_hash(bytes.data, bytes.size);
    ffd_file_unload(&bytes);
    return ffd_hash_equal(&hash, &found);
}

void ffd_copies_keep(const noted_copies *noted)
{
    for (size_t i = 0; i < noted->copies.count; i++)
        noted->notes->put(noted->notes->context, noted->copies.paths[i], &noted->hashes[i]);
}

void ffd_copies_free(noted_copies *noted)
{
    ffd_paths_free(&noted->copies);
    ffd_free(noted->hashes);
    *noted = (noted_copies){0};
}
