/* gltf_morph_targets.c - further morph targets, and those in place of others, in the model. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_left_bytes.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/read/gltf_users.h"

/* An attribute of a morph target of a primitive. */
typedef struct morph_place {
    const gltf_primitive *primitive;
    size_t target;
    gltf_semantic semantic;
} morph_place;

/* Whether every selected use of the primitive has results. Where a use has none the old offsets stay, which
   is right only for a use that is not selected. */
static bool has_results(const gltf_document *d, const gltf_morph *morph, const morph_place *place)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, place->primitive);
    const size_t uses = d->mesh_uses[place->primitive->mesh].node_count;
    for (size_t n = 0; n < uses; n++) {
        const size_t part = instances[n].part[place->semantic];
        if (instances[n].selected &&
            (part == GLTF_NONE || !ffd_gltf_morph_result(morph, part, place->semantic)))
            return false;
    }
    return uses > 0;
}

/* Whether any node that shows the primitive is not selected: it keeps the old offsets. */
static bool is_partly_selected(const gltf_document *d, const gltf_primitive *primitive)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
    for (size_t n = 0; n < d->mesh_uses[primitive->mesh].node_count; n++)
        if (!instances[n].selected)
            return true;
    return false;
}

/* Whether the new offsets of an attribute can be stored in the old accessor. It must hold floats, only these
   offsets, in bytes of its own, and every selected use must have results. If some uses are not selected, they
   keep the old offsets, and the accessor may be shared: saving then gives the selected uses a new one. users:
   from ffd_gltf_count_users. */
static bool can_reuse(const gltf_document *d, const unsigned char *users, const morph_place *place,
                      const gltf_morph *morph)
{
    const gltf_primitive *const primitive = place->primitive;
    const int index = primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    if (index < 0)
        return false;
    const gltf_accessor *const accessor = &d->model.accessors[index];
    const gltf_layout *const layout = &d->layouts[index];
    const bool is_own = users[index] == 1 && !accessor->sparse.present && accessor->view >= 0 && layout->data;
    return accessor->component == GLTF_FLOAT && accessor->columns == 1 && accessor->rows == 3 &&
           (is_own || is_partly_selected(d, primitive)) &&
           accessor->count == d->model.accessors[primitive->accessor[place->semantic]].count &&
           layout->readable && layout->packing == GLTF_PLAIN && has_results(d, morph, place);
}

/* What accessors of zeros are for. Those of gaps are no others': equal targets would get equal results. */
enum { ZEROS_DIRECTIONS, ZEROS_POSITIONS, ZEROS_GAP, ZEROS_KINDS };

typedef struct morph_writer {
    gltf_edit *edit;
    const gltf_morph *morph;
    const mesh_log *log;
    unsigned char *users;       /* before the target, from ffd_gltf_count_users */
    size_t *zeros[ZEROS_KINDS]; /* per accessor: the new accessor with as many zeros (zeros_for) */
    bool loses;                 /* whether unselected nodes of the current mesh lose old offsets */
    bool replaces;              /* whether any mesh had a target of that name */
} morph_writer;

/* Returns the new accessor of zeros for the offsets of an accessor's elements. */
static size_t zeros_for(morph_writer *w, size_t accessor, int kind)
{
    size_t *const zeros = &w->zeros[kind][accessor];
    if (*zeros == GLTF_NONE)
        *zeros = ffd_gltf_add_zeros(w->edit, w->edit->document->model.accessors[accessor].count,
                                    kind != ZEROS_DIRECTIONS);
    return *zeros;
}

/* Returns the accessor for an attribute of a target: that of the replaced target if it can be reused. */
static size_t accessor_for(morph_writer *w, const morph_place *place)
{
    const gltf_primitive *const primitive = place->primitive;
    if (can_reuse(w->edit->document, w->users, place, w->morph))
        return (size_t)primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    return zeros_for(w, (size_t)primitive->accessor[place->semantic],
                     place->semantic == GLTF_POSITION ? ZEROS_POSITIONS : ZEROS_DIRECTIONS);
}

/* Sets the accessors of a target. It has normals and tangents only if these are deformed. Notes whether uses
   that are not selected have offsets, and lose them because the target gets another accessor. */
static void set_target(morph_writer *w, gltf_primitive *primitive, size_t target)
{
    const bool wanted[GLTF_DEFORMED] = {true, w->morph->normals,
                                        w->morph->normals && primitive->accessor[GLTF_NORMAL] >= 0};
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const morph_place place = {primitive, target, (gltf_semantic)s};
        const bool is_there = wanted[s] && primitive->accessor[s] >= 0;
        const size_t accessor = is_there ? accessor_for(w, &place) : GLTF_NONE;
        int *const held = &primitive->target_accessors[GLTF_DEFORMED * target + s];
        w->loses = w->loses || (*held >= 0 && (size_t)*held != accessor &&
                                is_partly_selected(w->edit->document, primitive));
        *held = accessor == GLTF_NONE ? -1 : (int)accessor;
    }
}

