/* obj_save.c - writes an OBJ file with its results. */
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/number.h"
#include "io/obj/obj_document.h"
#include "io/obj/obj_faces.h"
#include "io/obj/obj_split.h"
#include "io/obj/resource/obj_resources.h"
#include "io/text/splice.h"
#include <inttypes.h>
#include <stdatomic.h>
#include <stdio.h>

typedef struct saver {
    const obj_document *document;
    obj_split split;
    byte_buffer *texts;     /* of blocks that are not written yet */
    file_splice *splice;    /* of the whole file */
    atomic_bool is_over;    /* after a failure */
    atomic_bool is_changed; /* the file is not the one that was read */
} saver;

/* A block as it is being made. */
typedef struct block_saver {
    saver *all;
    file_splice splice;
    decimal_run positions, directions;
} block_saver;

/* Replaces those of a statement's three numbers that have changed. */
static void replace_numbers(block_saver *s, obj_scan *scan, const double *numbers, unsigned changes,
                            decimal_run *run)
{
    text_word words[3];
    if (!changes)
        return;
    const size_t count = ffd_obj_scan_words(scan, words);
    ffd_splice_numbers(&s->splice, words, numbers, changes, count, run);
}

static void renumber_corners(block_saver *s, obj_walk *walk)
{
    saver *all = s->all;
    obj_face_corner corner;
    size_t pair;
    while (ffd_obj_walk_corner(walk, &corner)) {
        if (!corner.has_normal)
            continue;
        const bool found = ffd_obj_find_pair(all->document, &corner, &pair);
        const uint32_t target = found ? all->split.target[pair] : OBJ_NONE;
        if (!found)
            atomic_store(&all->is_changed, true);
        if (target == OBJ_NONE)
            continue;
        char text[24];
        const uint64_t index = (uint64_t)all->document->normals + target + 1;
        const int size = snprintf(text, sizeof text, "%" PRIu64, index);
        ffd_splice_replace(&s->splice, corner.normal_text, text, (size_t)size);
    }
}

/* The line end of the lines before `where`: the one right before it, else the file's first, else LF. */
static text_word line_end_at(const obj_document *d, const char *where)
{
    static const char lf[] = "\n";
    const char *first = (const char *)d->file.input.data, *last = first + d->file.input.size;
    if (where > first && where[-1] == '\n')
        return (text_word){where - (where - first > 1 && where[-2] == '\r' ? 2 : 1), where};
    if (where > first && where[-1] == '\r')
        return (text_word){where - 1, where};
    for (const char *at = first; at < last; at++)
        if (*at == '\n' || *at == '\r')
            return (text_word){at, at + ffd_obj_line_end_size(at, last)};
    return (text_word){lf, lf + 1};
}

static void write_word(file_splice *splice, text_word word)
{
    ffd_splice_bytes(splice, word.first, (size_t)(word.last - word.first));
}

/* Begins a new line at `where` that does not continue the line before: if that ends with a backslash, an
   empty line is written first. Comments count too, since some readers continue them. */
static void begin_line(file_splice *splice, const char *first, const char *where, text_word line_end)
{
    const char *text_end = where;
    if (where > first && (where[-1] == '\n' || where[-1] == '\r'))
        text_end -= line_end.last - line_end.first;
    else
        write_word(splice, line_end);
    while (text_end > first && ffd_obj_class(text_end - 1) == OBJ_BLANK)
        text_end--;
    if (text_end > first && text_end[-1] == '\\')
        write_word(splice, line_end);
}

static void add_normals(const saver *s, file_splice *splice)
{
    const obj_document *d = s->document;
    const char *first = (const char *)d->file.input.data, *where = first + d->addition;
    if (s->split.added_count == 0)
        return;
    const text_word line_end = line_end_at(d, where);
    ffd_splice_copy(splice, where);
    begin_line(splice, first, where, line_end);
    for (size_t i = 0; i < s->split.added_count; i++) {
        const double *value = d->file.new_directions + 3 * (size_t)s->split.added[i];
        ffd_splice_bytes(splice, "vn", 2);
        for (int a = 0; a < 3; a++) {
            char text[1 + FFD_NUMBER_CAPACITY] = " ";
            ffd_splice_bytes(splice, text, 1 + ffd_number_format(value[a], text + 1));
        }
        write_word(splice, line_end);
    }
}

static void replace_normal(block_saver *s, obj_walk *walk)
{
    const obj_document *d = s->all->document;
    const size_t n = walk->normals.seen - 1;
    const uint32_t keeper = s->all->split.keeper[n];
    if (keeper != OBJ_NONE)
        replace_numbers(s, &walk->scan, d->file.new_directions + 3 * (size_t)keeper,
                        d->direction_changes[keeper], &s->directions);
    if (n + 1 < d->normals || d->addition == d->end)
        return;
    ffd_obj_scan_finish(&walk->scan);
    if (walk->scan.at == (const char *)d->file.input.data + d->addition)
        add_normals(s->all, &s->splice);
    else
        atomic_store(&s->all->is_changed, true);
}

