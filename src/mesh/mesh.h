/* mesh.h - what a mesh format hands over to a job and takes back. Plain C; each format under src/io fills one
   mesh_format table.

   A document keeps the bytes of its file. It shows its vertices as parts; a job reads a part's streams in any
   order, hands results back, and has the document saved: the same bytes with the results spliced in.

   Main header of meshes: declares faces.c, part.c. */
#ifndef FFD_MESH_MESH_H
#define FFD_MESH_MESH_H

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
#include "mesh/rig.h"
#include "mesh/rounding.h"
#include "mesh/selector.h"
#include "splat/splat.h"
#include "json/json_text.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a vertex has. */
typedef enum mesh_stream { MESH_POSITIONS, MESH_NORMALS, MESH_TANGENTS, MESH_STREAMS } mesh_stream;

/* A morph target: offsets to some of a part's streams. A vertex in it is at its position plus the offset.
 */
typedef struct mesh_shape {
    bool has[MESH_STREAMS];
    mesh_rounding rounding; /* of the offsets to positions */
    double weight;          /* that it is shown with before any animation: 0 where it is not */
} mesh_shape;

/* Vertices that share one transform into the lattice's space. */
typedef struct mesh_part {
    size_t vertex_count;
    size_t normal_count; /* 0 where there are none */
    /* Normals are in the order of their vertices: those of vertex i are normal_start[i] ..
       normal_start[i+1]-1. NULL: normal i belongs to vertex i (normal_count is then vertex_count or 0). Lent
       by the document. */
    const uint32_t *normal_start;
    bool has_tangents; /* tangent i belongs to vertex i and to normal i; only with normal_start NULL */

    mesh_rounding rounding; /* of the positions */

    const mesh_shape *shapes; /* only with normal_start NULL. Lent by the document. */
    size_t shape_count;
    bool shows_shapes; /* the weight of some shape is not 0: what is shown is not the part's own vertices */

    /* The vertices are those of an earlier part (same positions, same transform), listed again for other
       normals or tangents: they are not counted, embedded or written a second time. */
    bool repeats_positions;
    size_t repeats; /* that part's number */

    bool identity; /* the part is in the lattice's space itself; the matrices are then not used */
    double linear[9], offset[3]; /* x = linear p + offset */
    double inverse[9];           /* of linear */
    bool singular;               /* linear has no inverse: the part's vertices are kept */
    bool skinned; /* every vertex has a linear and offset of its own (read_transforms); those above are then
                     not used, and identity and singular are false */

    /* What is selected: a vertex whose byte is 0 stays as it is and is not counted, a normal whose byte is 0
       stays. NULL: all vertices; the normals of the selected vertices. Lent by the document. */
    const uint8_t *selected, *selected_normals;
    bool skipped; /* nothing of the part is selected */

    bool splats;         /* the vertices are the centres of Gaussian splats */
    bool has_ellipsoids; /* whose rotations and sizes read_splats gives; else these stay as they are */
    splat_form form;     /* of ellipsoids */
    size_t place; /* of splats: the number by which place_name knows what shows them; or MESH_NO_PLACE */

    /* What shows the part is moved itself (follow): deformed points are taken through y + (carry y +
       carry[9..]) in the lattice's space, 9 numbers row by row and an offset, before they go back to the
       file's space. */
    bool carried;
    double carry[12];
    /* A vertex whose byte is 0 is in no face, line or point. NULL: all are in one, or there are none, or
       ffd_mesh_mark_used was not called. Lent by the document. */
    const uint8_t *used;
    bool hidden; /* a viewer does not show the part */
} mesh_part;

#define MESH_NO_PLACE SIZE_MAX

static inline bool ffd_part_selects(const mesh_part *part, size_t vertex)
{
    return !part->skipped && (!part->selected || part->selected[vertex]);
}

/* Whether the vertex is part of what is shown: a box goes round those that are. */
static inline bool ffd_part_shows(const mesh_part *part, size_t vertex)
{
    return !part->hidden && (!part->used || part->used[vertex]);
}

/* Polygons over all vertices of the document, for topology. Vertex numbers count the vertices of parts in
   order (the order of `ffd embed`); a document may give a subset where parts repeat storage. */
