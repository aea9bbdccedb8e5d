#include "io/formats.h"
#include "base/file/path.h"
#include "base/text/content.h"
#include "io/foam/foam_format.h"
#include "io/format_names.h"
#include "io/gltf/gltf_format.h"
#include "io/msh/msh_format.h"
#include "io/obj/obj_format.h"
#include "io/off/off_format.h"
#include "io/ply/ply_format.h"
#include "io/stl/stl_format.h"
#include "io/su2/su2_format.h"
#include "io/vtk/vtk_format.h"
#include "io/vtkxml/vtkxml_format.h"
#include <stdio.h>
#include <string.h>

const mesh_format *ffd_format_table(ffd_format format)
{
    switch (format) {
    case FFD_FORMAT_OBJ:
        return &ffd_obj_format;
    case FFD_FORMAT_GLTF:
    case FFD_FORMAT_GLB:
        return &ffd_gltf_format;
    case FFD_FORMAT_PLY:
        return &ffd_ply_format;
    case FFD_FORMAT_OFF:
        return &ffd_off_format;
    case FFD_FORMAT_STL:
        return &ffd_stl_format;
    case FFD_FORMAT_VTK:
        return &ffd_vtk_format;
    case FFD_FORMAT_SU2:
        return &ffd_su2_format;
    case FFD_FORMAT_VTU:
        return &ffd_vtu_format;
    case FFD_FORMAT_VTP:
        return &ffd_vtp_format;
    case FFD_FORMAT_VTS:
        return &ffd_vts_format;
    case FFD_FORMAT_MSH:
        return &ffd_msh_format;
    case FFD_FORMAT_FOAM:
        return &ffd_foam_format;
    case FFD_FORMAT_AUTO:
        break;
    }
    return NULL;
}

/* Where the content of a file that is not valid looks like another format, adds that to the message. */
static void mention_content(const mesh_format *format, const file_input *input, ffd_error *error)
{
    const content_kind *const kind = ffd_content_kind(input->data, input->size);
    const bool is_own_xml = kind && format->is_xml && strcmp(kind->name, CONTENT_XML) == 0;
    if (kind && !is_own_xml && ffd_format_table(kind->format) != format)
        ffd_content_mention(kind, error);
}

ffd_status ffd_format_open(const mesh_format *format, file_input *input, const ffd_source *source,
                           mesh_document **document, ffd_error *error)
{
    const ffd_status status = format->open(input, source, document, error);
    if (status == FFD_E_INVALID && error)
        mention_content(format, input, error);
    TRY(status);
    (*document)->format = format;
    return FFD_OK;
}

static bool is_foam(const char *name)
{
    return strcmp(name, FOAM_NAME) == 0 || strcmp(name, FOAM_PACKED) == 0;
}

ffd_format ffd_format_from_name(const char *name)
{
    static const struct {
        const char *ending;
        ffd_format format;
    } known[] = {{".obj", FFD_FORMAT_OBJ}, {".gltf", FFD_FORMAT_GLTF}, {".glb", FFD_FORMAT_GLB},
                 {".vrm", FFD_FORMAT_GLB}, {".ply", FFD_FORMAT_PLY},   {".off", FFD_FORMAT_OFF},
                 {".stl", FFD_FORMAT_STL}, {".vtk", FFD_FORMAT_VTK},   {".su2", FFD_FORMAT_SU2},
                 {".vtu", FFD_FORMAT_VTU}, {".vtp", FFD_FORMAT_VTP},   {".vts", FFD_FORMAT_VTS},
                 {".msh", FFD_FORMAT_MSH}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (ffd_path_has_ending(name, known[i].ending))
            return known[i].format;
    return is_foam(ffd_path_name(name)) ? FFD_FORMAT_FOAM : FFD_FORMAT_AUTO;
}
