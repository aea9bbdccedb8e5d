/* model.h - a mesh apart from any format: what a document of one format hands over to the writer of another.

   Corners of polygons name positions, texture coordinates and normals each by their own number, as OBJ does;
   the other formats are special cases of that. Positions and normals are those of the deformed scene.

   What a source has is noted as features. Some of them are the model's own content, others are only words for
   what was left behind; a target says which of them it holds, and a warning names the rest.

   Main header of models: declares model.c, model_features.c, model_morph.c. */
#ifndef FFD_MESH_MODEL_H
#define FFD_MESH_MODEL_H

#include "base/fail.h"
#include "base/memory/intern.h"
#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MODEL_NONE UINT32_MAX
/* Positions, texture coordinates or normals that a model may have. */
#define MODEL_VALUES_MAX (UINT32_MAX - 1)

typedef struct model_corner {
    uint32_t position, texcoord, normal; /* MODEL_NONE: it has none of the latter two */
} model_corner;

/* Polygons of at least three corners, lines along two or more, and points, of one corner. */
typedef enum model_kind { MODEL_FACES, MODEL_LINES, MODEL_POINTS, MODEL_KINDS } model_kind;

typedef struct model_list {
    size_t *starts; /* count + 1, into corners; NULL where count is 0 */
    size_t count, start_capacity;
    model_corner *corners;
    size_t corner_count, corner_capacity;
} model_list;

/* Elements that follow each other and share their names: those of a kind from `first` on, up to those of the
   next run. Names are numbers into model->names, or MODEL_NONE. */
typedef struct model_run {
    uint32_t object, group, material;
    size_t first[MODEL_KINDS];
    uint32_t material_number; /* in the list of the format's materials, or MODEL_NONE: by its name. Only where
                                 details are wanted. */
} model_run;

typedef enum model_feature {
    /* Content of the model. */
    MODEL_HAS_NORMALS = 1 << 0,
    MODEL_HAS_CORNER_NORMALS = 1 << 1, /* several at one position */
    MODEL_HAS_POINT_NORMALS = 1 << 2,  /* of lines or points */
    MODEL_HAS_TEXCOORDS = 1 << 3,
    MODEL_HAS_CORNER_TEXCOORDS = 1 << 4, /* several at one position */
    MODEL_HAS_COLOURS = 1 << 5,
    MODEL_HAS_ALPHA = 1 << 6, /* in colours */
    MODEL_HAS_POLYGONS = 1 << 7,
    MODEL_HAS_LINES = 1 << 8,
    MODEL_HAS_POINTS = 1 << 9,
    MODEL_HAS_LOOSE = 1 << 10, /* positions that nothing uses */
    MODEL_HAS_OBJECTS = 1 << 11,
    MODEL_HAS_GROUPS = 1 << 12,
    MODEL_HAS_MATERIAL_NAMES = 1 << 13,
    MODEL_HAS_FINE_POSITIONS = 1 << 14, /* so far from the origin that floats would change the shape */
    /* Left behind in the source. */
    MODEL_HAS_MATERIALS = 1 << 15,
    MODEL_HAS_TEXTURES = 1 << 16,
    MODEL_HAS_MORE_TEXCOORDS = 1 << 17, /* further sets, those of other textures, or third coordinates */
    MODEL_HAS_TANGENTS = 1 << 18,
    MODEL_HAS_FACE_COLOURS = 1 << 19,
    MODEL_HAS_SMOOTHING = 1 << 20,
    MODEL_HAS_FREE_FORM = 1 << 21,
    MODEL_HAS_HIERARCHY = 1 << 22,
    MODEL_HAS_SKINS = 1 << 23,
    MODEL_HAS_MORPHS = 1 << 24,
    MODEL_HAS_ANIMATIONS = 1 << 25,
    MODEL_HAS_CAMERAS = 1 << 26,
    MODEL_HAS_HIDDEN = 1 << 27,     /* what the source's scene does not show */
    MODEL_HAS_TRANSFORMS = 1 << 28, /* transforms of nodes, where each mesh is read in its own space */
    MODEL_HAS_MORE = 1 << 29,       /* attributes that no other format knows */
    MODEL_HAS_RATIONAL = 1 << 30,   /* a fourth coordinate, w, other than 1 */
} model_feature;

/* A morph target. */
typedef struct model_morph {
    double *positions, *normals; /* where it brings each position and normal of the model */
    const char *name;            /* lent */
} model_morph;

