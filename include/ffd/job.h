/* job.h - whole jobs, as the program `ffd` runs them: read, embed, deform, judge, write, report. Meshes and
   lattices are files, or bytes and objects in memory; results are files, or go to a callback. */
#ifndef FFD_JOB_H
#define FFD_JOB_H

#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/fold.h>
#include <ffd/isa.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ffd_format {
    FFD_FORMAT_AUTO = 0, /* by the name's ending */
    FFD_FORMAT_OBJ,
    FFD_FORMAT_GLTF,
    FFD_FORMAT_GLB, /* .glb and .vrm */
    FFD_FORMAT_PLY,
    FFD_FORMAT_OFF,
    FFD_FORMAT_STL
} ffd_format;

/* The format that a file name's ending (or a bare ending, "obj") stands for, any case;
   FFD_FORMAT_AUTO if none. */
FFD_API ffd_format ffd_format_from_name(const char *name);

/* Normals and tangents follow the deformation; stay; are those of the deformed faces: corners that had
   one position and one normal get one again, from all faces around them, by area and angle. */
typedef enum ffd_normals { FFD_NORMALS_TRANSFORM = 0, FFD_NORMALS_KEEP, FFD_NORMALS_RECOMPUTE } ffd_normals;
typedef enum ffd_space { FFD_SPACE_SCENE = 0, FFD_SPACE_MESH } ffd_space;
/* Joints, pivots, sockets, cameras, lights and animations of a glTF stay where they are; or go along with the
   deformation, so that characters keep moving (src/maths.md 9.5). */
typedef enum ffd_rig { FFD_RIG_KEEP = 0, FFD_RIG_FOLLOW } ffd_rig;
/* Images of a glTF, material libraries and maps of an OBJ, whose output is in another folder: they are copied
   beside it; or the URIs of a glTF lead back to them. */
typedef enum ffd_resources { FFD_RESOURCES_COPY = 0, FFD_RESOURCES_REFERENCE } ffd_resources;

/* Quality gates, to be joined by |. A violated one fails the job with FFD_E_GATE before anything is written.
 */
typedef enum ffd_gate {
    /* A deformed volume folds, or is not proven not to; or, with EXTEND, det F <= 0 at a vertex outside. */
    FFD_GATE_FOLDS = 1,
    FFD_GATE_OUTSIDE = 2,  /* a vertex is outside of every lattice, or there is none */
    FFD_GATE_MULTIPLE = 4, /* a vertex has several u,v,w */
    FFD_GATE_SINGULAR = 8, /* a vertex is where the rest volume has no inverse */
    FFD_GATE_INVALID = 16, /* a vertex has a coordinate that is not finite */
    FFD_GATE_TEAR = 32, /* the largest step of a torn edge is more than tear_most; or, where that is negative,
                           any edge is torn */
    FFD_GATE_FLIPPED = 64, /* more faces are flipped than flipped_most */
    FFD_GATE_EDGES = 128   /* a straight edge lies farther than edges_most from the deformed surface */
} ffd_gate;

typedef enum ffd_log_level { FFD_LOG_WARNING = 0, FFD_LOG_INFO, FFD_LOG_DETAIL } ffd_log_level;

/* Takes one line without line break, in the calling thread. */
typedef void (*ffd_log_function)(void *user, ffd_log_level level, const char *line);

/* From now on SIGHUP, SIGINT, SIGPIPE, SIGQUIT and SIGTERM, where they would end the program, do so after the
   temporary files of what is being written are gone. For programs, at their start: the library by itself does
   nothing about signals. */
FFD_API void ffd_cleanup_on_signals(void);

/* Input files are mapped into memory where they are large. From now on one that becomes shorter while it is
   read makes the function that reads it fail with FFD_E_IO; without this the system ends the program by
   SIGBUS. For programs, at their start, since it installs a handler for SIGBUS: what that does not know as an
   input's it hands on to the handler that was there before. */
FFD_API void ffd_guard_inputs(void);

/* Brings back what a run had set aside to replace it (a .gltf and its buffers), and had not replaced when it
   was killed; or removes it, if the new files were in place. ffd_deform_run and ffd_embed_run do this for
   their outputs. path: the .gltf, or another output that several files belong to; no stream. Does nothing
   where there is nothing to do. Errors: FFD_E_IO, FFD_E_MEMORY. */
FFD_API ffd_status ffd_restore_output(const char *path, ffd_error *error);

/* Bytes that the caller lends until the job has ended. NULL: none; a size other than 0 is then refused. They
   are not changed, and not copied where they begin at a multiple of 8. */
typedef struct ffd_bytes {
    const void *data;
    size_t size;
} ffd_bytes;

