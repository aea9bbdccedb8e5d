/* shape_judge.c - see shape_judge.h. */
#include "shape_judge.h"
#include "embed/locator.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Beyond these a root's status may depend on rounding: det J against the largest one, and how far rounding
   moves u,v,w, as parts of the domain. */
static const long double least_det = 1e-5L, most_reach = 1e-4L;

static long double length_of(const oracle_axis *axis)
{
    return oracle_last(axis) - oracle_first(axis);
}

/* The largest and the summed det J over a grid of up to 12 parameters a direction. */
static void survey(judge *j)
{
    int steps[3], i[3];
    long double sum = 0;
    for (int a = 0; a < 3; a++)
        steps[a] = j->volume.axis[a].n < 6 ? 2 * j->volume.axis[a].n : 12;
    for (i[2] = 0; i[2] < steps[2]; i[2]++)
        for (i[1] = 0; i[1] < steps[1]; i[1]++)
            for (i[0] = 0; i[0] < steps[0]; i[0]++) {
                long double uvw[3], point[3], jacobian[9];
                for (int a = 0; a < 3; a++)
                    uvw[a] = oracle_first(&j->volume.axis[a]) +
                             length_of(&j->volume.axis[a]) * (i[a] + 0.5L) / steps[a];
                oracle_evaluate(&j->volume, uvw, point, jacobian);
                const long double det = oracle_determinant(jacobian);
                j->most_det = fmaxl(j->most_det, fabsl(det));
                sum += det;
            }
    j->sign = sum < 0 ? -1 : 1;
}

bool judge_open(judge *j, trial *t, sample *s)
{
    ffd_error error = {.status = FFD_OK};
    *j = (judge){.t = t, .s = s};
    sample_write(s);
    j->lattice = trial_parse(t, s);
    if (!j->lattice)
        return false;
    const ffd_status status = ffd_locator_create(j->lattice, &j->locator, &error);
    trial_check(t, s, status == FFD_OK, "locator: %s %s", error.pointer, error.message);
    if (status != FFD_OK) {
        ffd_lattice_destroy(&j->lattice);
        return false;
    }
    j->volume = sample_volume(s, j->lattice, FFD_VOLUME_REST);
    for (size_t a = 0; a < 3; a++)
        j->origin[a] = j->volume.points[a];
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        j->volume.points[i] -= j->origin[i % 3];
    oracle_bounds(&j->volume, j->lo, j->hi);
    survey(j);
    return true;
}

void judge_close(judge *j)
{
    oracle_free(&j->volume);
    ffd_locator_destroy(&j->locator);
    ffd_lattice_destroy(&j->lattice);
}

static void add(judge *j, const long double local[3])
{
    for (int a = 0; a < 3; a++)
        j->xyz[3 * j->count + a] = (double)(j->origin[a] + local[a]);
    j->count++;
}

void judge_add_known(judge *j, const long double uvw[3])
{
    long double point[3];
    oracle_evaluate(&j->volume, uvw, point, NULL);
    add(j, point);
}

void judge_add_within(judge *j, draw *random)
{
    long double point[3];
    for (int a = 0; a < 3; a++)
        point[a] = j->lo[a] + (j->hi[a] - j->lo[a]) * (long double)draw_between(random, -0.1, 1.1);
    add(j, point);
}

void judge_add_near(judge *j, draw *random, const long double uvw[3], double distance)
{
    long double point[3];
    oracle_evaluate(&j->volume, uvw, point, NULL);
    for (int a = 0; a < 3; a++)
        point[a] += (j->hi[a] - j->lo[a]) * (long double)draw_between(random, -distance, distance);
    add(j, point);
}

void judge_add_far(judge *j, draw *random)
{
    long double point[3];
    const int far = draw_int(random, 0, 2);
    const double sign = random_chance(random, 0.5) ? -1 : 1;
    for (int a = 0; a < 3; a++) {
        const double part =
            a == far ? 0.5 + sign * pow(10, draw_between(random, 0, 30)) : draw_between(random, -0.5, 1.5);
        point[a] = j->lo[a] + (j->hi[a] - j->lo[a]) * (long double)part;
    }
    add(j, point);
}

bool judge_find(judge *j)
{
    ffd_error error = {.status = FFD_OK};
    const ffd_status status = ffd_locator_find(j->locator, j->xyz, (size_t)j->count, j->found, &error);
    trial_check(j->t, j->s, status == FFD_OK, "find: %s", error.message);
    for (int i = 0; status == FFD_OK && i < j->count; i++)
        j->seen[j->found[i].status]++;
    return status == FFD_OK;
}

