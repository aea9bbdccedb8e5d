/* job.h - whole jobs, as the program `ffd` runs them: read a mesh, embed it, deform it, judge the result,
   write it, report it. Meshes and lattices come from files or from memory; results go to files or to
   callbacks.

   Strings, arrays and objects that a description points to belong to the caller and are used during the call
   only. Jobs may run in several threads at once if they share no ffd_output_set, ffd_job_cache,
   ffd_shared_box, ffd_depfile or ffd_report, and write different outputs. */
#ifndef FFD_JOB_H
#define FFD_JOB_H

#include <ffd/author.h>
#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/isa.h>
#include <ffd/lattice.h>
#include <ffd/result.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Mesh formats. */
typedef enum ffd_format {
    FFD_FORMAT_AUTO = 0, /* by the ending of the file name */
    FFD_FORMAT_OBJ,
    FFD_FORMAT_GLTF,
    FFD_FORMAT_GLB, /* .glb and .vrm */
    FFD_FORMAT_PLY,
    FFD_FORMAT_OFF,
    FFD_FORMAT_STL,
    FFD_FORMAT_VTK, /* legacy */
    FFD_FORMAT_SU2,
    FFD_FORMAT_VTU,
    FFD_FORMAT_VTP,
    FFD_FORMAT_VTS,
    FFD_FORMAT_MSH, /* Gmsh */
    FFD_FORMAT_FOAM /* OpenFOAM: the file points, with faces, owner and others beside it */
} ffd_format;

/* Returns the format of a file name by its ending (or of a bare ending, "obj"), in upper or lower case;
   FFD_FORMAT_FOAM of a file called "points" or "points.gz"; FFD_FORMAT_AUTO of all others. Thread-safe. */
FFD_API ffd_format ffd_format_from_name(const char *name);
/* The endings that it knows, and foam, in words. */
#define FFD_FORMAT_NAMES "obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam"
/* Checks that it knows the format of a file name. Thread-safe. Errors: FFD_E_ARGUMENT (the message has the
   ending, and FFD_FORMAT_NAMES; of "-": that the format must be given). */
FFD_API ffd_status ffd_format_check_name(const char *name, ffd_error *error);

/* Normals and tangents: TRANSFORM multiplies normals by the cofactor matrix of the deformation gradient and
   tangents by the gradient (src/maths.md 9.1); KEEP leaves them as they are; RECOMPUTE computes them from the
   deformed faces (src/maths.md 9.2): corners that had the same position and the same normal share one normal
   again, the mean of the faces around them weighted by area and angle. */
typedef enum ffd_normals { FFD_NORMALS_TRANSFORM = 0, FFD_NORMALS_KEEP, FFD_NORMALS_RECOMPUTE } ffd_normals;
/* The space of the lattice for a glTF: SCENE is world space, in which nodes and skins of the default pose
   place the meshes; MESH is the local space of each mesh. */
typedef enum ffd_space { FFD_SPACE_SCENE = 0, FFD_SPACE_MESH } ffd_space;
/* The joints, pivots, sockets, cameras, lights and animations of a glTF: KEEP leaves them where they are,
   FOLLOW moves them with the deformation, so that characters can still be animated (src/maths.md 9.5). */
typedef enum ffd_rig { FFD_RIG_KEEP = 0, FFD_RIG_FOLLOW } ffd_rig;
/* What happens to the images of a glTF, and to the material libraries and maps of an OBJ, if the output is in
   another folder than the input: COPY copies them next to the output; REFERENCE (glTF only) rewrites the URIs
   so that they lead to the original files; REFRESH copies them too, and replaces a copy that is still as an
   earlier run has made it, where its original has changed. */
typedef enum ffd_resources {
    FFD_RESOURCES_COPY = 0,
    FFD_RESOURCES_REFERENCE,
    FFD_RESOURCES_REFRESH
} ffd_resources;

/* In place of the faces of ffd_lattice_seal: those that the mesh cuts. A mesh cuts the faces that a vertex
   outside of the lattice is beyond (those of the nearest point of the border) if an edge of a mesh face leads
   from it to a vertex inside. */
#define FFD_FACES_CUT 0u

/* Quality gates, combined with |. If one is violated, the job fails with FFD_E_GATE before it writes
   anything. */
typedef enum ffd_gate {
    /* A deformed volume folds, or is not proven to be without folds; or, with FFD_OUTSIDE_EXTEND, det F <= 0
       at a vertex outside. */
    FFD_GATE_FOLDS = 1,
    FFD_GATE_OUTSIDE = 2,  /* a vertex is outside of every lattice, or the mesh has no vertices */
    FFD_GATE_MULTIPLE = 4, /* a vertex has several u,v,w */
    FFD_GATE_SINGULAR = 8, /* a vertex is where the rest volume is not invertible */
    FFD_GATE_INVALID = 16, /* a coordinate of a vertex is not finite */
    FFD_GATE_TEAR = 32,    /* the largest step of a torn edge exceeds tear_most; if tear_most is negative: an
                              edge is torn */
    FFD_GATE_FLIPPED = 64, /* more than flipped_most faces are flipped */
    FFD_GATE_EDGES = 128,  /* a straight edge is farther than edges_most from the deformed surface */
    /* Of volume meshes; of others FFD_E_ARGUMENT. INVERTED: more than inverted_most cells are inverted by the
       deformation or could not be decided. QUALITY: the least scaled Jacobian of the deformed cells is below
       quality_least, none has one, or a cell could not be decided. */
    FFD_GATE_INVERTED = 256,
    FFD_GATE_QUALITY = 512
} ffd_gate;

/* The importance of a log line. The program `ffd` shows warnings, and with `-v` all lines. */
typedef enum ffd_log_level { FFD_LOG_WARNING = 0, FFD_LOG_INFO, FFD_LOG_DETAIL } ffd_log_level;

/* Receives one line without a line break, during the call only, in the thread that called the library. */
typedef void (*ffd_log_function)(void *user, ffd_log_level level, const char *line);

/* Recovers the files of an output of several files (a .gltf and its buffers) after a run that replaced them
   was killed: either restores the old files, which the run had set aside, or removes them if all new files
   are in place. ffd_deform_run and ffd_embed_run do this for their outputs. path: the .gltf, or the main file
   of another such output; not "-". Does nothing if there is nothing to recover. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_restore_output(const char *path, ffd_error *error);

/* Provides a file that a mesh in memory refers to: a buffer, an image, a material library or a map, or one
   beside the points of OpenFOAM ("faces").
   - name: relative to the mesh, with "/", as in the mesh except that "." and ".." are resolved; it never
     leads out of the mesh's folder.
   - bytes: zeroed before the call; leave it so if the file does not exist. A size without data ends the job
     with FFD_E_ARGUMENT. The bytes must stay valid until the job ends.

   Called once for each name, by one thread at a time, which is not always the thread that called the library.
   A result other than FFD_OK ends the job with this status before it writes anything (FFD_E_IO if it is not
   an ffd_status); there are no further calls. */
