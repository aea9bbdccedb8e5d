/* gltf_document.h - an open glTF file: its bytes, its model, and the parts of its scene. */
#ifndef FFD_IO_GLTF_READ_GLTF_DOCUMENT_H
#define FFD_IO_GLTF_READ_GLTF_DOCUMENT_H

#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_buffer.h"
#include "io/gltf/read/gltf_model.h"
#include "mesh/mesh.h"
#include "mesh/morphs.h"
#include "mesh/selector.h"
#include "json/json_tree.h"
#include <stdarg.h>
#include <stdatomic.h>

#define GLTF_NONE SIZE_MAX

/* The JSON values of the elements of a top-level array. */
typedef struct gltf_values {
    uint32_t *values;
    size_t count;
} gltf_values;

/* How the elements of an accessor are compressed. */
typedef enum gltf_packing { GLTF_PLAIN, GLTF_MESHOPT, GLTF_DRACO } gltf_packing;

/* The elements of an accessor, decoded from KHR_draco_mesh_compression. */
typedef struct gltf_unpacked {
    unsigned char *bytes; /* owned; NULL: Draco does not compress the accessor */
    size_t size, view;    /* view: that of the compressed data */
    uint64_t source;      /* the attribute's unique id; UINT64_MAX: the indices */
    double step;          /* the quantization step of floats; 0: not quantized, or unknown */
    /* The accessor's uncompressed elements, for readers without Draco; NULL: none. */
    const unsigned char *fallback;
    size_t fallback_stride;
    bool clash; /* primitives read different values through the accessor */
} gltf_unpacked;

/* The memory layout of an accessor's elements. ffd_gltf_check fills it, ffd_gltf_decode_draco that of
   elements compressed by Draco. */
typedef struct gltf_layout {
    const unsigned char *data; /* the first element, decoded; NULL: no bytes, or all zeros */
    size_t element_size, stride;
    size_t begin;  /* offset of the first element in the uncompressed buffer */
    bool readable; /* false: the buffer has no bytes, or the compression is not supported */
    gltf_packing packing;
} gltf_layout;

/* The bounds of vectors. Without vectors least is +infinity and largest is -infinity. */
typedef struct gltf_tile_bounds {
    float least[3], largest[3];
} gltf_tile_bounds;

/* A deformed attribute under one node. The result has 3 components per element (a rotation has 4),
   contiguous: floats whatever the accessor's type, rounded to values that this type can represent. */
typedef struct gltf_stream {
    size_t accessor; /* GLTF_NONE: the part lacks the attribute */
    size_t components;
    float *result; /* components * count; NULL before begin_results, and in a part that repeats another */
    /* One flag per tile of MESH_RANGE_STEP vectors of the result; 0: the tile is not written yet. NULL: all
       tiles are written. */
    uint8_t *filled;
    gltf_tile_bounds *bounds; /* of positions, one per tile; NULL: not known */
} gltf_stream;

typedef struct gltf_skin {
    size_t *joints; /* indices of nodes */
    size_t joint_count;
    int inverse_bind; /* accessor; -1: none */
    double *matrices; /* 12 per joint: world matrix * inverse bind matrix; NULL: not needed */
} gltf_skin;

typedef struct gltf_part {
    size_t node;                      /* GLTF_NONE in mesh space */
    const gltf_skin *skin;            /* NULL: no skin, or in mesh space */
    const gltf_influence *influences; /* lent by the model; only with a skin */
    size_t influence_count;
    const gltf_primitive *primitive; /* lent by the model: the first one that it deforms, which shows its */
    uint32_t first_weight;           /* morph targets by default weights from this JSON value on */
    gltf_stream streams[GLTF_DEFORMED];
    uint8_t *selected;  /* as in mesh_part */
    uint8_t *used;      /* as in mesh_part */
    bool is_all_used;   /* true for a primitive without indices: it draws all vertices */
    size_t first_shape; /* index in document->shapes of the part's first morph target */
    /* Index in document->parts of the first attributes of the part's splats, GLTF_DEFORMED attributes in
       each; GLTF_NONE: no splats that change. */
    size_t first_splat, splat_groups;
} gltf_part;

