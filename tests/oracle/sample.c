/* sample.c - see sample.h. */
#include "sample.h"
#include "../support/another_case.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

bool random_chance(draw *random, double probability)
{
    return draw_unit(random) < probability;
}

void random_direction(draw *random, double v[3])
{
    double length;
    do {
        for (int a = 0; a < 3; a++)
            v[a] = draw_between(random, -1, 1);
        length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    } while (length < 0.1 || length > 1);
    for (int a = 0; a < 3; a++)
        v[a] /= length;
}

void random_rotation(draw *random, double m[9])
{
    long double q[4], n = 0;
    for (int i = 0; i < 4; i++) {
        q[i] = draw_between(random, -1, 1) + (i == 0 ? 0.01 : 0);
        n += q[i] * q[i];
    }
    const long double s = 2 / n;
    const long double w = q[0], x = q[1], y = q[2], z = q[3];
    const long double r[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                              s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                              s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    for (int i = 0; i < 9; i++)
        m[i] = (double)r[i];
}

void text_add(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int needed = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (t->length + (size_t)needed + 1 > t->capacity) {
        t->capacity = 2 * t->capacity + (size_t)needed + 64;
        t->data = realloc(t->data, t->capacity);
        if (!t->data)
            abort();
    }
    va_start(arguments, format);
    vsnprintf(t->data + t->length, t->capacity - t->length, format, arguments);
    va_end(arguments);
    t->length += (size_t)needed;
}

void text_numbers(text *t, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        text_add(t, "%c%.17g", i == 0 ? '[' : ',', values[i]);
    text_add(t, "]");
}

void text_points(text *t, const double *xyz, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        text_add(t, "%c", i == 0 ? '[' : ',');
        text_numbers(t, xyz + 3 * i, 3);
    }
    text_add(t, "]");
}

void text_free(text *t)
{
    free(t->data);
    *t = (text){NULL, 0, 0};
}

void sample_init(sample *s, uint64_t seed)
{
    *s = (sample){.seed = seed};
}

void sample_clear_axes(sample *s)
{
    for (int a = 0; a < 3; a++)
        text_free(&s->knots[a]);
}

void sample_free(sample *s)
{
    sample_clear_axes(s);
    text_free(&s->moves);
    text_free(&s->json);
    free(s->points);
    free(s->weights);
    free(s->deformed_points);
    free(s->deformed_weights);
    *s = (sample){.seed = 0};
}

size_t sample_count(const sample *s)
{
    return (size_t)s->axis[0].n * (size_t)s->axis[1].n * (size_t)s->axis[2].n;
}

double *sample_array(size_t count)
{
    double *array = calloc(count, sizeof *array);
    if (!array)
        abort();
    return array;
}

void sample_named_axis(sample *s, int a, const char *kind, int n, int degree)
{
    oracle_axis *axis = &s->axis[a];
    *axis = (oracle_axis){.n = n, .degree = degree};
    axis->closed = strcmp(kind, "closed") == 0 || strcmp(kind, "periodic") == 0;
    if (axis->closed)
        for (int i = 0; i <= n; i++)
            axis->t[i] = (double)i / n;
    else
        for (int i = 0; i <= n + degree; i++) {
            const int inside = i < degree ? 0 : i > n ? n - degree : i - degree;
            if (strcmp(kind, "clamped") == 0)
                axis->t[i] = (double)inside / (n - degree);
            else if (strcmp(kind, "uniform") == 0)
                axis->t[i] = (double)i / (n + degree);
            else
                axis->t[i] = (double)(i - degree) / (n - degree);
        }
    text_free(&s->knots[a]);
    text_add(&s->knots[a], "\"%s\"", kind);
}

/* Steps between knots; some are 0, but no more than keeps the multiplicity at most degree. */
static double knot_step(draw *random, int degree, int *run, bool may_repeat)
{
    if (may_repeat && *run < degree && random_chance(random, 0.2)) {
        ++*run;
        return 0;
    }
    *run = 1;
    return draw_int(random, 12, 96) / 64.0;
}

/* Range and position of listed knots. Powers of two and whole offsets keep the sums of a period exact. */
static void place_knots(draw *random, double values[ORACLE_MAX_KNOTS], int count)
{
    const double scale = ldexp(1, draw_int(random, -6, 6));
    const double offset = random_chance(random, 0.5) ? 0 : draw_int(random, -8, 8);
    const double odd = random_chance(random, 0.3) ? draw_between(random, 0.5, 1) : 1;
    for (int i = 0; i < count; i++)
        values[i] = odd * (scale * (values[i] + offset));
}

