/* target.c - the table of formats in which a model can be written. */
#include "io/write/write.h"

const model_target *ffd_model_target(ffd_format format)
{
    switch (format) {
    case FFD_FORMAT_OBJ:
        return &ffd_obj_target;
    case FFD_FORMAT_GLTF:
        return &ffd_gltf_target;
    case FFD_FORMAT_GLB:
        return &ffd_glb_target;
    case FFD_FORMAT_PLY:
        return &ffd_ply_target;
    case FFD_FORMAT_STL:
        return &ffd_stl_target;
    case FFD_FORMAT_OFF:
        return &ffd_off_target;
    case FFD_FORMAT_VTK: /* volume meshes come from no other format */
    case FFD_FORMAT_SU2:
    case FFD_FORMAT_VTU:
    case FFD_FORMAT_VTP:
    case FFD_FORMAT_VTS:
    case FFD_FORMAT_MSH:
    case FFD_FORMAT_FOAM:
    case FFD_FORMAT_AUTO:
        break;
    }
    return NULL;
}
