#include "io/obj/obj_weights.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "io/obj/obj_number.h"
#include <stdatomic.h>

/* What threads share. */
typedef struct weight_reader {
    const obj_document *document;
    size_t before; /* numbers of a vertex before its channel */
    double *weights;
    atomic_size_t missing; /* the first block with a selected vertex without a colour */
} weight_reader;

/* Takes the number of the current vertex's channel. Returns false if it has none: a `v` with fewer than six
   numbers has no colour. */
static bool take_channel(obj_walk *walk, size_t before, double *weight)
{
    double number = 0;
    size_t count = 0;
    text_word word;
    while (count < 7 && ffd_obj_scan_word(&walk->scan, &word) && ffd_obj_number(word, &number)) {
        if (count == before)
            *weight = number;
        count++;
    }
    return count >= 6 && count > before;
}

/* Returns the line of the first selected vertex of a block without a colour; 0: all have one. */
static size_t read_block(const weight_reader *r, size_t block)
{
    const obj_document *const d = r->document;
    obj_walk walk;
    ffd_obj_document_walk_block(d, block, &walk);
    while (ffd_obj_walk_next(&walk)) {
        const size_t vertex = walk.vertices.seen - 1;
        if (walk.scan.keyword == OBJ_VERTEX && !take_channel(&walk, r->before, &r->weights[vertex]) &&
            ffd_part_selects(&d->file.part, vertex))
            return walk.scan.keyword_line;
    }
    return 0;
}

static void read_tile(void *context, size_t block, size_t first, size_t last, int worker)
{
    weight_reader *const r = context;
    size_t missing = atomic_load(&r->missing);
    (void)first, (void)last, (void)worker;
    if (block > missing || ffd_deadline_passed() || read_block(r, block) == 0)
        return;
    while (block < missing && !atomic_compare_exchange_weak(&r->missing, &missing, block))
        ;
}

static ffd_status read(const mesh_document *document, const weight_source *source, double *weights,
                       ffd_error *error)
{
    const obj_document *const d = ffd_obj_of(document);
    weight_reader r = {.document = d, .before = 3 + (size_t)source->channel, .weights = weights};
    atomic_init(&r.missing, SIZE_MAX);
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, read_tile, &r);
    TRY(ffd_deadline_check(error));
    const size_t missing = atomic_load(&r.missing);
    return missing == SIZE_MAX
               ? FFD_OK
               : ffd_fail_line(error, FFD_E_INVALID, d->file.name, read_block(&r, missing),
                               "the vertex has no colour, or none with \"%c\", after x y z ({weight})",
                               "rgba"[source->channel]);
}

const mesh_weight_calls ffd_obj_weights = {.kinds = WEIGHT_BIT(WEIGHT_COLOR), .read = read};
