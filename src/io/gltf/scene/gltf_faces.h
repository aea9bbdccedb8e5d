/* gltf_faces.h - what primitives draw: triangles, lines, points. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_FACES_H
#define FFD_IO_GLTF_SCENE_GLTF_FACES_H

#include "io/gltf/document/gltf_document.h"

/* Adds to the counts what the primitives of a mesh draw, for one use of the mesh. */
void ffd_gltf_count_drawing(const gltf_document *document, size_t mesh, size_t *triangles, size_t *lines,
                            size_t *points);

/* Returns the number of triangles that one use of a primitive draws. */
size_t ffd_gltf_count_triangles(const gltf_document *document, size_t mesh, size_t primitive);

/* Lists the vertices (0, 1, ..) that a primitive with positions draws, in order, for the caller to free;
   corners is NULL after a failure. Errors: FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_gltf_read_corners(const gltf_document *document, size_t mesh, size_t primitive,
                                 uint32_t **corners, size_t *count, ffd_error *error);

/* Returns the largest count that ffd_gltf_read_corners gives for any primitive. */
uint64_t ffd_gltf_most_corners(const gltf_document *document);

/* Finds the vertices of triangle t among a primitive's corners. Every second triangle of a strip has its
   order reversed (glTF 2.0, 3.7.2.1). */
void ffd_gltf_triangle(int mode, size_t t, const uint32_t *corners, uint32_t triangle[3]);

/* mesh_format's faces and corner_normals. */
mesh_faces_function ffd_gltf_faces;
mesh_corner_normals_function ffd_gltf_corner_normals;

#endif
