#include "job/input/weights.h"
#include "base/arithmetic.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include "io/npy/npy.h"
#include "job/input/source.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The words before a name, in the order of weight_kind. */
static const char *const words[] = {"attribute", "color", "joint", "property"};
enum { WORDS = sizeof words / sizeof *words };

static const char channels[] = "rgba";

/* Fails with what a source may be. */
static ffd_status refuse(const char *text, const char *why, ffd_error *error)
{
    char shown[100];
    ffd_name_shown(text, shown, sizeof shown);
    return ffd_fail(
        error, FFD_E_ARGUMENT,
        "{weight}: \"%s\" %s (FILE.npy, attribute:NAME, color:r|g|b|a, joint:NAME or property:NAME, "
        "perhaps after 1-)",
        shown, why);
}

ffd_status ffd_weight_source_parse(const char *text, weight_source *source, ffd_error *error)
{
    *source = (weight_source){.is_inverted = strncmp(text, "1-", 2) == 0};
    const char *const rest = text + (source->is_inverted ? 2 : 0);
    const size_t length = strcspn(rest, ":");
    int kind = 0;
    while (kind < WORDS &&
           !(rest[length] && strlen(words[kind]) == length && strncmp(rest, words[kind], length) == 0))
        kind++;
    source->kind = kind < WORDS ? (weight_kind)kind : WEIGHT_FILE;
    source->name = kind < WORDS ? rest + length + 1 : rest;
    if (source->kind == WEIGHT_FILE && !ffd_path_has_ending(rest, ".npy"))
        return refuse(text, "is no source of weights", error);
    if (!*source->name)
        return refuse(text, "names nothing", error);
    if (source->kind != WEIGHT_COLOR)
        return FFD_OK;
    const char *const channel = strchr(channels, *source->name);
    if (!channel || source->name[1])
        return refuse(text, "names no channel", error);
    source->channel = (int)(channel - channels);
    return FFD_OK;
}

ffd_status ffd_weight_check(const char *text, ffd_error *error)
{
    weight_source source;
    return ffd_weight_source_parse(text, &source, error);
}

const char *ffd_weight_file(const char *text)
{
    weight_source source;
    return !ffd_weight_source_parse(text, &source, NULL) && source.kind == WEIGHT_FILE ? source.name : NULL;
}

/* Reads the weights as they are. */
static ffd_status read(const weight_source *source, ffd_bytes bytes, const mesh_document *document,
                       const char *name, vertex_weights *weights, ffd_error *error)
{
    const mesh_weight_calls *const calls = document->format->weights;
    if (source->kind == WEIGHT_FILE)
        return ffd_npy_read_column(source->name, bytes, weights->count, weights->values, error);
    if (!calls || !(calls->kinds & WEIGHT_BIT(source->kind)))
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "{weight}: vertices of %s have no weights by \"%s:\": a FILE.npy may have them",
                             document->format->name, words[source->kind]);
    return calls->read(document, source, weights->values, error);
}

/* Vertices that are settled at a time. */
#define TILE ((size_t)1 << 14)

/* Figures of a tile. */
typedef struct tile_figures {
    ffd_weight_figures figures;
    uint64_t count; /* of selected vertices */
    double sum, least, most;
    size_t wrong; /* the first vertex of the part whose weight is not finite; SIZE_MAX: none */
} tile_figures;

/* A part whose weights are settled. */
typedef struct settle_work {
    const mesh_part *part;
    bool is_inverted;
    double *values; /* of the part's vertices */
    tile_figures *tiles;
} settle_work;

/* Clamps the weight of a vertex, inverts it if that is asked for, and counts it. */
static double settle(double read, bool is_inverted, ffd_weight_figures *figures)
{
    const double clamped = read > 0 ? lesser_of(read, 1) : 0;
    const double weight = is_inverted ? 1 - clamped : clamped;
    figures->clamped += (clamped < read) | (clamped > read);
    figures->zero += weight == 0;
    figures->one += weight == 1;
    return weight;
}

