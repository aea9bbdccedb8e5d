/* mesh.h - the interface between mesh formats and jobs. Each format in src/io fills a mesh_format table.

   A document keeps the bytes of its file, and presents its vertices as parts. A job reads the streams of a
   part in any order, hands back results, and lets the document save: the same bytes with the results spliced
   in. */
#ifndef FFD_MESH_MESH_H
#define FFD_MESH_MESH_H

#include "base/file/file_folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path_list.h"
#include "base/text/buffer.h"
#include "base/vector/vec.h"
#include "mesh/flaws.h"
#include "mesh/material.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include "mesh/model.h"
#include "mesh/rounding.h"
#include "splat/splat.h"
#include "json/json_text.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The attributes of vertices. */
typedef enum mesh_stream { MESH_POSITIONS, MESH_NORMALS, MESH_TANGENTS, MESH_STREAMS } mesh_stream;

/* Which positions, normals and tangents of a document are meant: those of the base, as the file stores them,
   or those that it shows, with the default weights of its morph targets. Without targets they are the same.
 */
typedef enum mesh_state { MESH_STORED, MESH_SHOWN } mesh_state;

/* A morph target of a part: offsets for some of its streams. The target moves a vertex to its position plus
   the offset. */
typedef struct mesh_shape {
    bool has[MESH_STREAMS];
    mesh_rounding rounding; /* of the offsets of positions */
    double weight;          /* default weight, without animation */
} mesh_shape;

/* A part: vertices that share a transform to the space of the lattice. */
typedef struct mesh_part {
    size_t vertex_count;
    size_t normal_count; /* 0: no normals */
    /* Normals are in the order of their vertices: vertex i has the normals normal_start[i] ..
       normal_start[i+1]-1. NULL: normal i belongs to vertex i (normal_count is then vertex_count or 0).
       Belongs to the document. */
    const uint32_t *normal_start;
    bool has_tangents; /* tangent i belongs to vertex i and normal i; only if normal_start is NULL */

    mesh_rounding rounding; /* of the positions */

    const mesh_shape *shapes; /* only if normal_start is NULL; belongs to the document */
    size_t shape_count;
    bool shows_shapes; /* a shape has a weight other than 0, so the visible positions differ from the stored
                          ones */

    /* The vertices are those of an earlier part (same positions, same transform), listed again with other
       normals or tangents. They are not counted, embedded or written again. */
    bool repeats_positions;
    size_t repeats; /* index of that part */

    bool identity;               /* the part is in the space of the lattice; the matrices are then unused */
    double linear[9], offset[3]; /* x = linear p + offset */
    double inverse[9];           /* of linear */
    bool singular;               /* linear is not invertible: the vertices of the part stay */
    bool skinned; /* every vertex has its own linear and offset (read_transforms); those above are then
                     unused, and identity and singular are false */

    /* The selection: a vertex with a byte of 0 stays and is not counted, a normal with a byte of 0 stays.
       NULL: all vertices; the normals of the selected vertices. Belongs to the document. */
    const uint8_t *selected, *selected_normals;
    bool skipped; /* no vertex of the part is selected */

    bool splats;         /* the vertices are the centres of Gaussian splats */
    bool has_ellipsoids; /* their rotations and scales are available from read_splats; false: these stay as
                            they are */
    splat_form form;     /* of ellipsoids */
    size_t place;        /* for splats: the number of the place (places.h) of the node that shows them; or
                            MESH_NO_PLACE */

    /* The node of the part moves itself (follow): deformed points are mapped by y + (carry y + carry[9..]) in
       the space of the lattice (a row-major matrix and an offset) before they are transformed back to the
       file's space. */
    bool carried;
    double carry[12];
    /* A vertex with a byte of 0 is in no face, line or point. NULL: all are in one, or there are no elements,
       or ffd_mesh_mark_used was not called. Belongs to the document. */
    const uint8_t *used;
    bool hidden;  /* viewers do not show the part */
    size_t owner; /* identifies what shows the part, also in a file that is written of this one */
} mesh_part;

#define MESH_NO_PLACE SIZE_MAX

static inline bool ffd_part_selects(const mesh_part *part, size_t vertex)
{
    return !part->skipped && (!part->selected || part->selected[vertex]);
}

