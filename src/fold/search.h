/* search.h - one cell while it is searched: the figures, the boxes that it is halved into, and what their
   coefficients say. Main header of the search: declares figures.c, box.c, border.c, search.c. */
#ifndef FFD_FOLD_SEARCH_H
#define FFD_FOLD_SEARCH_H

#include "fold/cell_form.h"
#include "fold/determinant.h"
#include "fold/scratch.h"
#include "fold/verdict.h"

/* A part of the cell. Its memory is the slot of a depth of the search. */
typedef struct box {
    double lo[3], hi[3];
    double *coefficients; /* of sign det J, with weights of sign W^4 det J */
    double *weights;      /* of W; NULL without weights */
    double rounding;      /* of each coefficient */
} box;

typedef struct cell_search {
    const fold_plan *plan;
    fold_scratch *scratch;
    size_t index[3];
    bool rational;
    int order[3], weight_order[3];
    scaled unit; /* of the deformed cell's determinant, relative to the mean of the rest volume's */
    cell_form form;
    determinant_bounds bounds;
    double greatest;      /* coefficient of the whole cell, in size */
    bool on_border[3][2]; /* the cell touches this end of the domain */
    bool has_rest;        /* what the border's zeros are judged by; made when a box needs it: border.c */
    bool has_exact_zeros;
    double rest_rounding, rest_greatest;
    bool refining;
    long boxes;         /* that may still be looked at */
    double whole_lower; /* the bound that the whole cell's coefficients give */
    cell_verdict result;
} cell_search;

/* What the coefficients of a box say. */
typedef struct box_view {
    double least;           /* coefficient that is not excused */
    int at[3];              /* its index */
    bool has_zeros;         /* some are excused: zeros that the rest volume has too */
    bool corner_is_zero[8]; /* among them these */
    bool is_positive;       /* proven: det J > 0 in the box, but for the border's excused zeros */
    double least_weight, greatest_weight;
} box_view;

/* Figures relative to the mean determinant of the rest volume. */

/* A value of the scaled cell; of W^4 det J with this W. */
double ffd_search_relative(const cell_search *search, double value, double weight);
/* The same for a lower bound, which stays one: the mean is known to a doubt only. */
double ffd_search_lower(const cell_search *search, double value, double least_weight, double greatest_weight);
/* A determinant that was computed at a point; a lower bound for a part; a witness. */
void ffd_search_see(cell_search *search, double relative);
/* Lowers the bound of the result to this value, if that is less. */
void ffd_search_lower_to(cell_search *search, double relative);
/* Records the witness of a fold: t in the cell's [0,1]^3, and the relative value there. */
void ffd_search_set_folded(cell_search *search, const double local[3], double relative);
/* The factor from a cell's scaled determinant to values relative to the rest volume's mean. */
scaled ffd_search_unit(const fold_plan *plan, const size_t index[3], int exponent);

/* Makes the box that is the whole cell. */
void ffd_box_make(cell_search *search, box *whole);
/* The lower half of `whole` into the next depth's slot; whole becomes the upper half. */
void ffd_box_halve(const cell_search *search, box *whole, int a, int depth, box *lower);
/* Finds what the coefficients of a box say. */
void ffd_box_view(cell_search *search, const box *part, box_view *view);
/* A lower bound of the determinant in the box. */
double ffd_box_lower(const cell_search *search, const box *part, const box_view *view);
/* W at t in the box's [0,1]^3; 1 without weights. */
double ffd_box_weight(const cell_search *search, const box *part, const double t[3]);
/* The least coefficient. */
double ffd_box_least(const cell_search *search, const box *part);

/* Finds view's figures anew, without the coefficients that the border's zeros excuse. */
void ffd_border_view(cell_search *search, const box *part, const bool touches[3][2], box_view *view);

/* Halves the box until it is decided, or good enough to refine min_det. */
void ffd_search_box(cell_search *search, box *part, int depth);

/* A cell's coefficients are as much work as this many boxes. */
#define DETERMINANT_COST 8

#endif