/* Finds a file that a mesh in memory names: a buffer, an image, a material library and its maps. name is
   relative to the mesh, with "/", as the mesh has it but for "." and ".."; none leads out of its folder.
   *bytes is zeroed: what stays so is a file that is not there; a size without data ends the job with
   FFD_E_ARGUMENT. Bytes are lent until the job has ended. Called once for a name, by one thread at a time,
   mostly but not always the caller's. Any status but FFD_OK ends the job with it (with FFD_E_IO, if it is
   none of ffd_status), before anything is written. It is not called again then. */
typedef ffd_status (*ffd_resolve_function)(void *user, const char *name, ffd_bytes *bytes);

/* Takes a file that a job has made: name is the output's, or that of a file beside it in the output's folder
   ("out/head.gltf": "out/head.bin", "out/skin.png"). The bytes are lent during the call. Called by the
   caller's thread, when all that can be refused was refused and all files are complete: once for each, the
   output itself last. Nothing reaches it where the job fails before. Any status but FFD_OK ends the job with
   it, as above: those that it has taken by then it keeps, without the output. */
typedef ffd_status (*ffd_sink_function)(void *user, const char *name, const void *bytes, size_t size);

/* Takes the deformed vertices of a job's mesh: x, y, z of each, count of them, in the order of `ffd embed`
   and in the lattice's space (that of the scene; with FFD_SPACE_MESH that of each mesh), as doubles that are
   not rounded to the file's numbers. Vertices that are not selected, or that stay, are there as well; those
   of a node whose matrix has no inverse are NaN. Of a glTF they are the stored shapes, without weights of
   morph targets or an animation. Lent during the call, which the caller's thread makes once, with dry_run
   too: after all gates, and before the output. Any status but FFD_OK ends the job with it, as above. */
typedef ffd_status (*ffd_positions_function)(void *user, const double *positions, size_t count);

/* A mesh to read. */
typedef struct ffd_source {
    /* "-": standard input. With bytes only a name, which messages have and whose ending says the format where
       nothing else does; or NULL: "mesh". FFD_E_ARGUMENT for a name, or one of an output in memory, whose
       last part is empty, "." or "..". */
    const char *path;
    ffd_format format; /* AUTO is not possible for "-" */
    ffd_space space;   /* glTF: the space of the lattice */
    /* Bytes of memory that the mesh and the lattices of its job may take; 0, or less than that: 100 MB and 20
       times the size of their files. What asks for more (a short file can show or unpack any number of
       vertices, or ask for any number of control points) is refused with FFD_E_LIMIT. Estimated. */
    uint64_t memory;
    int threads; /* for reading and writing it: 0: those of the job, or all cores */
    /* Normals will not be asked for: a format may leave them out, and does not describe them then.
       ffd_deform_run decides on this itself. */
    bool only_positions;
    /* What the format's specification calls an error is FFD_E_INVALID even where its meaning is plain. Else
       the log is warned of it. */
    bool strict;
    /* allow_extension_count names of glTF extensions, or NULL: a file that requires them is deformed although
       they are not known, or not supported: FFD_E_UNSUPPORTED else. */
    const char *const *allow_extensions;
    size_t allow_extension_count;
    ffd_bytes bytes;              /* the mesh itself; no file is read then, not even one that it names: */
    ffd_resolve_function resolve; /* finds these; NULL: there are none. Only with bytes. */
    void *resolve_user;
    uint64_t source_room[4]; /* 0; for later versions */
} ffd_source;

/* What a mesh file has against the specification of its format, where its meaning is plain: viewers open the
   file, and no vertex could stand elsewhere. */
typedef struct ffd_flaw {
    char message[256]; /* the first one of its kind, as ffd_error has it */
    char pointer[128]; /* JSON pointer to it, "": none */
    uint64_t line;     /* its line from 1, 0: none */
    uint64_t count;    /* of the kind */
} ffd_flaw;
/* The kinds of one file; what is left over shares the last. */
#define FFD_FLAWS 8

/* Whether text is a selector as ffd_deform_desc's only takes it. Errors: FFD_E_ARGUMENT,
   with the nearest kind. */
FFD_API ffd_status ffd_selector_check(const char *text, ffd_error *error);

/* Whether text is an animation of weights as ffd_deform_desc's clips take it. Errors: FFD_E_ARGUMENT, with
   what stands where something else should, FFD_E_MEMORY. */
FFD_API ffd_status ffd_clip_check(const char *text, ffd_error *error);

/* The files that one run has written so far. Jobs that share the record neither replace nor read what an
   earlier one of them wrote: two names can lead to one file. One thread at a time. */
typedef struct ffd_written ffd_written;

FFD_API ffd_status ffd_written_create(ffd_written **written, ffd_error *error);
/* Frees the record and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_written_destroy(ffd_written **written);

/* What a job leaves for the next one: its mesh, where that stays as it is, its lattices, whether they fold,
   what the rest volumes are searched with, and the mesh's u,v,w in the rest lattice where there is only one.
   A job that needs the same again does not read or make it anew; its output and its figures but for the
   seconds are the same either way. One job at a time. */
typedef struct ffd_share ffd_share;