typedef struct mesh_faces {
    size_t vertex_count, face_count;
    double *positions; /* 3*vertex_count, in the lattice's space */
    size_t *start;     /* face_count+1 */
    uint32_t *corners; /* start[face_count] vertex numbers */
    /* vertex_count, ascending: the numbers in the document of the vertices that corners count, which are then
       only those of faces; NULL: all vertices of the document. */
    uint32_t *numbers;
    size_t lines, points; /* primitives other than faces: counted only */
    /* Vertices in no face because an earlier one at the same position represents them (formats that list a
       vertex for every corner): topology does not count them. */
    size_t repeated;
} mesh_faces;

/* The number in the document of a vertex of faces. */
static inline uint32_t ffd_faces_number(const mesh_faces *faces, uint32_t vertex)
{
    return faces->numbers ? faces->numbers[vertex] : vertex;
}

/* What the file has at a point beside vertices: a joint, a camera and so on. */
typedef struct mesh_place {
    double at[3];   /* in the lattice's space */
    unsigned kinds; /* a set of PLACE_BIT; 0: what follow moves all the same */
    bool stays;     /* follow leaves it where it is, whatever it is below; */
    bool partial;   /* because its mesh is selected in part */
    unsigned holds; /* a set of PLACE_HOLDS, which stay as they are */
    size_t number;  /* by which place_name knows it */
} mesh_place;
#define PLACE_BIT(kind) (1u << (kind)) /* of an ffd_behind_kind */

/* Radii of a spring bone; the offset of the eyes; a direction to another place. */
enum { PLACE_HOLDS_SPRING = 1, PLACE_HOLDS_EYES = 2, PLACE_HOLDS_AIM = 4 };

/* What the deformation does at a place. */
typedef struct mesh_place_move {
    bool moves;         /* vertices there would be moved */
    bool singular;      /* the gradient there is not to be trusted */
    double to[3];       /* where they would come to */
    double gradient[9]; /* F - I there; zeros where nothing moves */
    double became[3];   /* where the place is in the output */
} mesh_place_move;

/* What follow has done. */
typedef struct mesh_following {
    uint64_t written;  /* nodes that are written otherwise */
    uint64_t sheared;  /* that turn as their parents do, since they would be sheared else */
    uint64_t singular; /* that stay, with all below them, since their matrices have no inverse */
    uint64_t partial;  /* that stay since their meshes are selected in part */
    uint64_t
        unscaled; /* that hold what stays: sizes of physics shapes, spring bones, offsets of eyes, splats */
} mesh_following;

typedef struct mesh_places {
    mesh_place *list;
    size_t count;
} mesh_places;

typedef struct mesh_document mesh_document;

/* What was found of the weights of skinned vertices. */
typedef struct skin_weights {
    uint64_t off;    /* vertices whose weights do not sum to 1: they are divided by their sum */
    uint64_t none;   /* vertices whose weights are all 0: they follow their first joint */
    double farthest; /* that a sum other than 0 is from 1 */
} skin_weights;

/* Makes arrays for the vertices and faces that are counted, and for their corners. A failure leaves nothing
   to be freed. Errors: FFD_E_MEMORY, FFD_E_LIMIT: the memory budget does not allow them. */
ffd_status ffd_mesh_faces_make(const mesh_document *document, mesh_faces *faces, size_t corners,
                               ffd_error *error);
/* Takes what these arrays need from the budget. */
ffd_status ffd_mesh_faces_take(const mesh_faces *faces, uint64_t corners, memory_budget *budget,
                               ffd_error *error);
/* Frees the arrays; leaves no faces. */
void ffd_mesh_faces_free(mesh_faces *faces);

/* A corner that has no normal. */
#define MESH_NO_NORMAL UINT32_MAX

typedef struct mesh_save_options {
    const char *path; /* "-": standard output */
    ffd_format format;
    bool force;
    ffd_resources resources;
    const char *input; /* the document's file, which a conversion must not replace; NULL or "-": none */
    /* Gets the further files that the output holds as they are: images and material libraries that are
       copied beside it, or are there already. NULL: not wanted. */
    path_list *copied;
    uint64_t *indices_left; /* gets how many indices in extensions cannot follow; NULL: not wanted */
    /* Gets how many bytes of morph targets and animations that are replaced stay, though nothing uses them.
       NULL: not wanted. */
    uint64_t *bytes_left;
} mesh_save_options;

