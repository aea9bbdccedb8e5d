/* model.h - a mesh independent of formats, which the document of one format passes to the writer of another.

   Corners of polygons have separate indices of positions, texture coordinates and normals, as in OBJ; the
   other formats are special cases of that. Positions and normals are those of the deformed scene.

   The content of a source is recorded as features. Some features are content of the model, others stand for
   what a model cannot hold. A target format declares the features that it supports, and a warning names the
   others.

   Main header of models: declares model.c, model_features.c. */
#ifndef FFD_MESH_MODEL_H
#define FFD_MESH_MODEL_H

#include "base/fail.h"
#include "base/memory/intern.h"
#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MODEL_NONE UINT32_MAX
/* The most positions, texture coordinates or normals of a model. */
#define MODEL_VALUES_MAX (UINT32_MAX - 1)

typedef struct model_corner {
    uint32_t position, texcoord, normal; /* the latter two may be MODEL_NONE */
} model_corner;

/* Kinds of elements: polygons with at least three corners, polylines with at least two, and points with
   one. */
typedef enum model_kind { MODEL_FACES, MODEL_LINES, MODEL_POINTS, MODEL_KINDS } model_kind;

typedef struct model_list {
    size_t *starts; /* count + 1 offsets into corners; NULL if count is 0 */
    size_t count, start_capacity;
    model_corner *corners;
    size_t corner_count, corner_capacity;
} model_list;

/* Consecutive elements with the same names: for each kind from `first` up to `first` of the next run. Names
   are indices into model->names, or MODEL_NONE. */
typedef struct model_run {
    uint32_t object, group, material;
    size_t first[MODEL_KINDS];
    /* The others only if wants_details. */
    uint32_t material_index; /* index in the list of the format's materials; MODEL_NONE: identified by its
                                name */
    int64_t glow_step;       /* from a corner's texture coordinates to those of the texture of the emission */
} model_run;

typedef enum model_feature {
    /* Content of the model. */
    MODEL_HAS_NORMALS = 1 << 0,
    MODEL_HAS_CORNER_NORMALS = 1 << 1, /* several at a position */
    MODEL_HAS_POINT_NORMALS = 1 << 2,  /* of lines or points */
    MODEL_HAS_TEXCOORDS = 1 << 3,
    MODEL_HAS_CORNER_TEXCOORDS = 1 << 4, /* several at a position */
    MODEL_HAS_COLOURS = 1 << 5,
    MODEL_HAS_ALPHA = 1 << 6,    /* in colours */
    MODEL_HAS_POLYGONS = 1 << 7, /* faces of more than three corners */
    MODEL_HAS_LINES = 1 << 8,
    MODEL_HAS_POINTS = 1 << 9,
    MODEL_HAS_LOOSE = 1 << 10, /* positions that nothing uses */
    MODEL_HAS_OBJECTS = 1 << 11,
    MODEL_HAS_GROUPS = 1 << 12,
    MODEL_HAS_MATERIAL_NAMES = 1 << 13,
    MODEL_HAS_FACE_COLOURS = 1 << 19,
    MODEL_HAS_FINE_POSITIONS = 1 << 14, /* so far from the origin that float32 would change the shape */
    /* Not in the model: */
    MODEL_HAS_MATERIALS = 1 << 15,
    MODEL_HAS_TEXTURES = 1 << 16,
    MODEL_HAS_MORE_TEXCOORDS = 1 << 17, /* further sets, sets of other textures, or third coordinates */
    MODEL_HAS_TANGENTS = 1 << 18,
    MODEL_HAS_SMOOTHING = 1 << 20,
    MODEL_HAS_FREE_FORM = 1 << 21,
    MODEL_HAS_HIERARCHY = 1 << 22,
    MODEL_HAS_SKINS = 1 << 23,
    MODEL_HAS_MORPHS = 1 << 24,
    MODEL_HAS_ANIMATIONS = 1 << 25,
    MODEL_HAS_CAMERAS = 1 << 26,
    MODEL_HAS_HIDDEN = 1 << 27,     /* what the scene of the source does not show */
    MODEL_HAS_TRANSFORMS = 1 << 28, /* transforms of nodes, if each mesh is read in its own space */
    MODEL_HAS_MORE = 1 << 29,       /* attributes that no other format has */
    MODEL_HAS_RATIONAL = 1 << 30,   /* a fourth coordinate, w, other than 1 */
} model_feature;

/* A morph target. */
typedef struct model_morph {
    double *positions, *normals; /* each position and normal of the model as the target moves it */
    const char *name;            /* borrowed */
} model_morph;