static void seen_from_origin(const judge *j, int i, long double p[3])
{
    for (int a = 0; a < 3; a++)
        p[a] = j->xyz[3 * i + a] - j->origin[a];
}

/* src/maths.md 6.6: the largest is that of sizes as in the file; sizes from the middle of the control points
   give the least (of 16 eps 4 may be C's own rounding), at which a root is surely met. */
static void tolerances(const judge *j, const long double p[3], long double least[3], long double largest[3])
{
    for (int a = 0; a < 3; a++) {
        const long double extent = j->hi[a] - j->lo[a], middle = (j->lo[a] + j->hi[a]) / 2;
        const long double most = fmaxl(fabsl(j->origin[a] + j->lo[a]), fabsl(j->origin[a] + j->hi[a]));
        least[a] = 12 * DBL_EPSILON * (extent / 2 + fabsl(p[a] - middle));
        largest[a] = 16 * DBL_EPSILON * (most + fabsl(p[a] + j->origin[a]));
    }
}

/* A point of the domain and what is known of C there. */
typedef struct domain_point {
    long double uvw[3], reach[3]; /* how far rounding moves u,v,w */
    long double det;              /* against the largest */
    bool sure, maybe, regular;
} domain_point;

static void examine(const judge *j, const long double p[3], domain_point *x)
{
    long double point[3], jacobian[9], inverse[9], least[3], largest[3];
    tolerances(j, p, least, largest);
    oracle_evaluate(&j->volume, x->uvw, point, jacobian);
    x->sure = x->maybe = true;
    for (int a = 0; a < 3; a++) {
        const long double residual = fabsl(point[a] - p[a]);
        x->sure = x->sure && residual <= least[a];
        x->maybe = x->maybe && residual <= 100 * largest[a];
    }
    const bool invertible = oracle_invert(jacobian, inverse);
    x->det = oracle_determinant(jacobian) / j->most_det;
    x->regular = invertible && fabsl(x->det) >= least_det;
    for (int a = 0; a < 3; a++) {
        x->reach[a] = 0;
        for (int b = 0; invertible && b < 3; b++)
            x->reach[a] += fabsl(inverse[3 * a + b]) * largest[b];
        x->regular = x->regular && x->reach[a] <= most_reach * length_of(&j->volume.axis[a]);
    }
}

/* In each direction that does not collapse, by itself. */
static void reach_of_singular(const judge *j, const long double p[3], domain_point *x)
{
    long double point[3], jacobian[9], least[3], largest[3];
    tolerances(j, p, least, largest);
    oracle_evaluate(&j->volume, x->uvw, point, jacobian);
    for (int a = 0; a < 3; a++) {
        long double length2 = 0, tolerance = 0;
        for (int b = 0; b < 3; b++) {
            length2 += jacobian[3 * b + a] * jacobian[3 * b + a];
            tolerance += fabsl(jacobian[3 * b + a]) * largest[b];
        }
        x->reach[a] = length2 > 0 ? tolerance / length2 : 0;
    }
}

static long double allowed(const judge *j, const domain_point *x, int a)
{
    return fmaxl(1e-12L * length_of(&j->volume.axis[a]), 4 * x->reach[a]);
}

static bool same_root(const judge *j, const domain_point *x, const long double uvw[3], long double factor)
{
    bool same = true;
    for (int a = 0; a < 3; a++)
        same = same && oracle_distance(&j->volume.axis[a], x->uvw[a], uvw[a]) <= factor * allowed(j, x, a);
    return same;
}

/* All that may be roots of point i, each once. */
static int all_roots(const judge *j, const long double p[3], domain_point candidates[ORACLE_MAX_ROOTS])
{
    long double roots[ORACLE_MAX_ROOTS][3];
    long double least[3], largest[3], accept = 1e-10L;
    tolerances(j, p, least, largest);
    for (int a = 0; a < 3; a++)
        accept = fmaxl(accept, 2 * largest[a] / (j->hi[a] - j->lo[a]));
    const int found = oracle_find_all(&j->volume, p, accept, roots);
    int count = 0;
    for (int k = 0; k < found; k++) {
        domain_point x = {.sure = false};
        bool known = false;
        oracle_descend(&j->volume, p, roots[k]);
        memcpy(x.uvw, roots[k], sizeof x.uvw);
        examine(j, p, &x);
        for (int i = 0; i < count; i++)
            known = known || same_root(j, &candidates[i], x.uvw, 100);
        if (x.maybe && !known)
            candidates[count++] = x;
    }
    return count;
}

