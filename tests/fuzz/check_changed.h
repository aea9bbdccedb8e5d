/* check_changed.h - a mesh file that somebody changes while it is open. */
#ifndef FFD_TESTS_FUZZ_CHECK_CHANGED_H
#define FFD_TESTS_FUZZ_CHECK_CHANGED_H

#include "mesh_trial.h"

/* Opens a file that was accepted before, changes its bytes, as a mapping shows what others write to a file,
   and uses it: each call succeeds or is refused, and the sanitizers see that none leaves its memory. */
void check_changed(const trial *of, const uint8_t *data, size_t size);

#endif