typedef ffd_status (*ffd_resolve_function)(void *user, const char *name, ffd_bytes *bytes);

/* Receives a file that a job has made. name is that of the output or, for a further file, a name in the
   folder of the output ("out/head.gltf": "out/head.bin", "out/skin.png"). bytes are valid during the call
   only. Called in the thread that called the library, once for each file and for the output itself last,
   after all checks have passed and all files are complete; a job that fails before that makes no call. A
   result other than FFD_OK ends the job as for ffd_resolve_function: the callee has then received some files
   without the output. */
typedef ffd_status (*ffd_sink_function)(void *user, const char *name, const void *bytes, size_t size);

/* Receives the deformed vertices of the mesh of a job: x,y,z of count vertices, in the order of `ffd embed`,
   in the space of the lattice (ffd_space), before rounding to the number type of the file. It includes
   vertices that are not selected or do not move; vertices of a node whose matrix is not invertible are NaN.
   For a glTF these are the stored shapes, without morph targets and animations. positions is valid during the
   call only. Called once, in the thread that called the library, after all gates and before the output is
   written; also with dry_run. A result other than FFD_OK ends the job as for ffd_resolve_function. */
typedef ffd_status (*ffd_positions_function)(void *user, const double *positions, size_t count);

/* A mesh to read. */
typedef struct ffd_source {
    /* "-": standard input. With bytes it is only a name for messages, and its ending says the format if
       format is FFD_FORMAT_AUTO; NULL then stands for "mesh". FFD_E_ARGUMENT if the last component of such a
       name, or of that of an output in memory, is empty, "." or "..", or if the name means a stream. */
    const char *path;
    ffd_format format; /* FFD_FORMAT_AUTO is not allowed for "-" */
    ffd_space space;   /* of the lattice; for glTF only */
    /* Memory budget in bytes for the mesh and the lattices of its job. The least budget, and the default (0),
       is 100 MB plus 20 times the size of their files. Input that needs more by estimate is refused with
       FFD_E_LIMIT: a short file can unpack to any number of vertices or ask for any number of control
       points. */
    uint64_t memory;
    int threads; /* for reading and writing the mesh; 0: those of the job, or all cores */
    /* Normals are not needed: a reader may skip them, and then does not describe them. ffd_deform_run sets
       this itself. */
    bool only_positions;
    /* true: violations of the format's specification are FFD_E_INVALID. false: those whose meaning is clear
       are only logged as warnings (ffd_flaw). */
    bool strict;
    /* allow_extension_count names of glTF extensions, or NULL. A file that requires an extension which is
       unknown or not supported is FFD_E_UNSUPPORTED, unless the extension is listed here. */
    const char *const *allow_extensions;
    size_t allow_extension_count;
    /* The content of the mesh file. No files are then read, not even those that the mesh refers to; resolve
       provides them. */
    ffd_bytes bytes;
    ffd_resolve_function resolve; /* with bytes only; NULL: no such files exist */
    void *resolve_user;           /* passed to resolve */
    uint64_t source_room[4];      /* reserved, 0 */
} ffd_source;

/* Checks the syntax of a selector, as in ffd_deform_desc.only. Thread-safe. Errors: FFD_E_ARGUMENT; the
   message names the most similar kind. */
FFD_API ffd_status ffd_selector_check(const char *text, ffd_error *error);

/* Checks the syntax of an animation of weights, as in ffd_deform_desc.clips. Thread-safe. Errors:
   FFD_E_ARGUMENT (the message quotes what is wrong), FFD_E_MEMORY. */
FFD_API ffd_status ffd_clip_check(const char *text, ffd_error *error);

/* The set of files that a run has written. Jobs that share it neither overwrite nor read what an earlier one
   of them wrote; files are compared by identity, because several names can lead to one file. One thread at a
   time. */
typedef struct ffd_output_set ffd_output_set;

/* Creates an empty set. The caller destroys *output_set. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_output_set_create(ffd_output_set **output_set, ffd_error *error);
/* Destroys the set and sets *output_set to NULL. output_set and *output_set may be NULL. */
FFD_API void ffd_output_set_destroy(ffd_output_set **output_set);

/* A cache that a job leaves for the next one: the mesh (if it is unchanged), the lattices, their fold proofs
   and search structures, and, for a single lattice, the u,v,w of the mesh. The output and all figures except
   the seconds are the same with and without a cache. One job at a time. */
typedef struct ffd_job_cache ffd_job_cache;

/* Creates an empty cache. The caller destroys *cache. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_job_cache_create(ffd_job_cache **cache, ffd_error *error);
/* As ffd_job_cache_create, for jobs that all have different meshes: keeps only lattices and their search
   structures. */
FFD_API ffd_status ffd_job_cache_create_for_lattices(ffd_job_cache **cache, ffd_error *error);
/* Destroys the cache and sets *cache to NULL. cache and *cache may be NULL. */
FFD_API void ffd_job_cache_destroy(ffd_job_cache **cache);

/* One box round the meshes of several jobs, for lattices whose box is "mesh" (`--shared-box`). One thread at
   a time; jobs only read it. */
typedef struct ffd_shared_box ffd_shared_box;

/* Creates an empty box. The caller destroys *box. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_shared_box_create(ffd_shared_box **box, ffd_error *error);
/* Destroys the box and sets *box to NULL. box and *box may be NULL. */
FFD_API void ffd_shared_box_destroy(ffd_shared_box **box);

/* A dependency file for make and ninja: a rule "OUT FILES: MESH BUFFERS IMAGES LATTICES EMBEDDING" for each
   job that succeeds; FILES are those that it writes beside OUT. Standard streams are left out; images and
   material libraries are listed only if they are copied with the output. One thread at a time. */
typedef struct ffd_depfile ffd_depfile;

/* Starts a dependency file at path ("-": standard output). It is written under a temporary name until it is
   complete, so an unwritable path fails before the first job. An existing file is replaced only if it is a
   dependency file. The caller destroys *depfile. Errors: FFD_E_IO, FFD_E_EXISTS, FFD_E_MEMORY. */
FFD_API ffd_status ffd_depfile_create(const char *path, ffd_depfile **depfile, ffd_error *error);
/* Destroys the object and sets *depfile to NULL. Without ffd_depfile_write an old file stays as it was, and
   no temporary file remains. depfile and *depfile may be NULL. */
FFD_API void ffd_depfile_destroy(ffd_depfile **depfile);
/* Writes the file under its own name. To be called at most once, after the jobs. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_depfile_write(ffd_depfile *depfile, ffd_error *error);

/* Creates an empty list of outputs (ffd/result.h). The caller destroys *list. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_output_list_create(ffd_output_list **list, ffd_error *error);
/* Destroys the list and sets *list to NULL. list and *list may be NULL. */
FFD_API void ffd_output_list_destroy(ffd_output_list **list);
/* Returns the number of names, of the last job. */
FFD_API size_t ffd_output_list_count(const ffd_output_list *list);
/* Returns a name, which is valid until the next job; NULL if index is not less than the number. */
FFD_API const char *ffd_output_list_name(const ffd_output_list *list, size_t index);

