/* packed_glb.c - writes a GLB with a large compressed sheet of squares, to show how much memory a few bytes
   can ask for: packed_glb edgebreaker|sequential|meshopt|meshopt-0 SIDE FILE (meshopt-0: indices in version
   0) */
#include "draco_sample.h"
#include "sheet.h"
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct sheet {
    size_t points, corners;
    float *positions;
    uint32_t *triangles;
} sheet;

/* The binary data of a file. */
typedef struct packed {
    unsigned char *bytes;
    size_t size, first; /* first: size of the positions; the rest is indices */
} packed;

static void make_sheet(uint32_t side, sheet *s)
{
    s->points = (size_t)side * side;
    s->corners = (size_t)6 * (side - 1) * (side - 1);
    s->positions = malloc(s->points * 3 * sizeof(float));
    s->triangles = malloc(s->corners * sizeof(uint32_t));
    if (!s->positions || !s->triangles)
        exit(1);
    for (size_t i = 0; i < s->points; i++) {
        s->positions[3 * i] = (float)(i % side);
        s->positions[3 * i + 1] = (float)(i / side);
        s->positions[3 * i + 2] = (float)((i % side) * (i / side) % 7);
    }
    sheet_triangles(side, s->triangles);
}

static packed pack_draco(const sheet *s, bool edgebreaker)
{
    const sample_options options = {.edgebreaker = edgebreaker, .bits = 10};
    const sample_mesh mesh = {.point_count = s->points,
                              .triangle_count = s->corners / 3,
                              .positions = s->positions,
                              .triangles = s->triangles};
    packed p = {0};
    p.bytes = make_draco(&mesh, &options, &p.size);
    return p;
}

static packed pack_meshopt(const sheet *s, int index_version)
{
    const size_t points = meshopt_encodeVertexBufferBound(s->points, 12);
    const size_t corners = meshopt_encodeIndexBufferBound(s->corners, s->points);
    packed p = {.bytes = malloc(points + corners)};
    if (!p.bytes)
        exit(1);
    p.first = meshopt_encodeVertexBuffer(p.bytes, points, s->positions, s->points, 12);
    meshopt_encodeIndexVersion(index_version);
    p.size = p.first + meshopt_encodeIndexBuffer(p.bytes + p.first, corners, s->triangles, s->corners);
    return p;
}

static int write_json(char *json, size_t room, const sheet *s, const packed *p)
{
    const char *draco = p->first ? ""
                                 : "\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
                                   "\"attributes\":{\"POSITION\":3}}},";
    const char *name = p->first ? "EXT_meshopt_compression" : "KHR_draco_mesh_compression";
    char views[600];
    if (p->first)
        snprintf(
            views, sizeof views,
            "{\"buffer\":1,\"byteLength\":%zu,\"byteStride\":12,\"extensions\":{\"%s\":{\"buffer\":0,"
            "\"byteLength\":%zu,\"byteStride\":12,\"count\":%zu,\"mode\":\"ATTRIBUTES\"}}},"
            "{\"buffer\":1,\"byteOffset\":%zu,\"byteLength\":%zu,\"extensions\":{\"%s\":{\"buffer\":0,"
            "\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":4,\"count\":%zu,\"mode\":\"TRIANGLES\"}}}",
            12 * s->points, name, p->first, s->points, 12 * s->points, 4 * s->corners, name, p->first,
            p->size - p->first, s->corners);
    else
        snprintf(views, sizeof views, "{\"buffer\":0,\"byteLength\":%zu}", p->size);
    char more[100] = "";
    if (p->first)
        snprintf(more, sizeof more, ",{\"byteLength\":%zu}", 12 * s->points + 4 * s->corners);
    return snprintf(
        json, room,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"%s\"],\"extensionsRequired\":[\"%s\"],"
        "\"buffers\":[{\"byteLength\":%zu}%s],\"bufferViews\":[%s],"
        "\"accessors\":[{%s\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\",\"min\":[0,0,0],"
        "\"max\":[%zu,%zu,6]},{%s\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{%s\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}",
        name, name, p->size, more, views, p->first ? "\"bufferView\":0," : "", s->points, s->points,
        s->points, p->first ? "\"bufferView\":1," : "", s->corners, draco);
}

static void put(FILE *file, size_t number)
{
    for (int i = 0; i < 4; i++)
        fputc((int)(number >> 8 * i & 255), file);
}

static int write_glb(const char *path, const sheet *s, const packed *p)
{
    char json[2000];
    const size_t length = (size_t)write_json(json, sizeof json, s, p);
    const size_t spaces = (4 - length % 4) % 4, zeros = (4 - p->size % 4) % 4;
    FILE *file = fopen(path, "wb");
    if (!file)
        return 1;
    fputs("glTF", file);
    put(file, 2);
    put(file, 28 + length + spaces + p->size + zeros);
    put(file, length + spaces);
    fputs("JSON", file);
    fprintf(file, "%s%*s", json, (int)spaces, "");
    put(file, p->size + zeros);
    fwrite("BIN", 1, 4, file);
    fwrite(p->bytes, 1, p->size, file);
    for (size_t i = 0; i < zeros; i++)
        fputc(0, file);
    return fclose(file) != 0;
}

int main(int count, char **arguments)
{
    if (count != 4)
        return 2;
    sheet s;
    make_sheet((uint32_t)strtoul(arguments[2], NULL, 10), &s);
    const packed p = strncmp(arguments[1], "meshopt", 7) == 0
                         ? pack_meshopt(&s, strcmp(arguments[1], "meshopt-0") != 0)
                         : pack_draco(&s, strcmp(arguments[1], "edgebreaker") == 0);
    return p.bytes ? write_glb(arguments[3], &s, &p) : 1;
}
