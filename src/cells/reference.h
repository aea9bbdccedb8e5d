/* reference.h - the places of a reference cell at which a Jacobian is evaluated: Gauss points, and of
   quadratic cells also corners and middles. */
#ifndef FFD_CELLS_REFERENCE_H
#define FFD_CELLS_REFERENCE_H

#include "base/fail.h"
#include "cells/cell_types.h"
#include "cells/jacobian_signs.h"

/* The derivatives of the shape functions of a kind at its places. */
typedef struct cell_rule {
    size_t points, places;
    /* places x 3 x points: the derivative by each reference coordinate is a sum of the points with these
       weights, whose sum is 0. */
    double weights[];
} cell_rule;

/* Rules of the kinds that have been asked for. All zeros: none. */
typedef struct cell_rules {
    cell_rule *of[CELL_TYPES]; /* by ffd_cell_type_index; NULL: none */
} cell_rules;

/* Adds the rule of a kind, if there is one. Errors: FFD_E_MEMORY. */
ffd_status ffd_cell_rules_add(cell_rules *rules, const cell_type *type, ffd_error *error);
/* Frees the rules. */
void ffd_cell_rules_free(cell_rules *rules);

/* Adds the signs of the Jacobian at the places of a rule. points: those of the cell, neither so large nor so
   small that products of three overflow or are lost. */
void ffd_cell_rule_signs(const cell_rule *rule, const double (*points)[3], jacobian_signs *signs);

#endif
