/* check_embedding.h - what ffd/embedding.h and ffd/deform.h promise, on one lattice and its points. */
#ifndef FFD_TESTS_FUZZ_CHECK_EMBEDDING_H
#define FFD_TESTS_FUZZ_CHECK_EMBEDDING_H

#include "probe.h"

/* False where the lattice is refused, for having no volume. */
bool check_embedding(const probe *of, const probe_point *points, size_t count);

#endif
