#include "lattice/border.h"
#include "base/vector/vec.h"
#include "spline/basis.h"
#include "spline/knots.h"
#include <float.h>
#include <math.h>

/* The control points of flat faces are in their plane to this multiple of eps. */
#define PLANE_ROUNDINGS 64

void ffd_border_face(const ffd_lattice *lattice, ffd_volume volume, int direction, int end, border_face *face)
{
    const knot_vector *knots = &lattice->knots[direction];
    const double u = end ? ffd_knots_last(knots) : ffd_knots_first(knots);
    const bool rest = volume == FFD_VOLUME_REST;
    *face = (border_face){.lattice = lattice,
                          .points = rest ? lattice->rest : lattice->deformed,
                          .weights = rest ? lattice->rest_weights : lattice->deformed_weights,
                          .direction = direction,
                          .span = ffd_knots_span(knots, u)};
    ffd_basis_values(knots, face->span, u, face->value);
}

void ffd_border_point(const border_face *face, const size_t index[3], const double origin[3], double point[4])
{
    const ffd_lattice *lattice = face->lattice;
    const int degree = lattice->knots[face->direction].degree;
    size_t at[3] = {index[0], index[1], index[2]};
    for (int c = 0; c < 4; c++)
        point[c] = 0;
    for (int i = 0; i <= degree; i++) {
        at[face->direction] = (size_t)(face->span - degree + i);
        const size_t flat = at[0] + lattice->size[0] * (at[1] + lattice->size[1] * at[2]);
        const double h = face->value[i] * (face->weights ? face->weights[flat] : 1);
        for (int a = 0; a < 3; a++)
            point[a] += h * (face->points[3 * flat + (size_t)a] - origin[a]);
        point[3] += h;
    }
}

static bool are_equal(const double a[4], const double b[4], const double tolerance[3])
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(a[c] / a[3] - b[c] / b[3]) <= tolerance[c]))
            return false;
    return true;
}

/* Returns whether the weights of a pair of points have the same ratio as those of earlier pairs; the first
   pair sets it. */
static bool is_in_ratio(const double a[4], const double b[4], double *ratio)
{
    if (*ratio == 0)
        *ratio = b[3] / a[3];
    return fabs(*ratio * a[3] - b[3]) <= 16 * DBL_EPSILON * b[3];
}

/* Sets the tolerance to eps times the magnitude of the control points, in the coordinates of the file. */
static void size_up(const ffd_lattice *lattice, const double *points, double eps, double tolerance[3])
{
    for (int a = 0; a < 3; a++) {
        double most = 0;
        for (size_t i = 0; i < lattice->count; i++)
            most = larger_of(most, fabs(points[3 * i + (size_t)a]));
        tolerance[a] = eps * DBL_EPSILON * most;
    }
}

/* Returns whether the first and the last face have the same control points within a tolerance of eps and, if
   weights is true, weights with a constant ratio. */
static bool faces_meet(const ffd_lattice *lattice, ffd_volume volume, int direction, double eps, bool weights)
{
    border_face first, last;
    double tolerance[3], a[4], b[4], ratio = 0;
    size_t index[3];
    ffd_border_face(lattice, volume, direction, 0, &first);
    ffd_border_face(lattice, volume, direction, 1, &last);
    size_up(lattice, first.points, eps, tolerance);
    const int across = (direction + 1) % 3, along = (direction + 2) % 3;
    index[direction] = 0;
    for (index[across] = 0; index[across] < lattice->size[across]; index[across]++)
        for (index[along] = 0; index[along] < lattice->size[along]; index[along]++) {
            ffd_border_point(&first, index, first.points, a);
            ffd_border_point(&last, index, first.points, b);
            if (!are_equal(a, b, tolerance) || (weights && !is_in_ratio(a, b, &ratio)))
                return false;
        }
    return true;
}

/* A plane: all p with normal . (p - point) = 0, to rounding. */
typedef struct plane {
    double point[3], normal[3], tolerance;
} plane;

static void face_corner(const border_face *face, bool across, bool along, double corner[3])
{
    const size_t *const size = face->lattice->size;
    const int a = (face->direction + 1) % 3, b = (face->direction + 2) % 3;
    size_t index[3] = {0, 0, 0};
    double point[4];
    index[a] = across ? size[a] - 1 : 0;
    index[b] = along ? size[b] - 1 : 0;
    ffd_border_point(face, index, face->points, point);
    for (int c = 0; c < 3; c++)
        corner[c] = point[c] / point[3];
}

/* Finds the plane through three corners of the control net of a face; positions are relative to the first
   control point. The normal is not a unit vector. */
static void plane_of(const border_face *face, plane *made)
{
    double first[3], second[3], most[3];
    face_corner(face, false, false, made->point);
    face_corner(face, true, false, first);
    face_corner(face, false, true, second);
    for (int c = 0; c < 3; c++) {
        first[c] -= made->point[c];
        second[c] -= made->point[c];
    }
    vec_cross(first, second, made->normal);
    size_up(face->lattice, face->points, PLANE_ROUNDINGS, most);
    made->tolerance = 0;
    for (int c = 0; c < 3; c++)
        made->tolerance += fabs(made->normal[c]) * most[c];
}