FFD_API ffd_status ffd_share_create(ffd_share **share, ffd_error *error);
/* For jobs of which each has another mesh: only lattices, and what their rest volumes are searched with. */
FFD_API ffd_status ffd_share_create_for_lattices(ffd_share **share, ffd_error *error);
/* Frees what is kept and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_share_destroy(ffd_share **share);

/* One box round the meshes of several jobs, for lattices whose box is "mesh" (`--shared-box`). */
typedef struct ffd_shared_box ffd_shared_box;

/* A box round nothing. */
FFD_API ffd_status ffd_shared_box_create(ffd_shared_box **box, ffd_error *error);
/* Frees the box and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_shared_box_destroy(ffd_shared_box **box);

/* The files that outputs were made from, as make and ninja read them: a rule "OUT: MESH BUFFERS IMAGES
   LATTICES EMBEDDING" for each job that succeeds. Streams are left out, and images and material libraries but
   those that are copied with the output. One thread at a time. */
typedef struct ffd_depfile ffd_depfile;

/* Starts a depfile that will be written to path ("-": standard output), under a temporary name until it is
   complete: what cannot be written is known before the first job. Of existing files it replaces depfiles only
   (FFD_E_EXISTS). Errors: FFD_E_IO, FFD_E_EXISTS, FFD_E_MEMORY. */
FFD_API ffd_status ffd_depfile_create(const char *path, ffd_depfile **depfile, ffd_error *error);
/* Frees a depfile; one that was not written leaves an old one, and nothing else behind. NULL and pointers to
   NULL are allowed. */
FFD_API void ffd_depfile_destroy(ffd_depfile **depfile);
/* Writes the depfile. At most once, after the jobs. */
FFD_API ffd_status ffd_depfile_write(ffd_depfile *depfile, ffd_error *error);

typedef struct ffd_deform_desc {
    size_t struct_size; /* sizeof(ffd_deform_desc) of the caller */
    ffd_source input;
    const char *output; /* path, "-" for standard output */
    /* May be another than the input's: the deformed mesh is then converted, in scene space, and the log is
       warned of what the output's format cannot hold. .gltf and .glb are one format in two containers. */
    ffd_format output_format;
    const char *const *lattices; /* lattice_count paths, applied in that order; at least one */
    size_t lattice_count;
    /* All lattices act on the mesh at rest, and each vertex is in one of them: the first that holds it. Else
       each acts on what the ones before have made. */
    bool blocks;
    /* set_count values for placeholders of the lattices' moves, or NULL. FFD_E_INVALID for one that no
       lattice has. */
    const ffd_setting *set;
    size_t set_count;
    ffd_outside outside;
    double falloff; /* EXTEND: the displacement fades to nothing over this distance, world units; 0: it
                       does not */
    /* A vertex that misses a lattice's volume by no more than this is inside, at the nearest point of its
       border: world units or, relative, parts of the rest lattice's diagonal. Whatever it is, a vertex is
       inside where its rounding reaches: half an ulp of the number in the file, half a step of quantized
       ones. */
    double snap;
    bool snap_relative;
    const char *embedding; /* the file that `ffd embed` made of this mesh and the only lattice, with this
                              snap, or NULL; not with blocks */
    unsigned fail_on;      /* of ffd_gate, with the values of some: */
    double tear_most;      /* negative: no edge may be torn */
    uint64_t flipped_most;
    double edges_most;
    bool quality; /* fill the result's folds, flipped faces and det F too: they cost time and memory */
    ffd_normals normals;
    /* FOLLOW: FFD_E_ARGUMENT with as_morph, in mesh space, and where input or output is no glTF. */
    ffd_rig rig;
    const char *as_morph; /* to glTF: leave the base shape and add the deformation as a morph target of this
                             name, weight 0, or replace the one of this name, whose weight stays; NULL: deform
                             it. ffd_check_run does not look at it. */
    /* To glTF: lattice_count names, each another, or NULL. The base shape is left, and each lattice by itself
       makes the morph target of its name, as as_morph makes one, in one pass over the mesh. Not with
       as_morph, blocks or, of several, embedding, and not for ffd_check_run and ffd_view_run. */
    const char *const *morphs;
    /* clip_count animations of the weights of morph targets, or NULL: texts "NAME: TIME TARGET=WEIGHT ...,
       TIME ..." (ffd_clip_check), seconds that ascend, between which weights are linear; a target that a time
       does not name has the weight 0 there. They name targets of morphs and of the file (FFD_E_ARGUMENT for
       others); targets that are neither keep their default weights. One of a clip's name is replaced. Only
       with morphs. */
    const char *const *clips;
    size_t clip_count;
    struct ffd_job_result *morph_results; /* filled: lattice_count, of each of morphs; or NULL */
    /* only_count selectors "KIND:NAME", or NULL: only what at least one of them names is moved, counted in
       the result and the gates, and inside of a lattice whose box is "mesh"; all else keeps every byte. glTF
       has the kinds node (with all below it), mesh, material; OBJ group, object, material; other formats have
       none. FFD_E_ARGUMENT for a kind or name that the file does not have. */
    const char *const *only;
    size_t only_count;
    ffd_resources resources;
    int threads; /* 0: all cores. Never changes a byte of the output. */
    ffd_isa isa; /* nor does this. FFD_E_ARGUMENT for one that is not available. */
    bool force;  /* overwrite an existing output */
    /* Overwrite an existing output only if it, or a file that belongs to it, would get other bytes: else all
       of them stay untouched. */
    bool if_changed;
    bool in_place; /* output is the input (output is NULL then) */
    /* Everything but the writing, unlike ffd_check_run with the refusals that concern the output and the
       files beside it; what only the writing finds out is not refused. */
    bool dry_run;
    ffd_written *written; /* of the run, or NULL */
    ffd_share *share;     /* with the jobs before and after, or NULL */
    /* What a lattice whose box is "mesh" goes round, in place of the job's own mesh; or NULL. */
    const ffd_shared_box *shared_box;
    ffd_depfile *depfile; /* gets the rule of the output, which is neither "-" nor in place; or NULL */
    ffd_log_function log; /* may be NULL */
    void *log_user;
    /* lattice_count objects, or NULL: one that is not NULL is taken in place of the file of its number, whose
       path is then a name for messages, or NULL. It is copied. Placeholders are of files only. */
    const ffd_lattice *const *lattice_objects;
    /* The same with the text of a file; not with an object of that number. FFD_E_ARGUMENT for a box round
       meshes, which a file names relative to itself. */
    const ffd_bytes *lattice_texts;
    ffd_bytes embedding_bytes; /* those of the file; embedding is then a name, or NULL */
    /* Takes what would be written, and nothing is: output is then a name, written is not looked at, and no
       file is in the way. FFD_E_ARGUMENT with in_place, depfile and FFD_RESOURCES_REFERENCE. */
    ffd_sink_function sink;
    void *sink_user;
    /* Takes the deformed positions, of ffd_deform_run and ffd_check_run; or NULL. With it output may be NULL:
       then no mesh is written, and as_morph, depfile and output_format are FFD_E_ARGUMENT. So are morphs. */
    ffd_positions_function positions;
    void *positions_user;
} ffd_deform_desc;

