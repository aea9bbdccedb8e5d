#include "io/openmesh/topology.h"
#include "base/memory.h"
/* OpenMesh's vectors begin unset, and gcc sees them copied into new vertices before they get their value. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include <algorithm>
#include <climits>
#include <new>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace
{

/* Arrays whose memory comes from base/memory.h. */
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

/* Half-edges are numbered by int, and a corner makes two at most. */
const size_t most_corners = INT_MAX / 2;

/* add_face walks round each corner's vertex: a hub of a million faces would take their square. A vertex with
   this many faces hands over to a copy of itself. */
const unsigned most_faces_of_vertex = 64;

/* The faces as half-edges. Vertices are made when a face first needs them and know their number in the file,
   their source; where half-edges cannot express what the file has, a source has several vertices. */
class surface
{
  public:
    explicit surface(const mesh_faces &faces);

    /* corners: at least 3, no neighbours equal; simple: all different. */
    void add_face(const array<uint32_t> &corners, bool simple);

    uint32_t source(vertex_handle vertex) const { return mesh.property(source_, vertex); }
    bool has_copies(uint32_t vertex) const { return vertices_of_[vertex] > 1; }

    half_edge_mesh mesh;

  private:
    vertex_handle new_vertex(uint32_t source);
    bool fits() const;
    bool closes_fan(halfedge_handle previous, halfedge_handle next) const;

    const double *positions_;
    OpenMesh::VPropHandleT<uint32_t> source_;
    OpenMesh::VPropHandleT<unsigned> faces_of_;
    array<vertex_handle> current_;     /* of each source, what the next face joins; may be invalid */
    array<unsigned char> vertices_of_; /* of each source: 0, 1, or 2 for more */
    array<vertex_handle> handles_;     /* of the face being added */
};