/* Writes the walk's statement with its changes. */
static void write_statement(block_saver *s, obj_walk *walk)
{
    const saver *all = s->all;
    const obj_document *d = all->document;
    const size_t v = walk->vertices.seen - 1;
    if (walk->scan.keyword == OBJ_VERTEX)
        replace_numbers(s, &walk->scan, d->file.new_positions + 3 * v, d->position_changes[v], &s->positions);
    else if (walk->scan.keyword == OBJ_NORMAL && all->split.keeper)
        replace_normal(s, walk);
    else if (walk->scan.keyword == OBJ_FACE && all->split.target &&
             (!d->selected_faces || d->selected_faces[walk->faces.seen - 1]))
        renumber_corners(s, walk);
}

static size_t pair_count(const obj_document *d)
{
    return d->pair_start[d->vertices];
}

static bool has_counts(const obj_walk *walk, size_t vertices, size_t texcoords, size_t normals, size_t faces)
{
    return walk->vertices.seen == vertices && walk->texcoords.seen == texcoords &&
           walk->normals.seen == normals && walk->faces.seen == faces;
}

/* Whether a walk that has ended has met as many elements as the block had when the file was read. */
static bool meets_all(const obj_document *d, size_t index, const obj_walk *walk)
{
    const obj_block *next = &d->blocks.list[index + 1];
    return index + 1 == d->blocks.count
               ? has_counts(walk, d->vertices, d->texcoords, d->normals, d->faces)
               : has_counts(walk, next->vertices, next->texcoords, next->normals, next->faces);
}

static void make_block(saver *all, size_t index, byte_buffer *text)
{
    const obj_block *block = &all->document->blocks.list[index];
    block_saver s = {.all = all};
    obj_walk walk;
    ffd_splice_begin_part(&s.splice, block->first, block->last, text, NULL);
    ffd_decimal_run_begin(&s.positions, all->document->file.new_positions + 3 * all->document->vertices);
    if (all->split.keeper)
        ffd_decimal_run_begin(&s.directions,
                              all->document->file.new_directions + 3 * pair_count(all->document));
    ffd_obj_document_walk_block(all->document, index, &walk);
    while (ffd_obj_walk_next(&walk))
        write_statement(&s, &walk);
    const bool is_spliced = ffd_splice_end(&s.splice) == FFD_OK;
    if (is_spliced && meets_all(all->document, index, &walk))
        ffd_obj_forget_vectors(all->document, block->vertices, walk.vertices.seen - block->vertices);
    else
        atomic_store(&all->is_changed, true);
}

/* Whether some statement of the block can change. */
static bool can_change(const saver *s, size_t index)
{
    const obj_document *d = s->document;
    const obj_block *block = &d->blocks.list[index];
    const bool is_last = index + 1 == d->blocks.count;
    return (is_last ? d->vertices : block[1].vertices) > block->vertices ||
           (s->split.keeper && (is_last ? d->normals : block[1].normals) > block->normals) ||
           (s->split.target && block->names_elements);
}

static void make_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    saver *s = context;
    byte_buffer text = s->texts[worker]; /* a local copy: entries of the list share cache lines */
    (void)last;
    (void)tile;
    const obj_block *block = &s->document->blocks.list[first];
    text.size = 0;
    if (!atomic_load(&s->is_over)) {
        ffd_file_prefault(block->first, (size_t)(block->last - block->first));
        if (can_change(s, first))
            make_block(s, first, &text);
    }
    s->texts[worker] = text;
}

static void write_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    saver *s = context;
    const obj_block *block = &s->document->blocks.list[first];
    (void)last;
    (void)tile;
    if (atomic_load(&s->is_over))
        return;
    if (s->texts[worker].failed)
        s->splice->status = ffd_fail_memory(s->splice->error);
    ffd_splice_part(s->splice, block->first, block->last, can_change(s, first) ? &s->texts[worker] : NULL);
    if (s->splice->status)
        atomic_store(&s->is_over, true);
}

static void write_blocks(saver *s)
{
    const obj_document *d = s->document;
    const int slots = ffd_ordered_slots(d->threads);
    s->texts = ffd_alloc_zero((size_t)slots, sizeof *s->texts);
    if (!s->texts || !ffd_parallel_in_order(d->blocks.count, 1, d->threads, make_tile, write_tile, s))
        s->splice->status = ffd_fail_memory(s->splice->error);
    for (int i = 0; s->texts && i < slots; i++)
        ffd_buffer_free(&s->texts[i]);
    ffd_free(s->texts);
}

ffd_status ffd_obj_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    file_splice splice;
    saver s = {.document = d, .splice = &splice};
    TRY(ffd_obj_bring_resources(&d->file.input, &document->folder, d->names_files, options, output, log,
                                error));
    if (!output)
        return FFD_OK;
    ffd_status status;
    TRY_END(d->file.new_directions ? ffd_obj_split_normals(d, &s.split, error) : FFD_OK);
    ffd_splice_begin(&splice, &d->file, options, output, error);
    if (d->file.new_positions && splice.status == FFD_OK)
        write_blocks(&s);
    if (d->addition == d->end)
        add_normals(&s, &splice);
    TRY_END(ffd_splice_end(&splice));
    if (atomic_load(&s.is_changed))
        TRY_END(ffd_file_document_changed(&d->file, error));
end:
    ffd_obj_split_free(&s.split);
    return status;
}
