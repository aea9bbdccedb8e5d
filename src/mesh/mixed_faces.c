#include "mesh/mixed_faces.h"
#include "base/memory/memory.h"
#include <string.h>

/* Makes room for this many words. Returns false if the list has failed. */
static bool grow(face_list *list, size_t words)
{
    list->failed =
        list->failed || !ffd_grow((void **)&list->words, &list->capacity, words, sizeof *list->words);
    return !list->failed;
}

void ffd_face_list_corner(face_list *list, uint32_t vertex)
{
    const size_t at = list->count + 1 + list->pending; /* one word is reserved for their number */
    if (at >= list->capacity && !grow(list, at + 1))
        return;
    list->words[at] = vertex;
    list->pending++;
}

void ffd_face_list_end(face_list *list, const vertex_marks *marks)
{
    const size_t corners = list->pending;
    list->pending = 0;
    list->failed = list->failed || corners > UINT32_MAX;
    if (list->failed || corners == 0 || !ffd_marks_differ(marks, list->words + list->count + 1, corners))
        return;
    list->words[list->count] = (uint32_t)corners;
    list->count += 1 + corners;
    list->faces++;
}

size_t ffd_marks_next(const vertex_marks *marks, size_t vertex)
{
    for (uint64_t eight; vertex < marks->vertices; vertex++) {
        unsigned any = 0;
        while (marks->planes == 1 && marks->vertices - vertex > sizeof eight) {
            memcpy(&eight, marks->bytes + vertex, sizeof eight);
            if (eight)
                break;
            vertex += sizeof eight;
        }
        for (size_t p = 0; p < marks->planes; p++)
            any |= marks->bytes[p * marks->vertices + vertex];
        if (any)
            break;
    }
    return vertex;
}

/* A set of vertices: a bit for each vertex of the document, and for each word the number of bits before
   it. */
typedef struct vertex_set {
    uint64_t *words;
    uint32_t *before;
    size_t word_count;
} vertex_set;

/* Returns how many of the bits below `bit` are set. */
static uint32_t count_below(uint64_t bits, unsigned bit)
{
    bits &= ((uint64_t)1 << bit) - 1;
    bits -= bits >> 1 & 0x5555555555555555;
    bits = (bits & 0x3333333333333333) + (bits >> 2 & 0x3333333333333333);
    bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return (uint32_t)(bits * 0x0101010101010101 >> 56);
}

static uint32_t place_in(const vertex_set *set, uint32_t vertex)
{
    return set->before[vertex / 64] + count_below(set->words[vertex / 64], vertex % 64);
}

static void free_set(vertex_set *set)
{
    ffd_free(set->words);
    ffd_free(set->before);
}

/* Makes the set of the vertices in the lists; *count is their number. */
static ffd_status make_set(const mesh_document *document, const face_list *lists, size_t list_count,
                           size_t vertices, vertex_set *set, size_t *count, ffd_error *error)
{
    const size_t words = vertices / 64 + 1;
    const ffd_status status =
        ffd_budget_check(&document->budget, words, sizeof *set->words + sizeof *set->before, error);
    *set = (vertex_set){.word_count = words};
    *count = 0;
    TRY(status);
    set->words = ffd_alloc_zero(words, sizeof *set->words);
    set->before = ffd_alloc(words, sizeof *set->before);
    if (!set->words || !set->before)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < list_count; l++)
        for (size_t i = 0; i < lists[l].count;)
            for (size_t left = lists[l].words[i++]; left > 0; left--, i++)
                set->words[lists[l].words[i] / 64] |= (uint64_t)1 << lists[l].words[i] % 64;
    for (size_t w = 0; w < words; w++) {
        set->before[w] = (uint32_t)*count;
        *count += count_below(set->words[w], 63) + (set->words[w] >> 63);
    }
    return FFD_OK;
}

/* Renumbers the corners by the set, and lists the vertices of the set. */
static void index_corners(const vertex_set *set, mesh_faces *faces)
{
    size_t count = 0;
    for (size_t c = 0; c < faces->start[faces->face_count]; c++)
        faces->corners[c] = place_in(set, faces->corners[c]);
    for (size_t w = 0; w < set->word_count; w++)
        for (unsigned bit = 0; bit < 64 && set->words[w] >> bit; bit++)
            if (set->words[w] >> bit & 1)
                faces->vertices[count++] = (uint32_t)(64 * w + bit);
}

static void fill_faces(const face_list *lists, size_t count, mesh_faces *faces)
{
    size_t face = 0, corner = 0;
    for (size_t l = 0; l < count; l++)
        for (size_t i = 0; i < lists[l].count;) {
            faces->start[face++] = corner;
            for (size_t left = lists[l].words[i++]; left > 0; left--)
                faces->corners[corner++] = lists[l].words[i++];
        }
    faces->start[face] = corner;
}

ffd_status ffd_face_lists_join(const mesh_document *document, const face_list *lists, size_t count,
                               mesh_faces *faces, ffd_error *error)
{
    size_t corners = 0;
    for (size_t l = 0; l < count; l++) {
        if (lists[l].failed)
            return ffd_fail_memory(error);
        faces->face_count += lists[l].faces;
        corners += lists[l].count - lists[l].faces;
    }
    TRY(ffd_mesh_faces_make(document, faces, corners, error));
    fill_faces(lists, count, faces);
    return FFD_OK;
}

ffd_status ffd_face_lists_narrow(const mesh_document *document, const face_list *lists, size_t count,
                                 mesh_faces *faces, ffd_error *error)
{
    vertex_set set;
    ffd_status status;
    faces->vertices = NULL;
    TRY_END(make_set(document, lists, count, faces->vertex_count, &set, &faces->vertex_count, error));
    faces->vertices = ffd_alloc(faces->vertex_count, sizeof *faces->vertices);
    if (!faces->vertices)
        TRY_END(ffd_fail_memory(error));
    TRY_END(ffd_face_lists_join(document, lists, count, faces, error));
    index_corners(&set, faces);
end:
    if (status)
        ffd_mesh_faces_free(faces);
    free_set(&set);
    return status;
}