/* An embedding of a job: a file, or its bytes. */
typedef struct ffd_embedding_source {
    const char
        *path; /* the file; with bytes only a name for messages, or NULL, which stands for "embedding" */
    ffd_bytes bytes; /* the content of such a file */
} ffd_embedding_source;

/* The weights of the vertices of a job: how far each takes part in the deformation. */
typedef struct ffd_weight_source {
    /* Where they are; a text of these, or of one of them after "1-", which means 1 - w:
       - "FILE.npy": a NumPy array of float32 or float64, of the shape (N) or (N, 1), in the order of
         `ffd embed`. With bytes it is only a name, or NULL, which stands for "weight.npy".
       - "attribute:NAME": a SCALAR attribute of a glTF, floats or normalized integers.
       - "color:r" (g, b, a): COLOR_0 of a glTF as stored, the colours of an OBJ or PLY.
       - "joint:NAME": the weight of the joints of that name in the skin of a glTF, divided by the sum of all.
       - "property:NAME": a property of the vertices of a PLY, or an array of the points of a VTK file: float
       or double; uchar, ushort as fractions. */
    const char *source;
    ffd_bytes bytes; /* the content of FILE.npy */
} ffd_weight_source;

/* Checks the syntax of a source of weights. Thread-safe. Errors: FFD_E_ARGUMENT (the message lists the
   forms). */
FFD_API ffd_status ffd_weight_check(const char *text, ffd_error *error);
/* Returns the file that a source of weights names: the end of the text; NULL: it names none. Thread-safe. */
FFD_API const char *ffd_weight_file(const char *text);

/* A job of `ffd deform` or `ffd check`. Fill with ffd_deform_desc_init, then set input, output and
   lattices. */
typedef struct ffd_deform_desc {
    size_t struct_size; /* sizeof(ffd_deform_desc) in the caller's header */
    ffd_source input;   /* the mesh */
    const char *output; /* path; "-": standard output */
    /* If it differs from the format of the input, the deformed mesh is converted, in scene space; the log is
       warned of what the format cannot hold. .gltf and .glb are the same format in two containers. */
    ffd_format output_format;
    const ffd_lattice_source *lattices; /* lattice_count lattices (>= 1), applied in this order */
    size_t lattice_count;
    /* false: each lattice acts on the result of those before it. true: all lattices act on the mesh at rest,
       and each vertex belongs to the first lattice that holds it. */
    bool blocks;
    /* set_count values for placeholders in the moves of the lattices, or NULL. FFD_E_INVALID for a
       placeholder that no lattice has. */
    const ffd_setting *set;
    size_t set_count;
    ffd_outside outside; /* for vertices without u,v,w in a lattice */
    /* With FFD_OUTSIDE_EXTEND: the distance in world units over which the displacement fades to 0; 0: it does
       not fade. */
    double falloff;
    /* A vertex that is outside of a lattice's volume by at most this distance is inside, at the nearest point
       of the border. World units, or with snap_relative a fraction of the diagonal of the rest lattice; >= 0.
       A vertex is inside also if the rounding of its stored coordinates (half an ulp, or half a quantization
       step) reaches the volume. */
    double snap;
    bool snap_relative;
    /* What `ffd embed` made of this mesh and the only lattice with the same snap, to be reused; or nothing.
       Not with blocks. */
    ffd_embedding_source embedding;
    unsigned fail_on; /* ffd_gate flags; the next three are the limits of some gates, the last members too */
    double tear_most; /* FFD_GATE_TEAR: world units; negative: no edge may be torn */
    uint64_t flipped_most; /* FFD_GATE_FLIPPED: number of faces */
    double edges_most;     /* FFD_GATE_EDGES: world units */
    bool quality; /* also compute the folds, flipped faces and det F of the result, which takes time and
                     memory */
    ffd_normals normals; /* normals and tangents of the output */
    /* FOLLOW is FFD_E_ARGUMENT with as_morph, in mesh space, and if the input or the output is not a glTF. */
    ffd_rig rig;
    /* glTF output: keep the base shape, and store the deformation as a morph target of this name with weight
       0. An existing target of this name is replaced and keeps its weight. NULL: deform the base shape.
       ffd_check_run ignores it. */
    const char *as_morph;
    /* glTF output: lattice_count different names, or NULL. The base shape is kept, and each lattice by itself
       makes the morph target of its name, as with as_morph, in one pass over the mesh. Not with as_morph or
       blocks, nor with embedding if there are several lattices, and not for ffd_check_run and
       ffd_view_run. */
    const char *const *morphs;
    /* clip_count animations of morph target weights, or NULL; only with morphs. Each is a text "NAME: TIME
       TARGET=WEIGHT ..., TIME ..." (ffd_clip_check) with ascending times in seconds. Weights are interpolated
       linearly; a target that is not named at a time has the weight 0 there. Targets are those of morphs and
       of the file (others are FFD_E_ARGUMENT); targets that no time names keep their default weights. An
       existing animation of the same name is replaced. */
    const char *const *clips;
    size_t clip_count;
    struct ffd_job_result *morph_results; /* lattice_count results, filled with those of each morph target; or
                                             NULL */
    /* only_count selectors "KIND:NAME", or NULL for all of the mesh. Only the parts that match at least one
       of them are moved, are counted in the result and by the gates, and determine a box "mesh"; everything
       else keeps its bytes. The kinds are node (with its descendants), mesh and material for glTF; group,
       object and material for OBJ; other formats have none. FFD_E_ARGUMENT for a kind or name that the file
       does not have. */
    const char *const *only;
    size_t only_count;
    ffd_resources resources; /* images and material libraries, if the output is in another folder */
    int threads;             /* >= 1, or 0 for all cores; does not affect the output */
    ffd_isa isa;             /* does not affect the output; FFD_E_ARGUMENT if not available */
    bool force;              /* overwrite an existing output */
    /* Overwrite an existing output only if its bytes, or those of a file that belongs to it, would change;
       otherwise all of them stay untouched. */
    bool if_changed;
    bool in_place; /* overwrite the input; output must be NULL */
    /* Do everything except writing. Unlike ffd_check_run, this includes the checks of the output path and of
       the files next to it; only errors of the writing itself are not found. */
    bool dry_run;
    ffd_output_set *output_set; /* the files of this run; may be NULL */
    ffd_job_cache *cache;       /* the cache of this run; may be NULL */
    /* The box for lattices whose box is "mesh", instead of the bounds of this mesh; may be NULL. */
    const ffd_shared_box *shared_box;
    ffd_depfile *depfile; /* receives the rule of the output; not with "-" and in_place; may be NULL */
    ffd_log_function log; /* receives warnings and, by level, more; may be NULL */
    void *log_user;       /* passed to log, as the other _user members to their functions */
    /* Receives what would be written; no file is written then. output is only a name, written is ignored, and
       existing files do not matter. FFD_E_ARGUMENT with in_place, depfile and FFD_RESOURCES_REFERENCE. */
    ffd_sink_function sink;
    void *sink_user;
    /* Receives the deformed positions, in ffd_deform_run and ffd_check_run; may be NULL. With it output may
       be NULL, to write no mesh; as_morph, morphs, depfile and output_format are FFD_E_ARGUMENT then. */
    ffd_positions_function positions;
    void *positions_user;
    /* A job that takes longer than so many seconds fails with FFD_E_LIMIT and writes nothing; 0: no limit.
       The job looks at the time at least between its steps. */
    double timeout;
    /* Make the folder of output, and those above it, just before the output is written. A job that fails
       leaves none that it made and that is empty. false: a missing folder is FFD_E_IO. */
    bool make_folders;
    /* Receives the names of the files that the job writes or, with dry_run, would write; also those that stay
       because they are up to date. Empty after a failure, and of ffd_check_run. May be NULL. */
    ffd_output_list *output_list;
    /* Called in the thread that called the library, several times a second while the job runs and at its end,
       with the finished fraction, 0..1, which never falls. If it returns false, the job fails with
       FFD_E_CANCELLED and writes nothing, after some tenths of a second; what a library does in one call, as
       to unpack a primitive, is ended first. Once the outputs are complete the answer does not matter. Of
       ffd_deform_run, ffd_check_run and ffd_view_run; NULL: no callback. */
    bool (*progress)(void *user, double done);
    void *progress_user;
    /* The same functions cancel the job also when *cancel is not 0. Another thread or the handler of a signal
       may set it, by an atomic store; NULL: nobody does. */
    const int *cancel;
    /* With has_time: lattices that have keys (ffd_lattice_set_time) are taken as they are at this time, in
       seconds; FFD_E_ARGUMENT where none has. Else they are taken as they are at their first key, and objects
       as they are. */
    double time;
    bool has_time;
    /* Weights of the vertices, from 0 to 1 (others are clamped, with a warning): a vertex moves by w times
       the displacement by all lattices together. Nothing: all are 1. FFD_E_INVALID for a selected vertex
       without a weight, or with one that is not finite. Not with FFD_RIG_FOLLOW. */
    ffd_weight_source weight;
    /* Hold faces of every lattice (ffd_lattice_seal) so that the deformed part joins the rest with this
       continuity; u,v,w stay those of the lattices as they are. seam_faces: FFD_FACES_CUT (default; of each
       lattice those that the mesh cuts as it reaches it; of blocks, that the mesh cuts where it leaves all of
       them), FFD_FACES_ALL, or faces of ffd_lattice_seal that all lattices have. FFD_E_ARGUMENT for a face of
       a closed direction, or a continuity that is not below the degree. */
    ffd_seam seam;
    unsigned seam_faces;
    /* rigid_count and uniform_count selectors of parts, or NULL: each moves as one piece, by the rigid motion
       (uniform: the similarity) that is nearest, in least squares, to where its vertices would lie. Of those
       that `only` leaves: what a selector of `only` names; "joint:NAME", the vertices that follow the joints
       of that name with more than half of their weight; "component", each connected component by itself of
       what no other selector names. With FFD_RIG_FOLLOW the nodes of a part move with it. At most
       FFD_RIGID_PARTS, a vertex in one of them. FFD_E_ARGUMENT for more, for an unknown name, for a vertex of
       two. Not with morphs. */
    const char *const *rigid;
    size_t rigid_count;
    const char *const *uniform;
    size_t uniform_count;
    uint64_t inverted_most; /* FFD_GATE_INVERTED: number of cells */
    double quality_least;   /* FFD_GATE_QUALITY: a scaled Jacobian, -1 to 1 */
} ffd_deform_desc;

