#include "job/input/source.h"
#include "base/file/file_set_record.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include "io/format_names.h"
#include "io/formats.h"
#include "mesh/bounds.h"
#include "mesh/linked_files.h"
#include "mesh/morphs.h"
#include <string.h>

/* Positions read per call. */
#define BLOCK 256

const char *ffd_source_name(const ffd_source *source)
{
    return ffd_file_display_name(source->path);
}

hash128 ffd_source_rules(const ffd_source *source)
{
    hash128 rules = ffd_hash(&source->strict, sizeof source->strict);
    for (size_t i = 0; i < source->allow_extension_count; i++) {
        const char *const name = source->allow_extensions[i];
        const hash_block blocks[] = {{rules.bytes, sizeof rules.bytes}, {name, strlen(name)}};
        rules = ffd_hash_blocks(blocks, 2);
    }
    return rules;
}

ffd_status ffd_source_format(const ffd_source *source, ffd_format *format, ffd_error *error)
{
    *format = source->format != FFD_FORMAT_AUTO ? source->format : ffd_format_from_name(source->path);
    if (ffd_format_table(*format))
        return FFD_OK;
    return ffd_format_refuse_name(source->path, error);
}

/* If a run has set the file aside, says so in the message: it is not lost. */
static void mention_set_aside(const char *path, ffd_error *error)
{
    if (error && !ffd_file_is_stream(path) && !ffd_file_exists(path) && ffd_record_exists(path))
        ffd_fail_file(error, error->status, path,
                      "%s (a run that replaces it is at work, or was killed: the next one that writes it "
                      "brings it back)",
                      error->message);
}

ffd_status ffd_source_open_bytes(const ffd_source *source, int threads, file_input *input,
                                 mesh_document **document, ffd_error *error)
{
    ffd_source typed = *source;
    *document = NULL;
    ffd_status status;
    TRY_END(ffd_source_format(source, &typed.format, error));
    typed.threads = source->threads ? source->threads : threads;
    TRY_END(ffd_threads_check(typed.threads, error));
    status = ffd_format_open(ffd_format_table(typed.format), input, &typed, document, error);
    ffd_fail_name_file(status ? error : NULL, ffd_source_name(source));
end:
    if (status)
        ffd_file_unload(input);
    return status;
}

ffd_status ffd_source_open(const ffd_source *source, int threads, mesh_document **document, ffd_error *error)
{
    ffd_format format;
    file_input input;
    *document = NULL;
    TRY(ffd_source_format(source, &format, error));
    const ffd_status status = ffd_file_take(source->path, source->bytes, &input, error);
    if (status && !source->bytes.data)
        mention_set_aside(source->path, error);
    return status ? status : ffd_source_open_bytes(source, threads, &input, document, error);
}

ffd_status ffd_source_files(const ffd_source *source, const mesh_document *document, path_list *files,
                            ffd_error *error)
{
    if (source->bytes.data)
        return FFD_OK;
    if (!ffd_file_is_stream(source->path))
        TRY(ffd_paths_add(files, source->path, error));
    if (document->format->sidecars)
        TRY(document->format->sidecars->list(document, files, error));
    return FFD_OK;
}

bool ffd_source_is_alone(const mesh_document *document)
{
    const mesh_sidecar_calls *const sidecars = document->format->sidecars;
    path_list others = {0};
    if (!sidecars)
        return true;
    const bool is_alone = !sidecars->list(document, &others, NULL) &&
                          !sidecars->list_images(document, &others, NULL) && others.count == 0;
    ffd_paths_free(&others);
    return is_alone;
}

void ffd_source_close(mesh_document **document)
{
    if (*document)
        (*document)->format->close(*document);
    *document = NULL;
}

void ffd_source_positions(const mesh_document *document, mesh_state state, size_t part, size_t first,
                          size_t count, double *xyz)
{
    document->format->read(document, part, MESH_POSITIONS, state, first, count, xyz);
    ffd_part_transform(document, part, first, count, xyz);
}

size_t ffd_source_widen(const mesh_document *document, mesh_state state, size_t part, ffd_bounds *bounds)
{
    const size_t vertices = document->parts[part].vertex_count;
    size_t not_finite = 0;
    double xyz[3 * BLOCK];
    for (size_t first = 0; first < vertices; first += BLOCK) {
        const size_t left = vertices - first, count = left < BLOCK ? left : BLOCK;
        ffd_source_positions(document, state, part, first, count, xyz);
        for (size_t i = 0; i < count; i++)
            if (vec_is_finite(xyz + 3 * i))
                ffd_bounds_widen(bounds, xyz + 3 * i);
            else
                not_finite++;
    }
    return not_finite;
}

/* State of a walk over the positions of a part. */
typedef struct place_walk {
    const mesh_document *document;
    size_t part;
    place_visitor *visit;
    void *context;
} place_walk;

/* Visits those positions, from `first` on, that the offsets of a morph target move; shape NULL: all. */
static bool visit_block(const place_walk *walk, mesh_state state, const size_t *shape, size_t first,
                        size_t count)
{
    const mesh_format *const format = walk->document->format;
    double xyz[3 * BLOCK], offsets[3 * BLOCK];
    format->read(walk->document, walk->part, MESH_POSITIONS, state, first, count, xyz);
    if (shape)
        format->morphs->read_offsets(walk->document, walk->part, *shape, MESH_POSITIONS, first, count,
                                     offsets);
    for (size_t i = 0; i < 3 * count; i++)
        xyz[i] += shape ? offsets[i] : 0;
    ffd_part_transform(walk->document, walk->part, first, count, xyz);
    for (size_t i = 0; i < count; i++) {
        const double *const m = offsets + 3 * i;
        const bool moves = !shape || m[0] != 0 || m[1] != 0 || m[2] != 0;
        if (moves && !walk->visit(walk->context, first + i, xyz + 3 * i))
            return false;
    }
    return true;
}

static bool visit_all(const place_walk *walk, mesh_state state, const size_t *shape)
{
    const size_t vertices = walk->document->parts[walk->part].vertex_count;
    bool goes_on = true;
    for (size_t first = 0; first < vertices && goes_on; first += BLOCK)
        goes_on = visit_block(walk, state, shape, first, vertices - first < BLOCK ? vertices - first : BLOCK);
    return goes_on;
}

bool ffd_source_visit_places(const mesh_document *document, size_t part, place_visitor *visit, void *context)
{
    const mesh_part *const p = &document->parts[part];
    const place_walk walk = {document, part, visit, context};
    bool goes_on = visit_all(&walk, MESH_STORED, NULL);
    for (size_t s = 0; s < p->shape_count && goes_on; s++)
        goes_on = !p->shapes[s].has[MESH_POSITIONS] || visit_all(&walk, MESH_STORED, &s);
    return goes_on && (!p->shows_shapes || visit_all(&walk, MESH_SHOWN, NULL));
}
