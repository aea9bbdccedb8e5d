/* gltf_document.h - an open glTF file: its bytes, its model, and the parts of its scene. */
#ifndef FFD_IO_GLTF_DOCUMENT_GLTF_DOCUMENT_H
#define FFD_IO_GLTF_DOCUMENT_GLTF_DOCUMENT_H

#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_buffer.h"
#include "io/gltf/model/gltf_model.h"
#include "mesh/mesh.h"
#include "json/json_span.h"
#include <stdarg.h>
#include <stdatomic.h>

#define GLTF_NONE SIZE_MAX

/* The JSON values of the elements of an array at the top of the file. */
typedef struct gltf_values {
    uint32_t *values;
    size_t count;
} gltf_values;

/* How the elements of an accessor are compressed. */
typedef enum gltf_packing { GLTF_PLAIN, GLTF_MESHOPT, GLTF_DRACO } gltf_packing;

/* Elements of an accessor, decoded from KHR_draco_mesh_compression. */
typedef struct gltf_unpacked {
    unsigned char *bytes; /* owned; NULL: the accessor is not compressed by it */
    size_t size, view;    /* view: the compressed data */
    uint64_t source;      /* the attribute's id, UINT64_MAX: the indices */
    double step;          /* of floats that were quantized; 0: they were not, or it is not known */
    /* The accessor's own elements, for readers that do not know Draco; NULL: none. */
    const unsigned char *fallback;
    size_t fallback_stride;
    bool clash; /* primitives read different values for the accessor */
} gltf_unpacked;

/* The memory layout of an accessor's elements; made by ffd_gltf_check, and by ffd_gltf_decode_draco if
   they are compressed. */
typedef struct gltf_layout {
    const unsigned char *data; /* its first element, decoded; NULL: no bytes, or all zeros */
    size_t element_size, stride;
    size_t begin;  /* of the first element in the buffer (before its compression) */
    bool readable; /* false: its buffer has no bytes, or its compression is not supported */
    gltf_packing packing;
} gltf_layout;

/* The bounds of vectors; least is +infinity and largest -infinity if there are none. */
typedef struct gltf_tile_bounds {
    float least[3], largest[3];
} gltf_tile_bounds;

/* One deformed attribute under one node. Its result has 3 components per element (a rotation has 4), as float
   whatever the accessor's type is, rounded to what that type can represent. */
typedef struct gltf_stream {
    size_t accessor; /* GLTF_NONE: the part has none */
    size_t components;
    float *result; /* components * count; NULL before begin_results, and in a part that repeats another */
    /* One for each tile of MESH_RANGE_STEP vectors of the result; 0: the tile is not written yet. NULL: all
       tiles are written. */
    uint8_t *filled;
    gltf_tile_bounds *bounds; /* of positions, one per tile; NULL: not known */
} gltf_stream;

typedef struct gltf_skin {
    size_t *joints; /* nodes */
    size_t joint_count;
    int inverse_bind; /* accessor; -1: absent */
    double *matrices; /* 12 per joint: world matrix * inverse bind matrix; NULL: not needed */
} gltf_skin;

typedef struct gltf_part {
    size_t node;                      /* GLTF_NONE in mesh space */
    const gltf_skin *skin;            /* NULL: no skin, or in mesh space */
    const gltf_influence *influences; /* lent by the model; with a skin */
    size_t influence_count;
    gltf_stream streams[GLTF_DEFORMED];
    uint8_t *selected;  /* the mesh_part's selected */
    uint8_t *used;      /* and used */
    bool is_all_used;   /* a primitive without indices draws all vertices */
    size_t first_shape; /* document->shapes holds the part's morph targets from here */
    /* document->parts holds the attributes of the part's splats from here, GLTF_DEFORMED each; GLTF_NONE
       where there are none that change. */
    size_t first_splat, splat_groups;
} gltf_part;

/* A node with EXT_mesh_gpu_instancing, and its instances. */
typedef struct gltf_instanced_node {
    size_t node;
    size_t translation, rotation, scale; /* accessors; GLTF_NONE: absent */
    uint64_t count;
    ffd_bounds mesh_bounds; /* in the mesh's own space; min > max: no vertices */
    bool unknown_bounds;    /* of the instances */
    bool deselected;
} gltf_instanced_node;

/* A primitive under a node that uses its mesh (in mesh space, the primitive by itself). */
typedef struct gltf_instance {
    size_t part[GLTF_DEFORMED]; /* that deforms its attribute; GLTF_NONE: it has none, or cannot be read */
    size_t first_target;        /* its morph targets in document->targets */
    size_t first_splat;         /* its splats in document->parts; GLTF_NONE: they do not change */
    bool selected;              /* false: it keeps its original content */
} gltf_instance;