FFD_API void ffd_deform_desc_init(ffd_deform_desc *desc, size_t size);

/* Widens the box by the mesh of a job, or what its selectors leave, as the file has it. To be done for all
   jobs before the first of them runs. Errors: those of reading the mesh, and FFD_E_ARGUMENT for a stream,
   which could not be read again. */
FFD_API ffd_status ffd_shared_box_add(ffd_shared_box *box, const ffd_deform_desc *desc, ffd_error *error);

typedef struct ffd_bounds {
    double min[3], max[3]; /* min > max where there is no finite vertex */
} ffd_bounds;

/* What stays as it is where the mesh is moved. */
typedef enum ffd_behind_kind {
    FFD_BEHIND_SOCKET = 0, /* an empty node without children */
    FFD_BEHIND_CAMERA,
    FFD_BEHIND_LIGHT,
    FFD_BEHIND_JOINT,
    FFD_BEHIND_PIVOT, /* a node whose translation, rotation or scale is animated */
    FFD_BEHIND_PHYSICS_SHAPE,
    FFD_BEHIND_SPLAT, /* a Gaussian splat that is moved, by more than a translation of all, and whose rotation
                         and scale cannot follow: see splats_carried */
    FFD_BEHIND_KIND_COUNT
} ffd_behind_kind;

#define FFD_BEHIND_NAMES 3
typedef struct ffd_behind {
    uint64_t count;
    /* The first ones in the order of the file (of splats: what shows them), cut to the size, control
       characters as '?'; "": there is none. */
    char names[FFD_BEHIND_NAMES][80];
} ffd_behind;

/* Joints, pivots and sockets of a glTF: whether there are any, and how far they are from where the lattice
   moves the mesh. */
typedef struct ffd_rig_result {
    bool is_there; /* there are some, or other nodes follow; else all is 0 */
    uint64_t joints;
    uint64_t moved;     /* nodes that are written otherwise */
    uint64_t sheared;   /* of these: nodes that turn as their parents do, since they would be sheared else */
    uint64_t singular;  /* nodes that stay, as do those below them: their matrices have no inverse */
    uint64_t partial;   /* nodes that stay because their meshes are selected in part */
    uint64_t unscaled;  /* nodes with sizes that stay: of physics shapes, spring bones, eyes (VRM), splats */
    double largest_lag; /* |D(x) - x'| over joints, pivots and sockets */
    char worst[80]; /* the name of the first one with this lag, as ffd_behind has names; "": there is none */
    uint64_t lagging_skins, lagging_pivots, lagging_sockets; /* with some lag; skins: of some joint */
} ffd_rig_result;

