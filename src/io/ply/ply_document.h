/* ply_document.h - a PLY file as a mesh document: one part, in the lattice's space. Declares ply_document.c,
   ply_roles.c, ply_faces.c, ply_splats.c.

   Every row of element vertex is a vertex, in the order of the file; its normal is nx ny nz. Positions and
   normals are held as doubles, with values that their types can hold. Everything else stays in the file's
   bytes and is read again when needed. */
#ifndef FFD_IO_PLY_PLY_DOCUMENT_H
#define FFD_IO_PLY_PLY_DOCUMENT_H

#include "io/ply/ply_walk.h"
#include "io/text/file_document.h"
#include "mesh/splats.h"
#include "splat/harmonics.h"

/* Marks of a splat: whether its numbers change, and whether its harmonics turn and are mirrored. */
enum { PLY_SPLAT_CHANGES = 1, PLY_SPLAT_TURNS = 2, PLY_SPLAT_MIRRORS = 4 };

/* Number of slots of a rotation and its scales. */
#define PLY_ELLIPSOID ((size_t)(PLY_REST_SLOT - PLY_ROTATION_SLOT))

typedef struct ply_document {
    file_document file;
    ply_header header;
    const ply_element *vertex;
    const ply_element *face;             /* NULL: no element of faces */
    const ply_property *face_corners;    /* its list vertex_indices or vertex_index */
    const ply_element *strips;           /* element tristrips; NULL: none */
    const ply_property *strip_corners;   /* its list of vertices; NULL: none */
    const ply_property *face_normals[3]; /* nx ny nz of the faces, if float or double; NULL: none */
    bool has_whole_face_normals;         /* whether they are of an integer type; they are then kept */
    bool renew_normals;                  /* whether face normals are computed anew with the results */
    number_type types[PLY_SLOT_COUNT];   /* by slot */
    /* Binary, without lists: all rows of vertices have the same size and layout. */
    bool has_fixed_rows;
    size_t offsets[PLY_SLOT_COUNT]; /* per slot: the offset of the number in a row; PLY_NOWHERE: absent */
    /* has_whole_normals: nx ny nz of an integer type, which do not count as normals. */
    bool has_normals, has_whole_normals;
    size_t behind;           /* offset after the last row */
    int threads;             /* for writing */
    splat_ellipsoid *splats; /* per vertex, if the part has ellipsoids but no fixed rows; else NULL */
    /* Results of splats, NULL before begin_results: PLY_ELLIPSOID numbers per vertex, in one of the first two
       arrays, depending on their types; and, if there are harmonics, the quaternions to turn them by, which
       saving does. */
    float *float_splats;
    double *double_splats;
    double (*new_turns)[4];
    uint8_t *splat_marks; /* per vertex: PLY_SPLAT_CHANGES and so on */
    size_t rest_count;    /* number of properties f_rest_0 and so on, whether they are turned or not */
    /* Whether the harmonics to turn are little-endian floats of fixed rows, contiguous and in order. */
    bool has_plain_rests;
} ply_document;

#define PLY_NOWHERE SIZE_MAX

/* Returns the bytes of a row of fixed size. */
static inline const char *ply_row(const ply_document *document, size_t vertex)
{
    const size_t begin = document->vertex->begin + vertex * document->vertex->least;
    return (const char *)document->file.input.data + begin;
}

static inline const ply_document *ffd_ply_of(const mesh_document *document)
{
    return (const ply_document *)document;
}

/* Begins a walk at the first row of an element. */
void ffd_ply_document_walk(const ply_document *document, const ply_element *element, ply_walk *walk);
/* Refuses an index that is not the number of a vertex. what, row: "face" or "strip" and its number; word: the
   index, of this type. */
ffd_status ffd_ply_refuse_vertex(const ply_document *document, const ply_walk *walk, const char *what,
                                 uint64_t row, number_type type, text_word word, ffd_error *error);

/* Finds the meanings of the elements and properties. */
ffd_status ffd_ply_find_roles(ply_document *document, ffd_error *error);

/* Pairs of property names that programs use for the texture coordinates of vertices. */
#define PLY_TEXCOORD_NAMES 3
extern const char *const ffd_ply_texcoord_names[PLY_TEXCOORD_NAMES][2];

/* Returns the element whose rows are lines: "edge" with vertex1 and vertex2. NULL if there is none. */
const ply_element *ffd_ply_find_edges(const ply_document *document);

/* Refuses corners of faces that are not vertex numbers. */
ffd_status ffd_ply_check_faces(const ply_document *document, ffd_error *error);

/* Finds the properties of Gaussian splats. */
void ffd_ply_find_splats(ply_document *document);
/* Returns the member of a splat for a slot from PLY_ROTATION_SLOT to before PLY_REST_SLOT. */
double *ffd_ply_splat_number(splat_ellipsoid *splat, size_t slot);
/* Returns the result of such a slot for a marked vertex, rounded to its type. */
static inline double ply_new_splat_number(const ply_document *document, size_t vertex, size_t slot)
{
    const size_t at = PLY_ELLIPSOID * vertex + slot - PLY_ROTATION_SLOT;
    return document->float_splats ? (double)document->float_splats[at] : document->double_splats[at];
}
/* Allocates the results of splats, none of which is changed. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_ply_begin_splats(ply_document *document, const mesh_results *results, ffd_error *error);
/* Returns the turn of a vertex marked PLY_SPLAT_TURNS. */
splat_turn ffd_ply_turn_of(const ply_document *document, size_t vertex);
/* Returns the slot of a coefficient of a channel. */
static inline size_t ply_rest_slot(const ply_document *document, int channel, int coefficient)
{
    const int functions = harmonics_count(document->file.part.form.degree);
    return PLY_REST_SLOT + (size_t)(channel * functions + coefficient);
}
/* Whether the types of a channel's coefficients can hold these; otherwise the channel stays unchanged. */
bool ffd_ply_rests_fit(const ply_document *document, const double coefficients[HARMONICS_MOST], int channel);

/* Functions of the mesh_format. */
mesh_warn_function ffd_ply_warn;
mesh_read_splats_function ffd_ply_read_splats;
mesh_write_splats_function ffd_ply_write_splats;
mesh_open_function ffd_ply_open;
mesh_close_function ffd_ply_close;
mesh_begin_results_function ffd_ply_begin_results;
mesh_write_function ffd_ply_write;
mesh_save_function ffd_ply_save;
mesh_mark_used_function ffd_ply_mark_used;
mesh_faces_function ffd_ply_faces;
mesh_mixed_faces_function ffd_ply_mixed_faces;
mesh_model_function ffd_ply_model;
mesh_describe_function ffd_ply_describe;
mesh_compare_function ffd_ply_compare;

#endif
