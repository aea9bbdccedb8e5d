#include "embed/cells/tolerance_image.h"
#include "base/vector/vec.h"
#include "embed/cells/region_root.h"
#include "embed/frame/face.h"
#include "embed/frame/slabs.h"
#include <float.h>
#include <string.h>

/* An error of a few roundings, relative to the sum of magnitudes. */
#define ROUNDINGS (16 * DBL_EPSILON)
/* The rounding of F and of the coefficients of J_F, in units of the aim, 16 eps, times the square of the
   degree: 146 halvings round by 73 eps times the degree, a difference of coefficients is multiplied by the
   degree, and there are 3 columns. */
#define COEFFICIENTS 16
/* The most steps towards a root; each makes the error smaller. */
#define FIND_STEPS 8

/* Planes */

typedef struct tolerance_image {
    const double *inverse; /* Y; its columns are the edges of the image */
    double jacobian[9];    /* the inverse of Y; its rows are normal to the faces of the image */
    double equation[3];    /* F at the centre of the region */
    double allowance[3];   /* of F at a root, with its rounding */
    double change[3];      /* of each row of J_F over the region: the sum of those of its entries */
    double bound;          /* L */
    double rounding;       /* of L, and of Y times the Jacobian */
    double half;           /* half a side of the region, and the rounding of u,v,w */
} tolerance_image;

/* Returns the rounding of F in a region, in units of the aim. */
static double rounding_of(const point_search *search)
{
    const int *const order = search->locator->cells->order;
    int degree = 0;
    for (int a = 0; a < 3; a++)
        degree = order[a] - 1 > degree ? order[a] - 1 : degree;
    return COEFFICIENTS * degree * degree;
}

/* Finds how far the derivatives of F over the box can be from those of the image, from their Bernstein
   coefficients. */
static void find_change(const bezier_box *box, const double x[3], tolerance_image *image)
{
    const size_t count = ffd_bezier_count(box->order);
    memset(image->change, 0, sizeof image->change);
    for (int a = 0; a < 3; a++) {
        const size_t stride = ffd_bezier_stride(box->order, a), order = (size_t)box->order[a];
        double most[3] = {0, 0, 0};
        for (size_t n = 0; n < count; n++) {
            const double *const low = box->coefficients + BEZIER_COMPONENTS * n;
            const double *const high = low + BEZIER_COMPONENTS * stride;
            for (int r = 0; r < 3 && n / stride % order < order - 1; r++) {
                const double slope = (double)(order - 1) * (high[r] - low[r] - (high[3] - low[3]) * x[r]);
                most[r] = larger_of(most[r], fabs(slope - image->jacobian[3 * r + a]));
            }
        }
        for (int r = 0; r < 3; r++)
            image->change[r] += most[r];
    }
}

/* Returns false if Y cannot be inverted: then the image has no shape to look at. */
static bool make_image(const point_search *search, const cell_region *region, const bezier_box *box,
                       tolerance_image *image)
{
    const double rounding = rounding_of(search);
    double most = 0;
    image->inverse = region->inverse;
    if (!mat_invert(region->inverse, image->jacobian))
        return false;
    for (int r = 0; r < 3; r++) {
        double size = 0;
        image->equation[r] = region->centre[r] - search->x[r] * region->centre[3];
        image->allowance[r] = region->greatest_weight * (search->tolerance[r] + rounding * search->aim[r]);
        for (int i = 0; i < 9; i++)
            size += fabs(region->inverse[3 * r + i / 3] * image->jacobian[i]);
        most = larger_of(most, size);
    }
    find_change(box, search->x, image);
    image->rounding = ROUNDINGS * most;
    image->half = 0.5 + 2 * region->grain;
    image->bound = region->bound;
    return true;
}

/* src/maths.md 6.5: for a root t with F(t) within the allowance, t - centre = Y (F(t) - F(centre)) + M (t -
   centre), where M is a mean of I - Y J. So for any n, |n . Y F(centre)| is at most |n . Y| allowance +
   (|n|_1 + |n . M|_1) / 2. |n . M|_1 is at most L |n|_1, and at most |n . Y| times the change of J, which is
   less for n across a long edge of the image. */
static void project_image(const tolerance_image *image, const double normal[3], tolerance_view *view)
{
    double off = 0, reach = 0, rounding = 0, bent = 0;
    const double length = fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2]);
    for (int r = 0; r < 3; r++) {
        double along = 0, size = 0;
        for (int a = 0; a < 3; a++) {
            const double term = normal[a] * image->inverse[3 * a + r];
            along += term;
            size += fabs(term);
        }
        off += along * image->equation[r];
        reach += fabs(along) * image->allowance[r];
        bent += fabs(along) * image->change[r];
        rounding += ROUNDINGS * size * (fabs(image->equation[r]) + image->allowance[r] + image->change[r]);
    }
    bent = lesser_of(bent, length * image->bound) + length * image->rounding;
    if (fabs(off) > reach + rounding + length * image->half + 0.5 * bent)
        view->misses = true;
    if (length > 0)
        view->blur = lesser_of(view->blur, 2 * reach / length);
}

/* The planes that can separate a cube and a parallelepiped (separating axis theorem): parallel to the faces
   of either, or to an edge of each. */
tolerance_view ffd_tolerance_view(const point_search *search, const cell_region *region,
                                  const bezier_box *box)
{
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tolerance_view view = {.blur = HUGE_VAL};
    tolerance_image image;
    if (!make_image(search, region, box, &image))
        return view;
    for (int a = 0; a < 3; a++) {
        project_image(&image, axes[a], &view);
        project_image(&image, image.jacobian + 3 * a, &view);
        for (int r = 0; r < 3; r++) {
            const double edge[3] = {image.inverse[r], image.inverse[3 + r], image.inverse[6 + r]};
            double normal[3];
            vec_cross(axes[a], edge, normal);
            project_image(&image, normal, &view);
        }
    }
    return view;
}

/* A point in both */

bool ffd_tolerance_find(point_search *search, const cell_region *region, double t[3], sample *at)
{
    for (int step = 0; step < FIND_STEPS; step++) {
        const step_box box = steps_in_unit_box(t);
        double allowed[3], d[3];
        ffd_search_evaluate_in(search, region, t, at);
        if (ffd_search_meets(search, region, t, at))
            return true;
        for (int a = 0; a < 3; a++)
            allowed[a] = at->weight * search->tolerance[a];
        if (!ffd_slabs_find(&box, at->equation, at->jacobian, allowed, d))
            return false;
        step_from(t, d, t);
    }
    return false;
}
