/* gltf_content_write.c - writes the new content of a buffer: threads prepare its pieces, which are
   written in order. */
#include "io/gltf/save/gltf_content_write.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/gltf/file/base64.h"
#include "io/gltf/save/gltf_content.h"
#include <stdatomic.h>

/* Bytes of a piece, multiples of 3 so that pieces of base64 join. Pieces are large, since each passes
   from thread to thread, but smaller if the pieces of all threads would take more than MOST_HELD. */
#define MOST_PIECE ((size_t)3 << 18)
#define LEAST_PIECE ((size_t)3 << 16)
#define MOST_HELD ((size_t)3 << 22)

/* Bytes that are written, a multiple of a piece, until the memory of all files is released: appended
   data may be anywhere in them. */
#define MOST_WRITTEN ((size_t)3 << 21)

/* A piece until it is written. */
typedef struct content_piece {
    unsigned char *block; /* bytes that had to be put together; NULL until a piece needs it */
    char *text;           /* base64; NULL until a piece needs it */
    const void *bytes;    /* to be written; NULL: memory ran out */
    size_t size;
} content_piece;

typedef struct content_writer {
    const gltf_saver *saver;
    size_t buffer;
    bool base64;
    size_t piece_size;
    content_piece *pieces; /* one per slot */
    ffd_status status;
    ffd_error *error;
    atomic_bool is_over; /* after a failure */
} content_writer;

/* Bytes that are in memory as they are to be written are not copied. */
static const unsigned char *find_content(const content_writer *w, size_t offset, size_t size,
                                         content_piece *piece)
{
    const unsigned char *bytes;
    if (ffd_gltf_content_at(w->saver, w->buffer, offset, &bytes) >= size)
        return bytes;
    if (!piece->block)
        piece->block = ffd_alloc(w->piece_size, 1);
    if (piece->block)
        ffd_gltf_content_read(w->saver, w->buffer, offset, size, piece->block);
    return piece->block;
}

static void encode(const content_writer *w, content_piece *piece)
{
    if (!piece->text)
        piece->text = ffd_alloc(ffd_base64_length(w->piece_size), 1);
    if (piece->text)
        ffd_base64_encode(piece->bytes, piece->size, piece->text);
    piece->bytes = piece->text;
    piece->size = ffd_base64_length(piece->size);
}

static void make_piece(void *context, size_t tile, size_t first, size_t last, int slot)
{
    const content_writer *w = context;
    content_piece piece = w->pieces[slot]; /* a copy: pieces of the array share cache lines */
    (void)tile;
    if (atomic_load(&w->is_over))
        return;
    piece.size = last - first;
    piece.bytes = find_content(w, first, piece.size, &piece);
    if (piece.bytes && w->base64)
        encode(w, &piece);
    else if (piece.bytes)
        ffd_file_prefault(piece.bytes, piece.size);
    w->pieces[slot] = piece;
}

static void write_piece(void *context, size_t tile, size_t first, size_t last, int slot)
{
    content_writer *w = context;
    const content_piece *piece = &w->pieces[slot];
    const gltf_new_buffer *buffer = &w->saver->buffers[w->buffer];
    if (atomic_load(&w->is_over))
        return;
    w->status = piece->bytes ? ffd_output_write(w->saver->output, piece->bytes, piece->size, w->error)
                             : ffd_fail_memory(w->error);
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
