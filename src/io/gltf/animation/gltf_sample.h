/* gltf_sample.h - the value of an animation's sampler at a time (glTF 2.0, appendix C). */
#ifndef FFD_IO_GLTF_ANIMATION_GLTF_SAMPLE_H
#define FFD_IO_GLTF_ANIMATION_GLTF_SAMPLE_H

#include "io/gltf/animation/gltf_animation.h"

/* Evaluates a sampler whose keys are loaded: sampler->width numbers. Before the first key and behind the last
   it is theirs; at a key, the key's own bits. is_rotation: LINEAR turns along the shorter arc, and what
   CUBICSPLINE gives is normalized. The same bits on every processor. */
void ffd_gltf_sample(const gltf_animation_sampler *sampler, bool is_rotation, double time, double *value);

/* The turn from a to b by the fraction t of the shorter arc between them; quaternions x,y,z,w. */
void ffd_gltf_slerp(const double a[4], const double b[4], double t, double turned[4]);

#endif
