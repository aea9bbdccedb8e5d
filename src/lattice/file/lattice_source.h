/* lattice_source.h - where a lattice of a job comes from (ffd_lattice_source). Its path is never NULL here: a
   text or an object has a name in it. */
#ifndef FFD_LATTICE_FILE_LATTICE_SOURCE_H
#define FFD_LATTICE_FILE_LATTICE_SOURCE_H

#include <ffd/lattice.h>

/* Returns the path of the lattice's file; NULL for standard input, a text and an object. */
const char *ffd_lattice_file(const ffd_lattice_source *source);
/* Returns the name for messages. */
const char *ffd_lattice_name(const ffd_lattice_source *source);
/* Returns whether the lattice is read from standard input. */
bool ffd_lattice_is_stream(const ffd_lattice_source *source);

#endif
