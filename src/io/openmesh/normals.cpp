#include "io/openmesh/normals.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "io/openmesh/surface.h"
#include "mesh/polygon.h"
#include <cfloat>
#include <cmath>

namespace
{

using namespace ffd_openmesh;

/* Returns the smallest power of two that is not less than any finite coordinate; 1 if all are 0. */
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

/* The terms of one face's corners. */
class face_terms
{
  public:
    face_terms(const mesh_faces &faces, const surface &s) : faces_(faces), surface_(s), unit_(unit_of(faces))
    {
    }

    /* Reads a face. Returns false if it contributes nothing. */
    bool read(half_edge_mesh::FaceHandle face);

    /* Values of the face read last. */
    size_t count() const { return indices_.size(); }
    uint32_t index(size_t i) const { return indices_[i]; }
    uint32_t vertex(size_t i) const { return vertices_[i]; }
    const double *unit_normal() const { return normal_; }
    /* Computes the term of a corner; returns its length. */
    double term(size_t i, double to[3]) const;

  private:
    const mesh_faces &faces_;
    const surface &surface_;
    const double unit_;
    array<uint32_t> indices_, vertices_;
    array<double> angles_;
    array<size_t> scratch_;
    double normal_[3];
    double vector_[3], length_ = 0; /* twice the area times the normal, in squared units */
};

/* The sum of a group so far. */
struct group_sum {
    double sum[3] = {0, 0, 0}, size = 0; /* of the terms; of their lengths */
    bool mixed = false;                  /* whether the faces have different normals */
};

bool face_terms::read(half_edge_mesh::FaceHandle face)
{
    const half_edge_mesh &mesh = surface_.mesh;
    const halfedge_handle first = mesh.halfedge_handle(face);
    double extent = 0;
    indices_.clear();
    vertices_.clear();
    halfedge_handle half = first;
    do {
        indices_.push_back(surface_.corner(half));
        vertices_.push_back(surface_.source(mesh.from_vertex_handle(half)));
        half = mesh.next_halfedge_handle(half);
    } while (half != first);
    if (!ffd_polygon_normal(faces_.positions, vertices_.data(), count(), vector_, &extent))
        return false;
    angles_.resize(count());
    scratch_.resize(count());
    ffd_polygon_angles(faces_.positions, vertices_.data(), count(), vector_, scratch_.data(), angles_.data());
    const double own_length = vec_length(vector_), scale = extent / unit_;
    for (int a = 0; a < 3; a++)
        normal_[a] = vector_[a] / own_length;
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

/* Adds a term to a group. direction: the common unit normal of the group's faces so far, valid until
   mixed. */
void add_term(group_sum &group, double sign, const double normal[3], const double term[3], double length,
              double direction[3])
{
    if (!(length > 0))
        return;
    for (int a = 0; a < 3; a++) {
        const double n = sign * normal[a] + 0.0; /* -0 becomes 0 */
        if (group.size > 0)
            group.mixed = group.mixed || n < direction[a] || n > direction[a];
        else
            direction[a] = n;
        group.sum[a] += sign * term[a];
    }
    group.size += length;
}

/* Keeps the direction of a group whose faces have one normal: computed from the sum of terms of different
   lengths, it could differ in the last bit at each corner of the face. */
void finish_group(const group_sum &group, double direction[3])
{
    if (!group.mixed)
        return;
    const double length = vec_length(group.sum);
    const bool cancelled = !(length > 16 * DBL_EPSILON * group.size);
    for (int a = 0; a < 3; a++)
        direction[a] = cancelled ? 0 : group.sum[a] / length;
}

void find_directions(const mesh_faces &faces, const uint32_t *groups, size_t group_count,
                     const uint8_t *mirrored, double *directions)
{
    surface s(faces);
    s.add_faces(faces);
    face_terms terms(faces, s);
    array<group_sum> sums(group_count);
    for (size_t f = 0; f < s.mesh.n_faces() && !ffd_deadline_passed_at(f); f++) {
        if (!terms.read(half_edge_mesh::FaceHandle(static_cast<int>(f))))
            continue;
        for (size_t i = 0; i < terms.count(); i++) {
            const uint32_t group = groups[terms.index(i)];
            if (group == NORMALS_NONE)
                continue;
            double term[3];
            const double length = terms.term(i, term), sign = mirrored && mirrored[terms.vertex(i)] ? -1 : 1;
            add_term(sums[group], sign, terms.unit_normal(), term, length,
                     directions + 3 * static_cast<size_t>(group));
        }
    }
    for (size_t g = 0; g < group_count; g++)
        finish_group(sums[g], directions + 3 * g);
}

} // namespace

ffd_status ffd_normals_of_groups(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                                 size_t group_count, const uint8_t *mirrored, double *directions,
                                 ffd_error *error)
{
    return guarded(
        [&] {
            mesh_faces placed = *faces;
            placed.positions = const_cast<double *>(positions); /* only read */
            const ffd_status status = check(placed, error);
            if (status != FFD_OK)
                return status;
            find_directions(placed, groups, group_count, mirrored, directions);
            return ffd_deadline_check(error);
        },
        "the normals", error);
}
