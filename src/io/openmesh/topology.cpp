#include "io/openmesh/topology.h"
#include "base/system/deadline.h"
#include "io/openmesh/surface.h"
#include <algorithm>
#include <tuple>

namespace
{

using namespace ffd_openmesh;

/* The edges of the file. They are those of the half-edge mesh, except that edges between copies of the same
   two sources count as one. */
struct source_edges {
    array<uint32_t> index; /* per edge of the half-edge mesh */
    size_t count = 0;

    explicit source_edges(const surface &s);
};

source_edges::source_edges(const surface &s) : index(s.mesh.n_edges())
{
    typedef std::tuple<uint32_t, uint32_t, uint32_t> seam; /* lower source, higher source, edge */
    array<seam> seams;
    for (size_t e = 0; e < index.size(); e++) {
        const halfedge_handle half =
            s.mesh.halfedge_handle(half_edge_mesh::EdgeHandle(static_cast<int>(e)), 0);
        const uint32_t a = s.source(s.mesh.from_vertex_handle(half)),
                       b = s.source(s.mesh.to_vertex_handle(half));
        if (s.has_copies(a) || s.has_copies(b))
            seams.emplace_back(std::min(a, b), std::max(a, b), static_cast<uint32_t>(e));
        else
            index[e] = static_cast<uint32_t>(count++);
    }
    std::sort(seams.begin(), seams.end());
    for (size_t i = 0; i < seams.size(); i++) {
        const bool same = i > 0 && std::get<0>(seams[i]) == std::get<0>(seams[i - 1]) &&
                          std::get<1>(seams[i]) == std::get<1>(seams[i - 1]);
        index[std::get<2>(seams[i])] = static_cast<uint32_t>(same ? count - 1 : count++);
    }
}

/* Disjoint sets (Tarjan), with path halving. */
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
    /* Returns 1 if a and b were in different sets, else 0. */
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

/* The faces along each edge. Edge e has two ends: 2e at its lower vertex and 2e+1 at its higher one. Two ends
   at a vertex are in the same set if they bound the same fan of faces. */
struct edge_uses {
    /* Number of faces; of those, how many run from the lower to the higher vertex. */
    array<uint32_t> faces, upward;
    array<uint32_t> vertex; /* per end */
    disjoint_sets fans;     /* sets of ends */

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
        const uint32_t edge = edges.index[static_cast<size_t>(mesh.edge_handle(half).idx())];
        const uint32_t next_edge = edges.index[static_cast<size_t>(mesh.edge_handle(after).idx())];
        uses.faces[edge]++;
        uses.upward[edge] += from < to;
        uses.vertex[2 * edge] = std::min(from, to);
        uses.vertex[2 * edge + 1] = std::max(from, to);
        uses.fans.join(2 * edge + (to > from), 2 * next_edge + (to > beyond));
    }
}

/* The length of Newell's vector: half the sum of the cross products of neighbouring corners, relative to the
   first corner. */
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

/* A vertex is manifold if the edges at it form one fan and none of them has more than two faces. */
void count_vertices(edge_uses &uses, mesh_topology &topology)
{
    array<unsigned char> fans(topology.vertices); /* per vertex: 0, 1, or 2 for more */
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
    topology.degenerate_faces = s.add_faces(faces);
    const source_edges edges(s);
    edge_uses uses(edges.count);
    use_edges(s, edges, uses);

    topology.vertices = faces.vertex_count;
    topology.faces = s.mesh.n_faces();
    topology.edges = edges.count;
    count_edges(uses, topology);
    count_vertices(uses, topology);
    topology.vertices -= faces.repeated;
    topology.isolated_vertices -= faces.repeated;
    topology.euler = static_cast<long long>(topology.vertices - topology.isolated_vertices) -
                     static_cast<long long>(topology.edges) + static_cast<long long>(topology.faces);
    for (size_t f = 0; f < topology.faces; f++)
        topology.area += face_area(s.mesh, half_edge_mesh::FaceHandle(static_cast<int>(f)));
    return topology;
}

} // namespace

ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error)
{
    return guarded(
        [&] {
            const ffd_status status = check(*faces, error);
            if (status != FFD_OK)
                return status;
            *topology = compute(*faces);
            return ffd_deadline_check(error);
        },
        "the topology", error);
}
