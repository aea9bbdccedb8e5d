#include "io/deflate/deflate_module.h"
#include "base/system/deadline.h"

FFD_API extern const deflate_module ffd_module;

const deflate_module ffd_module = {
    {DEFLATE_IDENTITY, NULL, ffd_spell_members, ffd_deadline_ask},
    ffd_inflate,
    ffd_deflate,
};
