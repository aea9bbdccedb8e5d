/* refine.h - what a refinement takes (public: ffd/author.h). */
#ifndef FFD_AUTHOR_REFINE_H
#define FFD_AUTHOR_REFINE_H

#include <ffd/author.h>

/* Finds the size of the lattice that ffd_lattice_refine would make. Errors: FFD_E_ARGUMENT, FFD_E_LIMIT and
   FFD_E_MEMORY, as there. */
ffd_status ffd_lattice_refined_size(const ffd_lattice *lattice, const ffd_refine_desc *desc, size_t size[3],
                                    ffd_error *error);

#endif
