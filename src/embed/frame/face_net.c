#include "embed/frame/face_net.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "lattice/border.h"
#include <math.h>

enum { N = BEZIER_COMPONENTS };

static int exponent_of(double size)
{
    int exponent = 0;
    if (size > 0)
        frexp(size, &exponent);
    return exponent;
}

void ffd_face_scale_find(const ffd_lattice *lattice, face_scale *scale)
{
    double greatest = 0;
    for (int r = 0; r < 3; r++) {
        double lo = lattice->rest[r], hi = lo;
        for (size_t i = 0; i < lattice->count; i++) {
            lo = minimum_number(lo, lattice->rest[3 * i + (size_t)r]);
            hi = maximum_number(hi, lattice->rest[3 * i + (size_t)r]);
        }
        scale->origin[r] = 0.5 * lo + 0.5 * hi;
        scale->exponent[r] = exponent_of(maximum_number(hi - scale->origin[r], scale->origin[r] - lo));
    }
    for (size_t i = 0; lattice->rest_weights && i < lattice->count; i++)
        greatest = maximum_number(greatest, lattice->rest_weights[i]);
    scale->exponent[3] = exponent_of(greatest);
}

ffd_status ffd_face_net_create(const ffd_lattice *lattice, int a, face_net *net, ffd_error *error)
{
    *net = (face_net){.lattice = lattice, .a = a, .b = (a + 1) % 3, .c = (a + 2) % 3};
    net->count_b = lattice->knots[net->b].functions;
    net->count_c = lattice->knots[net->c].functions;
    /* The number of functions in two directions is at most (points + degree) each. */
    net->points = ffd_alloc(net->count_b * net->count_c, N * sizeof(double));
    return net->points ? FFD_OK : ffd_fail_memory(error);
}

void ffd_face_net_free(face_net *net)
{
    ffd_free(net->points);
    net->points = NULL;
}

void ffd_face_net_fill(face_net *net, const face_scale *scale, int end)
{
    const ffd_lattice *lattice = net->lattice;
    border_face face;
    double *point = net->points;
    size_t index[3] = {0, 0, 0};
    ffd_border_face(lattice, FFD_VOLUME_REST, net->a, end, &face);
    for (int r = 0; r < N; r++)
        net->extent[r] = 0;
    for (size_t k = 0; k < net->count_c; k++)
        for (size_t j = 0; j < net->count_b; j++, point += N) {
            index[net->b] = ffd_knots_point(&lattice->knots[net->b], j);
            index[net->c] = ffd_knots_point(&lattice->knots[net->c], k);
            ffd_border_point(&face, index, scale->origin, point);
            for (int r = 0; r < N; r++) {
                /* In two steps, because the power of two may be out of range. */
                point[r] = ldexp(point[r], -scale->exponent[r]);
                if (r < 3)
                    point[r] = ldexp(point[r], lattice->rest_weights ? -scale->exponent[3] : 0);
                net->extent[r] = maximum_number(net->extent[r], fabs(point[r]));
            }
        }
}

void ffd_face_net_cell(const face_net *net, double *const extraction[3], size_t cell_b, size_t cell_c,
                       bezier_box *box)
{
    static const double one = 1;
    const knot_vector *knots = net->lattice->knots;
    const int order_b = knots[net->b].degree + 1, order_c = knots[net->c].degree + 1;
    const size_t first_b = (size_t)(knots[net->b].spans[cell_b] - order_b + 1);
    const size_t first_c = (size_t)(knots[net->c].spans[cell_c] - order_c + 1);
    const double *matrix[3] = {extraction[net->b] + cell_b * (size_t)order_b * (size_t)order_b,
                               extraction[net->c] + cell_c * (size_t)order_c * (size_t)order_c, &one};
    double *to = box->coefficients;
    box->rational = net->lattice->rest_weights != NULL;
    box->order[0] = order_b;
    box->order[1] = order_c;
    box->order[2] = 1;
    for (int k = 0; k < order_c; k++)
        for (int j = 0; j < order_b; j++, to += N)
            for (int r = 0; r < N; r++)
                to[r] =
                    net->points[N * (first_b + (size_t)j + net->count_b * (first_c + (size_t)k)) + (size_t)r];
    ffd_bezier_extract(box, matrix);
}
