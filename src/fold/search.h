/* search.h - the search in a cell: its result, the boxes into which it is subdivided, and bounds from their
   coefficients. Main header of the search: declares figures.c, box.c, border.c, flat.c,
   search.c. */
#ifndef FFD_FOLD_SEARCH_H
#define FFD_FOLD_SEARCH_H

#include "fold/cell_form.h"
#include "fold/determinant.h"
#include "fold/scratch.h"
#include "fold/sizes.h"
#include "fold/verdict.h"

/* A part of the cell. Its memory is the slot of a depth. */
typedef struct box {
    double lo[3], hi[3];
    double *coefficients; /* of sign * det J; with weights of sign * W^4 det J */
    row_sizes sizes;      /* with weights; row[3][1] is W */
    double rounding;      /* bound of the rounding error of each coefficient */
    double cell_rounding; /* the same, from the sizes of the whole cell */
    double halvings;      /* roundings of each coefficient in them */
    bool is_even;         /* the weights hardly differ: smaller boxes do not know their coefficients better */
} box;

/* The data of the rest volume for zeros on the border, made on demand (border.c). */
typedef enum rest_state { REST_NOT_MADE, REST_WITHOUT_ZEROS, REST_MADE } rest_state;

typedef struct cell_search {
    const fold_plan *plan;
    fold_scratch *scratch;
    size_t index[3];
    bool rational;
    int order[3], weight_order[3];
    scaled unit; /* factor from the determinant of the scaled cell to values relative to the mean of the rest
                    volume */
    cell_form form;
    determinant_bounds bounds;
    double relative;      /* with weights: the rounding error of a coefficient of the cell, relative to the
                             products that it adds up */
    double greatest;      /* greatest magnitude of a coefficient of the whole cell */
    bool on_border[3][2]; /* whether the cell touches this end of the domain */
    rest_state rest;
    bool has_exact_zeros;
    cell_form rest_form;
    double rest_rounding, rest_greatest;
    bool refining;
    long boxes;         /* remaining budget */
    double whole_lower; /* lower bound from the coefficients of the whole cell */
    cell_verdict result;
} cell_search;

/* What the coefficients of a box prove. */
typedef struct box_view {
    double least;           /* the least coefficient that is not excused */
    int at[3];              /* its index */
    bool has_zeros;         /* some coefficients are excused: zeros that the rest volume has too */
    bool corner_is_zero[8]; /* the corners among them */
    bool is_positive;       /* proven: det J > 0 in the box, except for excused zeros on the border */
    double least_weight, greatest_weight;
} box_view;

/* Values relative to the mean determinant of the rest volume. */

/* Converts a value of the scaled cell; with weights, of W^4 det J for this W. */
double ffd_search_relative(const cell_search *search, double value, double weight);
/* The same for a lower bound. The result is a lower bound too, although the mean has an error. */
double ffd_search_lower(const cell_search *search, double value, double least_weight, double greatest_weight);
/* Records a determinant that was computed at a point. */
void ffd_search_see(cell_search *search, double relative);
/* Lowers the bound of the result to this value if it is less. */
void ffd_search_lower_to(cell_search *search, double relative);
/* Records the witness of a fold: t in [0,1]^3 of the cell, and the relative value there. */
void ffd_search_set_folded(cell_search *search, const double local[3], double relative);
/* Returns the factor from the determinant of the scaled cell to values relative to the mean of the rest
   volume. */
scaled ffd_search_unit(const fold_plan *plan, const size_t index[3], int exponent);

/* Makes the box of the whole cell. */
void ffd_box_make(cell_search *search, box *whole);
/* Splits a box in direction a: lower is the lower half, in the slot of the next depth; whole becomes the
   upper half. */
void ffd_box_halve(const cell_search *search, box *whole, int a, int depth, box *lower);
/* Examines the coefficients of a box. */
void ffd_box_view(cell_search *search, const box *part, box_view *view);
/* Returns a lower bound of the determinant in the box. */
double ffd_box_lower(const cell_search *search, const box *part, const box_view *view);
/* Returns W at t in [0,1]^3 of the box; 1 without weights. */
double ffd_box_weight(const cell_search *search, const box *part, const double t[3]);
/* Returns the least coefficient. */
double ffd_box_least(const cell_search *search, const box *part);

/* Updates view, without the coefficients that are excused as zeros on the border. */
void ffd_border_view(cell_search *search, const box *part, const bool touches[3][2], box_view *view);

/* With weights: if a cell, all coefficients of which are 0 within rounding, is flat, records that it folds,
   where possible with a place at which the determinant is not positive. */
void ffd_search_flat(cell_search *search);

/* Subdivides the box until it is decided, or its bound is good enough for min_det. */
void ffd_search_box(cell_search *search, box *part, int depth);

/* The coefficients of a cell take as much work as this many boxes. */
#define DETERMINANT_COST 8
/* So does the determinant at one place, by ffd_place_determinant. */
#define PLACE_COST 8

#endif
