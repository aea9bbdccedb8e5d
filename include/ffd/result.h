/* result.h - the result of a job: its figures, grouped and named as in its report (data/schema/formats.md 2).

   A group that a job may leave out says so in is_known or is_there; the report then has null, or no such
   member. Lengths are in world units unless stated otherwise. room: reserved for figures of later versions.
 */
#ifndef FFD_RESULT_H
#define FFD_RESULT_H

#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/fold.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* An axis-aligned box, in world units. */
typedef struct ffd_bounds {
    double min[3], max[3]; /* min > max if no vertex is finite */
} ffd_bounds;

/* The largest value of something over all vertices, and the root of the mean of its squares. */
typedef struct ffd_max_rms {
    double max, rms;
} ffd_max_rms;

/* A size of the mesh at rest and deformed. NaN: unknown; infinite: too large for a double. */
typedef struct ffd_before_after {
    double before, after;
} ffd_before_after;

/* Vertices of the shapes that a glTF stores beside the one that it shows. The gates include them. */
typedef struct ffd_morph_target_figures {
    /* Vertices that a morph target moves outside of every lattice, counted for each target. */
    uint64_t outside;
    /* Of ffd_job_result.counts, the vertices outside in parts whose default weights show another shape than
       the base; and vertices of such a base that are outside of every lattice. */
    uint64_t shown_outside, base_outside;
    uint64_t invalid; /* as outside: moved to coordinates that are not finite */
    uint64_t room[2];
} ffd_morph_target_figures;

/* Vertices on a face that two lattices share. */
typedef struct ffd_shared_face_figures {
    uint64_t moved_twice; /* both lattices move them, one after the other */
    uint64_t disagreeing; /* blocks: another block moves them differently */
    double largest;       /* the largest such difference */
    uint64_t room[2];
} ffd_shared_face_figures;

/* Evaluations of C with its Jacobian for a vertex. */
typedef struct ffd_iteration_figures {
    double mean;
    uint64_t max;
} ffd_iteration_figures;

/* Why an edge is torn (src/maths.md 7.4). */
typedef enum ffd_tear_cause {
    FFD_TEAR_NONE = 0,
    FFD_TEAR_STAYS,      /* an end is outside of the lattices, and stays */
    FFD_TEAR_UNSELECTED, /* an end is not selected, or its matrix is not invertible */
    FFD_TEAR_LATTICES,   /* the edge leads out of a lattice, or into another one */
    FFD_TEAR_BLOCKS,     /* it leads from one block to another that moves the place differently */
    FFD_TEAR_SEAM,       /* it crosses two coinciding rest faces of a lattice that are moved apart */
    FFD_TEAR_AXIS,       /* it meets a collapsed face of a lattice that is opened */
    FFD_TEAR_BORDER,     /* outside, where another part of the border becomes the nearest */
    FFD_TEAR_OVERLAP,    /* it leads from one part of a lattice that overlaps itself to another */
    FFD_TEAR_WEIGHTS,    /* it is one of no length: vertices at one position have different weights */
    FFD_TEAR_RIGID       /* likewise: one of them moves with a rigid part, and the other does not */
} ffd_tear_cause;

/* Torn edges: one end moves and the other stays, where the displacement does not fade; or both move, but the
   displacement jumps between them (src/maths.md 7.4). Invisible edges do not count. */
typedef struct ffd_tear_figures {
    /* They were counted: with ffd_check_run, ffd_deform_desc.quality and FFD_GATE_TEAR, and in a mesh of at
       most 5.5 million vertices wherever some edge may be torn. */
    bool is_known;
    uint64_t edges;  /* number of torn edges */
    double largest;  /* the largest step of a torn edge; the rest is of that edge: */
    uint64_t vertex; /* an end of it: the one that stays, if one does. An index from 0 in the order of `ffd
                        embed` */
    char part[256];  /* the part of that vertex: "node:NAME", "mesh:NAME", "group:NAME" or "object:NAME"; "":
                        no name */
    uint64_t stays;  /* vertices that stay in that part, or in the mesh if there is no part */
    ffd_tear_cause cause;
    uint64_t room[4];
} ffd_tear_figures;

/* det F, the factor by which volumes grow, at the vertices. */
typedef struct ffd_det_figures {
    bool is_known;   /* with ffd_check_run and ffd_deform_desc.quality, if there is a vertex that moves */
    double min, max; /* min > max: not known */
    /* With FFD_OUTSIDE_EXTEND: the least at vertices outside, and the vertex, if it is computed
       (ffd_check_run, ffd_deform_desc.quality, FFD_GATE_FOLDS); else infinite. */
    double outside;
    uint64_t outside_vertex;
    uint64_t room[2];
} ffd_det_figures;

