#include "mesh/meshopt/meshopt_module.h"

FFD_API extern const meshopt_module ffd_module;

const meshopt_module ffd_module = {
    {MESHOPT_IDENTITY, NULL},
    ffd_meshopt_decode,
};
