#include "mesh/meshopt/meshopt_module.h"
#include "base/system/deadline.h"
#include "base/system/exceptions.h"

FFD_API extern const meshopt_module ffd_module;

const meshopt_module ffd_module = {
    {MESHOPT_IDENTITY, ffd_exceptions_prepare, ffd_spell_members, ffd_deadline_ask},
    ffd_meshopt_library_decode,
    ffd_meshopt_simplify,
};
