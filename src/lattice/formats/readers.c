#include "lattice/formats/readers.h"

static format_reader *const readers[FORMAT_KINDS] = {
    [FORMAT_CSV] = ffd_lattice_read_csv,       [FORMAT_NPY] = ffd_lattice_read_npy,
    [FORMAT_PLOT3D] = ffd_lattice_read_plot3d, [FORMAT_PRM] = ffd_lattice_read_prm,
    [FORMAT_SU2] = ffd_lattice_read_su2,       [FORMAT_VTK] = ffd_lattice_read_vtk,
    [FORMAT_VTS] = ffd_lattice_read_vts,       [FORMAT_CAGE] = ffd_lattice_read_cage,
    [FORMAT_NPZ] = ffd_lattice_read_npz,       [FORMAT_BLENDER_JSON] = ffd_lattice_read_blender_json,
};

static format_writer *const writers[FORMAT_KINDS] = {
    [FORMAT_CSV] = ffd_lattice_write_csv,       [FORMAT_NPY] = ffd_lattice_write_npy,
    [FORMAT_PLOT3D] = ffd_lattice_write_plot3d, [FORMAT_PRM] = ffd_lattice_write_prm,
    [FORMAT_VTK] = ffd_lattice_write_vtk,       [FORMAT_VTS] = ffd_lattice_write_vts,
    [FORMAT_CAGE] = ffd_lattice_write_cage,     [FORMAT_PREVIEW] = ffd_lattice_write_preview,
};

format_reader *ffd_format_reader(const lattice_format *format)
{
    return readers[format->kind];
}

format_writer *ffd_format_writer(const lattice_format *format)
{
    return writers[format->kind];
}
