/* preview.c - a lattice as a GLB that viewers show: the cages at rest and deformed, as lines and points. It
   is not read again: its numbers are floats, and it has no knots. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "lattice/formats/readers.h"
#include "json/json_text.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Numbers of glTF. */
enum {
    FLOAT = 5126,
    UINT32 = 5125,
    ARRAY_BUFFER = 34962,
    ELEMENT_ARRAY_BUFFER = 34963,
    POINTS = 0,
    LINES = 1
};
#define GLB_MAGIC 0x46546c67u
#define GLB_JSON 0x4e4f534au
#define GLB_BIN 0x004e4942u
#define CHUNK_HEADER 8
/* Bytes that are gathered before they are written. */
#define WRITTEN_AT_ONCE 65536

typedef struct preview {
    const ffd_lattice *lattice;
    size_t states;               /* 1: it moves nothing */
    uint64_t ends;               /* of lines */
    uint64_t state_bytes, bytes; /* the positions of a state; all data */
    unsigned char group[WRITTEN_AT_ONCE];
    size_t filled;
    file_output *output;
    ffd_error *error;
} preview;

static const char *const names[] = {"rest", "deformed"};
static const double colours[][4] = {{0.5, 0.5, 0.5, 1}, {1, 0.45, 0.1, 1}};

/* The number of ends of lines, along all directions. */
static uint64_t count_ends(const ffd_lattice *lattice)
{
    uint64_t ends = 0;
    for (int d = 0; d < 3; d++)
        ends += 2 * (uint64_t)(lattice->count / lattice->size[d]) *
                (lattice->size[d] - (ffd_knots_closed(&lattice->knots[d]) ? 0 : 1));
    return ends;
}

static const double *points_of(const preview *p, size_t state)
{
    return state ? p->lattice->deformed : p->lattice->rest;
}

static ffd_status flush(preview *p)
{
    TRY(ffd_output_write(p->output, p->group, p->filled, p->error));
    p->filled = 0;
    return FFD_OK;
}

static ffd_status write_u32(preview *p, uint32_t number)
{
    if (p->filled + sizeof number > WRITTEN_AT_ONCE)
        TRY(flush(p));
    store_u32(p->group + p->filled, number);
    p->filled += sizeof number;
    return FFD_OK;
}

/* The bounds of the floats that are written. Refuses what a float does not hold. */
static ffd_status find_bounds(const preview *p, size_t state, double low[3], double high[3])
{
    const double *const points = points_of(p, state);
    for (size_t i = 0; i < 3 * p->lattice->count; i++) {
        if (!(fabs(points[i]) <= FLT_MAX))
            return ffd_fail(p->error, FFD_E_UNSUPPORTED,
                            "a .glb holds floats, to 3.4e38; a control point is at %g", points[i]);
        const double value = (float)points[i];
        low[i % 3] = i < 3 || value < low[i % 3] ? value : low[i % 3];
        high[i % 3] = i < 3 || value > high[i % 3] ? value : high[i % 3];
    }
    return FFD_OK;
}

static void add_named(json_text *json, size_t state)
{
    ffd_json_object(json, NULL, true);
    ffd_json_string(json, "name", names[state]);
}

static void add_primitive(const preview *p, size_t state, int mode, json_text *json)
{
    ffd_json_object(json, NULL, true);
    ffd_json_object(json, "attributes", true);
    ffd_json_count(json, "POSITION", state);
    ffd_json_end(json, '}');
    if (mode == LINES)
        ffd_json_count(json, "indices", p->states);
    ffd_json_count(json, "mode", (uint64_t)mode);
    ffd_json_count(json, "material", state);
    ffd_json_end(json, '}');
}

