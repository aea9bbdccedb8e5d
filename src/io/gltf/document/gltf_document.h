/* gltf_document.h - an open glTF file: its bytes, its model, and the parts that it shows. */
#ifndef FFD_IO_GLTF_DOCUMENT_GLTF_DOCUMENT_H
#define FFD_IO_GLTF_DOCUMENT_GLTF_DOCUMENT_H

#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_buffer.h"
#include "io/gltf/model/gltf_model.h"
#include "mesh/mesh.h"
#include "json/json_span.h"

#define GLTF_NONE SIZE_MAX

/* The values in the JSON of an array at its top. */
typedef struct gltf_values {
    uint32_t *values;
    size_t count;
} gltf_values;

/* Compression that the elements of an accessor come out of. */
typedef enum gltf_packing { GLTF_PLAIN, GLTF_MESHOPT, GLTF_DRACO } gltf_packing;

/* Elements of an accessor out of KHR_draco_mesh_compression. */
typedef struct gltf_unpacked {
    unsigned char *bytes; /* owned; NULL: the accessor does not come out of it */
    size_t size, view;    /* view: the compressed data */
    uint64_t source;      /* the attribute's id, UINT64_MAX: the indices */
    /* The accessor's own elements, for readers that do not know Draco; NULL: none. */
    const unsigned char *fallback;
    size_t fallback_stride;
    bool clash; /* primitives take different values for the accessor */
} gltf_unpacked;

/* How an accessor's elements lie; made by ffd_gltf_check, and by ffd_gltf_decode_draco where they are
   compressed. */
typedef struct gltf_layout {
    const unsigned char *data; /* its first element, decoded; NULL: no bytes, or all zeros */
    size_t element_size, stride;
    size_t begin;  /* of the first element in the buffer (before its compression) */
    bool readable; /* false: its buffer has no bytes, or its compression is not supported */
    gltf_packing packing;
} gltf_layout;

/* Of numbers; infinite the wrong way round where there is none. */
typedef struct gltf_tile_bounds {
    float least[3], largest[3];
} gltf_tile_bounds;

/* One attribute that is deformed, under one node: a result of 3 components an element, as float whatever the
   accessor's type, rounded to the steps of that. */
typedef struct gltf_stream {
    size_t accessor; /* GLTF_NONE: the part has none */
    float *result;   /* 3 * count; NULL before begin_results, and where a part repeats */
    /* One for each MESH_RANGE_STEP vectors of the result: 0 where nothing has been handed back, and so
       nothing stands in it yet. NULL: all of it stands there. */
    uint8_t *is_there;
    gltf_tile_bounds *bounds; /* of positions, one for each of these tiles; NULL: not known */
} gltf_stream;

typedef struct gltf_skin {
    size_t *joints; /* nodes */
    size_t joint_count;
    int inverse_bind; /* accessor; -1: absent */
    double *matrices; /* 12 a joint: world matrix * inverse bind matrix; NULL until a shown node needs them */
} gltf_skin;

typedef struct gltf_part {
    size_t node;                      /* GLTF_NONE in mesh space */
    const gltf_skin *skin;            /* NULL: none, or not looked at */
    const gltf_influence *influences; /* lent by the model; with a skin */
    size_t influence_count;
    gltf_stream streams[GLTF_DEFORMED];
    uint8_t *selected;  /* the mesh_part's; NULL: see there */
    size_t first_shape; /* document->shapes holds the part's morph targets from here */
} gltf_part;

/* The instances of a node with EXT_mesh_gpu_instancing. */
typedef struct gltf_crowd {
    size_t node;
    size_t translation, rotation, scale; /* accessors; GLTF_NONE: absent */
    uint64_t count;
    ffd_bounds mesh; /* of the mesh in its own space; min > max: no vertices */
    bool everywhere; /* nothing more is known of their places */
    bool idle;       /* not selected */
} gltf_crowd;