/* Sets desc to defaults: all members 0, NULL or false. size: sizeof(ffd_deform_desc) in the caller's
   header. */
FFD_API void ffd_deform_desc_init(ffd_deform_desc *desc, size_t size);

/* Extends the box by the mesh of a job, or by what its selectors match, at rest. To be called for all jobs
   before the first of them runs. Errors: those of reading the mesh; FFD_E_ARGUMENT for standard input, which
   cannot be read twice. */
FFD_API ffd_status ffd_shared_box_add(ffd_shared_box *box, const ffd_deform_desc *desc, ffd_error *error);

/* Checks several jobs that differ in their meshes and outputs only, before the first of them runs: that no
   two write one file, and that none reads what another one writes. job: their settings; outputs: NULL if they
   are in place. Errors: FFD_E_ARGUMENT (two have one name), FFD_E_INVALID, FFD_E_MEMORY. */
FFD_API ffd_status ffd_deform_check_many(const ffd_deform_desc *job, const char *const *inputs,
                                         const char *const *outputs, size_t count, ffd_error *error);

/* Runs a job. It makes all checks before it writes anything; the output is complete or absent. result is
   filled in every case, also after a failure. Returns result->status. Errors: any; with FFD_E_GATE the
   requested figures are complete. */
FFD_API ffd_status ffd_deform_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);

/* Runs a job of `ffd check`: as ffd_deform_run without an output, with all figures of the result. Members of
   desc that concern outputs are ignored. Vertices that are not finite are counted and do not fail the job.
   result is filled in every case. Returns result->status. Errors: any. */
FFD_API ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);

/* The initial colouring of vertices and faces. */
typedef enum ffd_view_color {
    FFD_VIEW_DISPLACEMENT = 0, /* the distance by which a vertex moves */
    FFD_VIEW_STATUS,           /* the ffd_vertex_status of a vertex */
    FFD_VIEW_DET,              /* det F at a vertex, the factor by which volumes grow */
    FFD_VIEW_PLAIN,            /* materials and vertex colours of the mesh */
    FFD_VIEW_AUTO /* a picture: displacement; a page: as FFD_VIEW_PLAIN where the mesh has textures, vertex
                        colours or materials that are not white, else displacement */
} ffd_view_color;

/* Returns "displacement", "status", "det", "plain" or "auto"; NULL for another value. The string is static.
   Thread-safe. */
FFD_API const char *ffd_view_color_name(ffd_view_color color);

/* The axis that points upwards in a view. */
typedef enum ffd_up { FFD_UP_Y = 0, FFD_UP_Z, FFD_UP_X } ffd_up;

/* Fills direction with that of a named side, as ffd_view_desc.camera has it: "front", "back", "left",
   "right", "top", "bottom", or "iso", which gives zeros. Errors: FFD_E_ARGUMENT (another name or value;
   direction stays). Thread-safe. */
FFD_API ffd_status ffd_view_camera(const char *name, ffd_up up, double direction[3]);