/* What a job did: the figures of the report (data/schema/formats.md 2). Lengths in world units
   unless said otherwise. */
typedef struct ffd_job_result {
    size_t struct_size; /* sizeof(ffd_job_result) of the caller, set before the call */
    ffd_status status;
    ffd_error error;
    uint64_t vertices;
    uint64_t counts[FFD_VERTEX_STATUS_COUNT]; /* by ffd_vertex_status; of several lattices: outside is what is
                                                 outside of all, else the highest one */
    /* Vertices that are not inside and that nothing shows, which counts leaves out and no gate looks at: in
       no face, line or point; of hidden nodes (KHR_node_visibility). Those that are not finite are counted.
     */
    uint64_t unused, hidden;
    /* glTF: vertices that morph targets move outside of every lattice, or to coordinates that are not finite,
       once for each target; and those that the default weights of all targets move outside. The gates count
       these too. */
    uint64_t targets_outside, targets_invalid, shown_outside;
    bool own_box; /* a lattice's box was laid round the mesh of this job */
    uint64_t moved;
    double residual_max, residual_rms; /* relative to the diagonal of the rest lattice */
    double evaluations_mean;
    uint32_t evaluations_max;
    /* Of vertices that are not hidden, as default weights of morph targets show them; where the deformation
       becomes a morph target itself (as_morph), of the base. */
    ffd_bounds before, after;
    double displacement_max, displacement_rms;
    uint64_t
        moved_twice; /* vertices on a face that two lattices share, which both move, one after the other */
    uint64_t disagreeing; /* blocks: vertices on a face of theirs that another block moves otherwise */
    double disagreement;  /* the largest difference from the block that has the vertex */
    uint64_t normals_collapsed;
    uint64_t splats_carried;      /* Gaussian splats whose rotations, scales and harmonics follow; */
    uint64_t splats_flattened;    /* of these, those that lose a size, since F has no inverse there */
    uint64_t splats_broken;       /* that move without, since their rotation or scales are not numbers */
    uint64_t normals_carried;     /* RECOMPUTE: those without a face to be computed from, which
                                     follow the deformation */
    uint64_t transforms_singular; /* vertices kept because their node's or skin's matrix has no inverse */
    uint64_t weights_off;         /* vertices whose skin weights do not sum to 1: divided by their sum */
    double weights_farthest;      /* that such a sum is from 1 */
    uint64_t weights_none;        /* vertices without skin weights, which follow their first joint */
    bool has_folds;               /* the proof ran: for check, quality and FFD_GATE_FOLDS */
    ffd_folds folds;        /* of all lattices: the worst verdict (some, unknown, none), sums of cells, the
                               least min_det, the witness of the first lattice that has one */
    uint64_t folds_room[8]; /* for what ffd_folds gets in later versions, as all that is called room here */
    size_t folds_lattice;   /* number of the witness' lattice, from 0 */
    bool has_flipped;       /* for check and quality */
    uint64_t faces, flipped_faces;
    /* Torn edges: one end moves, and the other stays where the displacement does not fade, or moves otherwise
       although both are at one border or seam (src/maths.md 7.4). Edges that are not shown do not count.
       Counted for check, quality, FFD_GATE_TEAR, and where vertices stay in a mesh of at most 5.5 million. */
    bool has_tear;
    uint64_t tear_edges;
    double tear_largest; /* the largest step of one of them */
    uint64_t
        tear_vertex; /* an end of it, the one that stays if one does, from 0, in the order of `ffd embed` */
    char tear_part[256]; /* that has it: "node:NAME", "mesh:NAME", "group:NAME", "object:NAME"; "": no name */
    uint64_t tear_stays; /* vertices of that part, or else of the mesh, that stay */
    bool
        tear_unselected; /* it stays because it is not selected, or cannot be brought back to its own space */
    bool tear_between;   /* it moves too: other lattices of a chain than its neighbour's, or more or fewer */
    bool tear_seam; /* the edge crosses two rest faces of a lattice that coincide, and that are moved apart */
    bool tear_disagrees; /* blocks: it is on a common face, which another block moves otherwise */
    double det_outside;  /* with EXTEND: the least det F of vertices outside, where it is looked at (check,
                            quality, FFD_GATE_FOLDS); else infinite */
    uint64_t det_outside_vertex;
    double det_min, det_max; /* of F at the vertices, for check and quality; min > max where there is none */
    bool has_edges;          /* for check and FFD_GATE_EDGES */
    uint64_t edges;          /* each counted once */
    double deviation_max, deviation_mean;     /* of straight edges from the deformed surface */
    ffd_behind behind[FFD_BEHIND_KIND_COUNT]; /* by ffd_behind_kind */
    ffd_behind behind_room[5];
    ffd_rig_result rig;
    uint64_t rig_room[8];
    ffd_flaw flaws[FFD_FLAWS]; /* flaw_count, of the input */
    size_t flaw_count;
    uint64_t indices_left; /* indices in extensions of a glTF that do not follow its deformed meshes */
    const char *picture;   /* what ffd_view_run has written, lent by its description; else NULL */
    /* With morphs: their names, lattices and, where the description has room for them, figures: morph_count
       each (up to the one that a gate refuses), lent by the description: morph_lattices are its lattices,
       NULL where these are, or have no name. The figures above are then the worst ones of a target: counts of
       the one with the fewest vertices inside, what tears of the one with the largest step, folds of all,
       after round all. */
    size_t morph_count;
    const char *const *morphs;
    const char *const *morph_lattices;
    const struct ffd_job_result *morph_results;
    double seconds_read, seconds_embed, seconds_deform, seconds_judge, seconds_write;
    /* For check and quality: of all faces that are not hidden, selected or not, as the file places them,
       without what morph targets add. NaN: not known; area_after and volume_after where several morph targets
       are made, too. */
    double area_before, area_after;
    /* Enclosed by these faces; NaN where there are none, or they are not closed: where an edge has not as
       many faces that run along it one way as the other (vertices at one position are one). Negative where
       the faces show their backs outside. */
    double volume_before, volume_after;
    /* Of morph targets and animations of a glTF that were replaced: those that stay in the file, though
       nothing uses them any more. */
    uint64_t bytes_left;
} ffd_job_result;