/* A primitive under a node that shows it (or by itself, in mesh space). */
typedef struct gltf_instance {
    size_t part[GLTF_DEFORMED]; /* where its attribute is deformed; GLTF_NONE: has none, or cannot be read */
    size_t first_target;        /* its morph targets in document->targets */
    bool selected;              /* false: it shows what it showed before */
} gltf_instance;

/* The instances of a mesh: for each primitive, for each node. */
typedef struct gltf_showing {
    size_t first_instance;
    size_t *nodes;     /* lent by document->shown_nodes; ascending */
    size_t node_count; /* in mesh space 1, nodes is NULL */
    bool is_used;      /* by a node */
    bool hidden_too;   /* some node outside the shown scene uses it, or none at all */
} gltf_showing;

typedef struct gltf_document {
    mesh_document base;
    char *path;       /* "-" for standard input */
    const char *name; /* for messages */
    ffd_space space;
    file_input input;
    int threads; /* for reading and writing */
    bool binary;
    glb_layout glb;
    json_span tree;
    gltf_values buffer_values, view_values, accessor_values, mesh_values, node_values, skin_values,
        material_values, image_values;
    gltf_values primitive_values; /* of all meshes */
    size_t *first_primitive;      /* of a mesh, in them */
    gltf_model model;
    gltf_skin *skins; /* skin_values.count */
    /* What keeps the skins from placing their vertices: such a document can only be described. */
    ffd_status skins_status;
    ffd_error skins_error;
    gltf_buffer *buffers; /* buffer_values.count */
    gltf_layout *layouts; /* model.accessor_count */

    /* What compressed data becomes. */
    unsigned char **decoded_views; /* model.view_count; NULL: not compressed, or not supported */
    gltf_unpacked *unpacked;       /* model.accessor_count */
    char **draco_problems;         /* primitive_values.count; NULL: none */
    uint64_t draco_decoded;        /* points and corners of all decodings */

    double *world;  /* 12 a node: linear row by row, offset */
    bool *is_shown; /* a node */
    size_t *shown_nodes;
    size_t hidden_nodes; /* with a mesh, not shown */
    /* A node below two parents: not valid, but described as if it had the first; GLTF_NONE: none. */
    size_t shared_child, shared_by[2];
    gltf_showing *showings; /* model.mesh_count */
    gltf_instance *instances;
    /* base.part_count, and behind them one for each shape, whose streams are its offsets: results of both go
       the same way. */
    gltf_part *parts;
    mesh_part *mesh_parts;
    mesh_shape *shapes; /* morph targets of all parts, those of a part one behind the other */
    size_t shape_count;
    char *morph_name;     /* results are offsets of a further morph target of this name; NULL: they are not */
    bool morph_normals;   /* of normals and tangents too */
    size_t own_accessors; /* at the end of the list, that the file did not have: zeros without bytes */
    gltf_crowd *crowds;   /* by node */
    size_t crowd_count;
    /* What keeps their places from being known: such a document can only be described. */
    ffd_status crowds_status;
    ffd_error crowds_error;
    size_t *targets; /* of the instances' morph targets: the part that holds the offsets; GLTF_NONE: nothing
                        that is deformed */
} gltf_document;

/* The format's open function, with the room that the document has: another one may be in memory too. */
ffd_status ffd_gltf_open_within(file_input *input, const ffd_source *source, const mesh_room *room,
                                mesh_document **document, ffd_error *error);

/* Gives back the memory of the files' bytes, which are read again when they are needed. */
void ffd_gltf_forget(const gltf_document *document);
/* The same for those of one buffer's bytes [offset, offset + size) that it has. */
void ffd_gltf_forget_bytes(const gltf_document *document, const gltf_buffer *buffer, size_t offset,
                           size_t size);

static inline const gltf_document *ffd_gltf_of(const mesh_document *document)
{
    return (const gltf_document *)document;
}

/* Number of the value of primitive p of mesh m in the JSON. */
uint32_t ffd_gltf_primitive_value(const gltf_document *document, size_t mesh, size_t primitive);
/* value's extension of this name; JSON_NONE: it has none. */
uint32_t ffd_gltf_extension(const gltf_document *document, uint32_t value, const char *extension);
/* Whether value's "extensions" has one of this name. */
bool ffd_gltf_has_extension(const gltf_document *document, uint32_t value, const char *extension);
extern const char *const ffd_gltf_semantic_names[GLTF_DEFORMED];

