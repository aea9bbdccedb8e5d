/* warnings.h - what a job says of its figures: of vertices (vertices.c), folds (folds.c), torn edges
   (tears.c), cells of volume meshes (cells.c), what stays behind (behind.c), and of moves that move nothing
   (still.c) or less than they say (places.c). */
#ifndef FFD_JOB_JUDGE_WARNINGS_H
#define FFD_JOB_JUDGE_WARNINGS_H

#include "job/chain/chain.h"
#include "job/figures/pass_totals.h"

/* Logs "3 of 100 vertices are not inside: 2 outside (left where they are), 1 multiple" and other warnings of
   the pass. deformed: say whether vertices outside were kept or moved; else the job asked for u,v,w only. */
void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log);

/* Describes folds, such as "folds in 3 of 27 cells, as at u,v,w = 0.5 0.5 0.5 of b.json, x,y,z = 1 2 3", or
   that they could not be ruled out. Only for verdicts other than none. lattices: the names of the job's. */
void ffd_folds_describe(const ffd_job_result *result, const ffd_lattice_source *lattices, char *text,
                        size_t capacity);
/* Warns of folds and of faces that are turned over. */
void ffd_folds_warn(const ffd_job_result *result, const pass_totals *totals,
                    const ffd_lattice_source *lattices, const mesh_log *log);

/* Warns of vertices at which the mesh collapses to a plane, a line or a point. */
void ffd_collapse_warn(const pass_totals *totals, const mesh_log *log);

/* Describes torn edges, as in "36 vertices of Knight_Sword stay; the largest step to a neighbour is 0.47".
   Requires torn edges. */
void ffd_tears_describe(const ffd_job_result *result, char *text, size_t capacity);
/* Warns of torn edges, and suggests a remedy. selects: only parts of the mesh are deformed. */
void ffd_tears_warn(const ffd_job_result *result, bool selects, const mesh_log *log);

/* Describes cells that are inverted or could not be decided: "3 of 96 cells are inverted by the deformation".
   Empty if there are none. */
void ffd_cells_describe(const ffd_cell_figures *cells, char *text, size_t capacity);
/* Warns of them, and names the worst cell. */
void ffd_cells_warn(const ffd_job_result *result, const mesh_log *log);

/* Logs one line for each kind of thing left behind; with FFD_RIG_KEEP none for joints, pivots and sockets
   (ffd_rig_warn). */
void ffd_behind_warn(const ffd_job_result *result, ffd_rig rig, const mesh_log *log);

/* Warns, for each lattice, of a pull or a falloff with a centre that moves its place by less than half of
   what was asked, which sets *falls_short, and of a drag that misses places. Errors: FFD_E_MEMORY, and those
   of searches. */
ffd_status ffd_places_warn(const lattice_chain *chain, const mesh_log *log, bool *falls_short,
                           ffd_error *error);

/* Warns of lattices whose moves move no control point; and if no vertex moves, though lattices hold vertices
   and move control points, that none of these acts on a vertex, that all weights are 0, or that the floats of
   the output are too coarse for it. box: the bounds of the mesh at rest; is_target: it becomes a morph
   target; is_written: an output is. */
void ffd_still_warn(const pass_totals *totals, const lattice_chain *chain, const ffd_weight_figures *weights,
                    const ffd_bounds *box, bool is_target, bool is_written, const mesh_log *log);

#endif
