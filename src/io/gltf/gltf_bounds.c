#include "base/number.h"
#include "base/thread.h"
#include "io/gltf/gltf_encode.h"
#include "io/gltf/gltf_saver.h"
#include <float.h>
#include <math.h>

/* Bounds are numbers as they are stored: of normalized integers too, the integers (glTF 2.0, 3.6.2.5). */
typedef struct stored_bounds {
    double least[4], largest[4];
} stored_bounds;

/* Threads share that many tiles at most, of that many vectors at least. */
#define TILES 64
#define SMALLEST_TILE ((size_t)1 << 14)

typedef struct bounds_search {
    const float *xyz;
    stored_bounds tiles[TILES];
} bounds_search;

static void widen(stored_bounds *bounds, double least, double largest, size_t c)
{
    if (least < bounds->least[c])
        bounds->least[c] = least;
    if (largest > bounds->largest[c])
        bounds->largest[c] = largest;
}

static stored_bounds bounds_of_first(const float *xyz)
{
    stored_bounds bounds = {{0}, {0}};
    for (size_t c = 0; c < 3; c++)
        bounds.least[c] = bounds.largest[c] = xyz[c];
    return bounds;
}

/* So many vectors at a time, of which compilers make vectors of their own. */
#define GROUP 4

static void search_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    bounds_search *search = context;
    /* From the first vector of all on, as if there were one tile. */
    stored_bounds bounds = bounds_of_first(search->xyz);
    float least[3 * GROUP], largest[3 * GROUP];
    (void)worker;
    for (size_t k = 0; k < 3 * GROUP; k++)
        least[k] = largest[k] = search->xyz[k % 3];
    for (; last - first >= GROUP; first += GROUP)
        for (size_t k = 0; k < 3 * GROUP; k++) {
            const float value = search->xyz[3 * first + k];
            least[k] = value < least[k] ? value : least[k];
            largest[k] = value > largest[k] ? value : largest[k];
        }
    for (size_t k = 0; k < 3 * GROUP; k++)
        widen(&bounds, least[k], largest[k], k % 3);
    for (size_t k = 3 * first; k < 3 * last; k++)
        widen(&bounds, search->xyz[k], search->xyz[k], k % 3);
    search->tiles[tile] = bounds;
}

/* Floats go to the file as they are. */
static stored_bounds find_float_bounds(const float *xyz, size_t count, int threads)
{
    const size_t share = count / TILES + 1, size = share > SMALLEST_TILE ? share : SMALLEST_TILE;
    bounds_search search = {.xyz = xyz};
    if (count == 0)
        return search.tiles[0];
    ffd_parallel_tiles(count, size, threads, search_tile, &search);
    stored_bounds bounds = search.tiles[0];
    for (size_t t = 1; t < count / size + (count % size != 0); t++)
        for (size_t c = 0; c < 3; c++)
            widen(&bounds, search.tiles[t].least[c], search.tiles[t].largest[c], c);
    return bounds;
}

/* version NULL: those of the original content. */
static stored_bounds find_bounds(const gltf_document *d, size_t a, const gltf_version *version)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const int component = version ? version->component : accessor->component;
    const size_t size = ffd_gltf_component_size(component);
    stored_bounds bounds = {{0}, {0}};
    if (version && component == GLTF_FLOAT && accessor->rows == 3)
        return find_float_bounds(version->values, (size_t)accessor->count, d->threads);
    for (size_t i = 0; i < accessor->count; i++) {
        unsigned char encoded[GLTF_LARGEST_VECTOR];
        const unsigned char *element = ffd_gltf_element(d, a, i);
        if (version) {
            ffd_gltf_encode(accessor, component, element, version->values + 3 * i, encoded);
            element = encoded;
        }
        for (size_t c = 0; c < (size_t)accessor->rows; c++) {
            const double value = ffd_gltf_read_number(element + c * size, component, false);
            if (i == 0 || value < bounds.least[c])
                bounds.least[c] = value;
            if (i == 0 || value > bounds.largest[c])
                bounds.largest[c] = value;
        }
    }
    return bounds;
}

/* Whether the file's number, read in the accessor's type, is the wanted one, or the wanted one is none that
   JSON can hold (a normal or tangent of an input that is not valid). */
static bool says(double number, double wanted, int component)
{
    if (!isfinite(wanted))
        return true;
    const double read = component == GLTF_FLOAT && fabs(number) <= FLT_MAX ? (float)number : number;
    return !(read < wanted) && !(read > wanted);
}

/* Writes the least or largest stored values into a "min" or "max", where they are not what it says. */
static void edit_bound(const gltf_saver *saver, uint32_t array, const double bound[4], int component,
                       json_edits *edits)
{
    const json_span *tree = &saver->document->tree;
    size_t c = 0;
    for (uint32_t v = ffd_json_span_first(tree, array); v != JSON_NONE && c < 4;
         v = ffd_json_span_after(tree, v), c++) {
        double old;
        if (ffd_json_span_number(tree, v, &old) && says(old, bound[c], component))
            continue;
        char text[FFD_NUMBER_CAPACITY];
        const size_t size = ffd_number_format(bound[c], text);
        ffd_edits_replace(edits, tree->values[v].begin, tree->values[v].end, text, size);
    }
}

static void edit_bounds(const gltf_saver *saver, size_t a, const gltf_version *version, json_edits *edits)
{
    const gltf_document *d = saver->document;
    const uint32_t accessor = d->accessor_values.values[a];
    const int component = version ? version->component : d->model.accessors[a].component;
    const uint32_t min = ffd_json_span_member(&d->tree, accessor, "min");
    const uint32_t max = ffd_json_span_member(&d->tree, accessor, "max");
    if (min == JSON_NONE && max == JSON_NONE)
        return;
    const stored_bounds bounds = find_bounds(d, a, version);
    edit_bound(saver, min, bounds.least, component, edits);
    edit_bound(saver, max, bounds.largest, component, edits);
}

void ffd_gltf_edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits)
{
    edit_bounds(saver, version->accessor, version, edits);
}

void ffd_gltf_edit_original_bounds(const gltf_saver *saver, size_t accessor, json_edits *edits)
{
    edit_bounds(saver, accessor, NULL, edits);
}