surface::surface(const mesh_faces &faces)
    : positions_(faces.positions), current_(faces.vertex_count), vertices_of_(faces.vertex_count)
{
    mesh.add_property(source_);
    mesh.add_property(faces_of_);
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
   bound while other fans stand in its gap. */
bool surface::closes_fan(halfedge_handle previous, halfedge_handle next) const
{
    halfedge_handle incoming = mesh.opposite_halfedge_handle(next);
    while (!mesh.is_boundary(incoming))
        incoming = mesh.opposite_halfedge_handle(mesh.next_halfedge_handle(incoming));
    return incoming == previous && mesh.next_halfedge_handle(previous) != next;
}

/* Whether add_face will take the face of handles_. It would find out itself, but says so on a stream that
   belongs to the whole process. */
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

void surface::add_face(const array<uint32_t> &corners, bool simple)
{
    const size_t count = corners.size();
    handles_.resize(count);
    for (size_t i = 0; simple && i < count; i++) {
        vertex_handle &vertex = current_[corners[i]];
        if (!vertex.is_valid())
            vertex = new_vertex(corners[i]);
        handles_[i] = vertex;
    }
    if (!simple || !fits())
        for (size_t i = 0; i < count; i++)
            handles_[i] = new_vertex(corners[i]);
    if (!mesh.add_face(handles_.data(), count).is_valid())
        throw std::logic_error("a face does not fit");
    for (size_t i = 0; i < count; i++)
        if (++mesh.property(faces_of_, handles_[i]) >= most_faces_of_vertex)
            current_[corners[i]] = vertex_handle();
}

/* Adds all faces with at least three different corners; returns how many have not. */
size_t add_faces(const mesh_faces &faces, surface &s)
{
    array<size_t> seen_in(faces.vertex_count); /* the last face with the vertex, from 1 */
    array<uint32_t> corners;
    size_t degenerate = 0;
    for (size_t f = 0; f < faces.face_count; f++) {
        size_t distinct = 0;
        corners.clear();
        for (size_t c = faces.start[f]; c < faces.start[f + 1]; c++) {
            const uint32_t vertex = faces.corners[c];
            if (seen_in[vertex] != f + 1)
                distinct++;
            seen_in[vertex] = f + 1;
            if (corners.empty() || corners.back() != vertex)
                corners.push_back(vertex);
        }
        while (corners.size() > 1 && corners.back() == corners.front())
            corners.pop_back();
        if (distinct < 3)
            degenerate++;
        else
            s.add_face(corners, distinct == corners.size());
    }
    return degenerate;
}

/* The edges of the file: those of the half-edge mesh, where edges between copies of the same two sources are
 * one. */
struct source_edges {
    array<uint32_t> number; /* of each edge of the half-edge mesh */
    size_t count = 0;

    explicit source_edges(const surface &s);
};

source_edges::source_edges(const surface &s) : number(s.mesh.n_edges())
{
    typedef std::tuple<uint32_t, uint32_t, uint32_t> seam; /* lower source, higher source, edge */
    array<seam> seams;
    for (size_t e = 0; e < number.size(); e++) {
        const halfedge_handle half =
            s.mesh.halfedge_handle(half_edge_mesh::EdgeHandle(static_cast<int>(e)), 0);
        const uint32_t a = s.source(s.mesh.from_vertex_handle(half)),
                       b = s.source(s.mesh.to_vertex_handle(half));
        if (s.has_copies(a) || s.has_copies(b))
            seams.emplace_back(std::min(a, b), std::max(a, b), static_cast<uint32_t>(e));
        else
            number[e] = static_cast<uint32_t>(count++);
    }
    std::sort(seams.begin(), seams.end());
    for (size_t i = 0; i < seams.size(); i++) {
        const bool same = i > 0 && std::get<0>(seams[i]) == std::get<0>(seams[i - 1]) &&
                          std::get<1>(seams[i]) == std::get<1>(seams[i - 1]);
        number[std::get<2>(seams[i])] = static_cast<uint32_t>(same ? count - 1 : count++);
    }
}

/* Sets that are joined (Tarjan; path halving). */
class disjoint_sets
{
  public:
    explicit disjoint_sets(size_t count) : parent_(count)
    {
        for (size_t i = 0; i < count; i++)
            parent_[i] = static_cast<uint32_t>(i);
    }
    uint32_t find(uint32_t i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /* 1 when a and b were in different sets, else 0. */
    size_t join(uint32_t a, uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

  private:
    array<uint32_t> parent_;
};

/* What the faces say of each edge. An edge e has two ends, 2e at its lower vertex and 2e+1 at its higher one;
   two ends at a vertex are in one set when they bound the same fan of faces. */
struct edge_uses {
    array<uint32_t> faces, upward; /* faces along each edge; those from its lower to its higher vertex */
    array<uint32_t> vertex;        /* of each end */
    disjoint_sets fans;            /* of ends */

    explicit edge_uses(size_t edges) : faces(edges), upward(edges), vertex(2 * edges), fans(2 * edges) {}
    bool is_boundary(size_t edge) const { return faces[edge] == 1; }
    bool is_manifold(size_t edge) const
    {
        return faces[edge] == 1 || (faces[edge] == 2 && upward[edge] == 1);
    }
};

void use_edges(const surface &s, const source_edges &edges, edge_uses &uses)
{
    const half_edge_mesh &mesh = s.mesh;
    for (size_t h = 0; h < mesh.n_halfedges(); h++) {
        const halfedge_handle half(static_cast<int>(h));
        if (mesh.is_boundary(half))
            continue;
        const halfedge_handle after = mesh.next_halfedge_handle(half);
        const uint32_t from = s.source(mesh.from_vertex_handle(half));
        const uint32_t to = s.source(mesh.to_vertex_handle(half));
        const uint32_t beyond = s.source(mesh.to_vertex_handle(after));
        const uint32_t edge = edges.number[static_cast<size_t>(mesh.edge_handle(half).idx())];
        const uint32_t next_edge = edges.number[static_cast<size_t>(mesh.edge_handle(after).idx())];
        uses.faces[edge]++;
        uses.upward[edge] += from < to;
        uses.vertex[2 * edge] = std::min(from, to);
        uses.vertex[2 * edge + 1] = std::max(from, to);
        uses.fans.join(2 * edge + (to > from), 2 * next_edge + (to > beyond));
    }
}

/* Half the sum of the cross products of neighbouring corners, taken from the first: Newell's vector. */
double face_area(const half_edge_mesh &mesh, half_edge_mesh::FaceHandle face)
{
    const halfedge_handle first = mesh.halfedge_handle(face);
    const OpenMesh::Vec3d origin = mesh.point(mesh.from_vertex_handle(first));
    OpenMesh::Vec3d sum(0, 0, 0);
    halfedge_handle half = first;
    do {
        const OpenMesh::Vec3d a = mesh.point(mesh.from_vertex_handle(half)) - origin;
        const OpenMesh::Vec3d b = mesh.point(mesh.to_vertex_handle(half)) - origin;
        sum += OpenMesh::cross(a, b);
        half = mesh.next_halfedge_handle(half);
    } while (half != first);
    return sum.norm() / 2;
}

void count_edges(const edge_uses &uses, mesh_topology &topology)
{
    const size_t vertices = topology.vertices;
    disjoint_sets connected(vertices), rims(vertices);
    array<unsigned char> has_edge(vertices), on_rim(vertices);
    for (size_t e = 0; e < topology.edges; e++) {
        const uint32_t a = uses.vertex[2 * e], b = uses.vertex[2 * e + 1];
        has_edge[a] = has_edge[b] = 1;
        topology.components -= connected.join(a, b);
        if (!uses.is_manifold(e))
            topology.non_manifold_edges++;
        if (!uses.is_boundary(e))
            continue;
        on_rim[a] = on_rim[b] = 1;
        topology.boundary_edges++;
        topology.boundary_loops -= rims.join(a, b);
    }
    for (size_t v = 0; v < vertices; v++) {
        topology.isolated_vertices += !has_edge[v];
        topology.components += has_edge[v];
        topology.boundary_loops += on_rim[v];
    }
}

/* A vertex is manifold when the edges at it form one fan and each of them has two faces at most. */
void count_vertices(edge_uses &uses, mesh_topology &topology)
{
    array<unsigned char> fans(topology.vertices); /* 0, 1, or 2 for more */
    for (size_t end = 0; end < 2 * topology.edges; end++) {
        unsigned char &fan_count = fans[uses.vertex[end]];
        if (uses.faces[end / 2] > 2)
            fan_count = 2;
        else if (uses.fans.find(static_cast<uint32_t>(end)) == end && fan_count < 2)
            fan_count++;
    }
    for (size_t v = 0; v < topology.vertices; v++)
        topology.non_manifold_vertices += fans[v] > 1;
}

mesh_topology compute(const mesh_faces &faces)
{
    mesh_topology topology = {};
    surface s(faces);
    topology.degenerate_faces = add_faces(faces, s);
    const source_edges edges(s);
    edge_uses uses(edges.count);
    use_edges(s, edges, uses);

    topology.vertices = faces.vertex_count;
    topology.faces = s.mesh.n_faces();
    topology.edges = edges.count;
    count_edges(uses, topology);
    count_vertices(uses, topology);
    topology.euler = static_cast<long long>(topology.vertices - topology.isolated_vertices) -
                     static_cast<long long>(topology.edges) + static_cast<long long>(topology.faces);
    for (size_t f = 0; f < topology.faces; f++)
        topology.area += face_area(s.mesh, half_edge_mesh::FaceHandle(static_cast<int>(f)));
    return topology;
}

ffd_status check(const mesh_faces &faces, ffd_error *error)
{
    const size_t corners = faces.face_count ? faces.start[faces.face_count] : 0;
    if (corners > most_corners)
        return ffd_fail(error, FFD_E_LIMIT,
                        "%zu corners of faces are more than the %zu that topology is made for", corners,
                        most_corners);
    for (size_t c = 0; c < corners; c++)
        if (faces.corners[c] >= faces.vertex_count)
            return ffd_fail(error, FFD_E_ARGUMENT, "a face names vertex %lu of %zu",
                            static_cast<unsigned long>(faces.corners[c]), faces.vertex_count);
    return FFD_OK;
}

} // namespace

ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error)
{
    try {
        const ffd_status status = check(*faces, error);
        if (status == FFD_OK)
            *topology = compute(*faces);
        return status;
    } catch (const std::bad_alloc &) {
        return ffd_fail_memory(error);
    } catch (const std::length_error &) {
        return ffd_fail_memory(error);
    } catch (const std::exception &e) {
        return ffd_fail(error, FFD_E_LIMIT, "the topology cannot be computed: %s", e.what());
    } catch (...) {
        return ffd_fail(error, FFD_E_LIMIT, "the topology cannot be computed");
    }
}