/* Runs one job. Everything that can be refused is refused before anything is written; the output is complete
   or absent. result is filled in every case (not NULL). Returns result->status. Errors: all; FFD_E_GATE with
   all figures that were asked for. */
FFD_API ffd_status ffd_deform_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);

/* `ffd check`: everything that ffd_deform_run does but the writing, with all figures of the result. What desc
   says of outputs is not looked at. Vertices that are not finite are counted, no failure. result is filled in
   every case (not NULL). Returns result->status. Errors: all. */
FFD_API ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);

/* What vertices and faces are coloured by at first. */
typedef enum ffd_view_color {
    FFD_VIEW_DISPLACEMENT = 0, /* how far each vertex moves */
    FFD_VIEW_STATUS,           /* its ffd_vertex_status */
    FFD_VIEW_DET,              /* det F there: how many times larger a volume becomes */
    FFD_VIEW_PLAIN             /* base colours, colours of vertices */
} ffd_view_color;

/* `ffd view`: a page or a picture that shows a mesh before and after. */
typedef struct ffd_view_desc {
    size_t struct_size; /* sizeof(ffd_view_desc) of the caller */
    /* The mesh and what deforms it, as ffd_check_run takes it; lattice_count may be 0: the mesh is shown as
       it is. Its log gets the warnings. Its written has the output afterwards. */
    const ffd_deform_desc *job;
    /* The deformed mesh as a file, of as many vertices; NULL: it is deformed in memory. With it the lattices
       are drawn, and deform nothing. */
    const ffd_source *deformed;
    const char *output; /* a page: ends in .html or .htm; a picture: in .png */
    bool force;         /* overwrite an existing output */
    double camera[3]; /* the direction in which the camera is, seen from the mesh, y upwards; zeros: from the
                         right, above and in front */
    ffd_view_color color;
    bool full; /* a page shows all vertices; else at most 200,000: the mesh is simplified, and the page says
                  so */
    /* Of a picture, or of each in a row, in pixels; 0: 1600 and 900. A page is as large as its window. */
    uint32_t width, height;
    uint32_t frames; /* pictures in a row, from rest to deformed: 2 to 64; 0: before and after share one */
    /* Of the input, by its name; one without a name is "animation N", N from 0. A picture shows frames poses
       (0: 5) over its time in a row, and those of the deformed mesh in a row below; the lattices are not
       drawn. A page, which has all animations, opens with this one. NULL: none. The deformed mesh moves as
       its own file says, or where it is in memory as the input does. */
    const char *animation;
    bool as_stored; /* shapes are those that the file stores, as ffd_check_run judges them; else those that
                       default weights of morph targets show */
    ffd_sink_function sink; /* as ffd_deform_desc's, whose own is not looked at */
    void *sink_user;
} ffd_view_desc;

/* Shows before and after, colours by displacement, is not full. */
FFD_API void ffd_view_desc_init(ffd_view_desc *desc, size_t size);
/* Writes the output; it is complete or absent. A violated gate of the job ends in FFD_E_GATE after it was
   written. An image of the mesh that is missing or broken is grey in a picture, and warned of. result is
   filled in every case (not NULL): where lattices deform, as by ffd_check_run, of the shapes that are
   shown, and with picture. The mesh may take 400 MB where its source's memory allows less. Returns
   result->status. Errors: all. */
FFD_API ffd_status ffd_view_run(const ffd_view_desc *desc, ffd_job_result *result, ffd_error *error);