static const char *status_name(int status)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    return status >= 0 && status < FFD_VERTEX_STATUS_COUNT ? names[status] : "?";
}

/* -1 where a surely comes before b in the order of u, v, w, 1 after it, 0 where rounding decides. Equal to
   1e-9 of the domain is equal. */
static int order_of(const judge *j, const domain_point *a, const domain_point *b)
{
    for (int c = 0; c < 3; c++) {
        const oracle_axis *axis = &j->volume.axis[c];
        const long double equal = 1e-9L * length_of(axis), rounding = allowed(j, a, c) + allowed(j, b, c);
        const long double ahead = b->uvw[c] - a->uvw[c];
        if (fabsl(ahead) > equal + rounding)
            return ahead > 0 ? -1 : 1;
        if (fabsl(ahead) > equal - rounding)
            return 0;
    }
    return 0;
}

/* Whether the tie rule may choose candidates[k]. */
static bool may_be_chosen(const judge *j, const domain_point *candidates, int count, int k)
{
    bool right = false;
    for (int i = 0; i < count; i++)
        right = right || candidates[i].det * j->sign > 0;
    if (right && candidates[k].det * j->sign < 0)
        return false;
    for (int i = 0; i < count; i++)
        if ((!right || candidates[i].det * j->sign > 0) && order_of(j, &candidates[i], &candidates[k]) < 0)
            return false;
    return true;
}

/* What u is rounded by, from the start of its cell and in the file. */
static long double grain_of(const oracle_axis *axis, long double u)
{
    return DBL_EPSILON * (length_of(axis) + fabsl(u) / 2);
}

/* What is owed of every u,v,w found: in the domain, the residual within the tolerance and as reported. */
static void check_found(judge *j, int i)
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    long double uvw[3], q[3], point[3], jacobian[9], least[3], largest[3], length2 = 0, tolerance2 = 0;
    seen_from_origin(j, i, q);
    tolerances(j, q, least, largest);
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &j->volume.axis[a];
        trial_check(j->t, j->s,
                    found->uvw[a] >= (double)oracle_first(axis) && found->uvw[a] <= (double)oracle_last(axis),
                    "point %.17g %.17g %.17g: %c = %.17g is not in the domain", p[0], p[1], p[2], "uvw"[a],
                    found -> uvw[a]);
        uvw[a] = oracle_wrap(axis, found->uvw[a]);
    }
    oracle_evaluate(&j->volume, uvw, point, jacobian);
    for (int a = 0; a < 3; a++) {
        const long double residual = fabsl(point[a] - q[a]);
        for (int b = 0; b < 3; b++)
            largest[a] += fabsl(jacobian[3 * a + b]) * grain_of(&j->volume.axis[b], uvw[b]);
        length2 += residual * residual;
        tolerance2 += largest[a] * largest[a];
        trial_check(j->t, j->s, residual <= largest[a] || found->unresolved,
                    "point %.17g %.17g %.17g is %s at %.17g %.17g %.17g: residual[%d] %.3Lg > %.3Lg", p[0],
                    p[1], p[2], status_name(found->status), found->uvw[0], found->uvw[1], found->uvw[2], a,
                    residual, largest[a]);
    }
    trial_check(j->t, j->s, fabsl(found->residual - sqrtl(length2)) <= sqrtl(tolerance2),
                "reported residual %.3g, oracle %.3Lg", found->residual, sqrtl(length2));
}

static bool has_root(const ffd_location *found)
{
    return !isnan(found->uvw[0]);
}

/* What is owed of every result: u,v,w where the status says so, and no word of limits beside a proof.
   Singular without u,v,w is where the search gave up. */
