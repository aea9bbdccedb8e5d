/* gltf_content.c - makes and writes the new bytes of the buffers. */
#include "base/little_endian.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/base64.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static size_t buffer_of(const gltf_document *d, size_t accessor)
{
    return (size_t)d->model.views[d->model.accessors[accessor].view].buffer;
}

size_t ffd_gltf_append_buffer(const gltf_document *d, size_t accessor)
{
    if (accessor != GLTF_NONE && d->model.accessors[accessor].view >= 0 &&
        d->buffers[buffer_of(d, accessor)].kind != BUFFER_EMPTY)
        return buffer_of(d, accessor);
    size_t b = 0;
    while (b < d->buffer_values.count && d->buffers[b].kind == BUFFER_EMPTY)
        b++;
    return b;
}

/* Where the elements of an accessor that is overwritten in place lie in the output. */
typedef struct new_location {
    size_t buffer, begin;
} new_location;

static new_location location_of(const gltf_saver *saver, size_t a)
{
    const gltf_document *d = saver->document;
    const gltf_layout *layout = &d->layouts[a];
    const int view = d->model.accessors[a].view;
    const gltf_unpacking *u;
    switch (layout->packing) {
    case GLTF_MESHOPT:
        u = &saver->unpackings[saver->view_unpackings[view]];
        return (new_location){u->buffer, u->offset + (layout->begin - (size_t)d->model.views[view].offset)};
    case GLTF_DRACO:
        u = &saver->unpackings[saver->accessor_unpackings[a]];
        return (new_location){u->buffer, u->offset};
    default:
        return (new_location){buffer_of(d, a), layout->begin};
    }
}

static bool needs_buffer(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    if (d->edit->bytes.size > 0 && ffd_gltf_added_buffer(d) == d->buffer_values.count)
        return true;
    for (size_t i = 0; i < saver->plan.appended_count; i++)
        if (ffd_gltf_append_buffer(d, saver->plan.versions[saver->plan.appended[i]].accessor) ==
            d->buffer_values.count)
            return true;
    return false;
}

/* Only the first buffer of a GLB can be its BIN chunk; any other one has a URI. */
static gltf_buffer_kind kind_of_added(const gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    return saver->binary && d->buffer_values.count == 0 && !d->glb.has_bin ? BUFFER_BIN : BUFFER_DATA;
}

static ffd_status make_buffers(gltf_saver *saver, ffd_error *error)
{
    static const gltf_buffer nothing = {.kind = BUFFER_EMPTY};
    const gltf_document *d = saver->document;
    saver->buffer_count = d->buffer_values.count + needs_buffer(saver);
    saver->buffers = ffd_alloc_zero(saver->buffer_count, sizeof *saver->buffers);
    if (!saver->buffers)
        return ffd_fail_memory(error);
    for (size_t b = 0; b < saver->buffer_count; b++)
        saver->buffers[b].old = b < d->buffer_values.count ? &d->buffers[b] : &nothing;
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (saver->plan.in_place[a] != GLTF_NONE)
            saver->buffers[location_of(saver, a).buffer].overwrite_count++;
    for (size_t i = 0; i < saver->plan.appended_count; i++)
        saver->buffers[ffd_gltf_append_buffer(d, saver->plan.versions[saver->plan.appended[i]].accessor)]
            .append_count++;
    for (size_t i = 0; i < saver->unpacking_count; i++)
        saver->buffers[saver->unpackings[i].buffer].append_count++;
    if (d->edit->bytes.size > 0)
        saver->buffers[ffd_gltf_added_buffer(d)].append_count++;
    for (size_t b = 0; b < saver->buffer_count; b++) {
        gltf_new_buffer *buffer = &saver->buffers[b];
        buffer->length = buffer->old->length;
        buffer->changed = buffer->overwrite_count + buffer->append_count > 0;
        buffer->kind = b < d->buffer_values.count ? buffer->old->kind : kind_of_added(saver);
        buffer->overwrites = ffd_alloc(buffer->overwrite_count, sizeof *buffer->overwrites);
        buffer->appends = ffd_alloc(buffer->append_count, sizeof *buffer->appends);
        if (!buffer->overwrites || !buffer->appends)
            return ffd_fail_memory(error);
        buffer->overwrite_count = buffer->append_count = 0;
    }
    return FFD_OK;
}

