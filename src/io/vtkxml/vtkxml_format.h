/* vtkxml_format.h - VTK files in XML, for the table of formats: unstructured grids, polygonal data,
   structured grids. */
#ifndef FFD_IO_VTKXML_VTKXML_FORMAT_H
#define FFD_IO_VTKXML_VTKXML_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_vtu_format, ffd_vtp_format, ffd_vts_format;

#endif