static void check_location(judge *j, int i)
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    const bool none = isnan(found->uvw[0]) && isnan(found->uvw[1]) && isnan(found->uvw[2]);
    const bool proven = found->status == FFD_VERTEX_INSIDE || found->status == FFD_VERTEX_OUTSIDE;
    const bool may_lack = found->status == FFD_VERTEX_SINGULAR && found->unresolved;
    trial_check(j->t, j->s, !(proven && found->unresolved), "point %.17g %.17g %.17g is %s and unresolved",
                p[0], p[1], p[2], status_name(found->status));
    trial_check(j->t, j->s,
                none ? found->status == FFD_VERTEX_OUTSIDE || may_lack : found->status != FFD_VERTEX_OUTSIDE,
                "point %.17g %.17g %.17g is %s at %g %g %g", p[0], p[1], p[2], status_name(found->status),
                found->uvw[0], found->uvw[1], found->uvw[2]);
    trial_check(j->t, j->s, !none || found->residual == 0, "nothing found, with residual %g",
                found->residual);
    if (!none)
        check_found(j, i);
}

static void check_chosen(judge *j, int i, const domain_point *candidates, int count)
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    long double uvw[3];
    bool right = false;
    int first = 0;
    for (int a = 0; a < 3; a++)
        uvw[a] = found->uvw[a];
    for (int k = count - 1; k >= 0; k--)
        if (may_be_chosen(j, candidates, count, k)) {
            right = right || same_root(j, &candidates[k], uvw, 1);
            first = k;
        }
    const long double *expected = candidates[first].uvw;
    trial_check(j->t, j->s, right,
                "point %.17g %.17g %.17g (%d roots): found %.17g %.17g %.17g, expected %.20Lg %.20Lg %.20Lg",
                p[0], p[1], p[2], count, found->uvw[0], found->uvw[1], found->uvw[2], expected[0],
                expected[1], expected[2]);
}

/* The root next to known that belongs to p, which is rounded. False where rounding may have taken the point
   out of the volume. */
static bool root_of_rounded(const judge *j, const long double p[3], const long double known[3],
                            long double root[3])
{
    domain_point x = {.sure = false};
    memcpy(x.uvw, known, sizeof x.uvw);
    oracle_descend(&j->volume, p, x.uvw);
    examine(j, p, &x);
    memcpy(root, x.uvw, sizeof x.uvw);
    return x.sure;
}

/* Whether sizes as in the file are much larger than the lattice. */
static bool is_far(const judge *j, const long double p[3])
{
    long double least[3], largest[3];
    tolerances(j, p, least, largest);
    bool far = false;
    for (int a = 0; a < 3; a++)
        far = far || largest[a] > 100 * least[a];
    return far;
}

static bool is_on_border(const judge *j, const double uvw[3])
{
    bool on_border = false;
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &j->volume.axis[a];
        const long double near = 1e-6L * length_of(axis);
        on_border = on_border || uvw[a] <= oracle_first(axis) + near || uvw[a] >= oracle_last(axis) - near;
    }
    return on_border;
}

void judge_counted(judge *j, int i, const long double known[3])
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    domain_point candidates[ORACLE_MAX_ROOTS];
    long double q[3], root[3] = {0, 0, 0};
    seen_from_origin(j, i, q);
    bool clear = true, met = !known || !root_of_rounded(j, q, known, root);
    const int count = all_roots(j, q, candidates);
    for (int k = 0; k < count; k++) {
        met = met || same_root(j, &candidates[k], root, 1e3L);
        clear = clear && candidates[k].sure && candidates[k].regular;
        for (int other = 0; other < k; other++) /* two of a fold that is near */
            clear = clear && !same_root(j, &candidates[k], candidates[other].uvw, 1e4L);
    }
    check_location(j, i);
    j->judged++;
    /* What is outside by less than the tolerance has a root there that no exact search sees: that the
       tolerance is met was checked. Far from 0 the second root of a point may be such a one. */
    if ((count == 0 || is_far(j, q)) && has_root(found) &&
        (is_on_border(j, found->uvw) || found->status == FFD_VERTEX_MULTIPLE))
        clear = false;
    if (!clear) {
        j->left_out++;
        return;
    }
    trial_check(j->t, j->s, met, "the oracle misses the root %.17Lg %.17Lg %.17Lg of %.17g %.17g %.17g",
                known ? known[0] : 0, known ? known[1] : 0, known ? known[2] : 0, p[0], p[1], p[2]);
    const int status = count == 0 ? FFD_VERTEX_OUTSIDE : count == 1 ? FFD_VERTEX_INSIDE : FFD_VERTEX_MULTIPLE;
    trial_check(j->t, j->s, found->status == status,
                "point %.17g %.17g %.17g with %d roots (first %.17Lg %.17Lg %.17Lg) is %s", p[0], p[1], p[2],
                count, count ? candidates[0].uvw[0] : 0, count ? candidates[0].uvw[1] : 0,
                count ? candidates[0].uvw[2] : 0, status_name(found->status));
    if (count > 0 && has_root(found))
        check_chosen(j, i, candidates, count);
}