/* The distance of straight edges from the deformed surface. */
typedef struct ffd_deviation {
    double max, mean;
} ffd_deviation;

/* The edges of the mesh. */
typedef struct ffd_edge_figures {
    bool is_known;  /* with ffd_check_run and FFD_GATE_EDGES */
    uint64_t count; /* each counted once */
    ffd_deviation deviation;
    uint64_t room[2];
} ffd_edge_figures;

/* Vertices whose skin weights do not sum to 1. Weights that are not finite count nowhere. */
typedef struct ffd_skin_weight_figures {
    uint64_t off;    /* the weights are divided by their sum */
    double farthest; /* the largest difference of such a sum from 1 */
    uint64_t none;   /* the sum is 0 or less: the vertex follows its first joint */
    uint64_t room[2];
} ffd_skin_weight_figures;

/* Results whose shape the file's numbers change, in the file's space: so far from the origin that float32 or
   float64 are too coarse, or quantized to less than 12 bits of the part's size. */
typedef struct ffd_precision_figures {
    double error; /* the largest rounding error */
    double side;  /* the largest side of the part that it changes most; 0: all keep their shapes */
    uint64_t room[2];
} ffd_precision_figures;

/* Gaussian splats. */
typedef struct ffd_splat_figures {
    uint64_t carried;   /* rotation, scale and harmonics follow */
    uint64_t flattened; /* of these: splats that lose an extent, because F is not invertible there */
    uint64_t broken;    /* splats that only move, because their rotation or scale is not finite */
    uint64_t room[2];
} ffd_splat_figures;

/* Of vertices that are not hidden. */
typedef struct ffd_bounds_figures {
    ffd_bounds before, after;
} ffd_bounds_figures;

/* Scene objects that do not follow: they keep their place while the mesh moves. */
typedef enum ffd_behind_kind {
    FFD_BEHIND_SOCKET = 0, /* an empty node without children */
    FFD_BEHIND_CAMERA,
    FFD_BEHIND_LIGHT,
    FFD_BEHIND_JOINT,
    FFD_BEHIND_PIVOT, /* a node whose translation, rotation or scale is animated */
    FFD_BEHIND_PHYSICS_SHAPE,
    FFD_BEHIND_SPLAT, /* a Gaussian splat that moves, in a lattice that does more than translate, but whose
                         rotation and scale cannot follow (compare ffd_splat_figures.carried) */
    FFD_BEHIND_KIND_COUNT
} ffd_behind_kind;

/* Returns "socket", "camera", "light", "joint", "pivot", "physics_shape" or "splat"; NULL for another value.
   The string is static. Thread-safe. */
FFD_API const char *ffd_behind_kind_name(ffd_behind_kind kind);

/* The most names that are listed for a kind. */
#define FFD_BEHIND_NAMES 3
/* The things of one kind that are left behind. */
typedef struct ffd_behind {
    uint64_t count; /* number of things of this kind that are left behind */
    /* The first names in the order of the file (for splats: of the nodes that show them), cut to fit, with
       control characters replaced by '?'; "": no further name. */
    char names[FFD_BEHIND_NAMES][80];
} ffd_behind;

/* The joints, pivots and sockets of a glTF, and their lag: the distance from where a joint is in the output
   to where the lattice moves its place in the mesh. With as_morph and morphs only joints count, and the mesh
   is that of the morph target in full. */
typedef struct ffd_rig_figures {
    bool is_there; /* there are joints, pivots or sockets, or other nodes follow; if false, all other members
                      are 0 */
    uint64_t joints;
    uint64_t moved;     /* nodes whose transforms are changed in the output */
    uint64_t sheared;   /* of these: nodes that rotate with their parents, because another rotation would
                           shear them */
    uint64_t singular;  /* nodes that stay, with their descendants, because their matrices are not
                           invertible */
    uint64_t partial;   /* nodes that stay because their meshes are selected only in part */
    uint64_t unscaled;  /* nodes that follow but have sizes which do not: physics shapes, spring bones, eyes
                           (VRM), splats */
    double largest_lag; /* |D(x) - x'| over joints, pivots and sockets */
    char worst[80];     /* name of the first node with this lag, in the form of ffd_behind.names; "": none */
    uint64_t lagging_skins, lagging_pivots, lagging_sockets; /* with a lag above 0; skins: with such a
                                                                joint */
    uint64_t lagging_joints; /* joints with a lag that belong to no skin of the scene */
    /* FOLLOW: nodes that stay where they are because they are not selected, though a node above them follows;
       and the largest distance from where that node would carry one of them. */
    uint64_t unselected;
    double unselected_by;
    uint64_t room[4];
} ffd_rig_figures;

