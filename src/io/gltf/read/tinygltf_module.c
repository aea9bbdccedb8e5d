#include "io/gltf/read/tinygltf_module.h"
#include "base/system/deadline.h"
#include "base/system/exceptions.h"

FFD_API extern const tinygltf_module ffd_module;

const tinygltf_module ffd_module = {
    {TINYGLTF_IDENTITY, ffd_exceptions_prepare, ffd_spell_members, ffd_deadline_ask},
    ffd_gltf_parse_model,
};
