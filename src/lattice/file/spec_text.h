/* spec_text.h - writes a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_TEXT_H
#define FFD_LATTICE_FILE_SPEC_TEXT_H

#include "lattice/spec.h"

/* Returns the text of a lattice file: *size bytes, ending with a line break, followed by a 0; free it with
   ffd_free. NULL if memory runs out. */
char *ffd_spec_text(const lattice_spec *spec, size_t *size);

#endif