static void settle_tile(void *context, size_t index, size_t first, size_t last, int worker)
{
    const settle_work *const work = context;
    tile_figures tile = {.least = 1, .wrong = SIZE_MAX};
    (void)worker;
    for (size_t i = first; i < last; i++) {
        double *const value = &work->values[i];
        if (!ffd_part_selects(work->part, i)) {
            *value = (double)NAN;
            continue;
        }
        if (!isfinite(*value)) {
            tile.wrong = i;
            break;
        }
        *value = settle(*value, work->is_inverted, &tile.figures);
        tile.sum += *value;
        tile.least = lesser_of(tile.least, *value);
        tile.most = larger_of(tile.most, *value);
        tile.count++;
    }
    work->tiles[index] = tile;
}

/* Adds the figures of a tile to those of all. */
static void join_tile(const tile_figures *tile, tile_figures *all)
{
    all->figures.zero += tile->figures.zero;
    all->figures.one += tile->figures.one;
    all->figures.clamped += tile->figures.clamped;
    all->count += tile->count;
    all->sum += tile->sum;
    all->least = lesser_of(all->least, tile->least);
    all->most = larger_of(all->most, tile->most);
}

/* Settles the weights of a part. file: names what they are read from. */
static ffd_status settle_part(const mesh_part *part, const char *file, size_t first, bool is_inverted,
                              int threads, vertex_weights *weights, tile_figures *all, ffd_error *error)
{
    const size_t tiles = part->vertex_count / TILE + (part->vertex_count % TILE != 0);
    settle_work work = {part, is_inverted, weights->values + first, ffd_alloc(tiles, sizeof *work.tiles)};
    if (!work.tiles)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(part->vertex_count, TILE, threads, settle_tile, &work);
    ffd_status status = FFD_OK;
    for (size_t t = 0; t < tiles && !status; t++) {
        const size_t wrong = work.tiles[t].wrong;
        if (wrong != SIZE_MAX)
            status = ffd_fail_file(error, FFD_E_INVALID, file,
                                   "{weight}: that of vertex %zu (counted from 0) is %g, which is no weight",
                                   first + wrong, work.values[wrong]);
        join_tile(&work.tiles[t], all);
    }
    ffd_free(work.tiles);
    return status;
}

static ffd_status settle_all(const weight_source *source, const mesh_document *document, const char *name,
                             int threads, vertex_weights *weights, ffd_error *error)
{
    const char *const file = source->kind == WEIGHT_FILE ? source->name : name;
    tile_figures all = {.least = 1};
    for (size_t i = 0; i < document->part_count; i++) {
        TRY(ffd_deadline_check(error));
        if (!document->parts[i].repeats_positions)
            TRY(settle_part(&document->parts[i], file, weights->first[i], source->is_inverted, threads,
                            weights, &all, error));
    }
    weights->figures = all.figures;
    weights->figures.is_there = true;
    weights->figures.mean = all.sum / (double)all.count;
    weights->differ = all.least < all.most;
    return FFD_OK;
}

static void warn(const ffd_weight_figures *figures, const mesh_log *log)
{
    if (figures->clamped)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "{weight}: %" PRIu64 " %s below 0 or above 1 and %s clamped to 0 or 1", figures->clamped,
                     ffd_plural(figures->clamped, "weight is", "weights are"),
                     ffd_plural(figures->clamped, "is", "are"));
}

ffd_status ffd_vertex_weights_load(const ffd_weight_source *given, mesh_document *document, const char *name,
                                   int threads, const mesh_log *log, vertex_weights *weights,
                                   ffd_error *error)
{
    weight_source source;
    TRY(ffd_weight_source_parse(given->source, &source, error));
    weights->count = (size_t)ffd_mesh_vertex_count(document);
    TRY(ffd_budget_take(&document->budget, weights->count, sizeof *weights->values, error));
    weights->values = ffd_alloc_whole(weights->count, sizeof *weights->values);
    if (!weights->values)
        return ffd_fail_memory(error);
    TRY(ffd_first_vertices(document, &weights->first, error));
    TRY(read(&source, given->bytes, document, name, weights, error));
    TRY(settle_all(&source, document, name, threads, weights, error));
    warn(&weights->figures, log);
    return FFD_OK;
}

void ffd_vertex_weights_free(vertex_weights *weights)
{
    ffd_free(weights->values);
    ffd_free(weights->first);
    ffd_free(weights->slopes[MESH_STORED].sums);
    ffd_free(weights->slopes[MESH_SHOWN].sums);
    ffd_free(weights->splits);
    *weights = (vertex_weights){0};
}