/* One kind of violation of the format's specification in a mesh file, where the meaning is clear all the
   same: viewers open the file, and every position is certain. */
typedef struct ffd_flaw {
    char message[256]; /* of the first one of its kind, as in ffd_error */
    char pointer[128]; /* JSON pointer to it; "": none */
    uint64_t line;     /* its line, from 1; 0: none */
    uint64_t count;    /* number of violations of this kind */
} ffd_flaw;
/* The most kinds that are reported for a file; all further ones are counted with the last. */
#define FFD_FLAWS 8

/* The morph targets that a job has made (ffd_deform_desc.morphs): count elements each, up to the one that a
   gate refuses. The arrays belong to the description. */
typedef struct ffd_morph_results {
    size_t count;
    const char *const *names;
    const ffd_lattice_source *lattices;
    const struct ffd_job_result *results; /* NULL if the description has no room for them */
} ffd_morph_results;

/* The continuity C0, C1 or C2 with which what is deformed joins what is not, where faces of the lattices are
   held (ffd_lattice_seal); NONE: no face is held. */
typedef enum ffd_seam { FFD_SEAM_NONE = 0, FFD_SEAM_C0, FFD_SEAM_C1, FFD_SEAM_C2 } ffd_seam;

/* Returns "none", "C0", "C1" or "C2"; NULL for another value. The string is static. Thread-safe. */
FFD_API const char *ffd_seam_name(ffd_seam seam);

/* The most lattices of a job, and so the most that are listed. */
#define FFD_LATTICES_MOST 1024
/* The faces that ffd_deform_desc.seam holds. */
typedef struct ffd_seam_figures {
    bool is_there; /* it is set, and the lattices were fitted */
    ffd_seam continuity;
    uint64_t count;                   /* of lattices; with morphs one of each target */
    uint8_t faces[FFD_LATTICES_MOST]; /* of each: bit 2 a + side, as of ffd_lattice_seal; 0: none */
} ffd_seam_figures;

/* Wall clock time of each step. */
typedef struct ffd_seconds {
    double read, embed, deform, judge, write;
    uint64_t room[2];
} ffd_seconds;

/* The weights of the selected vertices (ffd_deform_desc.weight). */
typedef struct ffd_weight_figures {
    bool is_there;      /* weights are given; if false, all other members are 0 */
    uint64_t zero, one; /* vertices with the weight 0, and 1 */
    uint64_t clamped;   /* vertices whose weight was below 0 or above 1 */
    double mean;        /* NaN without vertices */
    uint64_t room[2];
} ffd_weight_figures;

/* The most parts that move as one piece. */
#define FFD_RIGID_PARTS 64
/* A part that moves as one piece (ffd_deform_desc.rigid, uniform). */
typedef struct ffd_rigid_part {
    char part[128];  /* its selector, shortened to fit */
    uint64_t pieces; /* 1; of "component" the number of components; 0: it has no vertices */
    double rotation; /* degrees, 0 to 180: the largest of all pieces */
    double scale;    /* the one that is farthest from 1; of rigid 1 */
    double distance; /* the largest of a vertex from where it would lie otherwise */
} ffd_rigid_part;
typedef struct ffd_rigid_figures {
    uint64_t count; /* of parts: those of rigid, then those of uniform; 0: no part is named */
    ffd_rigid_part parts[FFD_RIGID_PARTS];
} ffd_rigid_figures;

/* A number of cells of the mesh at rest and deformed. */
typedef struct ffd_count_before_after {
    uint64_t before, after;
} ffd_count_before_after;
/* The cells of three dimensions of a volume mesh, by their Jacobians (ffd/cells.h), with positions as they
   are in the files. */
typedef struct ffd_cell_figures {
    bool is_there;  /* the mesh has such cells, and they were measured; if false, all other members are 0 */
    uint64_t count; /* of volume cells */
    ffd_count_before_after inverted; /* cells whose Jacobian is 0 or below somewhere */
    /* Cells whose Jacobian has one sign everywhere at rest, and not that sign everywhere deformed. A mesh
       that numbers its cells the other way round is judged by it, too. */
    uint64_t by_deformation;
    /* Cells that could not be decided: as they are deformed, or as they were at rest where they are inverted
       deformed. None of by_deformation. */
    uint64_t unknown;
    ffd_before_after scaled_jacobian; /* the least of any cell; NaN: none has one */
    bool has_worst;
    uint64_t worst; /* the cell that has it deformed, the first of several: its index from 0 among all cells
                       of the file, in their order */
    uint64_t room[4];
} ffd_cell_figures;

