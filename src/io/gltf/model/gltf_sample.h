/* gltf_sample.h - the value of an animation's sampler at a time (glTF 2.0, appendix C). */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SAMPLE_H
#define FFD_IO_GLTF_MODEL_GLTF_SAMPLE_H

#include "io/gltf/model/gltf_animation.h"

/* Evaluates a sampler whose keys are loaded, and writes sampler->width numbers. Before the first key and
   after the last one the value is that key's; at a key it has the bits of the key's value. is_rotation:
   LINEAR turns along the shorter arc, and the result of CUBICSPLINE is normalized. The bits are the same on
   every processor. */
void ffd_gltf_sample(const gltf_animation_sampler *sampler, bool is_rotation, double time, double *value);

/* Interpolates between the rotations a and b along the shorter arc, by the fraction t; quaternions
   x,y,z,w. */
void ffd_gltf_slerp(const double a[4], const double b[4], double t, double turned[4]);

#endif