static int compare_overwrites(const void *a, const void *b)
{
    const gltf_overwrite *x = a, *y = b;
    return (x->begin > y->begin) - (x->begin < y->begin);
}

static void list_overwrites(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t a = 0; a < d->model.accessor_count; a++) {
        const size_t version = saver->plan.in_place[a];
        if (version == GLTF_NONE)
            continue;
        const gltf_layout *layout = &d->layouts[a];
        const size_t count = (size_t)d->model.accessors[a].count;
        const new_location location = location_of(saver, a);
        gltf_new_buffer *buffer = &saver->buffers[location.buffer];
        buffer->overwrites[buffer->overwrite_count++] =
            (gltf_overwrite){.accessor = a,
                             .begin = location.begin,
                             .end = location.begin + (count - 1) * layout->stride + layout->element_size,
                             .stride = layout->stride,
                             .version = &saver->plan.versions[version]};
    }
    for (size_t b = 0; b < saver->buffer_count; b++) {
        gltf_new_buffer *buffer = &saver->buffers[b];
        if (buffer->overwrite_count > 0)
            qsort(buffer->overwrites, buffer->overwrite_count, sizeof *buffer->overwrites,
                  compare_overwrites);
        size_t end = 0;
        for (size_t i = 0; i < buffer->overwrite_count; i++) {
            end = buffer->overwrites[i].end > end ? buffer->overwrites[i].end : end;
            buffer->overwrites[i].end_so_far = end;
        }
    }
}

static size_t element_size(const gltf_document *d, const gltf_version *version)
{
    return ffd_gltf_version_width(d, version) * ffd_gltf_component_size(version->component);
}

static ffd_status add_append(const gltf_saver *saver, size_t b, gltf_append append, ffd_error *error)
{
    gltf_new_buffer *buffer = &saver->buffers[b];
    const uint64_t offset = ffd_gltf_align(buffer->length);
    if (append.size > GLTF_LARGEST_SIZE || offset > GLTF_LARGEST_SIZE - append.size)
        return ffd_fail_file(error, FFD_E_LIMIT, saver->options->path,
                             "a buffer would have more than %zu bytes", GLTF_LARGEST_SIZE);
    append.offset = (size_t)offset;
    buffer->appends[buffer->append_count++] = append;
    buffer->length = append.offset + append.size;
    return FFD_OK;
}

/* Before all others: accessors of the edit name its offset. */
static ffd_status list_added(const gltf_saver *saver, ffd_error *error)
{
    const gltf_document *const d = saver->document;
    const byte_buffer *const added = &d->edit->bytes;
    const gltf_append append = {
        .size = added->size, .version = GLTF_NONE, .bytes = (unsigned char *)added->data};
    return added->size > 0 ? add_append(saver, ffd_gltf_added_buffer(d), append, error) : FFD_OK;
}

static ffd_status list_unpacked(gltf_saver *saver, ffd_error *error)
{
    for (size_t i = 0; i < saver->unpacking_count; i++) {
        gltf_unpacking *u = &saver->unpackings[i];
        const gltf_append append = {.size = u->size, .version = GLTF_NONE, .bytes = u->bytes};
        TRY(add_append(saver, u->buffer, append, error));
        u->offset = saver->buffers[u->buffer].length - u->size;
    }
    return FFD_OK;
}

static ffd_status list_appends(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const size_t index = saver->plan.appended[i];
        const gltf_version *version = &saver->plan.versions[index];
        const size_t stride = ffd_gltf_align(element_size(d, version));
        const size_t size = ffd_gltf_version_count(d, version) * stride;
        const gltf_stored_part *const sparse = &saver->sparse[i];
        const gltf_append append = {.size = sparse->bytes ? sparse->size : size,
                                    .stride = stride,
                                    .version = index,
                                    .bytes = sparse->bytes};
        TRY(add_append(saver, ffd_gltf_append_buffer(d, version->accessor), append, error));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error)
{
    TRY(ffd_gltf_list_unpackings(saver, error));
    TRY(ffd_gltf_mend_weights(saver, error));
    TRY(ffd_gltf_list_sparse(saver, error));
    TRY(make_buffers(saver, error));
    TRY(list_added(saver, error));
    TRY(list_appends(saver, error));
    TRY(list_unpacked(saver, error));
    list_overwrites(saver);
    return FFD_OK;
}