/* A job of `ffd view`: a web page or a picture that shows a mesh before and after. */
typedef struct ffd_view_desc {
    size_t struct_size; /* sizeof(ffd_view_desc) in the caller's header */
    /* The mesh and its deformation, as for ffd_check_run, except that lattice_count may be 0, to show the
       mesh as it is, and morphs may be set: the shape after then has these targets in full, beside the
       default weights of those of the file. job->log receives the warnings; the output is added to
       job->written. A page has sliders for the weights of all targets. */
    const ffd_deform_desc *job;
    /* The deformed mesh as a file with the same number of vertices; the lattices are then drawn, but do not
       deform anything. NULL: the lattices deform the mesh in memory. */
    const ffd_source *deformed;
    const char *output; /* .html or .htm: a page; .png: a picture */
    bool force;         /* overwrite an existing output */
    /* Direction from the mesh to the camera, in the axes of the mesh; zeros: from the right, above and in
       front. */
    double camera[3];
    ffd_view_color color; /* default FFD_VIEW_AUTO */
    bool full; /* page: show all vertices; else a mesh of more than 200,000 is simplified, and the page says
                  so */
    /* Of a picture, or of each picture in a row, in pixels; 0: 1600 and 900. A page fills its window. */
    uint32_t width, height;
    uint32_t frames; /* number of pictures in a row, from rest to deformed, 2 to 64; 0: before and after in
                        one picture */
    /* Name of an animation of the input; one without a name is called "animation N", N from 0. NULL: none. A
       picture has a row of poses (frames, or 5) over the duration, and a second row for the deformed mesh;
       lattices are not drawn. A page has all animations and opens with this one. The deformed mesh is
       animated as its own file says or, if it was deformed in memory, as the input. */
    const char *animation;
    /* true: show and judge the base shapes stored in the file. false: those with the default weights of morph
       targets, which ffd_check_run judges. */
    bool as_stored;
    ffd_sink_function sink; /* as ffd_deform_desc.sink; job->sink is ignored */
    void *sink_user;
    ffd_up up;    /* the axis that points upwards; the mesh stays as it is. Default FFD_UP_Y */
    bool no_cage; /* lattices are not drawn */
} ffd_view_desc;

/* Sets desc to defaults. size: sizeof(ffd_view_desc) in the caller's header. */
FFD_API void ffd_view_desc_init(ffd_view_desc *desc, size_t size);
/* Runs the job. The output is complete or absent. If a gate of the job is violated, the output is written all
   the same, and the result is FFD_E_GATE. A missing or broken image of the mesh is drawn grey in a picture,
   with a warning. The memory budget of the mesh is by default at least 400 MB. result is filled in every
   case: if lattices deform the mesh, as by ffd_check_run, for the shapes that are shown; with morphs as by
   ffd_deform_run, but without the results of each; and with picture.
   Returns result->status. Errors: any. */
FFD_API ffd_status ffd_view_run(const ffd_view_desc *desc, ffd_job_result *result, ffd_error *error);

/* A job of `ffd edit`: a web page in which a lattice is shaped by hand. */
typedef struct ffd_edit_desc {
    size_t struct_size; /* sizeof(ffd_edit_desc) in the caller's header */
    /* The mesh, and lattices of which the last is edited; lattice_count may be 0. Of the other members only,
       outside, falloff, snap, space (of the mesh), set, time, isa, threads, timeout, progress, cancel, log
       and written apply. The mesh is shown with the default weights of its morph targets, and without
       animations. */
    const ffd_deform_desc *job;
    /* Without lattices: the new one, laid round the mesh or what `only` leaves of it; NULL: defaults. With
       lattices it must be NULL. */
    const ffd_lattice_desc *lattice;
    const char *output; /* .html */
    bool force;         /* overwrite an existing output */
    bool full; /* show all vertices; else a mesh of more than 200,000 is simplified, and the page says so */
    ffd_up up; /* the axis that points upwards; the mesh stays as it is. Default FFD_UP_Y */
    ffd_sink_function sink; /* as ffd_deform_desc.sink; job->sink is ignored */
    void *sink_user;
} ffd_edit_desc;

/* Sets desc to defaults. size: sizeof(ffd_edit_desc) in the caller's header. */
FFD_API void ffd_edit_desc_init(ffd_edit_desc *desc, size_t size);
/* Runs the job. The output is complete or absent. A missing or broken image of the mesh is left out, with a
   warning. The memory budget of the mesh is by default at least 400 MB. Of result are filled: vertices,
   inside, outside, seconds, picture (the page) and status. Thread-safe. Returns result->status. Errors: any
   but FFD_E_GATE. */
FFD_API ffd_status ffd_edit_run(const ffd_edit_desc *desc, ffd_job_result *result, ffd_error *error);

/* A job of `ffd embed`: writes the u,v,w of all vertices to output (.npy version 1.0, float64, N x 3, C
   order, NaN without u,v,w), and their statuses to status_output (.npy, uint8, N). A lattice whose box is
   "mesh" is fitted to the mesh. */
typedef struct ffd_embed_desc {
    size_t struct_size; /* sizeof(ffd_embed_desc) in the caller's header */
    ffd_source input;   /* the mesh */
    /* Only the rest volume is used: placeholders in moves need no values. Without a path "lattice". */
    ffd_lattice_source lattice;
    const char *output;        /* path that ends in .npy; "-": standard output */
    const char *status_output; /* likewise; NULL: none */
    double snap;               /* as in ffd_deform_desc */
    bool snap_relative;
    int threads;          /* >= 1, or 0 for all cores; does not affect the output */
    bool force;           /* overwrite existing outputs */
    ffd_log_function log; /* receives warnings; may be NULL */
    void *log_user;
    const ffd_setting *set; /* set_count values for placeholders, as in ffd_deform_desc; or NULL */
    size_t set_count;
    ffd_sink_function sink; /* receives both outputs, as in ffd_deform_desc */
    void *sink_user;
} ffd_embed_desc;

/* Sets desc to defaults. size: sizeof(ffd_embed_desc) in the caller's header. */
FFD_API void ffd_embed_desc_init(ffd_embed_desc *desc, size_t size);
/* Runs the job. Both outputs are complete, or neither is there. result is filled in every case. Returns
   result->status. Errors: any but FFD_E_GATE. */
FFD_API ffd_status ffd_embed_run(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error);

/* The kinds of differences between two files. Each position, normal, tangent, texture coordinate, face, line
   or point that differs is one difference, however many of its numbers differ. */
typedef enum ffd_difference_kind {
    FFD_DIFFERENCE_POSITION = 0,
    FFD_DIFFERENCE_NORMAL,
    FFD_DIFFERENCE_TANGENT,
    FFD_DIFFERENCE_TEXCOORD,
    FFD_DIFFERENCE_TOPOLOGY, /* faces, lines, points (glTF: indices); the number of vertices or faces */
    FFD_DIFFERENCE_OTHER,    /* colours, names, materials, JSON values, headers, the format, ... */
    FFD_DIFFERENCE_KIND_COUNT
} ffd_difference_kind;