/* The uses of a mesh by the nodes of the scene. A use is an index into nodes. document->instances has,
   from first_instance on, node_count instances for each primitive. */
typedef struct gltf_mesh_uses {
    size_t first_instance;
    size_t *nodes;           /* lent by document->scene_nodes; ascending */
    size_t node_count;       /* in mesh space 1, and nodes is NULL */
    size_t target_count;     /* morph targets of the primitive that has most */
    bool is_used;            /* some node of the file has the mesh */
    bool used_outside_scene; /* a node outside the scene has it, or none does */
} gltf_mesh_uses;

/* A further morph target, whose results are complete. */
typedef struct gltf_morph {
    char *name;
    bool normals;    /* it has offsets of normals and tangents too */
    float **results; /* GLTF_DEFORMED per part, as streams have them */
    size_t result_count;
} gltf_morph;

typedef struct gltf_document {
    mesh_document base;
    char *path;       /* "-" for standard input */
    const char *name; /* for messages */
    ffd_space space;
    file_input input;
    int threads;      /* for reading and writing */
    bool keeps_pages; /* of its files, which are small: nothing is released */
    bool is_present;  /* it keeps them, and was saved before: all that a saving reads is in memory */
    bool binary;
    glb_layout glb;
    json_span tree;
    gltf_values buffer_values, view_values, accessor_values, mesh_values, node_values, skin_values,
        material_values, image_values, texture_values, sampler_values;
    gltf_values primitive_values; /* of all meshes */
    size_t *first_primitive;      /* of a mesh, in them */
    gltf_model model;
    gltf_skin *skins; /* skin_values.count */
    /* Why the skins' transforms are unknown, if they are: such a document can only be described. */
    ffd_status skins_status;
    ffd_error skins_error;
    gltf_buffer *buffers; /* buffer_values.count */
    gltf_layout *layouts; /* model.accessor_count */

    /* Decoded data. */
    unsigned char **decoded_views; /* model.view_count; NULL: not compressed, or not supported */
    int8_t **view_exponents;       /* likewise: of the numbers in an element (meshopt_view.h); NULL: none */
    gltf_unpacked *unpacked;       /* model.accessor_count */
    char **draco_problems;         /* primitive_values.count; NULL: none */
    uint64_t draco_decoded;        /* points and corners of all decodings */

    double *world;  /* world matrices, 12 per node: linear row by row, offset */
    bool *in_scene; /* per node: it is in the scene that is displayed, or stands in for such a node */
    /* Per node in the scene: how many come before it, parents before their children, both in the order that
       the file lists them; those that stand in come last. */
    size_t *scene_ranks;
    size_t nodes_in_scene;
    size_t *parents; /* per node: the node that places it; GLTF_NONE: none */
    /* Per node: it, or a node above it, is shown in place of a node of the scene at a distance (MSFT_lod). */
    bool *stands_in;
    size_t details_shared; /* uses of such a node for another node, at another place, than the first */
    bool *selected_nodes;  /* per node: a selector of nodes names it, or one above; NULL: there is none */
    bool *hidden;          /* per node: it or a node above it is not visible; NULL: none of them */
    size_t *scene_nodes;
    size_t nodes_outside_scene; /* nodes with a mesh */
    /* A node with two parents, which is not valid but is described as if it had the first
       only; GLTF_NONE: none. */
    size_t shared_child, shared_by[2];
    /* In the JSON: a required extension for which the vertices cannot be deformed; JSON_NONE: none. */
    uint32_t refused_extension;
    gltf_mesh_uses *mesh_uses; /* model.mesh_count */
    gltf_instance *instances;
    /* base.part_count, then one for each shape, whose streams are its offsets: the results of both are
       handled alike. */
    gltf_part *parts;
    mesh_part *mesh_parts;
    mesh_shape *shapes; /* morph targets of all parts, those of one part consecutive */
    size_t shape_count;
    size_t splat_groups;    /* in parts, behind those of shapes */
    atomic_size_t unturned; /* results of splats whose harmonics are not numbers */
    char *morph_name;   /* results are offsets of a further morph target of this name; NULL: they are not */
    gltf_morph *morphs; /* morph_count, before it */
    size_t morph_count, morph_capacity;
    const morph_clip *clips; /* clip_count, lent: animations to be added */
    size_t clip_count;
    bool morph_normals;   /* of normals and tangents too */
    size_t own_accessors; /* the last ones, which the file did not have: zeros without bytes */
    gltf_instanced_node *instanced_nodes; /* by node */
    size_t instanced_node_count;
    /* Why their transforms are unknown, if they are: such a document can only be described. */
    ffd_status instancing_status;
    ffd_error instancing_error;
    struct gltf_rig *rig; /* how nodes follow the deformation (io/gltf/rig); NULL: they do not */
    size_t *targets;      /* per morph target of an instance: the part that holds its offsets;
                             GLTF_NONE: none is deformed */
} gltf_document;