typedef struct mesh_model {
    double *positions, *texcoords, *normals; /* 3, 2 and 3 numbers each; v of texture coordinates upwards */
    size_t position_count, texcoord_count, normal_count;
    model_morph *morphs; /* morph_count */
    size_t morph_count, morph_capacity;
    bool drops_still; /* a mesh has no morph target that moves nothing in it, not even where nothing moves */
    const struct morph_clip *clips; /* clip_count animations of their weights, borrowed */
    size_t clip_count;
    double *colours;      /* 4 for each position: red, green, blue, alpha, 0 to 1, sRGB; NULL: none */
    bool coarse_colours;  /* colours were linear bytes, so sRGB bytes are precise enough */
    double *face_colours; /* the same for the first coloured_faces faces; NULL: none. After
                             ffd_model_finish all faces have one, or none has */
    size_t coloured_faces, face_colour_capacity;
    model_list lists[MODEL_KINDS];
    model_run *runs;
    size_t run_count, run_capacity;
    bool wants_details;     /* set by the caller who needs material indices, and: */
    uint64_t *indices;      /* of positions in the order of `ffd embed`; NULL: they are in that order */
    size_t odd_texcoords;   /* faces whose texture coordinates do not fit their corners: they are left out */
    size_t other_texcoords; /* primitives without the set that their texture uses: TEXCOORD_0 is taken */
    size_t nodes_left;      /* nodes that a model cannot represent (GPU instances); refused unless
                               wants_details */
    intern_table names;
    uint32_t features;     /* set of model_feature; complete after ffd_model_finish */
    memory_budget *budget; /* memory budget of the model and of writing it, borrowed; NULL: unlimited */
} mesh_model;

/* Frees the content of a model and empties it. */
void ffd_model_free(mesh_model *model);

/* Allocates values, all 0, for the caller to fill; none for a count of 0. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_model_make_values(mesh_model *model, size_t positions, size_t texcoords, size_t normals,
                                 ffd_error *error);
/* Adds white colours if there are none. */
ffd_status ffd_model_make_colours(mesh_model *model, ffd_error *error);

/* Begins a run with these names; NULL or "": no name. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_begin_run(mesh_model *model, const char *object, const char *group, const char *material,
                               ffd_error *error);
/* Sets the material index and the glow_step of the current run. Begins a new run if two materials have the
   same name, or two steps the same material. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_set_material(mesh_model *model, uint32_t index, int64_t glow_step, ffd_error *error);
/* Adds a face, line or point of count corners. A face with two corners becomes a line, and a face or line
   with one corner a point; without corners nothing is added. A run must have begun. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_model_add(mesh_model *model, model_kind kind, const model_corner *corners, size_t count,
                         ffd_error *error);
/* Gives the face that was added last a colour: red, green, blue, alpha, as in mesh_model. Faces before it
   without one are grey. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_colour_face(mesh_model *model, const double colour[4], ffd_error *error);
/* Gives the faces behind the last coloured one a colour too, if there is one. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_model_colour_rest(mesh_model *model, ffd_error *error);
/* Takes count * size bytes from the model's memory budget, if it has one. Errors: FFD_E_LIMIT. */
ffd_status ffd_model_take(mesh_model *model, uint64_t count, uint64_t size, ffd_error *error);
/* Checks that the budget allows a writer these bytes for each corner, with polygons triangulated, and for
   each run. Errors: FFD_E_LIMIT. */
ffd_status ffd_model_check_memory(const mesh_model *model, size_t corner_bytes, size_t run_bytes,
                                  ffd_error *error);
/* Completes a model: scales colours that are integers up to 255 to 0..1, makes points if there are only
   vertices, and sets the features. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_finish(mesh_model *model, ffd_error *error);

/* Combines the models of a document before and after it got results: `before` gets a further morph target
   that leads to the shape of `after`, which is emptied. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error);
/* Returns whether a morph target moves anything. */
bool ffd_model_morphs(const mesh_model *model, size_t morph);

/* Returns the corners of element i. */
static inline const model_corner *model_element(const model_list *list, size_t i, size_t *count)
{
    *count = list->starts[i + 1] - list->starts[i];
    return list->corners + list->starts[i];
}

/* Returns the index after the last element of a kind in a run. */
static inline size_t model_run_end(const mesh_model *model, size_t run, model_kind kind)
{
    return run + 1 < model->run_count ? model->runs[run + 1].first[kind] : model->lists[kind].count;
}

static inline const char *model_name(const mesh_model *model, uint32_t name)
{
    return name == MODEL_NONE ? NULL : ffd_intern_key(&model->names, name);
}

/* Sets indices[i] to the texture coordinate of the first corner at position i that has one; MODEL_NONE if
   there is none. Returns whether another corner at some position has a different value. */
bool ffd_model_texcoords_by_position(const mesh_model *model, uint32_t *indices);
/* The same for normals. */
bool ffd_model_normals_by_position(const mesh_model *model, uint32_t *indices);

/* Returns whether bytes can represent all colours: they are multiples of 1/255, to six decimal digits, or
   coarse_colours is set. */
bool ffd_model_colours_fit_bytes(const mesh_model *model);
/* The same for the colours of faces. */
bool ffd_model_face_colours_fit_bytes(const mesh_model *model);
/* Returns whether a face has an alpha other than 1. */
bool ffd_model_has_face_alpha(const mesh_model *model);

/* Lists the content of a model that a target with the features `holds` loses: "normals, materials"; "" if
   none. The text is truncated to capacity. */
void ffd_model_describe_loss(const mesh_model *model, uint32_t holds, char *text, size_t capacity);

#endif