static void listed_axis(sample *s, int a, draw *random, int n, int degree, bool closed)
{
    oracle_axis *axis = &s->axis[a];
    *axis = (oracle_axis){.n = n, .degree = degree, .closed = closed};
    double values[ORACLE_MAX_KNOTS] = {0};
    const int last = closed ? n : n + degree;
    const bool clamp_first = !closed && random_chance(random, 0.6);
    const bool clamp_last = !closed && random_chance(random, 0.6);
    int run = 1;
    for (int i = 1; i <= last; i++) {
        double step = knot_step(random, degree, &run, closed ? i < last : i != degree + 1);
        if ((clamp_first && i <= degree) || (clamp_last && i > n))
            step = 0;
        else if ((clamp_first && i == degree + 1) || (clamp_last && i == n))
            step = step > 0 ? step : 1;
        values[i] = values[i - 1] + step;
    }
    place_knots(random, values, last + 1);
    for (int i = 0; i <= last; i++)
        axis->t[i] = values[i];
    text_free(&s->knots[a]);
    text_add(&s->knots[a], "%s", closed ? "{\"closed\":" : "");
    text_numbers(&s->knots[a], values, (size_t)last + 1);
    text_add(&s->knots[a], "%s", closed ? "}" : "");
}

void sample_shift_knots(sample *s, int a, double shift)
{
    oracle_axis *axis = &s->axis[a];
    double values[ORACLE_MAX_KNOTS];
    const int count = axis->closed ? axis->n + 1 : axis->n + axis->degree + 1;
    for (int i = 0; i < count; i++)
        axis->t[i] = values[i] = (double)(axis->t[i] + shift);
    text_free(&s->knots[a]);
    text_add(&s->knots[a], "%s", axis->closed ? "{\"closed\":" : "");
    text_numbers(&s->knots[a], values, (size_t)count);
    text_add(&s->knots[a], "%s", axis->closed ? "}" : "");
}

void sample_axes(sample *s, draw *random, const sample_limits *limits)
{
    static const char *const kinds[] = {"clamped", "open", "unclamped", "uniform"};
    sample_clear_axes(s);
    for (int a = 0; a < 3; a++) {
        const int degree = draw_int(random, 1, limits->max_degree);
        const int n = degree + 1 + draw_int(random, 0, limits->max_extra);
        const bool closed = limits->always_closed[a] || (limits->closed[a] && random_chance(random, 0.3));
        if (closed && random_chance(random, 0.5))
            listed_axis(s, a, random, n < 3 ? 3 : n, degree, true);
        else if (closed)
            sample_named_axis(s, a, random_chance(random, 0.5) ? "closed" : "periodic", n < 3 ? 3 : n,
                              degree);
        else if (limits->only_clamped)
            sample_named_axis(s, a, "clamped", n, degree);
        else if (random_chance(random, 0.4))
            listed_axis(s, a, random, n, degree, false);
        else
            sample_named_axis(s, a, kinds[draw_int(random, 0, 3)], n, degree);
    }
}

void sample_weights(sample *s, draw *random, double spread)
{
    free(s->weights);
    s->weights = sample_array(sample_count(s));
    for (size_t i = 0; i < sample_count(s); i++)
        s->weights[i] = pow(spread, draw_between(random, -1, 1));
}

void sample_box(sample *s, draw *random, double scale, double offset)
{
    s->rest = SAMPLE_BOX;
    for (int a = 0; a < 3; a++) {
        s->box_min[a] = scale * (draw_between(random, -1, 1) + offset);
        s->box_max[a] = s->box_min[a] + scale * draw_between(random, 0.2, 2);
    }
    s->has_axes = random_chance(random, 0.4);
    if (s->has_axes) {
        random_rotation(random, s->box_axes);
        if (random_chance(random, 0.4))
            for (int a = 0; a < 3; a++)
                s->box_axes[a] = -s->box_axes[a];
    }
}