void judge_expect(judge *j, int i, int status, const long double uvw[3], const bool exact[3])
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    domain_point x = {.sure = false};
    long double q[3];
    memcpy(x.uvw, uvw, sizeof x.uvw);
    seen_from_origin(j, i, q);
    if (status == FFD_VERTEX_INSIDE) /* the root of the rounded point */
        oracle_descend(&j->volume, q, x.uvw);
    examine(j, q, &x);
    if (status == FFD_VERTEX_SINGULAR)
        reach_of_singular(j, q, &x);
    j->judged++;
    check_location(j, i);
    bool vague = !x.sure;
    for (int a = 0; status == FFD_VERTEX_INSIDE && a < 3; a++)
        vague = vague || x.reach[a] > most_reach * length_of(&j->volume.axis[a]);
    if (vague) {
        j->left_out++;
        return;
    }
    trial_check(j->t, j->s, found->status == status,
                "point %.17g %.17g %.17g (root %.17Lg %.17Lg %.17Lg) is %s, expected %s", p[0], p[1], p[2],
                x.uvw[0], x.uvw[1], x.uvw[2], status_name(found->status), status_name(status));
    for (int a = 0; has_root(found) && a < 3; a++) {
        const long double may = exact && exact[a] ? 0 : allowed(j, &x, a);
        trial_check(j->t, j->s, oracle_distance(&j->volume.axis[a], found->uvw[a], x.uvw[a]) <= may,
                    "point %.17g %.17g %.17g is %s: %c = %.17g, expected %.20Lg, allowed %.3Lg", p[0], p[1],
                    p[2], status_name(found->status), "uvw"[a], found -> uvw[a], x.uvw[a], may);
    }
}

void judge_next_to_singular(judge *j, int i, const long double known[3])
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    long double q[3], root[3] = {0, 0, 0};
    seen_from_origin(j, i, q);
    j->judged++;
    check_location(j, i);
    if (!root_of_rounded(j, q, known, root)) {
        j->left_out++;
        return;
    }
    trial_check(j->t, j->s,
                (found->status == FFD_VERTEX_INSIDE || found->status == FFD_VERTEX_SINGULAR) &&
                    !isnan(found->uvw[0]),
                "point %.17g %.17g %.17g next to a collapsed face (root %.17Lg %.17Lg %.17Lg) is %s, u = %g",
                p[0], p[1], p[2], known[0], known[1], known[2], status_name(found->status), found->uvw[0]);
}

/* The face's outward unit normal: the gradient of u_a. */
static bool outward_normal(const judge *j, const long double face[3], int a, long double normal[3],
                           long double at[3])
{
    long double jacobian[9], inverse[9], length = 0;
    oracle_evaluate(&j->volume, face, at, jacobian);
    if (!oracle_invert(jacobian, inverse))
        return false;
    for (int b = 0; b < 3; b++)
        length += inverse[3 * a + b] * inverse[3 * a + b];
    length = sqrtl(length) * (face[a] == oracle_first(&j->volume.axis[a]) ? -1 : 1);
    for (int b = 0; b < 3; b++)
        normal[b] = inverse[3 * a + b] / length;
    return true;
}

void judge_add_beside(judge *j, const long double face[3], int a, long double tolerance_count)
{
    long double normal[3], at[3], least[3], largest[3], unit = 0;
    if (!outward_normal(j, face, a, normal, at))
        memset(normal, 0, sizeof normal);
    tolerances(j, at, least, largest);
    for (int b = 0; b < 3; b++)
        unit += fabsl(normal[b]) * largest[b];
    for (int b = 0; b < 3; b++)
        at[b] += tolerance_count * unit * normal[b];
    add(j, at);
}

