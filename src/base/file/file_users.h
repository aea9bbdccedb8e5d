/* file_users.h - which models name which files as parts of themselves. */
#ifndef FFD_BASE_FILE_FILE_USERS_H
#define FFD_BASE_FILE_FILE_USERS_H

#include "base/fail.h"
#include "base/file/path_list.h"
#include "base/file/place.h"

/* The users of a file that are remembered by name. */
enum { USERS_NAMED = 4 };

typedef struct used_file {
    size_t count;                /* users */
    char *names[USERS_NAMED];    /* of the first ones, as they were added */
    hash128 places[USERS_NAMED]; /* theirs */
} used_file;

/* All zeros: empty. */
typedef struct file_users {
    file_places places;
    intern_table known, pairs; /* places of files; places of files and users */
    used_file *files;          /* one for each known file */
    size_t capacity;
} file_users;

/* Adds a model that names a file; each counts once. Errors: FFD_E_MEMORY. */
ffd_status ffd_users_add(file_users *users, const char *file, const char *user, ffd_error *error);
/* Finds the models that name a file, other than `except`: adds the names of the first three to `names` (may
   be NULL), and returns their number. *by_it: whether `except` names it. Errors: FFD_E_MEMORY. */
ffd_status ffd_users_find(file_users *users, const char *file, const char *except, size_t *count, bool *by_it,
                          path_list *names, ffd_error *error);
/* Frees everything; leaves all zeros. */
void ffd_users_free(file_users *users);

#endif