/* x = linear p + offset, in place. */
static inline void ffd_point_transform(const double linear[9], const double offset[3], double point[3])
{
    mat_apply(linear, point, point);
    for (int a = 0; a < 3; a++)
        point[a] += offset[a];
}

/* Takes the positions of a part's vertices [first, first + count) (3 doubles each) from the file's space to
   the lattice's: x = linear p + offset. Thread-safe. */
void ffd_part_transform(const mesh_document *document, size_t part, size_t first, size_t count,
                        double *points);
/* The same with the vertices' own transforms, as read_transforms gives them. */
void ffd_points_transform(const double *transforms, size_t count, double *points);

/* The functions of a format, each described at its member of mesh_format. */
typedef ffd_status mesh_open_function(file_input *input, const ffd_source *source, mesh_document **document,
                                      ffd_error *error);
typedef void mesh_close_function(mesh_document *document);
typedef ffd_status mesh_list_files_function(const mesh_document *document, path_list *files,
                                            ffd_error *error);
typedef ffd_status mesh_find_resources_function(const char *path, const file_input *bytes, path_list *files,
                                                ffd_error *error);
typedef size_t mesh_count_beside_function(const file_input *bytes, ffd_format from, ffd_format to);
typedef ffd_status mesh_list_beside_function(const char *output, size_t count, path_list *files,
                                             ffd_error *error);
typedef ffd_status mesh_check_function(const mesh_document *document, ffd_error *error);
typedef ffd_status mesh_warn_function(const mesh_document *document, const mesh_log *log, ffd_error *error);
/* Results of vertices are written in ranges that begin at its multiples. */
#define MESH_RANGE_STEP ((size_t)1024)

typedef ffd_status mesh_check_reach_function(const mesh_document *document, const ffd_bounds *reach,
                                             ffd_error *error);
typedef ffd_status mesh_list_places_function(const mesh_document *document, bool all, mesh_places *places,
                                             ffd_error *error);
typedef char *mesh_place_name_function(const mesh_document *document, size_t number);
typedef ffd_status mesh_count_skins_function(const mesh_document *document, const mesh_places *places,
                                             const uint8_t *marks, uint64_t *count, ffd_error *error);
typedef ffd_status mesh_follow_function(mesh_document *document, const mesh_places *places,
                                        mesh_place_move *moves, const mesh_log *log,
                                        mesh_following *following, ffd_error *error);
typedef ffd_status mesh_select_function(mesh_document *document, const mesh_selector *selectors, size_t count,
                                        ffd_error *error);
typedef struct mesh_listing mesh_listing; /* listing.h */
typedef ffd_status mesh_list_parts_function(const mesh_document *document, mesh_listing *listing,
                                            ffd_error *error);
typedef ffd_status mesh_mark_used_function(mesh_document *document, ffd_error *error);
typedef void mesh_read_function(const mesh_document *document, size_t part, size_t first, size_t count,
                                double *values);
typedef void mesh_read_transforms_function(const mesh_document *document, size_t part, size_t first,
                                           size_t count, double *transforms, skin_weights *found);
typedef void mesh_read_offsets_function(const mesh_document *document, size_t part, size_t shape,
                                        mesh_stream stream, size_t first, size_t count, double *xyz);
typedef ffd_status mesh_keep_base_function(mesh_document *document, const char *name, ffd_error *error);
typedef struct morph_clip morph_clip; /* morph/morph_clip.h */
typedef ffd_status mesh_keep_clips_function(mesh_document *document, const morph_clip *clips, size_t count,
                                            const char *const *names, size_t name_count, ffd_error *error);
typedef ffd_status mesh_begin_results_function(mesh_document *document, bool normals, bool tangents,
                                               ffd_error *error);
typedef void mesh_write_function(mesh_document *document, size_t part, size_t first, size_t count,
                                 const double *values, const uint8_t *changed);
typedef void mesh_write_offsets_function(mesh_document *document, size_t part, size_t shape,
                                         mesh_stream stream, size_t first, size_t count, const double *xyz,
                                         const uint8_t *changed);
