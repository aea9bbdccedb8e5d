/* spec_text.h - writes a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_TEXT_H
#define FFD_LATTICE_FILE_SPEC_TEXT_H

#include "lattice/spec.h"

/* The file's text for a spec, size bytes with a final line break, and a 0 after them (free with ffd_free).
   NULL: no memory. */
char *ffd_spec_text(const lattice_spec *spec, size_t *size);

#endif