/* Returns "position", "normal", "tangent", "texcoord", "topology" or "other"; NULL for another value. The
   string is static. Thread-safe. */
FFD_API const char *ffd_difference_kind_name(ffd_difference_kind kind);

/* One difference between two files a and b. */
typedef struct ffd_difference {
    ffd_difference_kind kind;
    bool measured;  /* a position, normal or tangent in both files; otherwise the next three are not set */
    double a, b;    /* the coordinate that differs most, in each file */
    double amount;  /* |a - b|, for positions in world units; infinite if only one of them is finite */
    char text[512]; /* one line: where and what; "": no difference */
} ffd_difference;

/* The result of a comparison. */
typedef struct ffd_comparison {
    size_t struct_size; /* sizeof(ffd_comparison) in the caller's header, set before the call */
    bool equal;         /* there are no differences */
    /* false: what follows a difference could not be matched (different formats, numbers of vertices or kinds
       of statements), so more differences are possible than were counted. */
    bool complete;
    uint64_t differences;                       /* number of differences */
    uint64_t counts[FFD_DIFFERENCE_KIND_COUNT]; /* by ffd_difference_kind */
    ffd_difference first;                       /* in the order of comparison */
    /* The difference of the largest amount: of positions, or if none differs, of normals, or else of
       tangents. text is "" if none of them differs. */
    ffd_difference worst;
    uint64_t positions_compared;     /* glTF: counted for each node that shows them */
    double position_difference_max;  /* largest |a - b| of a coordinate, within the tolerance or not */
    double direction_difference_max; /* the same for normals and tangents */
    double tolerance;                /* of positions, in world units, also if it was given as relative */
    double direction_tolerance;
    /* Of the bounding box of a, in world units; 0: no vertices, or the tolerance is not relative. */
    double diagonal;
} ffd_comparison;

/* A job of `ffd compare`. */
typedef struct ffd_compare_desc {
    size_t struct_size; /* sizeof(ffd_compare_desc) in the caller's header */
    ffd_source a, b;    /* at most one of them is "-" */
    /* Allowed difference of each coordinate of a position: world units, or if relative is true a fraction of
       the diagonal of a's bounding box (of its finite vertices, in the default pose). >= 0. */
    double tolerance;
    bool relative; /* whether tolerance is relative */
    /* Allowed difference of each component of normals and tangents, without unit. >= 0. */
    double direction_tolerance;
    ffd_log_function log; /* receives warnings, which begin with the file name; may be NULL */
    void *log_user;
} ffd_compare_desc;

/* Sets desc to defaults: tolerances of 0, with which numbers must be equal (0 equals -0, NaN equals NaN).
   size: sizeof(ffd_compare_desc) in the caller's header. */
FFD_API void ffd_compare_desc_init(ffd_compare_desc *desc, size_t size);

/* Compares two meshes: positions and directions within their tolerances, everything else exactly. Ignored is
   what does not belong to the mesh: white space, comments, the notation of numbers, the encoding of PLY and
   STL, the place of data in the buffers of a glTF. NaN equals NaN only, infinity equals itself. Morph targets
   count as positions, normals and tangents. Fills *comparison unless it fails. Thread-safe. Errors:
   FFD_E_ARGUMENT (tolerances), and those of reading a mesh. */
FFD_API ffd_status ffd_compare_run(const ffd_compare_desc *desc, ffd_comparison *comparison,
                                   ffd_error *error);

/* Writes a comparison as JSON ("ffd-comparison", version 1). a and b: names of the files in the text. *text
   ends with a line break and a 0 byte; the caller frees it with ffd_free. Thread-safe. Errors:
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_comparison_json(const ffd_comparison *comparison, const char *a, const char *b,
                                       char **text, ffd_error *error);

/* A mesh of two folders, as ffd_compare_folders finds it. All of it is valid during the call only. */
typedef struct ffd_compared_file {
    const char *name;                 /* relative to both folders, with "/" */
    bool in_a, in_b;                  /* if it is in one of them only, the next two are NULL */
    const ffd_comparison *comparison; /* NULL after an error */
    const ffd_error *error;           /* why it could not be compared; NULL: it was */
} ffd_compared_file;

/* Receives a mesh, in the thread that called the library, in the order of the names. A result other than
   FFD_OK ends the comparison with this status. */
typedef ffd_status (*ffd_compared_function)(void *user, const ffd_compared_file *file);

/* The result of comparing two folders, as numbers of meshes. */
typedef struct ffd_folder_comparison {
    size_t struct_size; /* sizeof(ffd_folder_comparison) in the caller's header, set before the call */
    bool equal;         /* nothing differs, and all could be read */
    uint64_t same, different, failed, only_a, only_b;
} ffd_folder_comparison;

/* Compares two folders: desc->a.path and desc->b.path, with all else as of ffd_compare_run. Meshes (files
   whose endings ffd_format_from_name knows) are paired by their relative names, those of folders below too;
   one that is in one folder only differs; other files are not looked at. file may be NULL. Thread-safe.
   Errors: FFD_E_IO (a folder cannot be read), FFD_E_ARGUMENT, FFD_E_MEMORY; a mesh that cannot be read is a
   failed one. */
FFD_API ffd_status ffd_compare_folders(const ffd_compare_desc *desc, ffd_compared_function file, void *user,
                                       ffd_folder_comparison *result, ffd_error *error);
/* The same, with the result as JSON too ("ffd-comparison", version 1). *text as of ffd_comparison_json. */
FFD_API ffd_status ffd_compare_folders_json(const ffd_compare_desc *desc, ffd_folder_comparison *result,
                                            char **text, ffd_error *error);

/* A job of `ffd info`. */
typedef struct ffd_info_desc {
    size_t struct_size; /* sizeof(ffd_info_desc) in the caller's header */
    ffd_source file;    /* a mesh; or a lattice, if the ending is .json and file.format is FFD_FORMAT_AUTO */
    bool json;          /* JSON instead of text for people */
    /* Mesh: list all names that selectors (ffd_deform_desc.only) accept, and the parts without a name, with
       bounds and the numbers of vertices and faces. FFD_E_ARGUMENT for a lattice. */
    bool parts;
    /* Lattice: set_count values for placeholders in its moves, or NULL; placeholders without a value are
       listed by name. FFD_E_INVALID for a placeholder that it does not have, FFD_E_ARGUMENT for a mesh. */
    const ffd_setting *set;
    size_t set_count;
    ffd_log_function log; /* receives warnings, which begin with the file name; may be NULL */
    void *log_user;
} ffd_info_desc;

/* Sets desc to defaults. size: sizeof(ffd_info_desc) in the caller's header. */
FFD_API void ffd_info_desc_init(ffd_info_desc *desc, size_t size);

/* Describes a mesh or a lattice file. *text ends with a line break and a 0 byte; the caller frees it with
   ffd_free. It is NULL after a failure. Thread-safe. Errors: FFD_E_ARGUMENT, and those of reading the
   file. */
