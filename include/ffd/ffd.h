/* ffd.h - free-form deformation of meshes with B-spline lattices: the whole public interface. */
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
