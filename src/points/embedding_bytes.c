/* embedding_bytes.c - serialises an embedding, in the byte order of the machine and for this version only.

   Layout: the head; 3 doubles for each point; 17 doubles for each extended point (its index, u,v,w, distance,
   direction, uvw_by_p); a status byte for each point; the hash of everything before. */
#include "base/memory/hash.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "points/embedding.h"
#include <ffd/version.h>
#include <string.h>

#define EXTENDED_NUMBERS ((size_t)17)

typedef struct bytes_head {
    char magic[8];
    char version[24];
    uint64_t order; /* 1, to detect another byte order */
    uint64_t count, extended_count;
    double falloff;
    hash128 rest;
} bytes_head;

_Static_assert(sizeof(bytes_head) == 80, "a head has no padding, which would be hashed and saved");

static const char magic[8] = "ffd-emb";

static bytes_head head_of(const ffd_embedding *embedding)
{
    bytes_head head;
    memset(&head, 0, sizeof head);
    memcpy(head.magic, magic, sizeof head.magic);
    memcpy(head.version, FFD_VERSION, sizeof FFD_VERSION);
    head.order = 1;
    head.count = embedding->count;
    head.extended_count = embedding->extended_count;
    head.falloff = embedding->falloff;
    head.rest = embedding->rest_hash;
    return head;
}

/* Computes the size without the hash. Returns false on overflow. */
static bool size_of(size_t count, size_t extended_count, size_t *size)
{
    size_t points, extended;
    return ffd_multiply_size(count, 3 * sizeof(double) + 1, &points) &&
           ffd_multiply_size(extended_count, EXTENDED_NUMBERS * sizeof(double), &extended) &&
           ffd_add_size(points, extended, size) && ffd_add_size(*size, sizeof(bytes_head), size);
}

static unsigned char *append(unsigned char *to, const void *from, size_t size)
{
    if (size > 0)
        memcpy(to, from, size);
    return to + size;
}

static void pack(const extended_point *extended, double numbers[EXTENDED_NUMBERS])
{
    const boundary_point *const nearest = &extended->nearest;
    numbers[0] = (double)extended->point;
    memcpy(numbers + 1, nearest->uvw, sizeof nearest->uvw);
    numbers[4] = nearest->distance;
    memcpy(numbers + 5, nearest->direction, sizeof nearest->direction);
    memcpy(numbers + 8, nearest->uvw_by_p, sizeof nearest->uvw_by_p);
}

/* Returns false if the numbers are not a valid extended point. */
static bool unpack(const double numbers[EXTENDED_NUMBERS], size_t count, extended_point *extended)
{
    boundary_point *const nearest = &extended->nearest;
    *extended = (extended_point){.nearest = {.found = true, .distance = numbers[4]}};
    memcpy(nearest->uvw, numbers + 1, sizeof nearest->uvw);
    memcpy(nearest->direction, numbers + 5, sizeof nearest->direction);
    memcpy(nearest->uvw_by_p, numbers + 8, sizeof nearest->uvw_by_p);
    if (!(numbers[0] >= 0 && numbers[0] < (double)count) || !vec_is_finite(nearest->uvw))
        return false;
    extended->point = (size_t)numbers[0];
    return true;
}

ffd_status ffd_embedding_save(const ffd_embedding *embedding, void **bytes, size_t *size, ffd_error *error)
{
    const bytes_head head = head_of(embedding);
    size_t content;
    *bytes = NULL;
    if (!size_of(embedding->count, embedding->extended_count, &content))
        return ffd_fail_memory(error);
    unsigned char *const all = ffd_alloc(content + sizeof(hash128), 1), *to = all;
    if (!all)
        return ffd_fail_memory(error);
    to = append(to, &head, sizeof head);
    to = append(to, embedding->uvw, embedding->count * 3 * sizeof *embedding->uvw);
    for (size_t i = 0; i < embedding->extended_count; i++) {
        double numbers[EXTENDED_NUMBERS];
        pack(&embedding->extended[i], numbers);
        to = append(to, numbers, sizeof numbers);
    }
    to = append(to, embedding->status, embedding->count);
    const hash128 hash = ffd_hash(all, content);
    append(to, &hash, sizeof hash);
    *bytes = all;
    *size = content + sizeof hash;
    return FFD_OK;
}