typedef void mesh_read_splats_function(const mesh_document *document, size_t part, size_t first, size_t count,
                                       splat_ellipsoid *splats);
typedef void mesh_write_splats_function(mesh_document *document, size_t part, size_t first, size_t count,
                                        const splat_ellipsoid *splats, const splat_turn *turns,
                                        const uint8_t *changed);
typedef ffd_status mesh_save_function(mesh_document *document, const mesh_save_options *options,
                                      file_output *output, const mesh_log *log, ffd_error *error);
typedef ffd_status mesh_faces_function(const mesh_document *document, mesh_faces *faces, ffd_error *error);
typedef struct vertex_marks vertex_marks; /* mixed_faces.h */
typedef ffd_status mesh_mixed_faces_function(const mesh_document *document, const vertex_marks *marks,
                                             mesh_faces *faces, ffd_error *error);
typedef uint64_t mesh_name_part_function(const mesh_document *document, uint64_t vertex, uint8_t *marks,
                                         char *name, size_t capacity);
typedef ffd_status mesh_corner_normals_function(const mesh_document *document, const mesh_faces *faces,
                                                uint32_t *normals, ffd_error *error);
typedef ffd_status mesh_model_function(const mesh_document *document, mesh_model *model, ffd_error *error);
typedef ffd_status mesh_list_materials_function(mesh_document *document, const mesh_log *log,
                                                mesh_materials *materials, ffd_error *error);
typedef ffd_status mesh_read_skeleton_function(mesh_document *document, bool after, mesh_skeleton **skeleton,
                                               ffd_error *error);
typedef ffd_status mesh_read_anchors_function(const mesh_skeleton *skeleton, bool after,
                                              mesh_anchors *anchors, ffd_error *error);
typedef ffd_status mesh_describe_function(const mesh_document *document, json_text *json, ffd_error *error);
typedef ffd_status mesh_compare_function(const mesh_document *a, const mesh_document *b,
                                         ffd_comparison *comparison, ffd_error *error);