/* Returns whether a vertex is visible; a box goes round the visible vertices. */
static inline bool ffd_part_shows(const mesh_part *part, size_t vertex)
{
    return !part->hidden && (!part->used || part->used[vertex]);
}

/* Polygons over all vertices of a document, for topology. Vertices are numbered through all parts (the order
   of `ffd embed`); a document may give a subset if parts repeat storage. */
typedef struct mesh_faces {
    size_t vertex_count, face_count;
    double *positions; /* 3*vertex_count, in the space of the lattice */
    size_t *start;     /* face_count+1 offsets into corners, the first 0 even if there are no faces */
    uint32_t *corners; /* start[face_count] indices of vertices */
    /* vertex_count entries, ascending: if the corners refer only to the vertices of faces, the indices of
       these vertices in the document. NULL: corners refer to all vertices of the document. */
    uint32_t *vertices;
    size_t lines, points; /* numbers of primitives other than faces */
    /* Number of vertices in no face because an earlier vertex at the same position represents them (formats
       that list a vertex for every corner), or because they are inside of volumes or between corners;
       topology does not count them. */
    size_t repeated;
} mesh_faces;

/* Returns the index in the document of a vertex of faces. */
static inline uint32_t ffd_faces_document_vertex(const mesh_faces *faces, uint32_t vertex)
{
    return faces->vertices ? faces->vertices[vertex] : vertex;
}

typedef struct mesh_document mesh_document;

/* Statistics of the weights of skinned vertices. */
typedef struct skin_weights {
    uint64_t off;    /* vertices whose weights do not sum to 1 and are divided by their sum */
    uint64_t none;   /* vertices whose weights sum to 0 or less, which follow their first joint */
    double farthest; /* greatest difference from 1 of a sum other than 0 */
} skin_weights;

/* Allocates the arrays for the counted vertices and faces, and for their corners. There is nothing to free
   after a failure. Errors: FFD_E_MEMORY, FFD_E_LIMIT (memory budget). */
ffd_status ffd_mesh_faces_make(const mesh_document *document, mesh_faces *faces, size_t corners,
                               ffd_error *error);
/* Takes the memory of these arrays from the budget. */
ffd_status ffd_mesh_faces_take(const mesh_faces *faces, uint64_t corners, memory_budget *budget,
                               ffd_error *error);
/* Frees the arrays and empties the struct. */
void ffd_mesh_faces_free(mesh_faces *faces);

/* The normal index of a corner without a normal. */
#define MESH_NO_NORMAL UINT32_MAX

/* Finds which models name a file, other than the output: the first ones are added to `names`, *count is their
   number. *by_output: whether the model that the output replaces names it. */
typedef ffd_status mesh_find_users_function(void *context, const char *file, const char *output,
                                            size_t *count, bool *by_output, path_list *names,
                                            ffd_error *error);
typedef struct mesh_sharing {
    mesh_find_users_function *find;
    void *context;
    bool is_cheap; /* find reads no files */
} mesh_sharing;

/* What an animation of new morph targets has become. */
typedef struct mesh_animated {
    size_t targets; /* that a mesh gets, at most */
    uint64_t bytes; /* by which the files grow; in a conversion those of targets and weights */
} mesh_animated;

typedef struct mesh_save_options {
    const char *path; /* "-": standard output */
    bool to_sink;     /* path is only a name: the output goes to a callback (ffd_output_redirect) */
    bool from_memory; /* so is input: the mesh is in memory */
    ffd_format format;
    bool force;
    ffd_resources resources;
    bool sparse_targets; /* new morph targets may be stored without their offsets of 0 */
    const char *input;   /* file of the document, which a conversion must not replace; NULL or "-": none */
    const mesh_sharing *sharing; /* models that may share buffers with the output; NULL: none */
    /* Receives further files of the output with unchanged content: images and material libraries that are
       copied next to it, or exist already. May be NULL. */
    path_list *copied;
    /* Receives the names of the further files that belong to the output, in its folder: buffers and copies,
       written now or there already, also if nothing is written. May be NULL. */
    path_list *outputs;
    struct noted_copies *noted; /* receives the copies, for later runs; NULL: without notes */
    uint64_t *indices_left;     /* receives the number of indices in extensions that cannot be updated; may be
                               NULL */
    /* Receives the number of bytes of replaced morph targets and animations that stay in the file unused. May
       be NULL. */
    uint64_t *bytes_left;
    mesh_animated *animated; /* receives these; a mesh gets no new target that moves nothing in it then, not
                                even where no mesh moves. NULL: no such animation */
    uint64_t *bounds_left;   /* receives the number of bounds in extensions that no longer fit; may be NULL */
} mesh_save_options;