void ffd_gltf_free_content(gltf_saver *saver)
{
    for (size_t b = 0; saver->buffers && b < saver->buffer_count; b++) {
        ffd_free(saver->buffers[b].overwrites);
        ffd_free(saver->buffers[b].appends);
        ffd_free(saver->buffers[b].target);
    }
    ffd_free(saver->buffers);
}

size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer)
{
    const gltf_new_buffer *made = &saver->buffers[buffer];
    return made->append_count > 0 || made->kind != made->old->kind ? made->length : made->old->size;
}

/* Copies the intersection of the `size` bytes at position `at` and the range [offset, offset + length). */
static void copy_common(const unsigned char *from, size_t at, size_t size, size_t offset, size_t length,
                        unsigned char *bytes)
{
    const size_t begin = at > offset ? at : offset;
    const size_t end = at + size < offset + length ? at + size : offset + length;
    if (begin < end)
        memcpy(bytes + (begin - offset), from + (begin - at), end - begin);
}

static void put_vectors(const float *xyz, size_t count, unsigned char *bytes)
{
    for (size_t c = 0; c < 3 * count; c++)
        store_float(bytes + 4 * c, xyz[c]);
}

/* Whether a version's bytes are those of its values: vectors of three floats, contiguous. */
static bool has_vectors(const gltf_document *d, const gltf_version *version)
{
    return version->component == GLTF_FLOAT && ffd_gltf_version_width(d, version) == 3;
}

static void apply_overwrite(const gltf_document *d, const gltf_overwrite *overwrite, size_t offset,
                            size_t size, unsigned char *bytes)
{
    const size_t element = d->layouts[overwrite->accessor].element_size;
    const bool is_vector = has_vectors(d, overwrite->version);
    size_t i =
        offset > overwrite->begin + element ? (offset - overwrite->begin - element) / overwrite->stride : 0;
    for (size_t at = overwrite->begin + i * overwrite->stride; at < offset + size && at < overwrite->end;
         i++, at += overwrite->stride) {
        unsigned char encoded[GLTF_LARGEST_ELEMENT];
        if (is_vector && at >= offset && at + element <= offset + size) {
            /* Contiguous elements are copied at once. */
            const size_t end = overwrite->end < offset + size ? overwrite->end : offset + size;
            const size_t count = overwrite->stride == element ? (end - at) / element : 1;
            put_vectors(overwrite->version->values + 3 * i, count, bytes + (at - offset));
            i += count - 1;
            at += (count - 1) * element;
            continue;
        }
        ffd_gltf_version_encode(d, overwrite->version, i, encoded);
        copy_common(encoded, at, element, offset, size, bytes);
    }
}

static bool all_end_by(const void *overwrite, const void *offset)
{
    return ((const gltf_overwrite *)overwrite)->end_so_far <= *(const size_t *)offset;
}

/* Returns the index of the first overwrite that may end after offset. */
static size_t find_overwrite(const gltf_new_buffer *buffer, size_t offset)
{
    return lower_bound(&offset, buffer->overwrites, buffer->overwrite_count, sizeof *buffer->overwrites,
                       all_end_by);
}

static void apply_overwrites(const gltf_document *d, const gltf_new_buffer *buffer, size_t offset,
                             size_t size, unsigned char *bytes)
{
    for (size_t i = find_overwrite(buffer, offset);
         i < buffer->overwrite_count && buffer->overwrites[i].begin < offset + size; i++)
        if (buffer->overwrites[i].end > offset)
            apply_overwrite(d, &buffer->overwrites[i], offset, size, bytes);
}

static void apply_append(const gltf_saver *saver, const gltf_append *append, size_t offset, size_t size,
                         unsigned char *bytes)
{
    if (append->bytes) {
        copy_common(append->bytes, append->offset, append->size, offset, size, bytes);
        return;
    }
    const gltf_version *version = &saver->plan.versions[append->version];
    const size_t element = element_size(saver->document, version), stride = append->stride;
    size_t i = offset > append->offset ? (offset - append->offset) / stride : 0;
    for (; i * stride < append->size && append->offset + i * stride < offset + size; i++) {
        unsigned char encoded[GLTF_LARGEST_ELEMENT];
        ffd_gltf_version_encode(saver->document, version, i, encoded);
        copy_common(encoded, append->offset + i * stride, element, offset, size, bytes);
    }
}

static bool ends_by(const void *append, const void *offset)
{
    const gltf_append *const a = append;
    return a->offset + a->size <= *(const size_t *)offset;
}