typedef struct mesh_model {
    double *positions, *texcoords, *normals; /* 3, 2 and 3 numbers each; texture coordinates with v upwards */
    size_t position_count, texcoord_count, normal_count;
    model_morph *morphs; /* morph_count */
    size_t morph_count, morph_capacity;
    const struct morph_clip *clips; /* clip_count, lent: animations of their weights */
    size_t clip_count;
    double *colours;     /* 4 a position, red green blue alpha, 0 to 1, in sRGB; NULL where there are none */
    bool coarse_colours; /* they were linear bytes: bytes of sRGB are as fine */
    model_list lists[MODEL_KINDS];
    model_run *runs;
    size_t run_count, run_capacity;
    bool wants_details; /* set by who asks for the model: materials' numbers, and: */
    uint64_t *numbers;  /* of positions in the order of `ffd embed`; NULL: they are in that order */
    size_t nodes_left;  /* nodes that a model has no room for (GPU instances): without details they are
                           refused */
    intern_table names;
    uint32_t features; /* of model_feature; complete after ffd_model_finish */
    memory_budget
        *budget; /* what the model and writing it take comes out of it; lent. NULL: it is not counted */
} mesh_model;

/* Frees what a model holds; leaves an empty one. */
void ffd_model_free(mesh_model *model);

/* Allocates values, all 0, for the caller to fill in; a count of 0 makes none. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_model_make_values(mesh_model *model, size_t positions, size_t texcoords, size_t normals,
                                 ffd_error *error);
/* Makes all colours white where there are none yet. */
ffd_status ffd_model_make_colours(mesh_model *model, ffd_error *error);

/* What is added from now on has these names; NULL: none. An empty name is none. */
ffd_status ffd_model_begin_run(mesh_model *model, const char *object, const char *group, const char *material,
                               ffd_error *error);
/* The material of what is added from now on, by its number, of the last run that was begun. Begins a new run
   where two materials share a name. */
ffd_status ffd_model_number_material(mesh_model *model, uint32_t number, ffd_error *error);
/* Adds a face, line or point of count corners. A face of two corners is a line, and one of a single corner a
   point; a line of less than two corners likewise; of none, nothing. A run must have begun. */
ffd_status ffd_model_add(mesh_model *model, model_kind kind, const model_corner *corners, size_t count,
                         ffd_error *error);
/* Takes count * size bytes from the model's memory budget, if it has one. Errors: FFD_E_LIMIT. */
ffd_status ffd_model_take(mesh_model *model, uint64_t count, uint64_t size, ffd_error *error);
/* Whether the budget allows a writer this much memory for each corner, with polygons cut into triangles, and
   for each run. Errors: FFD_E_LIMIT. */
ffd_status ffd_model_check_memory(const mesh_model *model, size_t corner_bytes, size_t run_bytes,
                                  ffd_error *error);
/* Completes a model: colours that are whole numbers up to 255 are brought to the scale of 1; vertices alone
   become points; and features describe the content. */
ffd_status ffd_model_finish(mesh_model *model, ffd_error *error);

/* Makes what the same document gave before and after it got results one model: the shape before, with a
   further morph target that leads to the shape after. after is left empty. Errors: FFD_E_LIMIT, FFD_E_MEMORY.
 */
ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error);
/* Whether a morph target moves anything. */
bool ffd_model_morphs(const mesh_model *model, size_t morph);

/* The corners of element i. */
static inline const model_corner *model_element(const model_list *list, size_t i, size_t *count)
{
    *count = list->starts[i + 1] - list->starts[i];
    return list->corners + list->starts[i];
}

/* One past the last element of a kind in a run. */
static inline size_t model_run_end(const mesh_model *model, size_t run, model_kind kind)
{
    return run + 1 < model->run_count ? model->runs[run + 1].first[kind] : model->lists[kind].count;
}

static inline const char *model_name(const mesh_model *model, uint32_t name)
{
    return name == MODEL_NONE ? NULL : ffd_intern_key(&model->names, name);
}

/* The texture coordinate of every position: numbers[i] is that of the first corner at position i,
   MODEL_NONE where no corner has one. Tells whether some other corner has one of another value. */
bool ffd_model_texcoords_by_position(const mesh_model *model, uint32_t *numbers);
/* The same for normals. */
bool ffd_model_normals_by_position(const mesh_model *model, uint32_t *numbers);

/* Whether bytes hold all colours: they are multiples of 1/255, as nearly as a text of six digits says it, or
   coarse. */
bool ffd_model_colours_fit_bytes(const mesh_model *model);

/* What a target that holds some features cannot hold of the model: "normals, materials"; "" for nothing. The
   text is cut to capacity. */
void ffd_model_describe_loss(const mesh_model *model, uint32_t holds, char *text, size_t capacity);

#endif