/* A node with EXT_mesh_gpu_instancing. */
typedef struct gltf_instanced_node {
    size_t node;
    size_t translation, rotation, scale; /* accessors; GLTF_NONE: absent */
    uint64_t count;
    ffd_bounds mesh_bounds; /* in the mesh's own space; min > max: no vertices */
    bool unknown_bounds;    /* whether the bounds of the instances are unknown */
    bool deselected;
} gltf_instanced_node;

/* A primitive under a node that uses its mesh. In mesh space each primitive has one instance. */
typedef struct gltf_instance {
    const gltf_primitive *primitive;
    size_t node; /* GLTF_NONE in mesh space */
    /* Per attribute: the part that deforms it; GLTF_NONE: absent, or it cannot be read. */
    size_t part[GLTF_DEFORMED];
    size_t first_target; /* index in document->targets of its first morph target */
    size_t first_splat;  /* index in document->parts of its splats; GLTF_NONE: they do not change */
    bool selected;       /* false: it keeps its original content */
} gltf_instance;

/* The uses of a mesh by the nodes of the scene. A use is an index into nodes. The instances of the mesh start
   at document->instances[first_instance]: node_count for each primitive. */
typedef struct gltf_mesh_uses {
    size_t first_instance;
    size_t *nodes;           /* lent by document->scene_nodes; ascending */
    size_t node_count;       /* in mesh space 1 (nodes is NULL) */
    size_t target_count;     /* the largest number of morph targets of a primitive */
    size_t filed_targets;    /* of these, those that the file has: saving may add further ones */
    bool is_used;            /* whether any node of the file has the mesh */
    bool used_outside_scene; /* whether a node outside the scene has it, or no node at all */
} gltf_mesh_uses;

/* A further morph target with complete results. */
typedef struct gltf_morph {
    char *name;
    bool normals;    /* whether it has offsets of normals and tangents too */
    float **results; /* GLTF_DEFORMED arrays per part, each as in gltf_stream */
    size_t result_count;
    /* Per mesh: its place among the mesh's targets; GLTF_NONE: the mesh does not get it. NULL before saving.
     */
    size_t *places;
} gltf_morph;

