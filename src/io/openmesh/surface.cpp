#include "io/openmesh/surface.h"
#include "base/system/deadline.h"
#include <climits>
#include <stdexcept>

namespace ffd_openmesh
{

/* OpenMesh numbers half-edges by int, and each corner makes at most two. */
const size_t most_corners = INT_MAX / 2;

/* add_face visits all faces at each corner's vertex: for a hub of a million faces that would take quadratic
   time. A vertex with this many faces is continued by a copy. */
const unsigned most_faces_of_vertex = 64;

surface::surface(const mesh_faces &faces)
    : positions_(faces.positions), current_(faces.vertex_count), vertices_of_(faces.vertex_count)
{
    mesh.add_property(source_);
    mesh.add_property(faces_of_);
    mesh.add_property(corner_);
}

vertex_handle surface::new_vertex(uint32_t source)
{
    const double *p = positions_ + 3 * static_cast<size_t>(source);
    const vertex_handle vertex = mesh.new_vertex(half_edge_mesh::Point(p[0], p[1], p[2]));
    mesh.property(source_, vertex) = source;
    mesh.property(faces_of_, vertex) = 0;
    if (vertices_of_[source] < 2)
        vertices_of_[source]++;
    return vertex;
}

/* Whether a face between these two boundary half-edges, which meet at a vertex, would close the fan that they
   bound although other fans are in its gap. */
bool surface::closes_fan(halfedge_handle previous, halfedge_handle next) const
{
    halfedge_handle incoming = mesh.opposite_halfedge_handle(next);
    while (!mesh.is_boundary(incoming))
        incoming = mesh.opposite_halfedge_handle(mesh.next_halfedge_handle(incoming));
    return incoming == previous && mesh.next_halfedge_handle(previous) != next;
}

/* Whether add_face will accept the face of handles_. add_face checks this too, but reports a failure on a
   stream that belongs to the whole process. */
bool surface::fits() const
{
    const size_t count = handles_.size();
    halfedge_handle previous = mesh.find_halfedge(handles_[count - 1], handles_[0]);
    for (size_t i = 0; i < count; i++) {
        const halfedge_handle next = mesh.find_halfedge(handles_[i], handles_[(i + 1) % count]);
        if (!mesh.is_boundary(handles_[i]) || (next.is_valid() && !mesh.is_boundary(next)))
            return false;
        if (previous.is_valid() && next.is_valid() && closes_fan(previous, next))
            return false;
        previous = next;
    }
    return true;
}

void surface::add_face(bool simple)
{
    const size_t count = sources_.size();
    handles_.resize(count);
    for (size_t i = 0; simple && i < count; i++) {
        vertex_handle &vertex = current_[sources_[i]];
        if (!vertex.is_valid())
            vertex = new_vertex(sources_[i]);
        handles_[i] = vertex;
    }
    if (!simple || !fits())
        for (size_t i = 0; i < count; i++)
            handles_[i] = new_vertex(sources_[i]);
    const half_edge_mesh::FaceHandle face = mesh.add_face(handles_.data(), count);
    if (!face.is_valid())
        throw std::logic_error("a face cannot be joined to the others");
    halfedge_handle half = mesh.halfedge_handle(face);
    while (mesh.from_vertex_handle(half) != handles_[0])
        half = mesh.next_halfedge_handle(half);
    for (size_t i = 0; i < count; i++, half = mesh.next_halfedge_handle(half))
        mesh.property(corner_, half) = indices_[i];
    for (size_t i = 0; i < count; i++)
        if (++mesh.property(faces_of_, handles_[i]) >= most_faces_of_vertex)
            current_[sources_[i]] = vertex_handle();
}

size_t surface::add_faces(const mesh_faces &faces)
{
    array<size_t> seen_in(faces.vertex_count); /* per vertex: the last face with it, counted from 1 */
    size_t degenerate = 0;
    for (size_t f = 0; f < faces.face_count && !ffd_deadline_passed_at(f); f++) {
        size_t distinct = 0;
        sources_.clear();
        indices_.clear();
        for (size_t c = faces.start[f]; c < faces.start[f + 1]; c++) {
            const uint32_t vertex = faces.corners[c];
            if (seen_in[vertex] != f + 1)
                distinct++;
            seen_in[vertex] = f + 1;
            if (!sources_.empty() && sources_.back() == vertex)
                continue;
            sources_.push_back(vertex);
            indices_.push_back(static_cast<uint32_t>(c));
        }
        while (sources_.size() > 1 && sources_.back() == sources_.front())
            sources_.pop_back();
        indices_.resize(sources_.size());
        if (distinct < 3)
            degenerate++;
        else
            add_face(distinct == sources_.size());
    }
    return degenerate;
}

ffd_status check(const mesh_faces &faces, ffd_error *error)
{
    const size_t corners = faces.face_count ? faces.start[faces.face_count] : 0;
    if (corners > most_corners)
        return ffd_fail(error, FFD_E_LIMIT, "%zu corners of faces are more than the limit of %zu", corners,
                        most_corners);
    for (size_t c = 0; c < corners; c++)
        if (faces.corners[c] >= faces.vertex_count)
            return ffd_fail(error, FFD_E_ARGUMENT, "a face names vertex %lu of %zu",
                            static_cast<unsigned long>(faces.corners[c]), faces.vertex_count);
    return FFD_OK;
}

} // namespace ffd_openmesh