/* Takes the attributes that no deformation changes out of a target that is replaced. */
static void drop_others(const gltf_document *d, gltf_primitive *primitive, size_t target)
{
    const uint32_t targets = ffd_json_tree_member(&d->tree, primitive->value, "targets");
    const uint32_t object = ffd_json_tree_element(&d->tree, targets, target);
    for (uint32_t v = ffd_json_tree_first(&d->tree, object); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        const size_t accessor = ffd_gltf_index(d, v, d->model.accessor_count);
        size_t i = 0;
        while (i < primitive->target_attribute_count && (primitive->targets[i].semantic != GLTF_OTHER ||
                                                         (size_t)primitive->targets[i].accessor != accessor))
            i++;
        if (i < primitive->target_attribute_count)
            primitive->targets[i] = primitive->targets[--primitive->target_attribute_count];
    }
}

/* Adds empty targets up to this number. Returns false if memory runs out. */
static bool grow_targets(gltf_primitive *primitive, size_t count)
{
    const size_t before = GLTF_DEFORMED * primitive->target_count, after = GLTF_DEFORMED * count;
    int *const accessors = ffd_realloc(primitive->target_accessors, after, sizeof *accessors);
    if (!accessors)
        return false;
    for (size_t i = before; i < after; i++)
        accessors[i] = -1;
    primitive->target_accessors = accessors;
    primitive->target_count = count;
    return true;
}

static void add_to_primitive(morph_writer *w, gltf_primitive *primitive)
{
    const size_t place = w->morph->places[primitive->mesh], old = primitive->target_count;
    if (place < old)
        drop_others(w->edit->document, primitive, place);
    else if (!grow_targets(primitive, place + 1))
        w->edit->edits.failed = true;
    for (size_t t = old; t < place && !w->edit->edits.failed; t++)
        if (primitive->accessor[GLTF_POSITION] >= 0)
            primitive->target_accessors[GLTF_DEFORMED * t + GLTF_POSITION] =
                (int)zeros_for(w, (size_t)primitive->accessor[GLTF_POSITION], ZEROS_GAP);
    if (!w->edit->edits.failed)
        set_target(w, primitive, place);
}

static void log_replaced(const morph_writer *w, size_t mesh)
{
    size_t target, found;
    if (!ffd_gltf_find_target(w->edit->document, mesh, w->morph->name, &target, &found))
        w->edit->edits.failed = true;
    const char *const loses = w->loses ? ", and nodes that are not selected lose its offsets, too" : "";
    if (found > 1)
        ffd_log_line(w->log, FFD_LOG_WARNING,
                     "mesh %zu has %zu morph targets \"%s\" already: the first is replaced%s", mesh, found,
                     w->morph->name, loses);
    else
        ffd_log_line(w->log, FFD_LOG_WARNING, "mesh %zu has a morph target \"%s\" already: it is replaced%s",
                     mesh, w->morph->name, loses);
}

static void add_to_meshes(morph_writer *w)
{
    const gltf_document *const d = w->edit->document;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const gltf_mesh *const mesh = &d->model.meshes[m];
        gltf_mesh_uses *const uses = &d->mesh_uses[m];
        if (w->morph->places[m] == GLTF_NONE)
            continue;
        w->loses = false;
        for (size_t p = 0; p < mesh->primitive_count; p++)
            add_to_primitive(w, &mesh->primitives[p]);
        if (w->morph->places[m] < uses->target_count) {
            w->replaces = true;
            log_replaced(w, m);
        } else {
            if (!ffd_gltf_log_target_name(d, m, w->log))
                w->edit->edits.failed = true;
            uses->target_count++;
        }
    }
}

/* Memory for a target that fills a gap: its text, and what the model keeps of it. */
#define GAP_BYTES 200

/* Refuses more gaps than the memory budget holds: a short file may have any number. */
static ffd_status limit_gaps(const gltf_document *d, const gltf_morph *morph, ffd_error *error)
{
    uint64_t gaps = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        const size_t place = morph->places[primitive->mesh] == GLTF_NONE ? 0 : morph->places[primitive->mesh];
        gaps += primitive->target_count < place ? place - primitive->target_count : 0;
    }
    const ffd_status status = ffd_budget_check(&d->base.budget, gaps, GAP_BYTES, error);
    if (status)
        ffd_fail_name_file(error, d->name);
    return status;
}

ffd_status ffd_gltf_add_target(gltf_edit *edit, const gltf_morph *morph, const mesh_log *log,
                               ffd_error *error)
{
    const gltf_document *const d = edit->document;
    const size_t count = d->model.accessor_count;
    morph_writer w = {.edit = edit, .morph = morph, .log = log};
    TRY(limit_gaps(d, morph, error));
    w.users = ffd_gltf_count_users(d, NULL);
    edit->any = true;
    edit->edits.failed = edit->edits.failed || !w.users;
    for (int i = 0; i < ZEROS_KINDS; i++) {
        w.zeros[i] = ffd_alloc(count, sizeof *w.zeros[i]);
        edit->edits.failed = edit->edits.failed || !w.zeros[i];
        for (size_t a = 0; w.zeros[i] && a < count; a++)
            w.zeros[i][a] = GLTF_NONE;
    }
    if (!edit->edits.failed)
        add_to_meshes(&w);
    ffd_status status;
    TRY_END(edit->edits.failed ? ffd_fail_memory(error) : FFD_OK);
    if (w.replaces)
        TRY_END(ffd_gltf_warn_of_left(d, w.users, count, morph->name, log, &edit->bytes_left, error));
end:
    ffd_free(w.users);
    for (int i = 0; i < ZEROS_KINDS; i++)
        ffd_free(w.zeros[i]);
    return status;
}