static void add_nodes(const preview *p, json_text *json)
{
    ffd_json_array(json, "nodes", false);
    for (size_t s = 0; s < p->states; s++) {
        add_named(json, s);
        ffd_json_count(json, "mesh", s);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
    ffd_json_array(json, "meshes", false);
    for (size_t s = 0; s < p->states; s++) {
        add_named(json, s);
        ffd_json_array(json, "primitives", true);
        add_primitive(p, s, LINES, json);
        add_primitive(p, s, POINTS, json);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void add_materials(const preview *p, json_text *json)
{
    ffd_json_array(json, "materials", false);
    for (size_t s = 0; s < p->states; s++) {
        add_named(json, s);
        ffd_json_object(json, "pbrMetallicRoughness", true);
        ffd_json_vector(json, "baseColorFactor", colours[s], 4);
        ffd_json_end(json, '}');
        ffd_json_object(json, "extensions", true);
        ffd_json_object(json, "KHR_materials_unlit", true);
        ffd_json_end(json, '}');
        ffd_json_end(json, '}');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static ffd_status add_accessors(const preview *p, json_text *json)
{
    ffd_json_array(json, "accessors", false);
    for (size_t s = 0; s < p->states; s++) {
        double low[3] = {0}, high[3] = {0};
        TRY(find_bounds(p, s, low, high));
        ffd_json_object(json, NULL, true);
        ffd_json_counts(
            json, (json_count[]){{"bufferView", s}, {"componentType", FLOAT}, {"count", p->lattice->count}},
            3);
        ffd_json_string(json, "type", "VEC3");
        ffd_json_vector(json, "min", low, 3);
        ffd_json_vector(json, "max", high, 3);
        ffd_json_end(json, '}');
    }
    ffd_json_object(json, NULL, true);
    ffd_json_counts(
        json, (json_count[]){{"bufferView", p->states}, {"componentType", UINT32}, {"count", p->ends}}, 3);
    ffd_json_string(json, "type", "SCALAR");
    ffd_json_end(json, '}');
    ffd_json_end(json, ']');
    return FFD_OK;
}

static void add_views(const preview *p, json_text *json)
{
    ffd_json_array(json, "bufferViews", false);
    for (size_t v = 0; v <= p->states; v++) {
        const bool is_indices = v == p->states;
        ffd_json_object(json, NULL, true);
        ffd_json_counts(json,
                        (json_count[]){{"buffer", 0},
                                       {"byteOffset", v * p->state_bytes},
                                       {"byteLength", is_indices ? 4 * p->ends : p->state_bytes},
                                       {"target", is_indices ? ELEMENT_ARRAY_BUFFER : ARRAY_BUFFER}},
                        4);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
    ffd_json_array(json, "buffers", true);
    ffd_json_object(json, NULL, true);
    ffd_json_count(json, "byteLength", p->bytes);
    ffd_json_end(json, '}');
    ffd_json_end(json, ']');
}

static ffd_status make_json(const preview *p, byte_buffer *text)
{
    json_text json;
    const double nodes[] = {0, 1};
    ffd_json_begin(&json, text);
    ffd_json_object(&json, NULL, false);
    ffd_json_object(&json, "asset", true);
    ffd_json_string(&json, "version", "2.0");
    ffd_json_string(&json, "generator", "ffd");
    ffd_json_end(&json, '}');
    ffd_json_array(&json, "extensionsUsed", true);
    ffd_json_string(&json, NULL, "KHR_materials_unlit");
    ffd_json_end(&json, ']');
    ffd_json_count(&json, "scene", 0);
    ffd_json_array(&json, "scenes", true);
    ffd_json_object(&json, NULL, true);
    ffd_json_vector(&json, "nodes", nodes, p->states);
    ffd_json_end(&json, '}');
    ffd_json_end(&json, ']');
    add_nodes(p, &json);
    add_materials(p, &json);
    TRY(add_accessors(p, &json));
    add_views(p, &json);
    ffd_json_end(&json, '}');
    while (text->size % 4 != 0)
        ffd_buffer_text(text, " ");
    return text->failed ? ffd_fail_memory(p->error) : FFD_OK;
}

static ffd_status write_positions(preview *p, size_t state)
{
    const double *const points = points_of(p, state);
    for (size_t i = 0; i < 3 * p->lattice->count; i++) {
        const float value = (float)points[i];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        TRY(write_u32(p, bits));
    }
    return FFD_OK;
}

static ffd_status write_lines(preview *p)
{
    const size_t *const n = p->lattice->size;
    for (int d = 0; d < 3; d++) {
        const size_t stride = d == 0 ? 1 : d == 1 ? n[0] : n[0] * n[1];
        const bool is_closed = ffd_knots_closed(&p->lattice->knots[d]);
        for (size_t i = 0; i < p->lattice->count; i++) {
            const bool is_last = i / stride % n[d] == n[d] - 1;
            if (is_last && !is_closed)
                continue;
            TRY(write_u32(p, (uint32_t)i));
            TRY(write_u32(p, (uint32_t)(is_last ? i - (n[d] - 1) * stride : i + stride)));
        }
    }
    return FFD_OK;
}

static ffd_status write_chunks(preview *p, const byte_buffer *text)
{
    TRY(write_u32(p, GLB_MAGIC));
    TRY(write_u32(p, 2));
    TRY(write_u32(p, (uint32_t)(12 + CHUNK_HEADER + text->size + CHUNK_HEADER + p->bytes)));
    TRY(write_u32(p, (uint32_t)text->size));
    TRY(write_u32(p, GLB_JSON));
    TRY(flush(p));
    TRY(ffd_output_write(p->output, text->data, text->size, p->error));
    TRY(write_u32(p, (uint32_t)p->bytes));
    TRY(write_u32(p, GLB_BIN));
    for (size_t s = 0; s < p->states; s++)
        TRY(write_positions(p, s));
    TRY(write_lines(p));
    return flush(p);
}

ffd_status ffd_lattice_write_preview(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    byte_buffer text = {0};
    preview *const p = ffd_alloc(1, sizeof *p);
    ffd_status status;
    if (!p)
        return ffd_fail_memory(error);
    *p = (preview){.lattice = lattice,
                   .states = ffd_lattice_is_still(lattice) ? 1 : 2,
                   .ends = count_ends(lattice),
                   .state_bytes = 12 * (uint64_t)lattice->count,
                   .output = output,
                   .error = error};
    p->bytes = p->states * p->state_bytes + 4 * p->ends;
    TRY_END(p->bytes < UINT32_MAX - 65536
                ? FFD_OK
                : ffd_fail(error, FFD_E_LIMIT,
                           "a .glb has at most 4 GB, which is not enough for these control points"));
    TRY_END(make_json(p, &text));
    TRY_END(write_chunks(p, &text));
end:
    ffd_buffer_free(&text);
    ffd_free(p);
    return status;
}