typedef struct mesh_format {
    ffd_format format;
    const char *name; /* "OBJ" */
    /* Reads the document from input, whose ownership passes to the document on success only. name is shown
       in messages; relative references are relative to it ("-": there are none). */
    mesh_open_function *open;
    mesh_close_function *close;
    /* Adds the files that open has read beside the one it was given: a .gltf's buffers. One that is named
       twice is added twice. NULL: there are none. */
    mesh_list_files_function *list_files;
    /* Adds the images beside the file or below, whether they are there or not. NULL: none. */
    mesh_list_files_function *list_images;
    /* The same, of images and of what else is copied with an output, by a look into the bytes of the file at
       a path, without opening a document. A file that is not valid has none. NULL: nothing is copied. */
    mesh_find_resources_function *find_resources;
    /* Counts the files that saving a mesh as `to` writes beside its output, images not among them, by a look
       into the input's bytes, which may be NULL where its format is another one. What is not valid has none.
       NULL: there are none. */
    mesh_count_beside_function *count_beside;
    /* Adds the first `count` of them. */
    mesh_list_beside_function *list_beside;
    /* Refuses (FFD_E_UNSUPPORTED) what the parts' streams do not show as it is, before anything is embedded
       or deformed: skins, morph targets, compressed data. A document that only is to be described need not
       pass. NULL: they show all. Called by ffd_mesh_check. */
    mesh_check_function *check;
    /* Says in a log which values of the file are not what the format has there, and what becomes of them.
       NULL: such values are refused. Errors: FFD_E_MEMORY. Called by ffd_mesh_warn. */
    mesh_warn_function *warn;
    double largest_coordinate; /* that the format's numbers can hold */
    /* Refuses (FFD_E_UNSUPPORTED) if, in a box of the lattice's space (edges may be infinite), the document
       shows something that its parts cannot change and that is selected. NULL: the parts are all. */
    mesh_check_reach_function *check_reach;
    /* Lists what the file places beside vertices, as far as it belongs to what is selected, in the order of
       the file; all: with what has no kind and what is not selected, for follow. places->list is the caller's
       to free, also after a failure. NULL: nothing. */
    mesh_list_places_function *list_places;
    /* The name of such a place, the caller's to free; NULL where memory runs out. */
    mesh_place_name_function *place_name;
    /* Counts the skins that have a marked place (a byte each) as a joint. */
    mesh_count_skins_function *count_skins;
    /* Moves the places (all of them) with the deformation, what is animated there, and the skins: after
       begin_results, which undoes it, and before vertices are written, whose parts it may set to be carried.
       Fills became. NULL: the format has none. Errors: FFD_E_MEMORY, FFD_E_LIMIT, and what is found in the
       file. */
    mesh_follow_function *follow;
    bool normals_of_faces; /* faces have normals, which saving renews, and vertices none */

    /* From now on only what one of the selectors names is moved, counted and written: sets selected and
       skipped of the parts, whose numbers and vertices stay. At most once, before results. selector_kinds is
       the set of kinds that the format has (0: select is NULL). Errors: FFD_E_ARGUMENT where a name is not in
       the file. */
    unsigned selector_kinds;
    mesh_select_function *select;
    /* Adds to a listing that is begun each name that select takes, with what all that have it draw, by kind
       and in the order of the file; and each thing without a name of a kind that has names. NULL: nothing has
       one. Errors: FFD_E_MEMORY, FFD_E_UNSUPPORTED, and what is found in the file. */
    mesh_list_parts_function *list_parts;

    /* Sets used of the parts that have vertices which no face, line or point names. Those whose faces cannot
       be read keep NULL. Called once (ffd_mesh_mark_used). NULL: every vertex is in one. Errors:
       FFD_E_MEMORY, FFD_E_LIMIT. */
    mesh_mark_used_function *mark_used;

    /* Raw values of the file, as double: 3 a position or normal, 4 a tangent (x,y,z and the
       handedness). Thread-safe. */
    mesh_read_function *read_positions;
    mesh_read_function *read_normals;
    mesh_read_function *read_tangents;

    /* Of a skinned part: 12 numbers a vertex, linear row by row and offset. found: NULL, or gets what its
       weights are like added. NULL where no part is skinned. */
    mesh_read_transforms_function *read_transforms;

    /* Offsets of a part's morph target to one of the streams that it has: 3 a vertex, of tangents too. NULL
       where no part has shapes. */
    mesh_read_offsets_function *read_offsets;

    /* From now on the base shape stays, and results are offsets of a further morph target of this name.
       Before begin_results; once more for each further target, where the results of the one before are
       complete. NULL: the format has no morph targets. */
    mesh_keep_base_function *keep_base;
    /* Has further animations of the weights saved with them, which stay the caller's and name these targets
       or others of the file. Before keep_base; names: of all targets to come. Errors: FFD_E_ARGUMENT for a
       clip that names another target. */
    mesh_keep_clips_function *keep_clips;

    /* Results. begin_results must come first: it allocates memory, and frees what an earlier deformation of
       the document has left. The writers may run in several threads on disjoint ranges, which begin at
       multiples of MESH_RANGE_STEP where there is a vector for each vertex. changed: one byte a vector, 0:
       kept as it was (its values are then not read). A vector is handed over once at most. */
    mesh_begin_results_function *begin_results;
    mesh_write_function *write_positions;
    mesh_write_function *write_normals;
    mesh_write_function *write_tangents;

    mesh_write_offsets_function *write_offsets;

    /* Ellipsoids of Gaussian splats, and what becomes of them: the harmonics of splat i turn by turns[i]. Of
       parts that have them; NULL where none has. */
    mesh_read_splats_function *read_splats;
    mesh_write_splats_function *write_splats;

    /* Writes the file (and what belongs to it) into output; byte-identical to the input
       where nothing changed. */
    mesh_save_function *save;
    /* Refuses what save refuses because of files other than the output's own: output is NULL, and nothing is
       written. NULL: there are none. */
    mesh_save_function *check_save;

    /* Topology and description. describe appends members to an open JSON object. */
    mesh_faces_function *faces;
    /* The faces whose vertices are not all marked alike, and perhaps others, with the positions of their
       vertices: of these alone where faces->numbers is set, else the rest have none that count. Vertices at
       one position are marked alike. Errors: FFD_E_MEMORY, FFD_E_LIMIT, and what is found in the file. */
    mesh_mixed_faces_function *mixed_faces;
    /* Writes what shows a vertex (by its number in the document) as a selector, "node:NAME", or "" where it
       has no name. Returns how many of its vertices are marked (a byte for each of the document), and clears
       their marks. NULL: nothing has names. */
    mesh_name_part_function *name_part;
    /* The normal of each corner that faces has given, or MESH_NO_NORMAL: numbers count the normals
       of the parts in order. Of documents with normals only. NULL: the normal of the corner's
       vertex, in the one part. */
    mesh_corner_normals_function *corner_normals;
    /* Fills an empty model (which the caller frees in every case) with the mesh as the parts transform it,
       and with the results where there are some. */
    mesh_model_function *model;
    /* Fills an empty list (which the caller frees in every case) with the materials of the file, and with the
       images of their base colours. glTF: element i is number i of the file. OBJ: those of its libraries, one
       for each name. An image that cannot be had is no failure: the log says so. What the list takes comes
       from the document's memory budget, for as long as it is open. NULL: there are none. Errors:
       FFD_E_MEMORY, FFD_E_LIMIT. */
    mesh_list_materials_function *list_materials;
    /* Makes the skeleton of a document with animations or skins, none of whose keys are loaded; to be freed
       before the document is closed. after: that of the deformed mesh, where follow has moved it.
       *skeleton is NULL where there are none. NULL: the format has none.
       Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
    mesh_read_skeleton_function *read_skeleton;
    /* Fills anchors, which the caller frees in every case, with the vertices as the file has them, or as the
       results of a deformation are; the targets are those that animations drive which are loaded. shown: as
       for read_positions. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
    mesh_read_anchors_function *read_anchors;
    mesh_describe_function *describe;

    /* Compares two documents of this format (see ffd_compare_run). The comparison is begun
       (ffd_difference_begin): it has the tolerances, and no differences yet. */
    mesh_compare_function *compare;
} mesh_format;

