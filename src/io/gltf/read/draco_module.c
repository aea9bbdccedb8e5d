#include "io/gltf/read/draco_module.h"
#include "base/system/deadline.h"
#include "base/system/exceptions.h"

FFD_API extern const draco_module ffd_module;

const draco_module ffd_module = {
    .head = {DRACO_IDENTITY, ffd_exceptions_prepare, ffd_spell_members, ffd_deadline_ask},
    .decode = ffd_draco_decode,
    .free = ffd_draco_free,
    .point_count = ffd_draco_point_count,
    .corner_count = ffd_draco_corner_count,
    .attribute = ffd_draco_attribute,
    .step = ffd_draco_step,
    .indices = ffd_draco_indices,
};
