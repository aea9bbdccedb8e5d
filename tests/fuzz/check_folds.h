/* check_folds.h - what ffd/fold.h promises, on one lattice. */
#ifndef FFD_TESTS_FUZZ_CHECK_FOLDS_H
#define FFD_TESTS_FUZZ_CHECK_FOLDS_H

#include "probe.h"

void check_folds(const probe *of, const probe_point *points, size_t count);

#endif
