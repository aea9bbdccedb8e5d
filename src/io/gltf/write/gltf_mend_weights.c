/* gltf_mend_weights.c - skin weights that are written decompressed. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_saver.h"
#include <math.h>
#include <string.h>

#define SEVERAL (GLTF_NONE - 1)
#define MOST_SETS ((size_t)16) /* as in gltf_skin.c, which refuses more */

/* Sums of floats that differ less from 1 are taken as they are. */
#define SUM_ROUNDING 1e-7

/* A list of four joints or weights per vertex. */
typedef struct influence_list {
    const gltf_accessor *accessor;
    const unsigned char *data; /* of the first element */
    unsigned char *copy;       /* the same in bytes that are written; NULL: they are not written anew */
    size_t stride;
} influence_list;

/* The joints and weights of a primitive, and those of one vertex. */
typedef struct influences {
    influence_list joints[MOST_SETS], weights[MOST_SETS];
    size_t set_count;
    double joint[4 * MOST_SETS], weight[4 * MOST_SETS];
} influences;

typedef struct mending {
    gltf_saver *saver;
    memory_budget budget;
    size_t *partner; /* per accessor: the one with the weights of its joints, or the other way round */
    bool *done;      /* per accessor: whether its weights are mended */
    size_t mended;   /* number of vertices */
    ffd_error *error;
} mending;

/* Returns what an accessor's elements are written decompressed in; GLTF_NONE: they are not. *begin: the
   offset of the first one in its bytes. */
static size_t unpacking_of(const gltf_saver *saver, size_t a, size_t *begin)
{
    const gltf_document *const d = saver->document;
    const gltf_layout *const layout = &d->layouts[a];
    *begin = 0;
    if (layout->packing == GLTF_DRACO)
        return saver->accessor_unpackings[a];
    if (layout->packing != GLTF_MESHOPT || d->model.accessors[a].sparse.present)
        return GLTF_NONE;
    const size_t view = (size_t)d->model.accessors[a].view;
    *begin = layout->begin - (size_t)d->model.views[view].offset;
    return saver->view_unpackings[view];
}

/* Describes the elements of an accessor, and copies the bytes that hold them if they are written
   decompressed. */
static ffd_status open_list(mending *m, size_t a, influence_list *list)
{
    const gltf_document *const d = m->saver->document;
    size_t begin;
    const size_t index = unpacking_of(m->saver, a, &begin);
    *list = (influence_list){&d->model.accessors[a], d->layouts[a].data, NULL, d->layouts[a].stride};
    if (index == GLTF_NONE)
        return FFD_OK;
    gltf_unpacking *const unpacking = &m->saver->unpackings[index];
    if (!unpacking->own) {
        TRY(ffd_budget_take(&m->budget, unpacking->size, 1, m->error));
        unpacking->own = ffd_alloc(unpacking->size, 1);
        if (!unpacking->own)
            return ffd_fail_memory(m->error);
        memcpy(unpacking->own, unpacking->bytes, unpacking->size);
        unpacking->bytes = unpacking->own;
    }
    list->copy = unpacking->own + begin;
    list->data = list->copy;
    return FFD_OK;
}

static void read_four(const influence_list *list, size_t vertex, double values[4])
{
    const size_t size = ffd_gltf_component_size(list->accessor->component);
    for (size_t c = 0; c < 4; c++)
        values[c] = list->data ? ffd_gltf_read_number(list->data + vertex * list->stride + c * size,
                                                      list->accessor->component, list->accessor->normalized)
                               : 0;
}

static void write_four(const influence_list *list, size_t vertex, const double values[4])
{
    unsigned char encoded[GLTF_LARGEST_ELEMENT], *const element = list->copy + vertex * list->stride;
    const size_t size = ffd_gltf_component_size(list->accessor->component);
    float numbers[4];
    for (size_t c = 0; c < 4; c++)
        numbers[c] = (float)values[c];
    ffd_gltf_encode(list->accessor, list->accessor->component, element, numbers, 4, encoded);
    memcpy(element, encoded, 4 * size);
}

/* Adds the second weight of a joint to the first, and gives weights of 0 the joint 0. Returns whether
   anything changes. */
static bool join_weights(influences *of)
{
    const size_t count = 4 * of->set_count;
    bool changes = false;
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < i && of->weight[i] > 0; k++)
            if (of->weight[k] > 0 && !(of->joint[k] < of->joint[i]) && !(of->joint[k] > of->joint[i])) {
                of->weight[k] += of->weight[i];
                of->weight[i] = 0;
                changes = true;
            }
        if (!(of->weight[i] > 0) && (of->weight[i] < 0 || of->joint[i] > 0)) {
            of->weight[i] = of->joint[i] = 0;
            changes = true;
        }
    }
    return changes;
}

static double sum_of(const influences *of)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * of->set_count; i++)
        sum += of->weight[i];
    return sum;
}

/* Whether the sum is 1 as validators judge it: integers exactly, floats up to rounding. */
static bool is_whole(const influences *of, double sum)
{
    const double steps = ffd_gltf_step(of->weights[0].accessor);
    return of->weights[0].accessor->component == GLTF_FLOAT ? fabs(sum - 1) <= SUM_ROUNDING
                                                            : fabs(sum - 1) < steps / 2;
}