/* `ffd embed`: writes u,v,w (float64, N x 3, C order, NaN where outside; .npy version 1.0) to output and,
   where status_output is not NULL, the statuses (uint8, N). Both files or none. The lattice's "mesh" box is
   fitted to the mesh. counts may be NULL. */
typedef struct ffd_embed_desc {
    size_t struct_size;
    ffd_source input;
    /* May be without moves, and placeholders in its moves without values: only its rest matters. */
    const char *lattice;
    const char *output;
    const char *status_output;
    double snap; /* as ffd_deform_desc's */
    bool snap_relative;
    int threads;
    bool force;
    ffd_log_function log;
    void *log_user;
    const ffd_setting *set; /* set_count values for placeholders, as in ffd_deform_desc; or NULL */
    size_t set_count;
    const ffd_lattice *lattice_object; /* in place of the file, as in ffd_deform_desc; or NULL */
    ffd_bytes lattice_text;            /* the same */
    ffd_sink_function sink;            /* as ffd_deform_desc's, of both outputs */
    void *sink_user;
} ffd_embed_desc;

FFD_API void ffd_embed_desc_init(ffd_embed_desc *desc, size_t size);
FFD_API ffd_status ffd_embed_run(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error);

/* What it is that differs between two files. A position, normal, tangent or texture coordinate is one
   difference however many of its numbers differ, and so is a face, line or point. */
typedef enum ffd_difference_kind {
    FFD_DIFFERENCE_POSITION = 0,
    FFD_DIFFERENCE_NORMAL,
    FFD_DIFFERENCE_TANGENT,
    FFD_DIFFERENCE_TEXCOORD,
    FFD_DIFFERENCE_TOPOLOGY, /* faces, lines, points (glTF: indices); the number of vertices or faces */
    FFD_DIFFERENCE_OTHER,    /* colours, names, materials, JSON values, headers, the format, ... */
    FFD_DIFFERENCE_KIND_COUNT
} ffd_difference_kind;

/* "position", "normal", "tangent", "texcoord", "topology", "other"; NULL for no kind. Not to be freed. */
FFD_API const char *ffd_difference_kind_name(ffd_difference_kind kind);

typedef struct ffd_difference {
    ffd_difference_kind kind;
    bool measured;  /* a position, normal or tangent of both files: the next three are set */
    double a, b;    /* its coordinate that differs most, in each file */
    double amount;  /* |a - b|: world units for positions; infinite where only one of them is finite */
    char text[512]; /* one line: where and what; "": there is no such difference */
} ffd_difference;

typedef struct ffd_comparison {
    size_t struct_size; /* sizeof(ffd_comparison) of the caller, set before the call */
    bool equal;         /* no differences */
    /* false: the differences keep what follows from being matched (other formats, other numbers of vertices,
       another kind of statement): there may be more of them than were counted. */
    bool complete;
    uint64_t differences;                       /* all of them */
    uint64_t counts[FFD_DIFFERENCE_KIND_COUNT]; /* of each kind */
    ffd_difference first;                       /* in the order in which the files are compared */
    /* That of the largest amount: of the positions; where none differs of the normals, else of the tangents.
       text is "" where nothing measured differs. */
    ffd_difference worst;
    uint64_t positions_compared;     /* glTF: once for each node that shows them */
    double position_difference_max;  /* largest |a - b| of a coordinate, within the tolerance or not */
    double direction_difference_max; /* the same of normals and tangents */
    double tolerance;                /* in world units: a relative one as it came out */
    double direction_tolerance;
    double
        diagonal; /* of a's bounding box, in world units; 0 without vertices; only for a relative tolerance */
} ffd_comparison;

typedef struct ffd_compare_desc {
    size_t struct_size; /* sizeof(ffd_compare_desc) of the caller */
    ffd_source a, b;    /* only one of them may be "-" */
    /* Positions may differ by this much in each coordinate: world units, or, relative, parts of the diagonal
       of a's bounding box (of its finite vertices, as the default pose shows them). Not negative, not NaN. */
    double tolerance;
    bool relative;
    /* Normals and tangents may differ by this much in each component, which has no unit. */
    double direction_tolerance;
    ffd_log_function log; /* gets warnings that begin with the file's name; may be NULL */
    void *log_user;
} ffd_compare_desc;

/* No tolerances: both must be equal as numbers (0 and -0 are, two NaN are). */
FFD_API void ffd_compare_desc_init(ffd_compare_desc *desc, size_t size);

/* `ffd compare`: are a and b the same mesh, positions and directions within their tolerances and all else
   equal? What is not part of a mesh is not compared: blanks, comments, the way a number is written, the
   encoding of PLY and STL, where the buffers of a glTF lie. A NaN equals a NaN only, an infinity itself.
   Morph targets are positions, normals and tangents like others. Fills *comparison (not NULL) unless it
   fails. Errors: FFD_E_ARGUMENT for tolerances, and those of reading a mesh. */
FFD_API ffd_status ffd_compare_run(const ffd_compare_desc *desc, ffd_comparison *comparison,
                                   ffd_error *error);

