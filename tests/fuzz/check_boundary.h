/* check_boundary.h - what embed/boundary.h promises, on one lattice and its points. */
#ifndef FFD_TESTS_FUZZ_CHECK_BOUNDARY_H
#define FFD_TESTS_FUZZ_CHECK_BOUNDARY_H

#include "probe.h"

void check_boundary(const probe *of, const probe_point *points, size_t count);

#endif
