/* ffd.h - free-form deformation of meshes with B-spline lattices: the whole public interface.

   Structs that may grow begin with struct_size, the size that the caller's header has: descriptions get it
   from their _init(&desc, sizeof desc), results from their caller (result.struct_size = sizeof result). A
   smaller size than the library's is taken: members that the caller does not have keep their defaults, and
   nothing is written behind the others. A larger one is refused (FFD_E_ARGUMENT): the library is older than
   the header. Structs that callers have arrays of, and those within others, keep their size, or grow into the
   room that follows them. data/promises.md says what is promised of versions. */
#ifndef FFD_FFD_H
#define FFD_FFD_H

#include <ffd/deform.h>
#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/fold.h>
#include <ffd/isa.h>
#include <ffd/jacobian.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <ffd/points.h>
#include <ffd/version.h>

#endif