/* Returns whether the control points of a face are in the plane, and widens their bounds. */
static bool is_in_plane(const border_face *face, const plane *of, double lo[3], double hi[3])
{
    const size_t *const size = face->lattice->size;
    const int a = (face->direction + 1) % 3, b = (face->direction + 2) % 3;
    size_t index[3] = {0, 0, 0};
    for (index[a] = 0; index[a] < size[a]; index[a]++)
        for (index[b] = 0; index[b] < size[b]; index[b]++) {
            double point[4], off = 0;
            ffd_border_point(face, index, face->points, point);
            for (int c = 0; c < 3; c++) {
                point[c] /= point[3];
                off += of->normal[c] * (point[c] - of->point[c]);
                lo[c] = lesser_of(lo[c], point[c]);
                hi[c] = larger_of(hi[c], point[c]);
            }
            if (!(fabs(off) <= of->tolerance))
                return false;
        }
    return true;
}

/* Returns how fast the volume goes through the plane at the middle of its first or last face. */
static double speed_through(const ffd_lattice *lattice, const plane *of, int direction, int end)
{
    double uvw[3], point[3], jacobian[9], speed = 0;
    for (int a = 0; a < 3; a++)
        uvw[a] = 0.5 * ffd_knots_first(&lattice->knots[a]) + 0.5 * ffd_knots_last(&lattice->knots[a]);
    uvw[direction] =
        end ? ffd_knots_last(&lattice->knots[direction]) : ffd_knots_first(&lattice->knots[direction]);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    for (int c = 0; c < 3; c++)
        speed += of->normal[c] * jacobian[3 * c + direction];
    return speed;
}

/* Returns whether both faces are parts of one plane that overlap, and the volume goes on from the last one to
   the side to which it leaves the first one: a turn with faces of different radii or parameters. */
static bool faces_share_plane(const ffd_lattice *lattice, int direction)
{
    border_face first, last;
    plane of;
    double low[2][3], high[2][3], most[3];
    ffd_border_face(lattice, FFD_VOLUME_REST, direction, 0, &first);
    ffd_border_face(lattice, FFD_VOLUME_REST, direction, 1, &last);
    plane_of(&first, &of);
    size_up(lattice, first.points, PLANE_ROUNDINGS, most);
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++) {
            low[i][c] = HUGE_VAL;
            high[i][c] = -HUGE_VAL;
        }
    if (!(vec_length(of.normal) > 0) || !is_in_plane(&last, &of, low[1], high[1]) ||
        !is_in_plane(&first, &of, low[0], high[0]))
        return false;
    for (int c = 0; c < 3; c++)
        if (low[0][c] > high[1][c] + most[c] || low[1][c] > high[0][c] + most[c])
            return false;
    return speed_through(lattice, &of, direction, 0) * speed_through(lattice, &of, direction, 1) > 0;
}

bool ffd_lattice_is_seam(const ffd_lattice *lattice, int direction)
{
    return !ffd_knots_closed(&lattice->knots[direction]) &&
           (faces_meet(lattice, FFD_VOLUME_REST, direction, 16, false) ||
            faces_share_plane(lattice, direction));
}

bool ffd_lattice_opens_seam(const ffd_lattice *lattice, int direction)
{
    return !faces_meet(lattice, FFD_VOLUME_DEFORMED, direction, 64, true);
}

/* Returns whether the row of control points of a face through index, in a direction, is one point. */
static bool is_one_point(const border_face *face, int along, size_t index[3], const double tolerance[3])
{
    double first[4], point[4];
    index[along] = 0;
    ffd_border_point(face, index, face->points, first);
    for (index[along] = 1; index[along] < face->lattice->size[along]; index[along]++) {
        ffd_border_point(face, index, face->points, point);
        if (!are_equal(first, point, tolerance))
            return false;
    }
    return true;
}

/* The largest coordinates' rounding, at rest and deformed: how far points may be apart that are one. */
typedef struct point_tolerance {
    double rest[3], deformed[3];
} point_tolerance;

/* Returns whether some row of a face in a direction is one point at rest and several deformed. */
static bool opens_row(const ffd_lattice *lattice, int direction, int end, int along,
                      const point_tolerance *tolerance)
{
    const int other = 3 - direction - along;
    border_face rest, deformed;
    size_t index[3] = {0, 0, 0};
    ffd_border_face(lattice, FFD_VOLUME_REST, direction, end, &rest);
    ffd_border_face(lattice, FFD_VOLUME_DEFORMED, direction, end, &deformed);
    for (index[other] = 0; index[other] < lattice->size[other]; index[other]++)
        if (is_one_point(&rest, along, index, tolerance->rest) &&
            !is_one_point(&deformed, along, index, tolerance->deformed))
            return true;
    return false;
}

bool ffd_lattice_opens_axis(const ffd_lattice *lattice)
{
    point_tolerance tolerance;
    size_up(lattice, lattice->rest, 16, tolerance.rest);
    size_up(lattice, lattice->deformed, 64, tolerance.deformed);
    for (int direction = 0; direction < 3; direction++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&lattice->knots[direction]); end++)
            for (int along = 0; along < 3; along++)
                if (along != direction && opens_row(lattice, direction, end, along, &tolerance))
                    return true;
    return false;
}
