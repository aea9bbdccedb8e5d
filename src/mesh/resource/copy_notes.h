/* copy_notes.h - what earlier runs have copied beside outputs: the hash of each copy, so that one that nobody
   else has changed can be replaced when its original has changed. */
#ifndef FFD_MESH_RESOURCE_COPY_NOTES_H
#define FFD_MESH_RESOURCE_COPY_NOTES_H

#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include <stdbool.h>

/* Where notes are kept. A note that cannot be kept is lost: its copy is then protected as that of others. */
typedef struct copy_notes {
    bool (*find)(void *context, const char *copy, hash128 *hash); /* false: none */
    void (*put)(void *context, const char *copy, const hash128 *hash);
    void *context;
} copy_notes;

/* A small file for each copy, in the folder of the default journals. */
extern const copy_notes ffd_copy_notes_of_user;

/* The copies of an output. All zeros but notes: none. */
typedef struct noted_copies {
    const copy_notes *notes;
    path_list copies;
    hash128 *hashes; /* of each */
    size_t capacity;
} noted_copies;

/* Adds a copy with its bytes. Errors: FFD_E_MEMORY. */
ffd_status ffd_copies_add(noted_copies *noted, const char *copy, const void *bytes, size_t size,
                          ffd_error *error);
/* Whether the file at a path is as its note says. */
bool ffd_copies_are_own(const noted_copies *noted, const char *copy);
/* Keeps the notes, once the copies are in place. */
void ffd_copies_keep(const noted_copies *noted);
/* Frees the list. */
void ffd_copies_free(noted_copies *noted);

#endif