static void apply_appends(const gltf_saver *saver, const gltf_new_buffer *buffer, size_t offset, size_t size,
                          unsigned char *bytes)
{
    const size_t first =
        lower_bound(&offset, buffer->appends, buffer->append_count, sizeof *buffer->appends, ends_by);
    for (size_t i = first; i < buffer->append_count && buffer->appends[i].offset < offset + size; i++)
        apply_append(saver, &buffer->appends[i], offset, size, bytes);
}

/* Bytes beyond the old byteLength are not content: a buffer grows from byteLength on. */
static size_t size_of_old(const gltf_new_buffer *made)
{
    return made->append_count > 0 ? made->old->length : made->old->size;
}

/* Reads bytes [offset, offset + size) of the new content. */
static void read_content(const gltf_saver *saver, size_t b, size_t offset, size_t size, unsigned char *bytes)
{
    const gltf_new_buffer *made = &saver->buffers[b];
    const size_t kept = size_of_old(made);
    const size_t held = kept <= offset ? 0 : kept - offset < size ? kept - offset : size;
    copy_common(made->old->data, 0, kept, offset, size, bytes);
    memset(bytes + held, 0, size - held);
    apply_appends(saver, made, offset, size, bytes);
    /* Last: decompressed data is appended unchanged first, and then overwritten. */
    apply_overwrites(saver->document, made, offset, size, bytes);
}

/* Returns the values of an overwrite if memory holds them exactly as written, else NULL. */
static const unsigned char *values_in_place(const gltf_document *d, const gltf_overwrite *overwrite)
{
    return LITTLE_ENDIAN_MACHINE && has_vectors(d, overwrite->version) &&
                   overwrite->stride == 3 * sizeof(float)
               ? (const unsigned char *)overwrite->version->values
               : NULL;
}

/* Returns how many bytes of the new content from offset on lie in memory exactly as written, in the old
   content or in the results, and points *bytes to them. 0: use read_content. */
static size_t content_at(const gltf_saver *saver, size_t b, size_t offset, const unsigned char **bytes)
{
    const gltf_new_buffer *made = &saver->buffers[b];
    const size_t next = find_overwrite(made, offset), size = ffd_gltf_content_size(saver, b);
    size_t end = size_of_old(made) < size ? size_of_old(made) : size, following = next;
    const unsigned char *values = NULL;
    if (next < made->overwrite_count && made->overwrites[next].begin <= offset) {
        const gltf_overwrite *here = &made->overwrites[following++];
        values = values_in_place(saver->document, here);
        if (!values)
            return 0;
        values += offset - here->begin;
        end = here->end < size ? here->end : size;
    }
    if (following < made->overwrite_count && made->overwrites[following].begin < end)
        end = made->overwrites[following].begin;
    if (end <= offset)
        return 0;
    *bytes = values ? values : made->old->data + offset;
    return end - offset;
}

/* Sizes of a piece in bytes: multiples of 3, so that pieces of base64 join. Pieces are large because each
   passes from one thread to another, but smaller if the pieces of all threads would take more than
   MOST_HELD. */
#define MOST_PIECE ((size_t)3 << 18)
#define LEAST_PIECE ((size_t)3 << 16)
#define MOST_HELD ((size_t)3 << 22)

/* Bytes written, a multiple of the piece size, before the mmap pages of all files are released: appended data
   may come from anywhere in them. */
#define MOST_WRITTEN ((size_t)3 << 21)

/* The maximum number of separate stretches of memory in a piece; a piece with more is copied together. */
#define MOST_STRETCHES 4

typedef struct content_stretch {
    const void *bytes;
    size_t size;
} content_stretch;

/* A piece from its preparation until it is written. */
typedef struct content_piece {
    unsigned char *block;                      /* bytes that had to be copied together; NULL until needed */
    char *text;                                /* base64; NULL until needed */
    content_stretch stretches[MOST_STRETCHES]; /* the bytes to write */
    size_t count;                              /* 0: memory ran out */
} content_piece;

typedef struct content_writer {
    const gltf_saver *saver;
    size_t buffer;
    bool base64;
    size_t piece_size;
    content_piece *pieces; /* one per slot */
    ffd_status status;
    ffd_error *error;
    atomic_bool is_over; /* set after a failure */
} content_writer;

