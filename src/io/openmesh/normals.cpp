#include "io/openmesh/normals.h"
#include "io/openmesh/surface.h"
#include "mesh/polygon.h"
#include <cmath>

namespace
{

using namespace ffd_openmesh;

/* The power of two that is not below any finite coordinate; 1 where all are 0. */
double unit_of(const mesh_faces &faces)
{
    double largest = 0;
    int exponent = 0;
    for (size_t i = 0; i < 3 * faces.vertex_count; i++)
        if (std::isfinite(faces.positions[i]))
            largest = std::fmax(largest, std::fabs(faces.positions[i]));
    std::frexp(largest, &exponent);
    return std::ldexp(1, exponent < 1000 ? exponent : 1000);
}

/* The corners of one face at a time. */
class face_terms
{
  public:
    face_terms(const mesh_faces &faces, const surface &s) : faces_(faces), surface_(s), unit_(unit_of(faces))
    {
    }

    /* False where the face adds nothing. */
    bool read(half_edge_mesh::FaceHandle face);

    /* Of the face read last. */
    size_t count() const { return numbers_.size(); }
    uint32_t number(size_t i) const { return numbers_[i]; }
    uint32_t vertex(size_t i) const { return vertices_[i]; }
    /* The term of a corner; returns its length. */
    double term(size_t i, double to[3]) const;

  private:
    const mesh_faces &faces_;
    const surface &surface_;
    const double unit_;
    array<uint32_t> numbers_, vertices_;
    array<double> angles_;
    array<size_t> scratch_;
    double vector_[3], length_ = 0; /* twice the area along the normal, in units */
};

bool face_terms::read(half_edge_mesh::FaceHandle face)
{
    const half_edge_mesh &mesh = surface_.mesh;
    const halfedge_handle first = mesh.halfedge_handle(face);
    double extent = 0;
    numbers_.clear();
    vertices_.clear();
    halfedge_handle half = first;
    do {
        numbers_.push_back(surface_.corner(half));
        vertices_.push_back(surface_.source(mesh.from_vertex_handle(half)));
        half = mesh.next_halfedge_handle(half);
    } while (half != first);
    if (!ffd_polygon_normal(faces_.positions, vertices_.data(), count(), vector_, &extent))
        return false;
    angles_.resize(count());
    scratch_.resize(count());
    ffd_polygon_angles(faces_.positions, vertices_.data(), count(), vector_, scratch_.data(), angles_.data());
    const double scale = extent / unit_;
    for (double &v : vector_)
        v *= scale * scale;
    length_ = std::sqrt(vector_[0] * vector_[0] + vector_[1] * vector_[1] + vector_[2] * vector_[2]);
    return true;
}

double face_terms::term(size_t i, double to[3]) const
{
    const double weight = 0.5 * angles_[i];
    for (int a = 0; a < 3; a++)
        to[a] = weight * vector_[a];
    return weight * length_;
}

void sum_all(const mesh_faces &faces, const uint32_t *groups, const uint8_t *mirrored, double *sums,
             double *sizes)
{
    surface s(faces);
    s.add_faces(faces);
    face_terms terms(faces, s);
    for (size_t f = 0; f < s.mesh.n_faces(); f++) {
        if (!terms.read(half_edge_mesh::FaceHandle(static_cast<int>(f))))
            continue;
        for (size_t i = 0; i < terms.count(); i++) {
            const uint32_t group = groups[terms.number(i)];
            if (group == NORMALS_NONE)
                continue;
            double term[3];
            sizes[group] += terms.term(i, term);
            const double sign = mirrored && mirrored[terms.vertex(i)] ? -1 : 1;
            for (size_t a = 0; a < 3; a++)
                sums[3 * static_cast<size_t>(group) + a] += sign * term[a];
        }
    }
}

} // namespace

ffd_status ffd_normals_sum(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                           const uint8_t *mirrored, double *sums, double *sizes, ffd_error *error)
{
    return guarded(
        [&] {
            mesh_faces placed = *faces;
            placed.positions = const_cast<double *>(positions); /* read only */
            const ffd_status status = check(placed, error);
            if (status == FFD_OK)
                sum_all(placed, groups, mirrored, sums, sizes);
            return status;
        },
        "the normals", error);
}