static ffd_status read_head(const unsigned char *bytes, size_t size, bytes_head *head, ffd_error *error)
{
    size_t content;
    hash128 hash;
    if (size < sizeof *head + sizeof hash || memcmp(bytes, magic, sizeof magic) != 0)
        return ffd_fail(error, FFD_E_INVALID, "these bytes are not an embedding");
    memcpy(head, bytes, sizeof *head);
    if (strncmp(head->version, FFD_VERSION, sizeof head->version) != 0 || head->order != 1)
        return ffd_fail(error, FFD_E_INVALID, "the embedding is of another version or another byte order");
    if (head->count > UINT32_MAX || head->extended_count > head->count ||
        !size_of((size_t)head->count, (size_t)head->extended_count, &content) ||
        content + sizeof hash != size)
        return ffd_fail(error, FFD_E_INVALID,
                        "the embedding has %zu bytes, which is not the size of its content", size);
    hash = ffd_hash(bytes, content);
    if (memcmp(&hash, bytes + content, sizeof hash) != 0)
        return ffd_fail(error, FFD_E_INVALID, "the embedding is damaged: its hash does not match");
    return FFD_OK;
}

/* Needed although the hash is correct, because bytes can be forged. */
static ffd_status check_points(const ffd_embedding *embedding, ffd_error *error)
{
    for (size_t i = 0; i < embedding->count; i++) {
        const bool finite = vec_is_finite(embedding->uvw + 3 * i);
        if (embedding->status[i] >= FFD_VERTEX_STATUS_COUNT || (ffd_embedding_has(embedding, i) && !finite))
            return ffd_fail(error, FFD_E_INVALID, "point %zu of the embedding is not valid", i);
    }
    return FFD_OK;
}

static ffd_status fill(const unsigned char *bytes, const bytes_head *head, ffd_embedding *embedding,
                       ffd_error *error)
{
    const size_t count = embedding->count, extended = (size_t)head->extended_count;
    embedding->falloff = head->falloff;
    embedding->extended = ffd_alloc(extended, sizeof *embedding->extended);
    if (!embedding->extended)
        return ffd_fail_memory(error);
    embedding->extended_count = extended;
    bytes += sizeof *head;
    if (count > 0)
        memcpy(embedding->uvw, bytes, count * 3 * sizeof *embedding->uvw);
    bytes += count * 3 * sizeof *embedding->uvw;
    for (size_t i = 0; i < extended; i++, bytes += EXTENDED_NUMBERS * sizeof(double)) {
        double numbers[EXTENDED_NUMBERS];
        memcpy(numbers, bytes, sizeof numbers);
        if (!unpack(numbers, count, &embedding->extended[i]) ||
            ffd_embedding_has(embedding, embedding->extended[i].point) ||
            (i > 0 && embedding->extended[i].point <= embedding->extended[i - 1].point))
            return ffd_fail(error, FFD_E_INVALID, "extended point %zu of the embedding is not valid", i);
    }
    if (count > 0)
        memcpy(embedding->status, bytes, count);
    return check_points(embedding, error);
}

ffd_status ffd_embedding_load(const void *bytes, size_t size, const ffd_lattice *lattice,
                              ffd_embedding **embedding, ffd_error *error)
{
    bytes_head head;
    *embedding = NULL;
    if (!lattice || !lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no lattice, or it has no control points yet");
    ffd_status status;
    TRY_END(read_head(bytes, size, &head, error));
    TRY_END(ffd_embedding_make(lattice, (size_t)head.count, embedding, error));
    if (!ffd_hash_equal(&head.rest, &(*embedding)->rest_hash))
        TRY_END(ffd_fail(error, FFD_E_INVALID,
                         "the embedding is of another lattice: rest points, knots or weights differ"));
    TRY_END(fill(bytes, &head, *embedding, error));
end:
    if (status)
        ffd_embedding_destroy(embedding);
    return status;
}