/* Returns whether a path of the output leads to a file of the input. */
static inline bool ffd_save_meets(const mesh_save_options *options, const char *input, const char *output)
{
    return !options->to_sink && !options->from_memory && ffd_file_same(input, output);
}

/* x = linear p + offset, in place. */
static inline void ffd_point_transform(const double linear[9], const double offset[3], double point[3])
{
    mat_apply(linear, point, point);
    for (int a = 0; a < 3; a++)
        point[a] += offset[a];
}

/* Transforms the positions of the vertices [first, first + count) of a part (3 doubles each) from the file's
   space to that of the lattice: x = linear p + offset. Thread-safe. */
void ffd_part_transform(const mesh_document *document, size_t part, size_t first, size_t count,
                        double *points);
/* The same with the transforms of individual vertices from read_transforms. */
void ffd_points_transform(const double *transforms, size_t count, double *points);

/* The calls that every format has. */

/* Reads a document from input, which it owns after success only. The source's path is for messages, and
   relative references are relative to it ("-": there are none). */
typedef ffd_status mesh_open_function(file_input *input, const ffd_source *source, mesh_document **document,
                                      ffd_error *error);
typedef void mesh_close_function(mesh_document *document);
/* Appends members that describe the document to an open JSON object. */
typedef ffd_status mesh_describe_function(const mesh_document *document, json_text *json, ffd_error *error);
/* Compares two documents of this format (see ffd_compare_run). The comparison was begun with
   ffd_difference_begin: it has the tolerances, and no differences. */
typedef ffd_status mesh_compare_function(const mesh_document *a, const mesh_document *b,
                                         ffd_comparison *comparison, ffd_error *error);
/* Reads values of the file, as doubles, without transforms: 3 for a position or normal, 4 for a tangent
   (x,y,z and the handedness). Thread-safe. */
typedef void mesh_read_function(const mesh_document *document, size_t part, mesh_stream stream,
                                mesh_state state, size_t first, size_t count, double *values);
/* Gets all faces, and counts lines and points. Errors: FFD_E_MEMORY, FFD_E_LIMIT, and those of the file's
 * content. */
typedef ffd_status mesh_faces_function(const mesh_document *document, mesh_state state, mesh_faces *faces,
                                       ffd_error *error);
/* Receives the corners of count triangles, as mesh_faces has them. */
typedef void mesh_triangle_visitor(void *context, const uint32_t *corners, size_t count);
/* Passes all faces, cut into triangles, to a visitor in the order of `faces`, without memory for all of them.
   first: the first vertex of each part in the document. Thread-safe. Errors: those of the file's content. */
typedef ffd_status mesh_visit_triangles_function(const mesh_document *document, const size_t *first,
                                                 mesh_triangle_visitor *visit, void *context,
                                                 ffd_error *error);
typedef struct vertex_marks vertex_marks; /* mixed_faces.h */
/* Gets the faces whose vertices do not all have equal marks, and possibly others, with the positions of
   their vertices: only of these vertices if faces->vertices is set, otherwise the positions of other
   vertices are undefined. Vertices at the same position have equal marks. Errors: FFD_E_MEMORY,
   FFD_E_LIMIT, and those of the file's content. */
typedef ffd_status mesh_mixed_faces_function(const mesh_document *document, mesh_state state,
                                             const vertex_marks *marks, mesh_faces *faces, ffd_error *error);
/* Fills an empty model, which the caller frees in every case, with the transformed mesh, and with the
   results if there are any; state must then be theirs. */
typedef ffd_status mesh_model_function(const mesh_document *document, mesh_state state, mesh_model *model,
                                       ffd_error *error);