void judge_beside(judge *j, int i, const long double face[3], int a)
{
    const ffd_location *found = &j->found[i];
    const double *p = j->xyz + 3 * i;
    long double normal[3], at[3], least[3], largest[3], q[3], out = 0, unit = 0;
    seen_from_origin(j, i, q);
    tolerances(j, q, least, largest);
    j->judged++;
    check_location(j, i);
    if (!outward_normal(j, face, a, normal, at))
        return;
    for (int b = 0; b < 3; b++) {
        out += normal[b] * (q[b] - at[b]);
        unit += fabsl(normal[b]) * largest[b];
    }
    /* The nearest point of the volume lies out behind: beyond the tolerance in some coordinate, or within
       half of it in all. */
    bool within = true;
    for (int b = 0; b < 3; b++)
        within = within && out * fabsl(normal[b]) <= least[b] / 2;
    if (!within && out < 1.9L * unit) {
        j->left_out++;
        return;
    }
    trial_check(j->t, j->s, found->status == (within ? FFD_VERTEX_INSIDE : FFD_VERTEX_OUTSIDE),
                "point %.17g %.17g %.17g, %.3Lg tolerances out of face %c = %.17Lg, is %s", p[0], p[1], p[2],
                out / unit, "uvw"[a], face[a], status_name(found->status));
}

void judge_far(judge *j, int i)
{
    const ffd_location *found = &j->found[i];
    j->judged++;
    check_location(j, i);
    trial_check(j->t, j->s,
                found->status == FFD_VERTEX_OUTSIDE && found->evaluations == 0 && found->leaves == 0,
                "far point %.17g %.17g %.17g is %s after %u evaluations in %u leaves", j->xyz[3 * i],
                j->xyz[3 * i + 1], j->xyz[3 * i + 2], status_name(found->status),
                (unsigned)found->evaluations, (unsigned)found->leaves);
}

static bool same_location(const ffd_location *a, const ffd_location *b)
{
    return memcmp(a->uvw, b->uvw, sizeof a->uvw) == 0 &&
           memcmp(&a->residual, &b->residual, sizeof a->residual) == 0 && a->status == b->status &&
           a->unresolved == b->unresolved && a->evaluations == b->evaluations && a->leaves == b->leaves;
}

static void shuffle(int *order, int count, draw *random)
{
    for (int i = 0; i < count; i++)
        order[i] = i;
    for (int i = count - 1; i > 0; i--) {
        const int k = draw_int(random, 0, i), swap = order[i];
        order[i] = order[k];
        order[k] = swap;
    }
}

static void check_company(const judge *j, const char *company, const ffd_location *found, int i)
{
    trial_check(j->t, j->s, same_location(found, &j->found[i]),
                "point %d is found otherwise %s: %.17g %.17g %.17g (%s), %.17g %.17g %.17g (%s)", i, company,
                found->uvw[0], found->uvw[1], found->uvw[2], status_name(found->status), j->found[i].uvw[0],
                j->found[i].uvw[1], j->found[i].uvw[2], status_name(j->found[i].status));
}

void judge_order(judge *j, draw *random)
{
    enum { EACH = 3 }; /* each point twice and a stranger */
    static const double strangers[4] = {0, 1, -1e300, INFINITY};
    double xyz[EACH * 3 * JUDGE_POINTS];
    int order[EACH * JUDGE_POINTS];
    ffd_location found[EACH * JUDGE_POINTS];
    ffd_locator *other = NULL;
    const int count = EACH * j->count;
    if (ffd_locator_create(j->lattice, &other, NULL) != FFD_OK)
        trial_check(j->t, j->s, false, "no second locator");
    shuffle(order, count, random);
    for (int k = 0; k < count; k++) {
        const bool strange = order[k] >= 2 * j->count;
        for (int a = 0; a < 3; a++)
            xyz[3 * k + a] = strange ? strangers[draw_int(random, 0, 3)] + (double)j->origin[a]
                                     : j->xyz[3 * (order[k] % j->count) + a];
    }
    for (int fresh = 0; other && fresh < 2; fresh++) {
        const ffd_status status =
            ffd_locator_find(fresh ? other : j->locator, xyz, (size_t)count, found, NULL);
        trial_check(j->t, j->s, status == FFD_OK, "find among others: status %d", (int)status);
        for (int k = 0; status == FFD_OK && k < count; k++)
            if (order[k] < 2 * j->count)
                check_company(j, fresh ? "by another locator" : "among others", &found[k],
                              order[k] % j->count);
    }
    for (int i = 0; i < j->count; i++)
        if (ffd_locator_find(j->locator, j->xyz + 3 * i, 1, found, NULL) == FFD_OK)
            check_company(j, "alone", found, i);
        else
            trial_check(j->t, j->s, false, "find alone fails");
    ffd_locator_destroy(&other);
}
