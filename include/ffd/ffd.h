/* ffd.h - free-form deformation of meshes with B-spline lattices: includes all public headers.

   Conventions, unless a comment says otherwise:
   - Growing structs. A struct that later versions may extend begins with struct_size, the size of the struct
     in the caller's header. X_init(&desc, sizeof desc) sets it in a description; the caller sets it in a
     result (result.struct_size = sizeof result). The library accepts a smaller struct than its own: missing
     members have their defaults, and nothing is written beyond struct_size. It refuses a larger struct with
     FFD_E_ARGUMENT, because the library is then older than the header. Structs that are elements of arrays or
     members of other structs keep their size, or grow into reserved members ("room") behind them.
   - Arrays. Control points are in the order index = i + size[0]*(j + size[1]*k), u fastest. Points and
     vectors are three consecutive doubles; matrices are row-major.
   - Units. Positions and lengths are in world units (those of the mesh, in the space where the lattice is);
     u,v,w are in the range of the knots; angles are in degrees.
   - Pointers are not NULL. Every ffd_error pointer may be NULL.
   - Ownership. An object returned through a pointer to a pointer belongs to the caller, who destroys it;
     after a failure it is NULL. Pointers that a get function returns belong to the object.
   - Threads. Any number of threads may use an object through const pointers at the same time. A function that
     takes a pointer without const needs the object for itself. "Thread-safe" means that a function shares no
     other state. If a number of threads is 0, for all cores, it is that of the processors which the calling
     thread may use: those of its affinity mask, which each call reads, but at most the processor time of its
     cgroup, rounded up, which the library reads at most once a second.
   - Errors. A function that can fail returns an ffd_status; "Errors" lists the values other than FFD_OK.

   data/promises.md says which versions are compatible. */
#ifndef FFD_FFD_H
#define FFD_FFD_H

#include <ffd/animate.h>
#include <ffd/author.h>
#include <ffd/batch.h>
#include <ffd/cells.h>
#include <ffd/chain.h>
#include <ffd/deform.h>
#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/fit.h>
#include <ffd/fold.h>
#include <ffd/isa.h>
#include <ffd/jacobian.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <ffd/points.h>
#include <ffd/program.h>
#include <ffd/result.h>
#include <ffd/settings.h>
#include <ffd/version.h>

#endif