typedef struct gltf_document {
    mesh_document base;
    char *path;       /* "-" for standard input */
    const char *name; /* for messages */
    ffd_space space;
    file_input input;
    int threads;      /* for reading and writing */
    bool keeps_pages; /* never releases the mmap pages of its files, which are small */
    bool is_present;  /* keeps the pages and was saved before: everything that saving reads is in memory */
    bool binary;
    glb_layout glb;
    json_tree tree;
    char *json; /* the text of tree, if the file is mapped; else NULL: tree.text is in input */
    gltf_values buffer_values, view_values, accessor_values, mesh_values, node_values, skin_values,
        material_values, image_values, texture_values, sampler_values;
    gltf_model model;
    gltf_skin *skins; /* skin_values.count */
    /* The reason if the skins' transforms are unknown: the document can then only be described. */
    ffd_status skins_status;
    ffd_error skins_error;
    gltf_buffer *buffers; /* buffer_values.count */
    gltf_layout *layouts; /* model.accessor_count */

    /* Decoded data. */
    unsigned char **decoded_views; /* model.view_count; NULL: not compressed, or not supported */
    /* model.view_count: exponents of the numbers in an element (meshopt_view.h); NULL: none. */
    int8_t **view_exponents;
    gltf_unpacked *unpacked; /* model.accessor_count */
    /* model.primitive_count: why a primitive was not decoded; NULL: no problem. */
    char **draco_problems;
    uint64_t draco_decoded; /* points and corners of all decodings together */

    double *world;  /* world matrices, 12 numbers per node: the linear part row by row, then the offset */
    bool *in_scene; /* per node: whether it is in the displayed scene, or stands in for a node that is */
    /* Per node in the scene: its rank in an order with parents before children, each in the order of the
       file's lists; nodes that stand in for others come last. */
    size_t *scene_ranks;
    size_t nodes_in_scene;
    size_t *parents; /* per node: its parent; GLTF_NONE: none */
    /* Per node: whether it or an ancestor replaces a node of the scene at a distance (MSFT_lod), or it is the
       shape of a node's collider or trigger. */
    bool *stands_in;
    /* Per node: whether it is such a shape. It is where that node is, which is its parent; its own transform
       does not count. It is hidden. */
    bool *collides;
    /* How often such a node also replaces a further node, or is its shape, at another place than its first.
     */
    size_t details_shared, shapes_shared;
    /* Per node: whether a selector names it or an ancestor; NULL: no selectors of nodes. */
    bool *selected_nodes;
    bool *hidden; /* per node: whether it or an ancestor is invisible, or it is a shape; NULL: none is */
    size_t *scene_nodes;
    size_t nodes_outside_scene; /* nodes with a mesh */
    /* A node with two parents: not valid, but the file is described as if the node had the first parent only.
       GLTF_NONE: none. */
    size_t shared_child, shared_by[2];
    /* The JSON value of a required extension that prevents deforming the vertices; JSON_NONE: none. */
    uint32_t refused_extension;
    gltf_mesh_uses *mesh_uses; /* model.mesh_count */
    /* instance_count: those of each primitive in the order of model.primitives, and of their nodes. */
    gltf_instance *instances;
    size_t instance_count;
    /* base.part_count, then one per shape, whose streams are offsets, so that both kinds of results are
       handled alike; then splat_groups. */
    gltf_part *parts;
    mesh_part *mesh_parts;
    mesh_shape *shapes; /* the morph targets of all parts; those of one part are consecutive */
    size_t shape_count;
    size_t splat_groups;    /* number of elements of parts that hold splats, after those of shapes */
    atomic_size_t unturned; /* splats whose harmonics could not be turned: they are not finite numbers */
    mesh_results results;   /* as they were begun */
    /* Results are offsets of a further morph target of this name; NULL: results are not offsets. */
    char *morph_name;
    gltf_morph *morphs; /* morph_count: the further morph targets before it, complete */
    size_t morph_count, morph_capacity;
    const morph_clip *clips; /* clip_count, lent: animations to add */
    size_t clip_count;
    gltf_instanced_node *instanced_nodes; /* in the order of nodes */
    size_t instanced_node_count;
    /* The reason if the transforms of instances are unknown: the document can then only be described. */
    ffd_status instancing_status;
    ffd_error instancing_error;
    struct gltf_edit *edit; /* what saving changes and adds beside results (io/gltf/edit) */
    gltf_values replaced;   /* animations that it replaces */
    /* Per morph target of an instance: the part that holds its offsets; GLTF_NONE: not deformed. */
    size_t *targets;
} gltf_document;

/* Decides whether the document keeps the mmap pages of its files. Call it once they are open. */
void ffd_gltf_choose_pages(gltf_document *document);

/* Releases the mmap pages of the files, unless the document keeps them; later reads load them again. */
void ffd_gltf_forget(const gltf_document *document);

/* Releases only the pages of bytes [offset, offset + size) of one buffer, as far as the buffer has these
   bytes. */
void ffd_gltf_forget_bytes(const gltf_document *document, const gltf_buffer *buffer, size_t offset,
                           size_t size);

/* Releases only the pages of elements [first, first + count) of an accessor, if they are stored
   uncompressed. */
void ffd_gltf_forget_elements(const gltf_document *document, size_t accessor, size_t first, size_t count);

/* Frees the arrays of a stream's result. */
void ffd_gltf_free_result(gltf_stream *stream);

/* Converts a mesh document, which must be of glTF. */
static inline const gltf_document *ffd_gltf_of(const mesh_document *document)
{
    return (const gltf_document *)document;
}

/* Returns the number of parts and shapes together. */
static inline size_t ffd_gltf_shape_end(const gltf_document *document)
{
    return document->base.part_count + document->shape_count;
}

/* Returns the number of elements of document->parts: parts, shapes and groups of splats. */
static inline size_t ffd_gltf_part_count(const gltf_document *document)
{
    return ffd_gltf_shape_end(document) + document->splat_groups;
}

/* Whether an accessor of the model is not one of the file: saving adds it, with zeros and no bytes. */
static inline bool ffd_gltf_is_added(const gltf_document *document, size_t accessor)
{
    return accessor >= document->accessor_values.count;
}

