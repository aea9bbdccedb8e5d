/* sample.h - random lattices: as JSON text for the library, and as oracle volumes made independently of it.
 */
#ifndef FFD_TESTS_SAMPLE_H
#define FFD_TESTS_SAMPLE_H

#include "../support/draw.h"
#include "oracle.h"
#include <ffd/ffd.h>
#include <stdint.h>

bool random_chance(draw *random, double probability);
void random_rotation(draw *random, double m[9]); /* orthonormal to rounding, right-handed */
void random_direction(draw *random, double v[3]);

/* Growing text; ends in 0. */
typedef struct text {
    char *data;
    size_t length, capacity;
} text;

void text_add(text *t, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;
void text_numbers(text *t, const double *values, size_t count); /* [a,b,...] */
void text_points(text *t, const double *xyz, size_t count);     /* [[x,y,z],...] */
void text_free(text *t);

typedef enum sample_rest { SAMPLE_BOX, SAMPLE_CYLINDER, SAMPLE_POINTS } sample_rest;

typedef struct sample {
    uint64_t seed;
    oracle_axis axis[3];
    text knots[3]; /* the JSON value of each direction */
    sample_rest rest;
    double box_min[3], box_max[3], box_axes[9];
    bool has_axes, uniform_spacing;
    double center[3], cylinder_axis[3], zero[3], radius[2], height, angle[2];
    bool has_zero;
    double *points, *weights;                   /* 3*count (SAMPLE_POINTS); count or NULL */
    double *deformed_points, *deformed_weights; /* or NULL */
    bool box_units;
    text moves; /* the JSON objects, comma between */
    text json;
} sample;

/* What sample_axes may choose. */
typedef struct sample_limits {
    int max_degree, max_extra; /* size is degree + 1 .. degree + 1 + max_extra */
    bool closed[3];            /* a direction may be closed */
    bool always_closed[3];
    bool only_clamped;
} sample_limits;

void sample_init(sample *s, uint64_t seed);
void sample_free(sample *s);

/* Random sizes, degrees and knots of all kinds. */
void sample_axes(sample *s, draw *random, const sample_limits *limits);
/* One direction with a kind of data/schema/lattice.md 4 by its name. */
void sample_named_axis(sample *s, int a, const char *kind, int n, int degree);
/* Lists the knots of direction a with shift added to each. */
void sample_shift_knots(sample *s, int a, double shift);
void sample_clear_axes(sample *s);

size_t sample_count(const sample *s);
/* n doubles that live until sample_free would be too late: the caller stores them in the sample. */
double *sample_array(size_t count);

/* Positive weights within [1/spread, spread]. */
void sample_weights(sample *s, draw *random, double spread);

/* A box with random sides, sometimes with axes (also left-handed), scaled by scale and moved by offset *
 * scale. */
void sample_box(sample *s, draw *random, double scale, double offset);
void sample_cylinder(sample *s, draw *random, bool full_turn);
/* With evenly spaced knots along v where the random ones leave more than 100 degrees between control points.
 */
void sample_round_cylinder(sample *s, draw *random, bool full_turn);
/* The widest angle in degrees between neighbouring control points of a cylinder placed by Greville abscissae.
 */
double sample_widest_angle(const sample *s);

/* Writes s->json. */
void sample_write(sample *s);

/* The box' control points by data/schema/lattice.md 5.1, in long double, seen from the box' lower corner: so
   they are as exact far from the origin as near it. */
oracle_volume sample_box_volume(const sample *s, long double corner[3]);

/* A volume of the library's own control points. */
oracle_volume sample_volume(const sample *s, const ffd_lattice *lattice, ffd_volume which);

/* A trial counts its cases and checks; a failed check prints the numbers, the seed and (once a case) the
 * JSON. */
typedef struct trial {
    const char *name;
    long cases, checks, failures;
    uint64_t printed_seed;
    double began; /* processor seconds at the first case */
} trial;

/* A trial that has fewer cases by itself makes all of them, on every machine. */
#define TRIAL_LEAST 24

/* The first seed: FFD_SEED, else 1. */
uint64_t trial_seed(void);
/* Whether a trial that has t->cases makes another. It always makes a quarter of `most`, and TRIAL_LEAST; then
   it goes on up to `most` for one second of processor time, so that a slow build makes fewer and not later.
   FFD_CASES=N: exactly N. FFD_SECONDS=N: for so long, whatever `most` is. */
bool trial_next(trial *t, long most);

void trial_check(trial *t, const sample *s, bool ok, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;
/* Prints the counts; no case or a failure fails the cmocka test. */
void trial_end(const trial *t);

/* Parses s->json; NULL (and a failed check) when the library refuses it. */
ffd_lattice *trial_parse(trial *t, const sample *s);

#endif