void sample_cylinder(sample *s, draw *random, bool full_turn)
{
    s->rest = SAMPLE_CYLINDER;
    for (int a = 0; a < 3; a++)
        s->center[a] = draw_between(random, -3, 3);
    random_direction(random, s->cylinder_axis);
    if (random_chance(random, 0.4))
        for (int a = 0, keep = draw_int(random, 0, 2); a < 3; a++)
            s->cylinder_axis[a] = a == keep ? 1 : 0;
    double other[3];
    random_direction(random, other);
    s->has_zero = random_chance(random, 0.6);
    /* A direction across the axis: the cross product with any other. */
    long double zero[3], length = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        zero[a] = (long double)s->cylinder_axis[b] * other[c] - (long double)s->cylinder_axis[c] * other[b];
        length += zero[a] * zero[a];
    }
    for (int a = 0; a < 3; a++)
        s->zero[a] = (double)(zero[a] / sqrtl(length));
    s->radius[0] = draw_between(random, 0.2, 1);
    s->radius[1] = s->radius[0] + draw_between(random, 0.3, 2);
    s->height = draw_between(random, 0.5, 4);
    s->angle[0] = draw_int(random, -180, 180);
    s->angle[1] = s->angle[0] + (full_turn ? 360 : draw_int(random, 20, 270));
}

double sample_widest_angle(const sample *s)
{
    const oracle_axis *axis = &s->axis[1];
    long double widest = 0;
    for (int i = 0; i < axis->n - (axis->closed ? 0 : 1); i++)
        widest = fmaxl(widest, oracle_greville(axis, i + 1) - oracle_greville(axis, i));
    return (double)(widest / (oracle_last(axis) - oracle_first(axis)) * (s->angle[1] - s->angle[0]));
}

void sample_round_cylinder(sample *s, draw *random, bool full_turn)
{
    sample_cylinder(s, random, full_turn);
    if (sample_widest_angle(s) <= 100)
        return;
    const int degree = s->axis[1].degree, n = s->axis[1].n < degree + 4 ? degree + 4 : s->axis[1].n;
    sample_named_axis(s, 1, full_turn ? "closed" : "clamped", n, degree);
}

static void write_rest(sample *s, text *j)
{
    if (s->rest == SAMPLE_POINTS) {
        text_add(j, "{\"points\":");
        text_points(j, s->points, sample_count(s));
    } else if (s->rest == SAMPLE_BOX) {
        text_add(j, "{\"box\":{\"min\":");
        text_numbers(j, s->box_min, 3);
        text_add(j, ",\"max\":");
        text_numbers(j, s->box_max, 3);
        if (s->has_axes) {
            text_add(j, ",\"axes\":");
            text_points(j, s->box_axes, 3);
        }
        text_add(j, "%s}", s->uniform_spacing ? ",\"spacing\":\"uniform\"" : "");
    } else {
        text_add(j, "{\"cylinder\":{\"center\":");
        text_numbers(j, s->center, 3);
        text_add(j, ",\"axis\":");
        text_numbers(j, s->cylinder_axis, 3);
        if (s->has_zero) {
            text_add(j, ",\"zero\":");
            text_numbers(j, s->zero, 3);
        }
        text_add(j, ",\"radius\":");
        text_numbers(j, s->radius, 2);
        text_add(j, ",\"height\":%.17g,\"angle\":", s->height);
        text_numbers(j, s->angle, 2);
        text_add(j, "}");
    }
    text_add(j, "}");
}

static void write_deformed(sample *s, text *j)
{
    if (!s->deformed_points && !s->deformed_weights)
        return;
    text_add(j, ",\n\"deformed\":{");
    if (s->deformed_points) {
        text_add(j, "\"points\":");
        text_points(j, s->deformed_points, sample_count(s));
    }
    if (s->deformed_weights) {
        text_add(j, "%s\"weights\":", s->deformed_points ? "," : "");
        text_numbers(j, s->deformed_weights, sample_count(s));
    }
    text_add(j, "}");
}

/* Whether the degrees are those that a file without the key "degree" gets. */
static bool has_default_degrees(const sample *s)
{
    for (int a = 0; a < 3; a++)
        if (s->axis[a].degree != (s->axis[a].n < 4 ? s->axis[a].n - 1 : 3))
            return false;
    return true;
}