/* The names of the files that a job has written: first the output, as the caller has named it, then the files
   that belong to it (buffers, copied images and material libraries). ffd/job.h has its functions. One thread
   at a time. */
typedef struct ffd_output_list ffd_output_list;

/* The result of a job. Of a glTF all figures are of the shape that the default weights of morph targets show;
   if the deformation becomes a morph target itself (as_morph, morphs), of the base shape. With several morphs
   the figures of the job are the worst of any target: the counts of the target with the fewest vertices
   inside, the tear of the one with the largest step, the folds of all lattices, and bounds.after round
   all. */
typedef struct ffd_job_result {
    size_t struct_size; /* sizeof(ffd_job_result) in the caller's header, set before the call */
    ffd_status status;  /* what the function returned */
    ffd_error error;    /* details of a failure */
    uint64_t vertices;  /* selected vertices that are counted */
    /* Vertices by ffd_vertex_status. With several lattices a vertex is outside if it is outside of all of
       them; otherwise its status is the highest of those it has in the lattices. */
    uint64_t counts[FFD_VERTEX_STATUS_COUNT];
    /* Vertices that are not inside and not visible: in no face, line or point; of hidden nodes
       (KHR_node_visibility). counts and gates leave them out, unless they are not finite. */
    uint64_t unused, hidden;
    ffd_morph_target_figures morph_targets;
    uint64_t moved; /* vertices whose position changes */
    ffd_shared_face_figures shared_faces;
    ffd_max_rms residual; /* of C(u,v,w) - p, relative to the diagonal of the rest lattice */
    ffd_iteration_figures iterations;
    /* With ffd_check_run, ffd_deform_desc.quality and FFD_GATE_FOLDS. Of all lattices: the worst verdict
       (some, then unknown, then none), the sums of cells, the least min_det and what it is relative to, and
       the witness of the first lattice that has one. */
    ffd_folds folds;
    uint64_t folds_room[8];
    bool has_flipped; /* with ffd_check_run and ffd_deform_desc.quality, and of a mesh of at most 1,000
                         vertices: faces are counted */
    uint64_t faces, flipped_faces;
    ffd_tear_figures tear;
    /* With ffd_check_run and ffd_deform_desc.quality: the volume that all visible faces enclose, selected or
       not, in world space; negative if their back sides are outside. NaN if there are no faces or the surface
       is not closed: at some edge the numbers of faces in its two directions differ (vertices at the same
       position count as one). With several morphs the size after is NaN. */
    ffd_before_after volume;
    ffd_before_after area; /* likewise, of these faces */
    ffd_det_figures det;
    ffd_edge_figures edges;
    ffd_skin_weight_figures skin_weights;
    ffd_precision_figures precision;
    ffd_splat_figures splats;
    ffd_bounds_figures bounds;
    ffd_max_rms displacement;
    ffd_behind behind[FFD_BEHIND_KIND_COUNT]; /* indexed by ffd_behind_kind */
    ffd_behind behind_room[5];
    ffd_rig_figures rig;
    ffd_morph_results morphs;
    uint64_t indices_left; /* indices in glTF extensions that still refer to meshes and accessors before the
                              deformation */
    uint64_t bytes_left;   /* bytes of replaced morph targets and animations that remain in the glTF although
                              nothing uses them */
    uint64_t bounds_left;  /* boxes and spheres in glTF extensions and extras that are named as bounds of what
                              was deformed, and stay as they were before */
    ffd_flaw flaws[FFD_FLAWS]; /* flaw_count entries, of the input */
    uint64_t flaw_count;
    ffd_seconds seconds;
    const char *picture;          /* the output of ffd_view_run, belongs to its description; else NULL */
    bool own_box;                 /* a box "mesh" was laid round the mesh of this job */
    uint64_t normals_collapsed;   /* normals that keep their direction, because the deformed surface has none
                                     there */
    uint64_t normals_carried;     /* RECOMPUTE: normals without a face, which are transformed instead */
    uint64_t transforms_singular; /* vertices that stay because the matrix of their node or skin is not
                                     invertible */
    const ffd_output_list *outputs; /* ffd_deform_desc.output_list */
    const char *page;               /* of a job of a batch: its page (ffd_batch_desc.pages); else NULL */
    /* Of a job of a batch: why its picture has a frame of its own, unlike those of other jobs on its mesh:
       "far" or "options" (ffd_batch_desc.view); else NULL. */
    const char *own_frame;
    ffd_weight_figures weight;
    ffd_seam_figures seam;
    ffd_rigid_figures rigid;
    ffd_cell_figures cells; /* of a volume mesh */
} ffd_job_result;

#ifdef __cplusplus
}
#endif

#endif
