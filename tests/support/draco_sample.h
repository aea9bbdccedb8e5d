/* draco_sample.h - meshes compressed with the Draco library, for tests. */
#ifndef FFD_TESTS_DRACO_SAMPLE_H
#define FFD_TESTS_DRACO_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Ids of a sample's attributes, if its mesh has them. */
enum {
    SAMPLE_POSITION = 3,
    SAMPLE_NORMAL = 7,
    SAMPLE_JOINTS = 300,
    SAMPLE_FACTOR = 8,
    SAMPLE_TEXCOORD = 9,
    SAMPLE_WEIGHTS = 10,
    SAMPLE_TANGENT = 11
};

typedef struct sample_mesh {
    size_t point_count, triangle_count;
    const float *positions;    /* 3 a point */
    const float *normals;      /* 3 a point, or NULL */
    const float *texcoords;    /* 2 a point, or NULL */
    const uint16_t *joints;    /* 4 a point, or NULL */
    const uint8_t *factors;    /* 1 a point, normalized, or NULL */
    const uint32_t *triangles; /* 3 each */
    const float *weights;      /* 4 a point, or NULL */
    const float *tangents;     /* 4 a point, or NULL */
} sample_mesh;

typedef struct sample_options {
    bool edgebreaker; /* else the sequential method, which keeps the order of points and triangles */
    int bits;         /* of quantization; 0: floats are not quantized */
    bool metadata;    /* add some metadata */
    bool as_points;   /* encode a point cloud instead of a mesh */
} sample_options;

/* Compresses a mesh. Returns NULL if the library fails. Free the bytes with free(). */
unsigned char *make_draco(const sample_mesh *mesh, const sample_options *options, size_t *size);

/* Computes the unit vector at a place of the unfolded octahedron with the library's own header. */
void unfold_as_draco(int bits, const int32_t place[2], float normal[3]);

#ifdef __cplusplus
}
#endif

#endif