void sample_write(sample *s)
{
    text *j = &s->json;
    text_free(j);
    text_add(j, "{\"format\":\"ffd-lattice\",\"version\":1,\n\"size\":[%d,%d,%d],\n", s->axis[0].n,
             s->axis[1].n, s->axis[2].n);
    if (!has_default_degrees(s))
        text_add(j, "\"degree\":[%d,%d,%d],\n", s->axis[0].degree, s->axis[1].degree, s->axis[2].degree);
    text_add(j, "\"knots\":[%s,%s,%s],\n\"rest\":", s->knots[0].data, s->knots[1].data, s->knots[2].data);
    write_rest(s, j);
    if (s->weights) {
        text_add(j, ",\n\"weights\":");
        text_numbers(j, s->weights, sample_count(s));
    }
    write_deformed(s, j);
    if (s->box_units)
        text_add(j, ",\n\"units\":\"box\"");
    if (s->moves.length > 0)
        text_add(j, ",\n\"moves\":[%s]", s->moves.data);
    text_add(j, "}\n");
}

/* Where control point i of the box lies between 0 and 1 of its side. */
static long double box_place(const sample *s, int a, int i)
{
    const oracle_axis *axis = &s->axis[a];
    if (s->uniform_spacing)
        return (long double)i / (axis->n - 1);
    return (oracle_greville(axis, i) - oracle_first(axis)) / (oracle_last(axis) - oracle_first(axis));
}

static long double box_axis(const sample *s, int a, int r)
{
    return s->has_axes ? s->box_axes[3 * a + r] : a == r;
}

oracle_volume sample_box_volume(const sample *s, long double corner[3])
{
    oracle_volume volume = oracle_make(s->axis, s->weights != NULL);
    size_t at = 0;
    int i[3];
    for (int r = 0; r < 3; r++) {
        corner[r] = 0;
        for (int a = 0; a < 3; a++)
            corner[r] += s->box_min[a] * box_axis(s, a, r);
    }
    for (i[2] = 0; i[2] < s->axis[2].n; i[2]++)
        for (i[1] = 0; i[1] < s->axis[1].n; i[1]++)
            for (i[0] = 0; i[0] < s->axis[0].n; i[0]++, at++) {
                for (int a = 0; a < 3; a++) {
                    const long double side = (long double)s->box_max[a] - s->box_min[a];
                    for (int r = 0; r < 3; r++)
                        volume.points[3 * at + (size_t)r] += side * box_place(s, a, i[a]) * box_axis(s, a, r);
                }
                if (s->weights)
                    volume.weights[at] = s->weights[at];
            }
    return volume;
}

oracle_volume sample_volume(const sample *s, const ffd_lattice *lattice, ffd_volume which)
{
    return oracle_with_points(s->axis, ffd_lattice_get_points(lattice, which),
                              ffd_lattice_get_weights(lattice, which));
}

void trial_check(trial *t, const sample *s, bool ok, const char *format, ...)
{
    t->checks++;
    if (ok)
        return;
    t->failures++;
    if (t->failures > 40)
        return;
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: seed %llu: ", t->name, (unsigned long long)s->seed);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    if (s->seed != t->printed_seed && s->json.data) {
        fprintf(stderr, "%.*s%s\n", 1500, s->json.data, s->json.length > 1500 ? " ..." : "");
        const char *folder = getenv("FFD_DUMP");
        char name[512];
        snprintf(name, sizeof name, "%s/%s-%llu.json", folder ? folder : ".", t->name,
                 (unsigned long long)s->seed);
        FILE *file = folder ? fopen(name, "w") : NULL;
        if (file) {
            fputs(s->json.data, file);
            fclose(file);
        }
    }
    t->printed_seed = s->seed;
}

void trial_end(const trial *t)
{
    printf("%s: %ld cases, %ld checks, %ld failures (first seed %llu)\n", t->name, t->cases, t->checks,
           t->failures, (unsigned long long)trial_seed());
    assert_true(t->cases > 0 && t->checks > 0);
    assert_int_equal(t->failures, 0);
}

uint64_t trial_seed(void)
{
    const char *seed = getenv("FFD_SEED");
    return seed ? strtoull(seed, NULL, 10) : 1;
}

bool trial_next(trial *t, long most)
{
    const long least = most < TRIAL_LEAST ? most : most / 4 < TRIAL_LEAST ? TRIAL_LEAST : most / 4;
    return another_case(t->cases, &t->began, least, most, 1);
}

ffd_lattice *trial_parse(trial *t, const sample *s)
{
    ffd_lattice *lattice = NULL;
    ffd_error error = {.status = FFD_OK};
    const ffd_status status = ffd_lattice_parse(s->json.data, s->json.length, "sample", &lattice, &error);
    trial_check(t, s, status == FFD_OK, "parse: %s %s", error.pointer, error.message);
    return status == FFD_OK ? lattice : NULL;
}
