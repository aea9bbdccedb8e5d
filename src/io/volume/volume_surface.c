#include "io/volume/volume_surface.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <string.h>

#define NO_FACE UINT32_MAX
/* The most corners of a face of a cell that is no polyhedron. */
#define FACE_MAX 6
/* The corners of a voxel in the order of a hexahedron, and of a pixel in that of a quad. */
static const uint8_t turned[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/* The faces of volumes, and a table of them by their corners. */
typedef struct surface {
    size_t face_count, corner_count;
    size_t face_capacity, corner_capacity, shared_capacity;
    size_t *ends;
    uint32_t *corners;
    uint8_t *shared; /* whether two volumes have the face */
    uint32_t *slots; /* mask + 1 */
    size_t mask;
    const memory_budget *budget;
    ffd_error *error;
    ffd_status status;
} surface;

static const uint32_t *face_of(const surface *s, size_t face, size_t *count)
{
    const size_t first = face ? s->ends[face - 1] : 0;
    *count = s->ends[face] - first;
    return s->corners + first;
}

/* The finalizer of splitmix64 (Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, 2014). */
static uint64_t mix(uint64_t bits)
{
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
    return bits ^ bits >> 31;
}

/* The same for all orders of the corners. */
static uint64_t hash_of(const uint32_t *corners, size_t count)
{
    uint64_t sum = count;
    for (size_t c = 0; c < count; c++)
        sum += mix(corners[c] + UINT64_C(0x9e3779b97f4a7c15));
    return mix(sum);
}

/* Whether two faces have the same corners, going round in either direction. */
static bool is_same(const uint32_t *a, const uint32_t *b, size_t count)
{
    size_t start = 0, forth = 0, back = 0;
    while (start < count && b[start] != a[0])
        start++;
    if (start == count)
        return false;
    while (forth < count && a[forth] == b[(start + forth) % count])
        forth++;
    while (back < count && a[back] == b[(start + count - back) % count])
        back++;
    return forth == count || back == count;
}

/* Finds the slot of a face: that of the same face, or an empty one. */
static uint32_t *find_slot(const surface *s, const uint32_t *corners, size_t count)
{
    for (size_t at = (size_t)hash_of(corners, count) & s->mask;; at = (at + 1) & s->mask) {
        uint32_t *const slot = &s->slots[at];
        size_t other_count;
        if (*slot == NO_FACE)
            return slot;
        const uint32_t *const other = face_of(s, *slot, &other_count);
        if (other_count == count && is_same(corners, other, count))
            return slot;
    }
}

static void add_face(void *context, const uint32_t *corners, size_t count)
{
    surface *const s = context;
    if (s->status || count == 0)
        return;
    if (!ffd_grow((void **)&s->ends, &s->face_capacity, s->face_count + 1, sizeof *s->ends) ||
        !ffd_grow((void **)&s->shared, &s->shared_capacity, s->face_count + 1, sizeof *s->shared) ||
        !ffd_grow((void **)&s->corners, &s->corner_capacity, s->corner_count + count, sizeof *s->corners)) {
        s->status = ffd_fail_memory(s->error);
        return;
    }
    memcpy(s->corners + s->corner_count, corners, count * sizeof *corners);
    s->corner_count += count;
    s->shared[s->face_count] = 0;
    s->ends[s->face_count++] = s->corner_count;
    if (s->face_count >= NO_FACE)
        s->status = ffd_fail(s->error, FFD_E_LIMIT, "the cells have more than 2^32 - 2 faces");
    else
        s->status = ffd_budget_check(s->budget, s->corner_count + 4 * (uint64_t)s->face_count,
                                     2 * sizeof *s->corners, s->error);
}

/* The sides of a prism or pyramid, which looks outwards where it is numbered as VTK numbers hexahedra. */
static void visit_sides(const cell_kind *kind, const uint32_t *corners, surface_visitor *visit, void *context)
{
    const size_t n = kind->base;
    uint32_t face[FACE_MAX];
    for (size_t i = 0; i < n; i++)
        face[i] = corners[(n - i) % n];
    visit(context, face, n);
    if (!kind->is_pointed)
        visit(context, corners + n, n);
    for (size_t i = 0; i < n; i++) {
        const size_t next = (i + 1) % n;
        const uint32_t side[4] = {corners[i], corners[next], corners[kind->is_pointed ? n : n + next],
                                  corners[n + i]};
        visit(context, side, kind->is_pointed ? 3 : 4);
    }
}

static void visit_volume(uint8_t number, const uint32_t *words, size_t count, surface_visitor *visit,
                         void *context)
{
    const cell_kind *const kind = ffd_cell_kind(number);
    uint32_t corners[2 * FACE_MAX + 1] = {0};
    if (number == CELL_POLYHEDRON) {
        for (size_t at = 1; at < count; at += 1 + (size_t)words[at])
            visit(context, words + at + 1, words[at]);
        return;
    }
    for (size_t c = 0; c < cell_corners(kind); c++)
        corners[c] = words[number == CELL_VOXEL ? turned[c] : c];
    visit_sides(kind, corners, visit, context);
}

/* The faces of a cell of two dimensions. */
static void visit_flat(uint8_t number, const uint32_t *words, size_t count, surface_visitor *visit,
                       void *context)
{
    const cell_kind *const kind = ffd_cell_kind(number);
    if (number == CELL_PIXEL) {
        const uint32_t corners[4] = {words[0], words[1], words[3], words[2]};
        visit(context, corners, 4);
    } else if (number == CELL_STRIP) {
        for (size_t i = 0; i + 2 < count; i++) {
            const uint32_t corners[3] = {words[i], words[i + 1 + (i & 1)], words[i + 2 - (i & 1)]};
            visit(context, corners, 3);
        }
    } else
        visit(context, words, kind->base ? kind->base : number == CELL_QUADRATIC_POLYGON ? count / 2 : count);
}

/* Fills the table. Faces that are there already become shared. */
static ffd_status fill_table(surface *s)
{
    size_t size = 16;
    while (size / 2 < s->face_count)
        size *= 2;
    TRY(ffd_budget_check(s->budget, size, sizeof *s->slots, s->error));
    s->slots = ffd_alloc(size, sizeof *s->slots);
    if (!s->slots)
        return ffd_fail_memory(s->error);
    memset(s->slots, 0xff, size * sizeof *s->slots);
    s->mask = size - 1;
    for (size_t f = 0; f < s->face_count; f++) {
        size_t count;
        const uint32_t *const corners = face_of(s, f, &count);
        TRY(ffd_deadline_check_at(f, s->error));
        uint32_t *const slot = find_slot(s, corners, count);
        if (*slot == NO_FACE)
            *slot = (uint32_t)f;
        else
            s->shared[*slot] = s->shared[f] = 1;
    }
    return FFD_OK;
}

static ffd_status find_faces(surface *s, const volume_cells *cells)
{
    for (size_t c = 0; c < cells->count && !s->status; c++) {
        size_t count;
        const uint32_t *const words = ffd_cell_words(cells, c, &count);
        TRY(ffd_deadline_check_at(c, s->error));
        if (ffd_cell_kind(cells->kinds[c])->dimension == 3)
            visit_volume(cells->kinds[c], words, count, add_face, s);
    }
    return s->status ? s->status : fill_table(s);
}

/* A visitor of faces that are cells, and what keeps sides of volumes from it. */
typedef struct flat_visitor {
    const surface *s;
    surface_visitor *visit;
    void *context;
} flat_visitor;

static void visit_unless_side(void *context, const uint32_t *corners, size_t count)
{
    const flat_visitor *const flat = context;
    if (count > 0 && (!flat->s->slots || *find_slot(flat->s, corners, count) == NO_FACE))
        flat->visit(flat->context, corners, count);
}

ffd_status ffd_surface_visit(const volume_cells *cells, const memory_budget *budget, surface_visitor *visit,
                             void *context, ffd_error *error)
{
    surface s = {.budget = budget, .error = error};
    flat_visitor flat = {&s, visit, context};
    ffd_status status = FFD_OK;
    if (cells->volumes)
        TRY_END(find_faces(&s, cells));
    for (size_t f = 0; f < s.face_count; f++) {
        size_t count;
        const uint32_t *const corners = face_of(&s, f, &count);
        if (!s.shared[f])
            visit(context, corners, count);
    }
    for (size_t c = 0; c < cells->count; c++) {
        size_t count;
        const uint32_t *const words = ffd_cell_words(cells, c, &count);
        TRY_END(ffd_deadline_check_at(c, error));
        if (ffd_cell_kind(cells->kinds[c])->dimension == 2)
            visit_flat(cells->kinds[c], words, count, visit_unless_side, &flat);
    }
end:
    ffd_free(s.ends);
    ffd_free(s.corners);
    ffd_free(s.shared);
    ffd_free(s.slots);
    return status;
}

ffd_status ffd_sides_visit(const volume_cells *cells, surface_visitor *visit, void *context, ffd_error *error)
{
    for (size_t c = 0; c < cells->count; c++) {
        size_t count;
        const uint32_t *const words = ffd_cell_words(cells, c, &count);
        const uint8_t dimension = ffd_cell_kind(cells->kinds[c])->dimension;
        TRY(ffd_deadline_check_at(c, error));
        if (dimension == 3)
            visit_volume(cells->kinds[c], words, count, visit, context);
        else if (dimension == 2)
            visit_flat(cells->kinds[c], words, count, visit, context);
    }
    return FFD_OK;
}