/* gltf_check.c: validates every index, offset, count and stride of the model, and fills layouts. */
ffd_status ffd_gltf_check(gltf_document *document, ffd_error *error);
/* gltf_views.c: decodes the bufferViews that are compressed. Comes within ffd_gltf_check. What is not
   supported is left out. */
ffd_status ffd_gltf_decode_views(gltf_document *document, ffd_error *error);
/* The meshopt extension of a view; JSON_NONE: it is not compressed. */
uint32_t ffd_gltf_meshopt_value(const gltf_document *document, size_t view);
/* The bytes of a view, decoded; NULL: there are none. */
const unsigned char *ffd_gltf_view_bytes(const gltf_document *document, size_t view);
/* The bytes that a compressed view is stored in; NULL: it is not compressed, or they are not there. */
const unsigned char *ffd_gltf_compressed_bytes(const gltf_document *document, size_t view, size_t *size);
/* Says why a compressed view was left out. */
ffd_status ffd_gltf_refuse_view(const gltf_document *document, size_t view, ffd_error *error);
/* gltf_draco.c: likewise for the primitives that are compressed, of meshes that are checked. */
ffd_status ffd_gltf_decode_draco(gltf_document *document, ffd_error *error);
uint32_t ffd_gltf_draco_value(const gltf_document *document, size_t mesh, size_t primitive);
ffd_status ffd_gltf_refuse_draco(const gltf_document *document, size_t mesh, size_t primitive,
                                 ffd_error *error);
/* gltf_indices.c: refuses indices that are not below their primitive's number of vertices. */
ffd_status ffd_gltf_check_indices(const gltf_document *document, ffd_error *error);
/* gltf_scene.c: which nodes are shown, and their matrices. Refuses cycles and second parents. */
ffd_status ffd_gltf_make_scene(gltf_document *document, ffd_error *error);
/* The node's own matrix, linear row by row and offset. */
void ffd_gltf_local_matrix(const gltf_node *node, double linear[9], double offset[3]);
/* joined (12 numbers) = parent (likewise) * (linear, offset). */
void ffd_gltf_join_matrix(const double parent[12], const double linear[9], const double offset[3],
                          double joined[12]);
/* gltf_skin.c. list: reads the skins. place: gives the skins of shown nodes their matrices, and checks what
   weighs them. */
ffd_status ffd_gltf_list_skins(gltf_document *document, ffd_error *error);
ffd_status ffd_gltf_place_skins(gltf_document *document, ffd_error *error);
void ffd_gltf_free_skins(gltf_document *document);
/* mesh.h's read_transforms. */
mesh_read_function ffd_gltf_read_transforms;
/* gltf_parts.c */
ffd_status ffd_gltf_make_parts(gltf_document *document, ffd_error *error);
/* gltf_shapes.c: the morph targets of the parts. Comes after ffd_gltf_make_parts. */
ffd_status ffd_gltf_make_shapes(gltf_document *document, ffd_error *error);
/* gltf_instancing.c. make: finds the nodes with EXT_mesh_gpu_instancing; nothing of them is selected. Comes
   after ffd_gltf_make_parts. */
ffd_status ffd_gltf_make_crowds(gltf_document *document, ffd_error *error);
/* That of a node; NULL: it shows its mesh once, or not at all. */
gltf_crowd *ffd_gltf_crowd_of(const gltf_document *document, size_t node);
mesh_check_reach_function ffd_gltf_check_reach;
/* Parts and shapes. */
static inline size_t ffd_gltf_part_count(const gltf_document *document)
{
    return document->base.part_count + document->shape_count;
}
/* gltf_refuse.c: valid, but more than can be done. read: what would make the positions wrong or unreadable;
   store: what cannot be written back. */