/* Lists the bytes of a piece if memory holds them exactly as written, in at most `most` stretches. */
static bool list_stretches(const content_writer *w, size_t offset, size_t size, size_t most,
                           content_piece *piece)
{
    piece->count = 0;
    for (size_t done = 0; done < size;) {
        const unsigned char *bytes;
        const size_t there = content_at(w->saver, w->buffer, offset + done, &bytes);
        const size_t length = there < size - done ? there : size - done;
        if (length == 0 || piece->count == most)
            return false;
        piece->stretches[piece->count++] = (content_stretch){bytes, length};
        done += length;
    }
    return true;
}

/* Finds the bytes of a piece. Those that memory holds exactly as written are not copied. */
static void find_content(const content_writer *w, size_t offset, size_t size, content_piece *piece)
{
    if (list_stretches(w, offset, size, w->base64 ? 1 : MOST_STRETCHES, piece))
        return;
    if (!piece->block)
        piece->block = ffd_alloc(w->piece_size, 1);
    if (piece->block)
        read_content(w->saver, w->buffer, offset, size, piece->block);
    piece->stretches[0] = (content_stretch){piece->block, size};
    piece->count = piece->block != NULL;
}

static void encode(const content_writer *w, content_piece *piece)
{
    content_stretch *const all = &piece->stretches[0];
    if (!piece->text)
        piece->text = ffd_alloc(ffd_base64_length(w->piece_size), 1);
    if (piece->text)
        ffd_base64_encode(all->bytes, all->size, piece->text);
    *all = (content_stretch){piece->text, ffd_base64_length(all->size)};
    piece->count = piece->text != NULL;
}

static void make_piece(void *context, size_t tile, size_t first, size_t last, int slot)
{
    const content_writer *w = context;
    content_piece piece = w->pieces[slot]; /* a copy, because the pieces of the array share cache lines */
    (void)tile;
    if (atomic_load(&w->is_over))
        return;
    find_content(w, first, last - first, &piece);
    if (piece.count > 0 && w->base64)
        encode(w, &piece);
    for (size_t i = 0; i < piece.count && !w->base64 && !w->saver->document->is_present; i++)
        ffd_file_prefault(piece.stretches[i].bytes, piece.stretches[i].size);
    w->pieces[slot] = piece;
}

static void write_piece(void *context, size_t tile, size_t first, size_t last, int slot)
{
    content_writer *w = context;
    const content_piece *piece = &w->pieces[slot];
    const gltf_new_buffer *buffer = &w->saver->buffers[w->buffer];
    if (atomic_load(&w->is_over))
        return;
    w->status = piece->count > 0 ? FFD_OK : ffd_fail_memory(w->error);
    for (size_t i = 0; i < piece->count && !w->status; i++)
        w->status =
            ffd_output_write(w->saver->output, piece->stretches[i].bytes, piece->stretches[i].size, w->error);
    if (w->status)
        atomic_store(&w->is_over, true);
    ffd_gltf_forget_bytes(w->saver->document, buffer->old, first, last - first);
    if (buffer->append_count > 0 && (tile + 1) * w->piece_size % MOST_WRITTEN == 0)
        ffd_gltf_forget(w->saver->document);
}

static size_t piece_size(size_t slots)
{
    size_t size = MOST_PIECE;
    while (size > LEAST_PIECE && slots * size > MOST_HELD)
        size /= 2;
    return size;
}

ffd_status ffd_gltf_write_content(const gltf_saver *saver, size_t buffer, bool base64, ffd_error *error)
{
    const int threads = saver->document->threads, slots = ffd_ordered_slots(threads);
    content_writer w = {.saver = saver,
                        .buffer = buffer,
                        .base64 = base64,
                        .piece_size = piece_size((size_t)slots),
                        .pieces = ffd_alloc_zero((size_t)slots, sizeof *w.pieces),
                        .error = error};
    atomic_init(&w.is_over, false);
    ffd_gltf_forget(saver->document);
    if (!w.pieces || !ffd_parallel_in_order(ffd_gltf_content_size(saver, buffer), w.piece_size, threads,
                                            make_piece, write_piece, &w))
        w.status = ffd_fail_memory(error);
    for (int i = 0; w.pieces && i < slots; i++) {
        ffd_free(w.pieces[i].block);
        ffd_free(w.pieces[i].text);
    }
    ffd_free(w.pieces);
    return w.status;
}