/* Divides the weights by their sum, rounded to the numbers of the file. What rounding leaves goes to the
   largest one. */
static void divide_weights(influences *of, double sum)
{
    const size_t count = 4 * of->set_count;
    size_t largest = 0;
    double rest = 1;
    for (size_t i = 0; i < count; i++) {
        of->weight[i] = (double)ffd_gltf_round(of->weights[i / 4].accessor, of->weight[i] / sum);
        largest = of->weight[i] > of->weight[largest] ? i : largest;
    }
    for (size_t i = 0; i < count; i++)
        rest -= i == largest ? 0 : of->weight[i];
    of->weight[largest] = (double)ffd_gltf_round(of->weights[largest / 4].accessor, rest);
}

/* Mends a vertex. Returns whether it changes. A vertex without weights follows its first joint. */
static bool mend_vertex(influences *of, size_t vertex)
{
    for (size_t s = 0; s < of->set_count; s++) {
        read_four(&of->joints[s], vertex, of->joint + 4 * s);
        read_four(&of->weights[s], vertex, of->weight + 4 * s);
    }
    const double first = of->joint[0], before = sum_of(of);
    if (!isfinite(before))
        return false;
    bool changes = join_weights(of);
    const double sum = sum_of(of);
    if (!(sum > 0)) {
        of->joint[0] = first;
        of->weight[0] = 1;
        changes = true;
    } else if (!is_whole(of, sum)) {
        divide_weights(of, sum);
        join_weights(of); /* a weight may have become 0 */
        changes = true;
    }
    for (size_t s = 0; s < of->set_count && changes; s++) {
        write_four(&of->joints[s], vertex, of->joint + 4 * s);
        write_four(&of->weights[s], vertex, of->weight + 4 * s);
    }
    return changes;
}

static void note_partner(mending *m, int64_t a, int64_t other)
{
    size_t *const partner = &m->partner[a];
    *partner = *partner == GLTF_NONE || *partner == (size_t)other ? (size_t)other : SEVERAL;
}

/* Notes what joints and weights belong together. Where joints have several weights, none is mended. */
static void note_partners(mending *m, const gltf_primitive *primitive)
{
    for (size_t s = 0; s < primitive->influence_count; s++) {
        const gltf_influence *const set = &primitive->influences[s];
        if (set->joints < 0 || set->weights < 0)
            continue;
        note_partner(m, set->joints, set->weights);
        note_partner(m, set->weights, set->joints);
    }
}

/* Whether a set is written decompressed, so that it can change, and is not mended yet. */
static bool set_mends(const mending *m, const gltf_influence *set)
{
    size_t begin;
    return set->joints >= 0 && set->weights >= 0 && m->partner[set->joints] == (size_t)set->weights &&
           m->partner[set->weights] == (size_t)set->joints && !m->done[set->weights] &&
           unpacking_of(m->saver, (size_t)set->joints, &begin) != GLTF_NONE &&
           unpacking_of(m->saver, (size_t)set->weights, &begin) != GLTF_NONE;
}

/* Opens the sets of a primitive. *mends: whether all are written decompressed, so that they can change. */
static ffd_status open_sets(mending *m, const gltf_primitive *primitive, influences *of, bool *mends)
{
    of->set_count = primitive->influence_count <= MOST_SETS ? primitive->influence_count : 0;
    *mends = of->set_count > 0;
    for (size_t s = 0; s < of->set_count && *mends; s++)
        *mends = set_mends(m, &primitive->influences[s]);
    for (size_t s = 0; s < of->set_count && *mends; s++) {
        TRY(open_list(m, (size_t)primitive->influences[s].joints, &of->joints[s]));
        TRY(open_list(m, (size_t)primitive->influences[s].weights, &of->weights[s]));
        m->done[primitive->influences[s].weights] = true;
    }
    return FFD_OK;
}

static ffd_status mend_primitive(mending *m, const gltf_primitive *primitive)
{
    influences of;
    bool mends;
    TRY(open_sets(m, primitive, &of, &mends));
    if (!mends)
        return FFD_OK;
    for (size_t v = 0; v < of.weights[0].accessor->count; v++)
        m->mended += mend_vertex(&of, v);
    return FFD_OK;
}

ffd_status ffd_gltf_mend_weights(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *const d = saver->document;
    mending m = {.saver = saver, .budget = d->base.budget, .error = error};
    if (saver->unpacking_count == 0 || d->skin_values.count == 0)
        return FFD_OK;
    const size_t count = d->model.accessor_count;
    m.done = ffd_alloc_zero(count, sizeof *m.done);
    m.partner = ffd_alloc(count, sizeof *m.partner);
    ffd_status status;
    TRY_END(m.done && m.partner ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++)
        m.partner[i] = GLTF_NONE;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        note_partners(&m, &d->model.primitives[i]);
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY_END(mend_primitive(&m, &d->model.primitives[i]));
    if (m.mended > 0)
        ffd_log_line(saver->log, FFD_LOG_INFO,
                     "the skin weights of %zu %s, which were compressed, are written so that they sum to 1",
                     m.mended, ffd_plural(m.mended, "vertex", "vertices"));
end:
    ffd_free(m.partner);
    ffd_free(m.done);
    return status;
}
