/* spec_keys.h - reads "keys" of a lattice file: what its control points are at several times. */
#ifndef FFD_LATTICE_FILE_SPEC_KEYS_H
#define FFD_LATTICE_FILE_SPEC_KEYS_H

#include "lattice/file/spec_set.h"

/* Settings with the values that keys give at a time, which come last. All zeros: empty. */
typedef struct keyed_settings {
    spec_settings settings;
    ffd_setting *values;
    bool *used;
    char **texts; /* text_count values of the keys */
    size_t text_count;
} keyed_settings;

/* Reads the times of the keys and, where they are of KEYS_VALUES, their values; chooses the time. Does
   nothing without keys. Errors: FFD_E_ARGUMENT for a setting of a placeholder that the keys give,
   FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_spec_begin_keys(json_cursor keys, const spec_settings *settings, lattice_spec *spec);

/* Adds the values of the keys at their time to settings, which may be those of no file. The caller frees
   keyed, also after a failure. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_add_keyed(const spec_keys *keys, const spec_settings *settings, keyed_settings *keyed,
                              ffd_error *error);
/* Marks the settings that were used, without those of the keys. */
void ffd_spec_mark_used(const keyed_settings *keyed, const spec_settings *settings);
/* Frees the values and empties them. */
void ffd_keyed_settings_free(keyed_settings *keyed);

/* Lists the values of the tree in which placeholders may be: the moves of the file, and those of keys. The
   caller frees *lists. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_list_moves(json_cursor root, uint32_t **lists, size_t *count);

/* Reads the rest of the keys when all else has been read: offsets and moves, which are left out if
   placeholders are open; or keeps the moves of the file for other times. Errors: FFD_E_INVALID, FFD_E_MEMORY.
 */
ffd_status ffd_spec_end_keys(json_cursor root, const keyed_settings *keyed, bool with_moves,
                             lattice_spec *spec);

/* Makes the moves of a file with keys of KEYS_VALUES for the time of its keys. spec: a copy of the file's
   that shares all arrays; it gets moves and drags of its own, which the caller frees, also after a failure.
   Errors: FFD_E_INVALID for what the moves cannot be, FFD_E_MEMORY. */
ffd_status ffd_spec_moves_at(lattice_spec *spec, ffd_error *error);

#endif