/* What the results of a document will be. */
typedef struct mesh_results {
    mesh_state state; /* the vectors that they replace */
    bool directions;  /* normals and tangents are written, too */
    bool converted; /* they are for another format (model), so they are not rounded to the quantization steps
                       of the file, and morph targets and splats have none */
    bool replace;   /* nobody reads the original values after results are written, so results may replace
                       them; the same for all results of a document */
} mesh_results;
/* Begins results, before any is written: allocates memory, and frees the results of an earlier deformation of
   the document. */
typedef ffd_status mesh_begin_results_function(mesh_document *document, const mesh_results *results,
                                               ffd_error *error);
/* Results of vertices are written in ranges that begin at multiples of this. */
#define MESH_RANGE_STEP ((size_t)1024)
/* Writes results. It may run in several threads on disjoint ranges, which begin at multiples of
   MESH_RANGE_STEP if there is a vector for each vertex. changed: one byte for each vector; 0: unchanged (its
   values are then not read). Each vector is written at most once. */
typedef void mesh_write_function(mesh_document *document, size_t part, mesh_stream stream, size_t first,
                                 size_t count, const double *values, const uint8_t *changed);
/* Writes the file, and further files that belong to it, to output; byte-identical to the input if nothing
   changed. output NULL: only makes the checks that concern files other than the output itself. */
typedef ffd_status mesh_save_function(mesh_document *document, const mesh_save_options *options,
                                      file_output *output, const mesh_log *log, ffd_error *error);

/* Calls that a format needs only where its files have such content. */

/* Refuses (FFD_E_UNSUPPORTED) content that the streams of the parts do not represent, before anything is
   embedded or deformed: skins, morph targets, compressed data. Not needed for a document that is only
   described. Called by ffd_mesh_check. */
typedef ffd_status mesh_check_function(const mesh_document *document, ffd_error *error);
/* Fails with FFD_E_UNSUPPORTED if the document shows, in a box in the space of the lattice (sides may be
   infinite), something selected that its parts cannot change. */
typedef ffd_status mesh_check_reach_function(const mesh_document *document, const ffd_bounds *reach,
                                             ffd_error *error);
/* Logs which values of the file violate the format, and how they are treated. Without it, such values
   are refused. Errors: FFD_E_MEMORY. Called by ffd_mesh_warn. */
typedef ffd_status mesh_warn_function(const mesh_document *document, const mesh_log *log, ffd_error *error);
/* Reads the transforms of a skinned part: 12 numbers for each vertex, linear (row-major) and offset.
   found: statistics of weights are added; may be NULL. Thread-safe. */
typedef void mesh_read_transforms_function(const mesh_document *document, size_t part, size_t first,
                                           size_t count, double *transforms, skin_weights *found);
/* Sets used of the parts with vertices that are in no face, line or point; it stays NULL for parts whose
   faces cannot be read. Called once (ffd_mesh_mark_used). Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
typedef ffd_status mesh_mark_used_function(mesh_document *document, ffd_error *error);
/* Gets the index of the normal of each corner that `faces` has given, or MESH_NO_NORMAL; normals are
   numbered through all parts. Only for documents with normals. Without it, it is that of the corner's vertex,
   in the only part. */
typedef ffd_status mesh_corner_normals_function(const mesh_document *document, const mesh_faces *faces,
                                                uint32_t *normals, ffd_error *error);
/* Fills an empty list, which the caller frees in every case, with the materials of the file and the
   images of their base colours. glTF: element i is material i of the file. OBJ: the materials of its
   libraries, one for each name. A missing image is not a failure; it is logged. Memory is taken from the
   budget of the document, for as long as it is open. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
typedef ffd_status mesh_list_materials_function(mesh_document *document, const mesh_log *log,
                                                mesh_materials *materials, ffd_error *error);

/* The calls for what meshes of some formats have, each described in its header. */
typedef struct mesh_selector_calls mesh_selector_calls; /* selector.h */
typedef struct mesh_resource_calls mesh_resource_calls; /* linked_files.h */
typedef struct mesh_sidecar_calls mesh_sidecar_calls;   /* linked_files.h */
typedef struct mesh_place_calls mesh_place_calls;       /* places.h */
typedef struct mesh_morph_calls mesh_morph_calls;       /* morphs.h */
typedef struct mesh_rig_calls mesh_rig_calls;           /* rig.h */
typedef struct mesh_splat_calls mesh_splat_calls;       /* splats.h */
typedef struct mesh_weight_calls mesh_weight_calls;     /* weights.h */
typedef struct mesh_cell_calls mesh_cell_calls;         /* cell_list.h */

