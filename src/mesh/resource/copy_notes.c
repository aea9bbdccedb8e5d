#include "mesh/resource/copy_notes.h"
#include "base/file/cache_folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* A note: a word, and the hash in 32 digits. */
#define WORD "ffd-copy 1\n"
#define DIGITS "%016" PRIx64 "%016" PRIx64
enum { NOTE = sizeof WORD - 1 + 33 };

static void format_note(const hash128 *hash, char note[NOTE + 1])
{
    snprintf(note, NOTE + 1, WORD DIGITS "\n", load_u64(hash->bytes), load_u64(hash->bytes + 8));
}

/* Returns the path of a copy's note; NULL: there is no folder, or memory runs out. */
static char *note_of(const char *copy)
{
    const hash128 place = ffd_place_of(NULL, copy);
    char name[60];
    snprintf(name, sizeof name, "copy-" DIGITS, load_u64(place.bytes), load_u64(place.bytes + 8));
    char *const folder = ffd_cache_folder(), *const path = folder ? ffd_path_join(folder, name) : NULL;
    ffd_free(folder);
    return path;
}

static bool read_note(const char *path, hash128 *hash)
{
    file_input bytes;
    char note[NOTE + 1];
    uint64_t halves[2];
    if (!ffd_file_exists(path) || ffd_file_load(path, &bytes, NULL))
        return false;
    const bool has_size = bytes.size == NOTE;
    if (has_size)
        memcpy(note, bytes.data, NOTE);
    ffd_file_unload(&bytes);
    note[NOTE] = 0;
    if (!has_size || sscanf(note, WORD "%16" SCNx64 "%16" SCNx64, &halves[0], &halves[1]) != 2)
        return false;
    store_u64(hash->bytes, halves[0]);
    store_u64(hash->bytes + 8, halves[1]);
    return true;
}

static bool find_note(void *context, const char *copy, hash128 *hash)
{
    char *const path = note_of(copy);
    const bool found = path && read_note(path, hash);
    (void)context;
    ffd_free(path);
    return found;
}

static ffd_status write_note(const char *path, const hash128 *hash)
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
    TRY_END(ffd_output_commit(output, NULL));
end:
    ffd_output_destroy(&output);
    ffd_free(folder);
    return status;
}

static void put_note(void *context, const char *copy, const hash128 *hash)
{
    hash128 old;
    char *const path = note_of(copy);
    if (path && !(read_note(path, &old) && ffd_hash_equal(&old, hash)))
        write_note(path, hash);
    (void)context;
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