ffd_status ffd_gltf_refuse_read(const gltf_document *document, ffd_error *error);
ffd_status ffd_gltf_refuse_store(const gltf_document *document, bool normals, bool tangents,
                                 ffd_error *error);

/* Refuses a primitive whose accessor cannot be read. */
ffd_status ffd_gltf_refuse_unreadable(const gltf_document *document, size_t mesh, size_t primitive,
                                      int accessor, ffd_error *error);

/* gltf_faces.c: adds what the primitives of a mesh draw, once. */
void ffd_gltf_count_drawing(const gltf_document *document, size_t mesh, size_t *triangles, size_t *lines,
                            size_t *points);

/* gltf_faces.c: the vertices (0, 1, ..) that a primitive with positions draws, one after the other, for the
   caller to free; NULL after a failure. */
ffd_status ffd_gltf_read_corners(const gltf_document *document, size_t mesh, size_t primitive,
                                 uint32_t **corners, size_t *count, ffd_error *error);

/* gltf_faces.c: the most that it gives of any primitive. */
uint64_t ffd_gltf_most_corners(const gltf_document *document);

/* gltf_faces.c: the vertices of triangle t among a primitive's corners. Every second triangle of a strip is
   turned round (glTF 2.0, 3.7.2.1). */
void ffd_gltf_triangle(int mode, size_t t, const uint32_t *corners, uint32_t triangle[3]);

/* gltf_read.c: elements [first, first + count) of an accessor as double, `components` values of each (the
 * first ones). */
void ffd_gltf_read(const gltf_document *document, size_t accessor, size_t first, size_t count,
                   size_t components, double *values);
/* The bytes of element i of a readable accessor: those of its sparse value, of its bufferView, or zeros. */
const unsigned char *ffd_gltf_element(const gltf_document *document, size_t accessor, size_t i);
/* The first 3 components of an element as results hold them (gltf_stream): floats bit for bit. */
void ffd_gltf_original(const gltf_document *document, size_t accessor, size_t i, float values[3]);
/* Those of elements [first, first + count). */
void ffd_gltf_originals(const gltf_document *document, size_t accessor, size_t first, size_t count,
                        float *values);
/* The number that a component's bytes stand for. */
double ffd_gltf_read_number(const unsigned char *at, int component, bool normalized);
/* Element i of a sparse.indices or index accessor. */
uint32_t ffd_gltf_read_index(const unsigned char *at, int component);
size_t ffd_gltf_component_size(int component);

/* gltf_bounds.c: of so many vectors. */
gltf_tile_bounds ffd_gltf_find_bounds(const float *xyz, size_t count);

/* gltf_results.c */
mesh_begin_results_function ffd_gltf_begin_results;
/* Brings the originals to where nothing has been handed back. */
void ffd_gltf_complete_results(gltf_document *document);
void ffd_gltf_free_result(gltf_stream *stream);
mesh_write_function ffd_gltf_write_positions;
mesh_write_function ffd_gltf_write_normals;
mesh_write_function ffd_gltf_write_tangents;
mesh_write_offsets_function ffd_gltf_write_offsets;

/* gltf_open.c: entries of the table (mesh.h). */
mesh_open_function ffd_gltf_open;
mesh_close_function ffd_gltf_close;
mesh_list_files_function ffd_gltf_list_files;

/* gltf_resources.c: mesh.h's list_images. */
mesh_list_files_function ffd_gltf_list_images;

/* gltf_as_morph.c: mesh.h's keep_base. */
mesh_keep_base_function ffd_gltf_keep_base;

/* gltf_select.c, gltf_save.c, gltf_describe.c, gltf_faces.c, gltf_extract.c, gltf_compare.c: entries of the
   table (mesh.h). */
mesh_select_function ffd_gltf_select;
mesh_save_function ffd_gltf_save;
mesh_model_function ffd_gltf_extract;
mesh_describe_function ffd_gltf_describe;
mesh_faces_function ffd_gltf_faces;
mesh_corner_normals_function ffd_gltf_corner_normals;
mesh_compare_function ffd_gltf_compare;

#endif