FFD_API ffd_status ffd_info_run(const ffd_info_desc *desc, char **text, ffd_error *error);

/* A job of `ffd lattice new`: makes one lattice round everything that the meshes show (in scene space), or
   round all their vertices if they show nothing, and writes it. */
typedef struct ffd_lattice_new_desc {
    size_t struct_size;       /* sizeof(ffd_lattice_new_desc) in the caller's header */
    const ffd_source *meshes; /* mesh_count meshes, at least one */
    size_t mesh_count;
    /* only_count selectors "KIND:NAME", or NULL: the lattice goes round the parts that match one of them.
       Each mesh must have every name. */
    const char *const *only;
    size_t only_count;
    const ffd_lattice_desc *lattice; /* shape, size, margin and so on of the lattice */
    const char *output;              /* path; "-": standard output */
    bool force;                      /* overwrite an existing output */
    ffd_log_function log;            /* receives warnings, which begin with the name of a mesh; may be NULL */
    void *log_user;
    ffd_sink_function sink; /* as in ffd_deform_desc */
    void *sink_user;
} ffd_lattice_new_desc;

/* Sets desc to defaults. size: sizeof(ffd_lattice_new_desc) in the caller's header. */
FFD_API void ffd_lattice_new_desc_init(ffd_lattice_new_desc *desc, size_t size);
/* Runs the job. The output is complete or absent. Errors: those of reading a mesh, of ffd_lattice_create and
   of ffd_lattice_save. */
FFD_API ffd_status ffd_lattice_new_run(const ffd_lattice_new_desc *desc, ffd_error *error);

/* What jobs have in common that make a lattice of a lattice, and write it. Fill with ffd_author_desc_init,
   then set lattice and output. */
typedef struct ffd_author_desc {
    size_t struct_size; /* sizeof(ffd_author_desc) in the caller's header */
    ffd_lattice_source lattice;
    const ffd_setting *set; /* set_count values for placeholders in the moves, or NULL */
    size_t set_count;
    /* With has_time: lattices that have keys are taken as they are at this time, as in ffd_deform_desc.
       Without it they are FFD_E_ARGUMENT, but for an object whose time was set. */
    double time;
    bool has_time;
    /* The box of a lattice that goes round a mesh is laid round these mesh_count meshes, or what of them
       matches one of only_count selectors; NULL: it stays without positions, where none are needed. */
    const ffd_source *meshes;
    size_t mesh_count;
    const char *const *only;
    size_t only_count;
    /* memory, strict and space: of the lattice and of meshes that it names. The other members are ignored. */
    ffd_source reading;
    int threads;        /* >= 1, or 0 for all cores; does not affect the output */
    const char *output; /* path; "-": standard output; an ending is .json, of ffd_lattice_convert_run any */
    bool force;         /* overwrite an existing output */
    ffd_output_set *output_set; /* the files of this run; may be NULL */
    ffd_log_function log;       /* receives warnings; may be NULL */
    void *log_user;
    ffd_sink_function sink; /* as in ffd_deform_desc */
    void *sink_user;
} ffd_author_desc;

/* Sets desc to defaults. size: sizeof(ffd_author_desc) in the caller's header. */
FFD_API void ffd_author_desc_init(ffd_author_desc *desc, size_t size);

/* How long the parts of a job of ffd_lattice_refine_run took. */
typedef struct ffd_refine_seconds {
    double read, refine, write; /* refine: with the measuring */
} ffd_refine_seconds;

/* What such a job has done. */
typedef struct ffd_refine_result {
    size_t struct_size; /* sizeof(ffd_refine_result) in the caller's header, set by the caller */
    ffd_status status;
    ffd_error error; /* if status is not FFD_OK */
    ffd_refine_seconds seconds;
    size_t size_before[3], size[3]; /* 0 where the lattice could not be read, or refined */
    int degree_before[3], degree[3];
    /* The largest difference of a coordinate of C, at rest and deformed, at 3 places of each new span in each
       direction; -1: the job failed before. */
    double largest_difference;
} ffd_refine_result;

/* Runs the job of `ffd lattice refine`: makes a lattice of more control points or higher degrees that is the
   same map (ffd_lattice_refine). The output is complete or absent. result may be NULL; the maps are measured
   only for it. Errors: those of ffd_lattice_load, ffd_lattice_refine, ffd_lattice_save, and of reading a
   mesh; FFD_E_ARGUMENT for meshes where the lattice does not go round one. */
FFD_API ffd_status ffd_lattice_refine_run(const ffd_author_desc *job, const ffd_refine_desc *refine,
                                          ffd_refine_result *result, ffd_error *error);

/* Which states of a lattice are written. */
typedef enum ffd_lattice_part {
    FFD_PART_DEFAULT, /* both, if the format holds both; else the rest of a lattice that moves nothing */
    FFD_PART_BOTH,
    FFD_PART_REST,    /* nothing is moved */
    FFD_PART_DEFORMED /* the deformed control points, and weights, as rest */
} ffd_lattice_part;

/* The order in which a file has the points of an array. */
typedef enum ffd_point_order {
    FFD_ORDER_UVW, /* as it stands: u fastest, or of an array (n_u, n_v, n_w, 3) the last index */
    /* Found by the points: the counts may be in another order, that with the nearest neighbours; and of all
       orders and directions in which no cell is turned over, u is nearest to +x, then v to +y. */
    FFD_ORDER_AUTO,
    FFD_ORDER_DEFAULT /* as it stands, but of a .obj that does not tell its size found by the points */
} ffd_point_order;

/* How ffd_lattice_convert_run reads and writes. Fill with ffd_convert_desc_init. */
typedef struct ffd_convert_desc {
    size_t struct_size; /* sizeof(ffd_convert_desc) in the caller's header */
    size_t size[3];     /* of an array (n, 3): control points along u, v and w; all 0 (default): not given */
    int degree[3];      /* of a format that has none; 0 (default): min(3, size - 1) */
    ffd_lattice_part part;
    ffd_point_order order; /* of points; the log is told what was found. Default FFD_ORDER_DEFAULT */
    const char *block;     /* of a file of several lattices: its number from 0 (Plot3D), or its name (SU2) */
} ffd_convert_desc;

/* Sets desc to defaults. size: sizeof(ffd_convert_desc) in the caller's header. */
FFD_API void ffd_convert_desc_init(ffd_convert_desc *desc, size_t size);

/* Whether ffd_lattice_convert_run reads or writes files with the ending of this name, and they are not JSON.
   Thread-safe. */
