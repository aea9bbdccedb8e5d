#include "io/gltf/rig/gltf_rig_users.h"
#include "io/gltf/rig/gltf_rig.h"

void ffd_gltf_mark_rig_originals(const gltf_document *d, bool *used)
{
    for (size_t s = 0; s < d->skin_values.count; s++)
        if (d->skins[s].inverse_bind >= 0 && d->rig->skin_contents[s] == GLTF_NONE)
            used[d->skins[s].inverse_bind] = true;
}