typedef struct mesh_format {
    ffd_format format;
    const char *name;          /* "OBJ" */
    double largest_coordinate; /* of the format's number type */
    bool is_xml;               /* its files are XML */
    bool keeps_format;         /* its meshes cannot become those of another format */
    mesh_open_function *open;
    mesh_close_function *close;
    mesh_describe_function *describe;
    mesh_compare_function *compare;
    mesh_read_function *read;
    mesh_faces_function *faces;
    mesh_mixed_faces_function *mixed_faces;
    mesh_model_function *model;
    mesh_begin_results_function *begin_results;
    mesh_write_function *write;
    mesh_save_function *save;

    /* NULL: there is nothing of that kind. */
    mesh_visit_triangles_function *visit_triangles; /* without it, `faces` has them */
    mesh_describe_function *list_names;             /* animations, morph targets, joints, cameras, scenes */
    mesh_check_function *check;
    mesh_check_reach_function *check_reach;
    mesh_warn_function *warn;
    mesh_read_transforms_function *read_transforms; /* without it, no part is skinned */
    mesh_mark_used_function *mark_used;
    mesh_corner_normals_function *corner_normals;
    mesh_list_materials_function *list_materials;

    /* NULL: meshes of the format have none. */
    const mesh_selector_calls *selectors; /* names that `--only` selects by */
    const mesh_resource_calls *resources; /* images and other files that they name */
    const mesh_sidecar_calls *sidecars;   /* further files that they consist of */
    const mesh_place_calls *places;       /* places that are not vertices */
    const mesh_morph_calls *morphs;
    const mesh_rig_calls *rig; /* skeletons and animations */
    const mesh_splat_calls *splats;
    const mesh_weight_calls *weights; /* of vertices, which `--weight` takes */
    const mesh_cell_calls *cells;     /* of volume meshes */
} mesh_format;

/* The first member of every format's own document struct. */
struct mesh_document {
    const mesh_format *format;
    const mesh_part *parts; /* part_count parts, which belong to the document */
    size_t part_count;
    double largest_coordinate; /* of the file's number type; 0: that of the format */
    bool has_face_normals;     /* faces have normals, which saving computes anew */
    file_folder folder;        /* where the names in the file lead */
    memory_budget budget;
    mesh_flaws flaws; /* found by open */
    /* Number of things whose faces, lines or points are unknown (the flaws say why); they are in no faces. */
    size_t unknown_drawings;
    bool used_is_marked; /* ffd_mesh_mark_used was called */
};

/* Returns whether a part has shapes with weights other than 0. */
bool ffd_mesh_shows_shapes(const mesh_document *document);

static inline ffd_status ffd_mesh_check(const mesh_document *document, ffd_error *error)
{
    const mesh_format *format = document->format;
    return format->check ? format->check(document, error) : FFD_OK;
}

static inline ffd_status ffd_mesh_warn(const mesh_document *document, const mesh_log *log, ffd_error *error)
{
    const mesh_format *format = document->format;
    return format->warn ? format->warn(document, log, error) : FFD_OK;
}

/* Sets used of the parts, at most once. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_mesh_mark_used(mesh_document *document, ffd_error *error);

/* For formats: allocates a byte of 0 for each of count vertices, from the document's budget. The caller frees
   them with ffd_free. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_used_make(mesh_document *document, size_t count, uint8_t **used, ffd_error *error);
/* Returns whether some of these bytes are 0 and some are not. Otherwise frees them, because they carry no
   information. */
bool ffd_used_keep(mesh_document *document, size_t count, uint8_t **used);

/* Returns the number of vertices of a document; parts that repeat positions do not count. */
uint64_t ffd_mesh_vertex_count(const mesh_document *document);

/* For formats: describes the number of Gaussian splats and the highest degree of their harmonics, if there
   are any. */
void ffd_mesh_describe_splats(const mesh_document *document, json_text *json);

/* Computes the index in the document of the first vertex of each part; for a part that repeats positions,
   that of the repeated part. The caller frees *first, which is NULL after a failure. Errors: FFD_E_MEMORY. */
ffd_status ffd_first_vertices(const mesh_document *document, size_t **first, ffd_error *error);

#endif