/* The comparison of the files a and b (names as they are to be shown) as JSON ("ffd-comparison", version 1).
 *text is the caller's, freed with ffd_text_free, ends in a line break and 0. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_comparison_json(const ffd_comparison *comparison, const char *a, const char *b,
                                       char **text, ffd_error *error);

typedef struct ffd_info_desc {
    size_t struct_size; /* sizeof(ffd_info_desc) of the caller */
    ffd_source file;    /* a mesh, or with the ending .json and no format of its own a lattice */
    bool json;          /* else text for people */
    /* Of a mesh: every name that a selector of ffd_deform_desc's only can have, and what has none, with
       bounds and numbers of vertices and faces. FFD_E_ARGUMENT for a lattice. */
    bool parts;
    /* Of a lattice: set_count values for placeholders of its moves, or NULL; those without a value are told
       by their names. FFD_E_INVALID for one that it does not have, FFD_E_ARGUMENT for a mesh. */
    const ffd_setting *set;
    size_t set_count;
    ffd_log_function log; /* gets warnings that begin with the file's name; may be NULL */
    void *log_user;
} ffd_info_desc;

FFD_API void ffd_info_desc_init(ffd_info_desc *desc, size_t size);

/* `ffd info`: describes a mesh or lattice file. *text is the caller's, freed with ffd_text_free, ends in a
   line break and 0; NULL after a failure. */
FFD_API ffd_status ffd_info_run(const ffd_info_desc *desc, char **text, ffd_error *error);

/* `ffd lattice new`: makes one lattice round all that the meshes show (in scene space), or, where they show
   nothing, round all their vertices, and writes it. */
typedef struct ffd_lattice_new_desc {
    size_t struct_size;       /* sizeof(ffd_lattice_new_desc) of the caller */
    const ffd_source *meshes; /* mesh_count, at least one */
    size_t mesh_count;
    /* only_count selectors "KIND:NAME", or NULL: the lattice goes round what at least one of them names. Each
       mesh must have every name. */
    const char *const *only;
    size_t only_count;
    const ffd_lattice_desc *lattice;
    const char *output;   /* path, "-" for standard output */
    bool force;           /* overwrite an existing output */
    ffd_log_function log; /* gets warnings that begin with a mesh's name; may be NULL */
    void *log_user;
    ffd_sink_function sink; /* as ffd_deform_desc's */
    void *sink_user;
} ffd_lattice_new_desc;

FFD_API void ffd_lattice_new_desc_init(ffd_lattice_new_desc *desc, size_t size);
FFD_API ffd_status ffd_lattice_new_run(const ffd_lattice_new_desc *desc, ffd_error *error);

/* The report (data/schema/formats.md 2). Entries are added in the order of the jobs, and
   go to its file at once. */
typedef struct ffd_report ffd_report;

/* Starts a report at path ("-": standard output): JSON, or of a name that ends in .jsonl JSON Lines, an entry
   a line. A file stands under its own name from now on, so that what cannot be written is known before the
   first job; it is whole JSON after each entry, and what was added stays where the program is killed. Of
   existing files it replaces its own kind only (FFD_E_EXISTS). stable: without times. written may be NULL.
   Errors: FFD_E_IO, FFD_E_EXISTS, FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_create(const char *path, bool stable, ffd_written *written, ffd_report **report,
                                     ffd_error *error);
/* The same in memory: ffd_report_write hands the whole report to sink. name says JSON or JSON Lines. Errors:
   FFD_E_ARGUMENT (no name or sink), FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_create_sink(const char *name, bool stable, ffd_sink_function sink, void *user,
                                          ffd_report **report, ffd_error *error);
/* Frees a report; a file keeps the entries that were added. NULL and pointers to NULL are allowed. */
FFD_API void ffd_report_destroy(ffd_report **report);
FFD_API ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                                  const ffd_job_result *result, ffd_error *error);
/* Completes the report. At most once, after the jobs. */
FFD_API ffd_status ffd_report_write(ffd_report *report, ffd_error *error);

/* `ffd report merge`: joins count reports (at least one; "-": standard input) to one and writes it to
   output ("-": standard output). Names that end in .jsonl are of JSON Lines. Every entry keeps its bytes. The
   entries of one report follow those of the one before; interleave: one of each report in turn, which for
   those of the shards 0 to count-1 is the order of the manifest (FFD_E_INVALID where one has too few entries
   for that). All are checked before anything is written,
   and held in memory only where they are no files. Errors: FFD_E_ARGUMENT, FFD_E_IO, FFD_E_EXISTS,
   FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_LIMIT, FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_merge_run(const char *const *reports, size_t count, bool interleave,
                                        const char *output, bool force, ffd_error *error);

/* The same as ffd_free (ffd/lattice.h), for a text. */
FFD_API void ffd_text_free(char *text);

#ifdef __cplusplus
}
#endif

#endif
