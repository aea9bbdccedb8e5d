/* gltf_bounds.c - edits "min" and "max" of accessors whose content changes. */
#include "base/text/number.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <float.h>
#include <math.h>

/* Bounds in stored numbers: those of normalized integers are the integers (glTF 2.0, 3.6.2.5). */
typedef struct stored_bounds {
    double least[16], largest[16];
} stored_bounds;

static void widen(stored_bounds *bounds, double least, double largest, size_t c)
{
    if (least < bounds->least[c])
        bounds->least[c] = least;
    if (largest > bounds->largest[c])
        bounds->largest[c] = largest;
}

/* Finds the bounds of floats, which are stored unchanged. tiles: the bounds of the tiles, or NULL. */
static stored_bounds find_float_bounds(const float *xyz, size_t count, const gltf_tile_bounds *tiles)
{
    stored_bounds bounds = {{0}, {0}};
    for (size_t c = 0; c < 3 && count > 0; c++)
        bounds.least[c] = bounds.largest[c] = xyz[c];
    for (size_t first = 0; first < count; first += MESH_RANGE_STEP) {
        const size_t rest = count - first, size = rest < MESH_RANGE_STEP ? rest : MESH_RANGE_STEP;
        const gltf_tile_bounds tile =
            tiles ? tiles[first / MESH_RANGE_STEP] : ffd_gltf_find_bounds(xyz + 3 * first, size);
        for (size_t c = 0; c < 3; c++)
            widen(&bounds, tile.least[c], tile.largest[c], c);
    }
    return bounds;
}

/* Returns the bounds of the tiles of a version's values; NULL if unknown. */
static const gltf_tile_bounds *tiles_of(const gltf_document *d, const gltf_version *version)
{
    return d->parts[version->order / GLTF_DEFORMED].streams[version->order % GLTF_DEFORMED].bounds;
}

/* Finds the bounds of a version, or, if version is NULL, of elements that are written decompressed. */
static stored_bounds find_bounds(const gltf_document *d, size_t a, const gltf_version *version,
                                 const unsigned char *elements)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const int component = version ? version->component : accessor->component;
    const size_t size = ffd_gltf_component_size(component);
    const size_t width = version ? ffd_gltf_version_width(d, version) : (size_t)accessor->rows;
    stored_bounds bounds = {{0}, {0}};
    if (version && version->width == 0 && component == GLTF_FLOAT && accessor->rows == 3)
        return find_float_bounds(version->values, (size_t)accessor->count, tiles_of(d, version));
    for (size_t i = 0; i < accessor->count; i++) {
        unsigned char encoded[GLTF_LARGEST_ELEMENT];
        const unsigned char *element = version ? encoded : elements + i * d->layouts[a].stride;
        if (version)
            ffd_gltf_version_encode(d, version, i, encoded);
        for (size_t c = 0; c < width; c++) {
            const double value = ffd_gltf_read_number(element + c * size, component, false);
            if (i == 0 || value < bounds.least[c])
                bounds.least[c] = value;
            if (i == 0 || value > bounds.largest[c])
                bounds.largest[c] = value;
        }
    }
    return bounds;
}

/* Whether the file's number, rounded to the accessor's type, equals the wanted one, or JSON cannot represent
   the wanted one (infinity or NaN from normals of an invalid input). */
static bool is_bound(double number, double wanted, int component)
{
    if (!isfinite(wanted))
        return true;
    const double read = component == GLTF_FLOAT && fabs(number) <= FLT_MAX ? (float)number : number;
    return !(read < wanted) && !(read > wanted);
}

/* Writes a bound of an accessor of zeros that saving adds: 0 where the results do not change it. */
static void write_bound(const char *key, const double bound[3], byte_buffer *text)
{
    ffd_buffer_format(text, ",\"%s\":[", key);
    for (size_t c = 0; c < 3; c++) {
        char number[FFD_NUMBER_CAPACITY];
        const size_t size = ffd_number_format(is_bound(0, bound[c], GLTF_FLOAT) ? 0 : bound[c], number);
        ffd_buffer_text(text, c > 0 ? "," : "");
        ffd_buffer_append(text, number, size);
    }
    ffd_buffer_text(text, "]");
}

void ffd_gltf_write_bounds(const gltf_saver *saver, const gltf_version *version, byte_buffer *text)
{
    const stored_bounds bounds =
        version ? find_bounds(saver->document, version->accessor, version, NULL) : (stored_bounds){{0}, {0}};
    write_bound("min", bounds.least, text);
    write_bound("max", bounds.largest, text);
}

/* Edits the numbers of a "min" or "max" that differ from the stored values. */
static void edit_bound(const gltf_saver *saver, uint32_t array, const double bound[16], int component,
                       json_edits *edits)
{
    const json_tree *tree = &saver->document->tree;
    size_t c = 0;
    for (uint32_t v = ffd_json_tree_first(tree, array); v != JSON_NONE && c < 16;
         v = ffd_json_tree_after(tree, v), c++) {
        double old;
        if (ffd_json_tree_number(tree, v, &old) && is_bound(old, bound[c], component))
            continue;
        char text[FFD_NUMBER_CAPACITY];
        const size_t size = ffd_number_format(bound[c], text);
        ffd_edits_replace(edits, tree->values[v].begin, tree->values[v].end, text, size);
    }
}

static void edit_bounds(const gltf_saver *saver, size_t a, const gltf_version *version,
                        const unsigned char *elements, json_edits *edits)
{
    const gltf_document *d = saver->document;
    const uint32_t accessor = d->accessor_values.values[a];
    const int component = version ? version->component : d->model.accessors[a].component;
    const uint32_t min = ffd_json_tree_member(&d->tree, accessor, "min");
    const uint32_t max = ffd_json_tree_member(&d->tree, accessor, "max");
    if (min == JSON_NONE && max == JSON_NONE)
        return;
    const stored_bounds bounds = find_bounds(d, a, version, elements);
    edit_bound(saver, min, bounds.least, component, edits);
    edit_bound(saver, max, bounds.largest, component, edits);
}

void ffd_gltf_edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits)
{
    edit_bounds(saver, version->accessor, version, NULL, edits);
}

void ffd_gltf_edit_unpacked_bounds(const gltf_saver *saver, const gltf_unpacking *unpacking,
                                   json_edits *edits)
{
    edit_bounds(saver, unpacking->accessor, NULL, unpacking->bytes, edits);
}
