#include "lattice/formats/formats.h"
#include "base/file/path.h"
#include <stdio.h>
#include <string.h>

#define BOTH_WAYS (FORMAT_IS_READ | FORMAT_IS_WRITTEN)
#define ALL (FORMAT_HOLDS_BOTH | FORMAT_HOLDS_ALL)
#define OF_POINTS (FORMAT_TAKES_SIZE | FORMAT_TAKES_DEGREE | FORMAT_TAKES_ORDER)
#define OF_BLOCKS (FORMAT_TAKES_DEGREE | FORMAT_TAKES_ORDER | FORMAT_TAKES_BLOCK)

/* JSON first, twice: as a lattice file, and as an add-on of Blender has it, whose file has the same ending.
 */
static const lattice_format formats[] = {
    {FORMAT_JSON, ".json", "a lattice file", BOTH_WAYS | ALL},
    {FORMAT_BLENDER_JSON, ".json", "a lattice of Blender",
     FORMAT_IS_READ | FORMAT_HOLDS_BOTH | FORMAT_GOES_ON},
    {FORMAT_CSV, ".csv", "a table", BOTH_WAYS | ALL | FORMAT_TAKES_DEGREE},
    {FORMAT_NPY, ".npy", "an array", BOTH_WAYS | OF_POINTS},
    {FORMAT_PLOT3D, ".xyz", "Plot3D", BOTH_WAYS | OF_BLOCKS},
    {FORMAT_PLOT3D, ".fmt", "Plot3D", BOTH_WAYS | OF_BLOCKS},
    {FORMAT_PRM, ".prm", "a file of PyGeM", BOTH_WAYS | ALL}, /* it refuses what it does not hold */
    {FORMAT_SU2, ".su2", "a mesh of SU2", FORMAT_IS_READ | FORMAT_TAKES_BLOCK},
    {FORMAT_VTK, ".vtk", "a structured grid", BOTH_WAYS | ALL | FORMAT_TAKES_DEGREE},
    {FORMAT_VTS, ".vts", "a structured grid", BOTH_WAYS | ALL | FORMAT_TAKES_DEGREE},
    {FORMAT_CAGE, ".obj", "a cage", BOTH_WAYS | FORMAT_HOLDS_BOTH | OF_POINTS},
    {FORMAT_NPZ, ".npz", "a lattice of Blender", FORMAT_IS_READ | FORMAT_HOLDS_BOTH | FORMAT_GOES_ON},
    {FORMAT_PREVIEW, ".glb", "a preview", FORMAT_IS_WRITTEN | FORMAT_HOLDS_BOTH | FORMAT_SHOWS},
};
#define FORMATS (sizeof formats / sizeof *formats)

const lattice_format *ffd_format_of_json(bool is_blender)
{
    return &formats[is_blender];
}

const lattice_format *ffd_lattice_format(const char *name)
{
    if (strcmp(name, "-") == 0)
        return &formats[0];
    for (size_t f = 0; f < FORMATS; f++)
        if (ffd_path_has_ending(name, formats[f].ending))
            return &formats[f];
    return NULL;
}

void ffd_format_endings(bool written, char text[FORMAT_ENDINGS])
{
    const char *endings[FORMATS];
    size_t count = 0, used = 0;
    for (size_t f = 0; f < FORMATS; f++)
        if (formats[f].traits & (written ? FORMAT_IS_WRITTEN : FORMAT_IS_READ) &&
            formats[f].kind != FORMAT_BLENDER_JSON)
            endings[count++] = formats[f].ending;
    for (size_t e = 0; e < count; e++)
        used += (size_t)snprintf(text + used, FORMAT_ENDINGS - used, "%s%s",
                                 e == 0          ? ""
                                 : e + 1 < count ? ", "
                                                 : " or ",
                                 endings[e]);
}

ffd_status ffd_format_check_wish(const lattice_format *format, const char *name, const format_wish *wish,
                                 ffd_error *error)
{
    const unsigned traits = format->traits;
    if (wish->size[0] && !wish->size_is_known && !(traits & FORMAT_TAKES_SIZE))
        return ffd_fail_file(error, FFD_E_ARGUMENT, name, "tells its size itself: {size} is not for it");
    if (wish->degree[0] && !(traits & FORMAT_TAKES_DEGREE))
        return ffd_fail_file(error, FFD_E_ARGUMENT, name, "tells its degree itself: {degree} is not for it");
    if (wish->finds_order && !(traits & FORMAT_TAKES_ORDER))
        return ffd_fail_file(error, FFD_E_ARGUMENT, name, "tells its order itself: {order} is not for it");
    if (wish->block && !(traits & FORMAT_TAKES_BLOCK))
        return ffd_fail_file(error, FFD_E_ARGUMENT, name, "has no blocks: {block} is not for it");
    return FFD_OK;
}