/* Decides whether the document keeps the pages of its files, once they are open. */
void ffd_gltf_choose_pages(gltf_document *document);

/* Releases the pages of the files' mmap, unless it keeps them; they are read again when they are needed. */
void ffd_gltf_forget(const gltf_document *document);

/* Releases only those of bytes [offset, offset + size) of one buffer, as far as it has them. */
void ffd_gltf_forget_bytes(const gltf_document *document, const gltf_buffer *buffer, size_t offset,
                           size_t size);

/* Releases those of elements [first, first + count) of an accessor, where they are in the file as they are.
 */
void ffd_gltf_forget_elements(const gltf_document *document, size_t accessor, size_t first, size_t count);

/* Returns the document as what it is; it must be of glTF. */
static inline const gltf_document *ffd_gltf_of(const mesh_document *document)
{
    return (const gltf_document *)document;
}

/* Returns the number of parts and shapes together. */
static inline size_t ffd_gltf_shape_end(const gltf_document *document)
{
    return document->base.part_count + document->shape_count;
}

/* And of those that hold results of splats. */
static inline size_t ffd_gltf_part_count(const gltf_document *document)
{
    return ffd_gltf_shape_end(document) + document->splat_groups;
}

/* Returns the instances of a primitive of a mesh, one for each use of the mesh. */
static inline gltf_instance *ffd_gltf_instances(const gltf_document *document, size_t mesh, size_t primitive)
{
    const gltf_mesh_uses *uses = &document->mesh_uses[mesh];
    return document->instances + uses->first_instance + primitive * uses->node_count;
}

/* Whether a viewer does not show a node (GLTF_NONE: none) of the scene. */
static inline bool ffd_gltf_is_hidden(const gltf_document *document, size_t node)
{
    return document->hidden && node != GLTF_NONE && document->hidden[node];
}

/* Returns the result of an attribute of a part for a further morph target; NULL: there is none. */
static inline const float *ffd_gltf_morph_result(const gltf_morph *morph, size_t part, size_t semantic)
{
    return morph->results[part * GLTF_DEFORMED + semantic];
}

/* Returns the JSON value of a primitive of a mesh. */
uint32_t ffd_gltf_primitive_value(const gltf_document *document, size_t mesh, size_t primitive);

/* Notes what is wrong at a value but has a plain meaning, or fails with it, as the document's flaws say (see
   mesh/flaws.h). */
ffd_status ffd_gltf_flaw(gltf_document *document, uint32_t value, ffd_error *error, const char *format, ...)
    FFD_PRINTF(4, 5);
/* The same with the arguments of a caller. */
ffd_status ffd_gltf_note_flaw(gltf_document *document, uint32_t value, ffd_error *error, const char *format,
                              va_list arguments);

/* Returns a value's extension of this name; JSON_NONE if it has none. */
uint32_t ffd_gltf_extension(const gltf_document *document, uint32_t value, const char *extension);

/* Whether a value has an extension of this name. */
bool ffd_gltf_has_extension(const gltf_document *document, uint32_t value, const char *extension);

/* Returns the whole number below count that a value is; GLTF_NONE if it is none. */
size_t ffd_gltf_index(const gltf_document *document, uint32_t value, size_t count);

/* Returns the node whose number a value is; GLTF_NONE if it is none. */
size_t ffd_gltf_node(const gltf_document *document, uint32_t value);

/* Returns the first element of an array that is a member of an object; JSON_NONE if there is none. */
uint32_t ffd_gltf_first(const gltf_document *document, uint32_t object, const char *key);

/* The attributes of splats, in the order of their slots behind those of vectors. */
#define GLTF_SPLAT_NAME 48
enum { GLTF_SPLAT_ROTATION, GLTF_SPLAT_SCALE, GLTF_SPLAT_HARMONICS, GLTF_SPLAT_ATTRIBUTES = 17 };
/* Writes the name of one: "KHR_gaussian_splatting:ROTATION" and so on. */
void ffd_gltf_splat_name(size_t attribute, char name[GLTF_SPLAT_NAME]);

/* The names of the deformed attributes: "POSITION" and so on. */
extern const char *const ffd_gltf_semantic_names[GLTF_DEFORMED];

#endif