/* Whether a value is among others (NULL: none). */
static inline bool ffd_gltf_is_among(const gltf_values *list, uint32_t value)
{
    for (size_t i = 0; list && i < list->count; i++)
        if (list->values[i] == value)
            return true;
    return false;
}

/* Whether an animation is replaced in the output: what it names does not count. */
static inline bool ffd_gltf_is_replaced(const gltf_document *document, uint32_t animation)
{
    return ffd_gltf_is_among(&document->replaced, animation);
}

/* Returns the primitive of a mesh after `primitive`, or the first one if that is NULL; NULL: there is none.
 */
static inline const gltf_primitive *ffd_gltf_next_primitive(const gltf_document *document, size_t mesh,
                                                            const gltf_primitive *primitive)
{
    const gltf_mesh *const of = &document->model.meshes[mesh];
    const size_t next = primitive ? primitive->index + 1 : 0;
    return next < of->primitive_count ? &of->primitives[next] : NULL;
}

/* Returns the instances of a primitive of a mesh, one for each use of the mesh. */
static inline gltf_instance *ffd_gltf_instances(const gltf_document *document,
                                                const gltf_primitive *primitive)
{
    const gltf_mesh_uses *const uses = &document->mesh_uses[primitive->mesh];
    return document->instances + uses->first_instance + primitive->index * uses->node_count;
}

/* Returns the skin of an instance's node; NULL: it has none, or in mesh space. */
static inline gltf_skin *ffd_gltf_skin_of(const gltf_document *document, const gltf_instance *instance)
{
    const int skin = instance->node == GLTF_NONE ? -1 : document->model.nodes[instance->node].skin;
    return skin < 0 ? NULL : &document->skins[skin];
}

/* Whether viewers hide a node (GLTF_NONE: none) of the scene. */
static inline bool ffd_gltf_is_hidden(const gltf_document *document, size_t node)
{
    return document->hidden && node != GLTF_NONE && document->hidden[node];
}

/* Returns the results of a part's attribute in a further morph target; NULL: none. */
static inline const float *ffd_gltf_morph_result(const gltf_morph *morph, size_t part, size_t semantic)
{
    return morph->results[part * GLTF_DEFORMED + semantic];
}

/* Handles a flaw at a JSON value: something wrong whose meaning is still clear. Notes it or fails with it, as
   the document's flaws say (mesh/flaws.h). */
ffd_status ffd_gltf_flaw(gltf_document *document, uint32_t value, ffd_error *error, const char *format, ...)
    FFD_PRINTF(4, 5);
/* The same with a va_list. */
ffd_status ffd_gltf_note_flaw(gltf_document *document, uint32_t value, ffd_error *error, const char *format,
                              va_list arguments);

/* Returns a value's extension of this name; JSON_NONE if it has none. */
uint32_t ffd_gltf_extension(const gltf_document *document, uint32_t value, const char *extension);

/* Whether a value has an extension of this name. */
bool ffd_gltf_has_extension(const gltf_document *document, uint32_t value, const char *extension);

/* Returns a JSON value as a whole number below count; GLTF_NONE if it is not one. */
size_t ffd_gltf_index(const gltf_document *document, uint32_t value, size_t count);

/* Returns a JSON value as the index of a node; GLTF_NONE if it is not one. */
size_t ffd_gltf_node(const gltf_document *document, uint32_t value);

/* Returns the first element of the array that is a member of an object; JSON_NONE if absent or empty. */
uint32_t ffd_gltf_first(const gltf_document *document, uint32_t object, const char *key);

/* The attributes of splats, in the order of their slots, which follow the slots of vectors. */
#define GLTF_SPLAT_NAME 48
enum { GLTF_SPLAT_ROTATION, GLTF_SPLAT_SCALE, GLTF_SPLAT_HARMONICS, GLTF_SPLAT_ATTRIBUTES = 17 };
/* Writes the name of a splat attribute: "KHR_gaussian_splatting:ROTATION" and so on. */
void ffd_gltf_splat_name(size_t attribute, char name[GLTF_SPLAT_NAME]);

/* The names of the deformed attributes: "POSITION" and so on. */
extern const char *const ffd_gltf_semantic_names[GLTF_DEFORMED];

#endif
