/* surface.h - the faces of a document as OpenMesh's half-edges (C++, for the adapters of this folder). */
#ifndef FFD_IO_OPENMESH_SURFACE_H
#define FFD_IO_OPENMESH_SURFACE_H

#include "base/memory/memory.h"
#include "mesh/mesh.h"
/* OpenMesh's vectors begin unset, and gcc sees them copied into new vertices before they get their value. */
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

/* Arrays whose memory comes from base/memory/memory.h. */
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

/* The faces as half-edges. Vertices are made when a face first needs them and know their number in the file,
   their source; where half-edges cannot express what the file has, a source has several vertices. */
class surface
{
  public:
    explicit surface(const mesh_faces &faces);

    /* Adds all faces with at least three different corners; returns how many have not. A corner that repeats
       the one before it is left out. */
    size_t add_faces(const mesh_faces &faces);

    uint32_t source(vertex_handle vertex) const { return mesh.property(source_, vertex); }
    /* The index in the file's corners of the corner that a half-edge of a face starts at. */
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
    array<vertex_handle> current_;      /* of each source, what the next face joins; may be invalid */
    array<unsigned char> vertices_of_;  /* of each source: 0, 1, or 2 for more */
    array<uint32_t> sources_, numbers_; /* of the corners of the face being added: vertices, and their indices
                                           in the file's corners; no neighbours equal */
    array<vertex_handle> handles_;      /* likewise */
};

/* Refuses what half-edges cannot number and corners that are not numbers of vertices. */
ffd_status check(const mesh_faces &faces, ffd_error *error);

/* Calls what makes `what` of the faces, and turns exceptions into errors. */
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
