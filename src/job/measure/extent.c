#include "job/measure/extent.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

/* A compensated sum (A. Neumaier, Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen,
   1974). */
typedef struct exact_sum {
    double sum, lost;
} exact_sum;

static void add(exact_sum *s, double value)
{
    const double sum = s->sum + value;
    s->lost += fabs(s->sum) >= fabs(value) ? (s->sum - sum) + value : (value - sum) + s->sum;
    s->sum = sum;
}

static double total(const exact_sum *s)
{
    return s->sum + s->lost;
}

typedef struct extent_work {
    const mesh_document *document;
    const double *rest, *xyz;
    size_t part, first, end; /* part of the last vertex looked up, and its vertices [first, end) */
    const double *origin;    /* a vertex relative to which volumes are computed; NULL before the first face */
    double scale;            /* of the positions, a power of 2 */
    double largest;          /* the largest finite coordinate */
    exact_sum area, volume;
    uint64_t border; /* sum of edge hashes; 0 if the mesh is closed */
} extent_work;

/* Called for each face that is not hidden. */
typedef void face_visit(extent_work *work, const uint32_t *corners, size_t count);

static const double *position(const extent_work *work, uint32_t vertex)
{
    const double *const xyz = work->xyz + 3 * (size_t)vertex;
    return isnan(xyz[0]) ? work->rest + 3 * (size_t)vertex : xyz;
}

/* Finds the part of a vertex. Resumes at the last part, as faces mostly come part by part. */
static void find_part(extent_work *work, uint32_t vertex)
{
    const mesh_document *const document = work->document;
    if (vertex < work->first)
        work->part = work->first = work->end = 0;
    while (vertex >= work->end && work->part < document->part_count) {
        const mesh_part *const part = &document->parts[work->part++];
        work->first = work->end;
        work->end += part->repeats_positions ? 0 : part->vertex_count;
    }
}

static bool is_hidden(extent_work *work, uint32_t vertex)
{
    if (!work->document)
        return false;
    if (vertex < work->first || vertex >= work->end)
        find_part(work, vertex);
    return work->document->parts[work->part - 1].hidden;
}

/* A bijective mix (D. Stafford's variant 13 of the finalizer of MurmurHash3). */
static uint64_t mix(uint64_t value)
{
    value = (value ^ value >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    value = (value ^ value >> 27) * UINT64_C(0x94d049bb133111eb);
    return value ^ value >> 31;
}

/* Folds the upper bits into the lower ones, which are 0 in short numbers: multiplication carries bits upwards
   only. */
static uint64_t spread(double number, uint64_t factor)
{
    uint64_t bits;
    number += 0.0; /* makes -0 equal to 0 */
    memcpy(&bits, &number, sizeof bits);
    return (bits ^ bits >> 32) * factor;
}

static uint64_t hash_of(const double p[3])
{
    return mix(spread(p[0], UINT64_C(0x9e3779b97f4a7c15)) + spread(p[1], UINT64_C(0xc2b2ae3d27d4eb4f)) +
               spread(p[2], UINT64_C(0xd6e8feb86659fd93)));
}

/* Hash of a directed edge. The opposite direction has the negative hash. */
static uint64_t edge_hash(uint64_t from, uint64_t to)
{
    if (from == to)
        return 0;
    const uint64_t low = from < to ? from : to, high = from < to ? to : from;
    const uint64_t hash = mix(low + high * UINT64_C(0x9fb21c651e98df25));
    return from < to ? hash : 0 - hash;
}

/* Adds the area and volume of a face, and the hashes of its edges. normal: twice the vector area. */
static void measure_face(extent_work *work, const uint32_t *corners, size_t count)
{
    const double *const p = position(work, corners[0]);
    double before[3] = {0}, after[3], normal[3] = {0}, from_origin[3];
    const uint64_t first = hash_of(p);
    uint64_t last = first;
    for (size_t c = 1; c < count; c++) {
        const double *const q = position(work, corners[c]);
        const uint64_t hash = hash_of(q);
        for (int a = 0; a < 3; a++)
            after[a] = q[a] * work->scale - p[a] * work->scale;
        normal[0] += before[1] * after[2] - before[2] * after[1];
        normal[1] += before[2] * after[0] - before[0] * after[2];
        normal[2] += before[0] * after[1] - before[1] * after[0];
        memcpy(before, after, sizeof before);
        work->border += edge_hash(last, hash);
        last = hash;
    }
    work->border += edge_hash(last, first);
    if (!work->origin)
        work->origin = p;
    for (int a = 0; a < 3; a++)
        from_origin[a] = p[a] * work->scale - work->origin[a] * work->scale;
    add(&work->area, vec_length(normal) / 2);
    add(&work->volume, vec_dot(from_origin, normal) / 6);
}

static void find_largest(extent_work *work, const uint32_t *corners, size_t count)
{
    for (size_t c = 0; c < count; c++) {
        const double *const p = position(work, corners[c]);
        for (int a = 0; a < 3; a++)
            if (isfinite(p[a]))
                work->largest = maximum_number(work->largest, fabs(p[a]));
    }
}

static void visit_faces(extent_work *work, const mesh_faces *faces, face_visit *visit)
{
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t count = faces->start[f + 1] - faces->start[f];
        if (count > 0 && !is_hidden(work, corners[0]))
            visit(work, corners, count);
    }
}

/* Takes the sums again with coordinates of at most 1, so that they do not overflow. Returns e: the lengths
   are to be multiplied by 2^e. */
static int measure_scaled(extent_work *work, const mesh_faces *faces)
{
    int exponent;
    visit_faces(work, faces, find_largest);
    frexp(work->largest, &exponent);
    work->scale = ldexp(1, -exponent);
    work->area = work->volume = (exact_sum){0};
    visit_faces(work, faces, measure_face);
    return exponent;
}

/* Returns a sum times 2^exponent: infinite if that is too large for a double, NaN if one of the positions is
   not finite. */
static double unscaled(const exact_sum *sum, int exponent)
{
    const double value = total(sum);
    return isfinite(value) ? ldexp(value, exponent) : NAN;
}

void ffd_extent_measure(const mesh_document *document, const mesh_faces *faces, const double *xyz,
                        mesh_extent *extent)
{
    extent_work work = {.document = document, .rest = faces->positions, .xyz = xyz, .scale = 1};
    visit_faces(&work, faces, measure_face);
    const bool is_closed = work.origin && work.border == 0;
    const bool overflows = !isfinite(total(&work.area)) || !isfinite(total(&work.volume));
    const int exponent = overflows ? measure_scaled(&work, faces) : 0;
    extent->area = unscaled(&work.area, 2 * exponent);
    extent->volume = is_closed ? unscaled(&work.volume, 3 * exponent) : NAN;
}
