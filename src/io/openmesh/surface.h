/* surface.h - the faces of a document as OpenMesh's half-edges (C++, for the adapters of this folder). */
#ifndef FFD_IO_OPENMESH_SURFACE_H
#define FFD_IO_OPENMESH_SURFACE_H

#include "base/memory/memory.h"
#include "mesh/mesh.h"
/* OpenMesh's vectors are uninitialized at first, and gcc warns where they are copied into new vertices before
   they are set. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include <new>
#include <stdexcept>
#include <vector>

namespace ffd_openmesh
{

/* Arrays that take their memory from base/memory/memory.h. */
template <class T> struct base_allocator {
    typedef T value_type;
    base_allocator() = default;
    template <class U> base_allocator(const base_allocator<U> &) {}
    T *allocate(size_t count)
    {
        void *block = ffd_alloc(count, sizeof(T));
        if (!block)
            throw std::bad_alloc();
        return static_cast<T *>(block);
    }
    void deallocate(T *block, size_t) { ffd_free(block); }
    template <class U> bool operator==(const base_allocator<U> &) const { return true; }
    template <class U> bool operator!=(const base_allocator<U> &) const { return false; }
};

template <class T> using array = std::vector<T, base_allocator<T>>;

struct double_traits : OpenMesh::DefaultTraits {
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
};

typedef OpenMesh::PolyMesh_ArrayKernelT<double_traits> half_edge_mesh;
typedef half_edge_mesh::VertexHandle vertex_handle;
typedef half_edge_mesh::HalfedgeHandle halfedge_handle;

/* The faces as half-edges. A vertex is made when a face first needs it, and knows its number in the file: its
   source. Where half-edges cannot express the mesh, one source has several vertices. */
class surface
{
  public:
    explicit surface(const mesh_faces &faces);

    /* Adds all faces with at least three different corners; returns the number of other faces. A corner that
       repeats the previous one is left out. */
    size_t add_faces(const mesh_faces &faces);

    uint32_t source(vertex_handle vertex) const { return mesh.property(source_, vertex); }
    /* Returns the corner (an index in the file's corners) at which a half-edge of a face starts. */
    uint32_t corner(halfedge_handle half) const { return mesh.property(corner_, half); }
    bool has_copies(uint32_t vertex) const { return vertices_of_[vertex] > 1; }

    half_edge_mesh mesh;

  private:
    void add_face(bool simple);
    vertex_handle new_vertex(uint32_t source);
    bool fits() const;
    bool closes_fan(halfedge_handle previous, halfedge_handle next) const;

    const double *positions_;
    OpenMesh::VPropHandleT<uint32_t> source_;
    OpenMesh::VPropHandleT<unsigned> faces_of_;
    OpenMesh::HPropHandleT<uint32_t> corner_;
    array<vertex_handle> current_;     /* per source: the vertex that the next face joins; may be invalid */
    array<unsigned char> vertices_of_; /* per source: the number of its vertices: 0, 1, or 2 for more */
    /* Per corner of the face being added: the vertex, and its index in the file's corners. Neighbours
       differ. */
    array<uint32_t> sources_, indices_;
    array<vertex_handle> handles_; /* per corner too */
};

/* Refuses more corners than half-edges can number, and corners that are not vertex numbers. */
ffd_status check(const mesh_faces &faces, ffd_error *error);

/* Calls make, and turns exceptions into errors. what: what it computes, for messages. */
template <class function> ffd_status guarded(function make, const char *what, ffd_error *error)
{
    try {
        return make();
    } catch (const std::bad_alloc &) {
        return ffd_fail_memory(error);
    } catch (const std::length_error &) {
        return ffd_fail_memory(error);
    } catch (const std::exception &e) {
        return ffd_fail(error, FFD_E_LIMIT, "%s cannot be computed: %s", what, e.what());
    } catch (...) {
        return ffd_fail(error, FFD_E_LIMIT, "%s cannot be computed", what);
    }
}

} // namespace ffd_openmesh

#endif
