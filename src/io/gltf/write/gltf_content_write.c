/* gltf_content_write.c - writes the new content of a buffer: threads prepare pieces, which are written in
   order. */
#include "io/gltf/write/gltf_content_write.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/base64.h"
#include "io/gltf/write/gltf_content.h"
#include <stdatomic.h>

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
        const size_t there = ffd_gltf_content_at(w->saver, w->buffer, offset + done, &bytes);
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
        ffd_gltf_content_read(w->saver, w->buffer, offset, size, piece->block);
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