/* The head of every document; a format's own struct starts with it. */
struct mesh_document {
    const mesh_format *format;
    const mesh_part *parts; /* part_count, lent */
    size_t part_count;
    double largest_coordinate; /* that the file's numbers can hold; 0: that of the format */
    memory_budget budget;
    mesh_flaws flaws; /* that opening has found */
    /* Things whose faces, lines or points cannot be known (the flaws say why): they are among no faces. */
    size_t unknown_drawings;
    bool used_is_marked; /* ffd_mesh_mark_used was called */
    /* Set before results: they are for another format (model), not for the file, and so not rounded to the
       steps of its integers. */
    bool converted;
    /* Set before the first results, and not changed: nobody looks at what the document was before once they
       are written, so that they may replace it. */
    bool results_replace;
    /* Set by a job: positions, normals and tangents are read as the weights of the morph targets show them,
       and results are of these. */
    bool shown;
    /* Results are offsets of a morph target of its own (keep_base): the others stay. */
    bool keeps_base;
    /* Set by a job before it saves: of such targets only offsets other than 0 need be stored. */
    bool sparse_targets;
};

/* Whether some part shows more than its own vertices. */
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

/* Sets used of the parts, once. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_mesh_mark_used(mesh_document *document, ffd_error *error);

/* For formats: takes a byte for each of count vertices from the document's budget, all 0; to be freed with
   ffd_free. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_used_make(mesh_document *document, size_t count, uint8_t **used, ffd_error *error);
/* Whether some of these bytes are 0 and some are not: else they say nothing, and are freed. */
bool ffd_used_keep(mesh_document *document, size_t count, uint8_t **used);

/* The number of the document's vertices, in the order of `ffd embed`: parts that repeat
   positions do not count. */
uint64_t ffd_mesh_vertex_count(const mesh_document *document);

/* For formats: says how many Gaussian splats there are, and the highest degree of their harmonics. Nothing
   where there are none. */
void ffd_mesh_describe_splats(const mesh_document *document, json_text *json);

/* The number of each part's first vertex in the document; of a part that repeats positions it is that of the
   part which it repeats. *first is the caller's to free, NULL after a failure. Errors: FFD_E_MEMORY. */
ffd_status ffd_parts_number(const mesh_document *document, size_t **first, ffd_error *error);

#endif