FFD_API bool ffd_lattice_converts(const char *name);
/* Runs the job of `ffd lattice convert`: reads a lattice of one format, by the ending of its name, and writes
   it in another, by that of the output (data/schema/lattice.md 12). Moves become
   offsets. The text of job->lattice is the content of a file of its format; settings and meshes are for .json
   alone. convert: NULL for defaults. The output is complete or absent. Errors: those of ffd_lattice_load,
   ffd_lattice_save and of reading a mesh; FFD_E_INVALID for a file that is not what its ending says;
   FFD_E_ARGUMENT for an ending that is none of these, size, degree or order for a format that has its own, a
   part that the format cannot hold, and settings or meshes that the lattice has no use for. */
FFD_API ffd_status ffd_lattice_convert_run(const ffd_author_desc *job, const ffd_convert_desc *convert,
                                           ffd_error *error);

/* What `ffd lattice set` does to a lattice, one after the other. */
typedef enum ffd_operation_kind {
    FFD_OPERATION_STRENGTH,   /* ffd_lattice_strength by number */
    FFD_OPERATION_BLEND,      /* ffd_lattice_blend with other by number */
    FFD_OPERATION_ADD,        /* ffd_lattice_add of other */
    FFD_OPERATION_MIRROR,     /* ffd_lattice_mirror along direction */
    FFD_OPERATION_SYMMETRIZE, /* ffd_lattice_symmetrize along direction, by keep_last */
    FFD_OPERATION_TRANSFORM,  /* ffd_lattice_transform by matrix; so are the next three: */
    FFD_OPERATION_MOVE,       /* by place */
    FFD_OPERATION_ROTATE,     /* by number degrees about the axis `direction` through place, right-handed */
    FFD_OPERATION_SCALE,      /* by number, about place */
    FFD_OPERATION_INVERT,     /* ffd_lattice_invert */
    FFD_OPERATION_SEAL,       /* ffd_lattice_seal with continuity and faces */
    /* The deformed control points become those of other, whatever its degrees, knots and rest are: its
       deformed ones, if it moves something; and so do the deformed weights, if it has weights.
       FFD_E_INVALID where it has another number of control points along u, v or w. */
    FFD_OPERATION_DEFORMED,
    /* The displacements become those of other; if its file has none, its control points are displacements. */
    FFD_OPERATION_DEFORMED_OFFSETS
} ffd_operation_kind;

typedef struct ffd_operation {
    ffd_operation_kind kind;
    double number;
    int direction; /* 0 to 2: u, v, w, or the axis x, y, z */
    bool keep_last;
    double place[3], matrix[16];
    int continuity; /* 1: C1 */
    unsigned faces; /* or FFD_FACES_CUT: those that the job's meshes cut, at least one */
    /* Read with the settings and meshes of the job. The last two take a .csv or .npy too
       (ffd_lattice_convert_run), an array (n, 3) in the order of the lattice. */
    ffd_lattice_source other;
    const char *block; /* of other, as in ffd_convert_desc */
} ffd_operation;

/* Runs the job of `ffd lattice set`: does count operations, at least one, to a lattice in this order. The
   job's settings and meshes are also for the other lattices: each value is that of a placeholder of one of
   them. The output is complete or absent. Errors: those of ffd_lattice_load, of the operations, of
   ffd_lattice_save, and of reading a mesh; FFD_E_ARGUMENT for meshes where no lattice goes round one
   and none is cut. */
FFD_API ffd_status ffd_lattice_set_run(const ffd_author_desc *job, const ffd_operation *operations,
                                       size_t count, ffd_error *error);

/* Writes the figures of a result for people, as `ffd check` prints them, a line or two for each. lattice: the
   name of the lattice result->folds.witness.lattice, or NULL. *text ends with a line break and a 0 byte; the
   caller frees it with ffd_free. Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
FFD_API ffd_status ffd_job_result_text(const ffd_job_result *result, const char *lattice, char **text,
                                       ffd_error *error);

/* A report (data/schema/formats.md 2). Entries are added in the order of the jobs, and written to the file at
   once. One thread at a time. */
typedef struct ffd_report ffd_report;

/* Starts a report at path ("-": standard output): JSON or, if the name ends in .jsonl, JSON Lines with an
   entry on each line. The file is under its own name from now on, so an unwritable path fails before the
   first job. It is valid JSON after each entry, and keeps its entries if the program is killed. An existing
   file is replaced only if it is a report of the same kind. stable: leave out times. output_set may be NULL.
   The caller destroys *report. Errors: FFD_E_IO, FFD_E_EXISTS, FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_create(const char *path, bool stable, ffd_output_set *output_set,
                                     ffd_report **report, ffd_error *error);
/* As ffd_report_create, in memory: ffd_report_write passes the whole report to sink. The ending of name
   selects JSON or JSON Lines. Errors: FFD_E_ARGUMENT (no name or no sink), FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_create_sink(const char *name, bool stable, ffd_sink_function sink, void *user,
                                          ffd_report **report, ffd_error *error);
/* Destroys the object and sets *report to NULL; a file keeps the entries that it has. report and *report may
   be NULL. */
FFD_API void ffd_report_destroy(ffd_report **report);
/* Adds the entry of a job. input and output: the paths that the entry gives; output may be NULL. It has the
   names of all outputs if the job had an output_list, which must still hold them; else only output is known.
   Errors: FFD_E_IO, FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                                  const ffd_job_result *result, ffd_error *error);
/* The same for a job of ffd_lattice_refine_run. */
FFD_API ffd_status ffd_report_add_refine(ffd_report *report, const char *input, const char *output,
                                         const ffd_refine_result *result, ffd_error *error);
/* Completes the report. To be called at most once, after the jobs. Errors: FFD_E_IO, FFD_E_MEMORY, and those
   of the sink. */
FFD_API ffd_status ffd_report_write(ffd_report *report, ffd_error *error);

/* `ffd report merge`: joins count reports (at least one; "-": standard input) and writes the result to output
   ("-": standard output), which replaces a file only with force. Names that end in .jsonl are JSON Lines.
   Entries keep their bytes. Without
   interleave the entries of each report follow those of the one before. With interleave one entry of each
   report is taken in turn, which restores the order of the manifest for the reports of shards 0 to count-1
   (FFD_E_INVALID if a report has too few entries). All reports are checked before anything is written; those
   that are not files are held in memory. Errors: FFD_E_ARGUMENT, FFD_E_IO, FFD_E_EXISTS, FFD_E_INVALID,
   FFD_E_UNSUPPORTED, FFD_E_LIMIT, FFD_E_MEMORY. */
FFD_API ffd_status ffd_report_merge_run(const char *const *reports, size_t count, bool interleave,
                                        const char *output, bool force, ffd_error *error);

/* `ffd report junit`: writes count reports, or comparisons of two folders (ffd_compare_folders_json), as
   JUnit XML to output: a suite for each, a case for each job or mesh. A job with exit code 1, or a mesh that
   differs, is a failure; one with another exit code, or that could not be read, an error. Names, force and
   errors: as of ffd_report_merge_run; also FFD_E_EXISTS if output is one of the reports, which would be lost.
 */
FFD_API ffd_status ffd_report_junit_run(const char *const *reports, size_t count, const char *output,
                                        bool force, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
