/* key_values.h - the values of placeholders that keys give, and those between two keys. */
#ifndef FFD_LATTICE_FILE_KEY_VALUES_H
#define FFD_LATTICE_FILE_KEY_VALUES_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Reads the member "set" of key k: numbers, and arrays of the same shape as in the first key, of the same
   placeholders, within the bounds of their parameters. The first key chooses the names. Errors:
   FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_key_read_values(json_cursor set, size_t k, lattice_spec *spec);

/* Returns the value of a placeholder (its index) at the time of the keys, as JSON; free it with ffd_free.
   NULL: memory ran out. */
char *ffd_key_value(const spec_keys *keys, size_t name);

#endif
