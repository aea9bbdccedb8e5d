#include "io/off/off_walk.h"

void ffd_off_walk_begin(const off_header *header, off_walk *walk)
{
    *walk = (off_walk){.header = header, .scan = header->body, .pass_line = !header->free_layout};
}

/* Moves to the first word of a vertex or face. */
static bool begin_record(off_walk *walk)
{
    if (walk->pass_line)
        ffd_text_next_line(&walk->scan);
    return ffd_text_find(&walk->scan);
}

/* Takes a required word of the record. */
static bool take_word(off_walk *walk, text_word *word)
{
    if (walk->header->free_layout)
        ffd_text_find(&walk->scan);
    return ffd_text_word(&walk->scan, word);
}

bool ffd_off_walk_vertex(off_walk *walk, off_vertex *vertex)
{
    const size_t needed = off_vertex_width(walk->header);
    text_word word;
    while (walk->header->free_layout && ffd_off_walk_rest(walk, &word))
        ;
    if (!begin_record(walk))
        return false;
    vertex->line = walk->scan.line;
    vertex->found = 0;
    while (vertex->found < needed && take_word(walk, &vertex->numbers[vertex->found]))
        vertex->found++;
    walk->rest = ffd_off_header_rest_max(walk->header);
    return true;
}

bool ffd_off_walk_face(off_walk *walk)
{
    text_word word;
    while (walk->header->free_layout && !walk->in_faces && ffd_off_walk_rest(walk, &word))
        ;
    if (!begin_record(walk))
        return false;
    walk->in_faces = true;
    walk->pass_line = true;
    return true;
}

bool ffd_off_walk_whole(off_walk *walk, text_word *word, uint64_t *number)
{
    if (walk->header->free_layout)
        ffd_text_find(&walk->scan);
    return ffd_text_short_whole(&walk->scan, word, number) ||
           (take_word(walk, word) && ffd_text_whole(*word, number));
}

bool ffd_off_walk_rest(off_walk *walk, text_word *word)
{
    if (walk->in_faces || !walk->header->free_layout)
        return ffd_text_word(&walk->scan, word);
    if (walk->rest == 0)
        return false;
    walk->rest--;
    return take_word(walk, word);
}

size_t ffd_off_walk_face_size(off_walk *walk)
{
    text_word word;
    uint64_t number;
    ffd_off_walk_face(walk);
    return ffd_off_walk_whole(walk, &word, &number) ? (uint32_t)number : 0;
}

uint32_t ffd_off_walk_corner_index(off_walk *walk)
{
    text_word word;
    uint64_t number;
    return ffd_off_walk_whole(walk, &word, &number) ? (uint32_t)number : UINT32_MAX;
}
