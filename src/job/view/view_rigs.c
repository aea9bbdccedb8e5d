/* view_rigs.c - the animations of a view: skeletons and keys of the mesh before and after. */
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "job/view/view.h"
#include "mesh/rig.h"
#include "view/view_pose.h"
#include <stdio.h>
#include <string.h>

#define SHOWN 8 /* the most names in a message */
#define NAME 36 /* bytes of each, at most */

/* Returns the name of an animation. An unnamed one is called, and chosen as, "animation 3". */
static char *name_of(const mesh_skeleton *skeleton, size_t animation)
{
    const char *const name = skeleton->animations[animation].name;
    byte_buffer text = {0};
    if (name && *name)
        ffd_buffer_text(&text, name);
    else
        ffd_buffer_format(&text, "animation %zu", animation);
    return ffd_buffer_finish(&text);
}

static ffd_status read_skeleton(mesh_document *document, bool after, view_rig *rig, ffd_error *error)
{
    const mesh_format *const format = document->format;
    return format->rig ? format->rig->read_skeleton(document, after, &rig->skeleton, error) : FFD_OK;
}

static ffd_status list_animations(view_scene *scene, ffd_error *error)
{
    const mesh_skeleton *const from = scene->rigs[0].skeleton;
    const size_t count = from ? from->animation_count : 0;
    scene->animations = ffd_alloc_zero(count, sizeof *scene->animations);
    if (!scene->animations)
        return ffd_fail_memory(error);
    for (size_t a = 0; a < count; a++) {
        view_animation *const to = &scene->animations[scene->animation_count++];
        *to = (view_animation){.name = name_of(from, a), .of = {a, a}};
        if (!to->name)
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

/* Writes: "a", "b", "c" and 4 more */
static void write_names(const view_scene *scene, char *text, size_t capacity)
{
    size_t length = 0;
    for (size_t a = 0; a < scene->animation_count && a < SHOWN; a++) {
        char name[NAME];
        ffd_name_shown(scene->animations[a].name, name, sizeof name);
        length += (size_t)snprintf(text + length, capacity - length, "%s\"%s\"", a > 0 ? ", " : "", name);
    }
    if (scene->animation_count > SHOWN)
        snprintf(text + length, capacity - length, " and %zu more", scene->animation_count - SHOWN);
}

static ffd_status refuse_name(const view_rigs_desc *desc, const view_scene *scene, ffd_error *error)
{
    char names[SHOWN * (NAME + 4) + 40], wanted[NAME], shown[NAME] = "";
    nearest_word nearest = {.word = desc->animation, .length = strlen(desc->animation)};
    if (scene->animation_count == 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, desc->before_name,
                             "{animation}: there are no animations that can be shown");
    for (size_t a = 0; a < scene->animation_count; a++)
        ffd_nearest_offer(&nearest, scene->animations[a].name);
    ffd_name_shown(desc->animation, wanted, sizeof wanted);
    ffd_name_shown(nearest.best, shown, sizeof shown);
    write_names(scene, names, sizeof names);
    return ffd_fail_file(error, FFD_E_ARGUMENT, desc->before_name,
                         "{animation}: none is called \"%s\" (nearest: \"%s\"; there %s %s)", wanted, shown,
                         ffd_plural(scene->animation_count, "is", "are"), names);
}

/* Chooses the wanted animation: the first one of its name. */
static ffd_status choose(const view_rigs_desc *desc, view_scene *scene, ffd_error *error)
{
    size_t alike = 0;
    scene->animation = RIG_NONE;
    for (size_t a = 0; a < scene->animation_count && desc->animation; a++) {
        if (strcmp(scene->animations[a].name, desc->animation) != 0)
            continue;
        scene->animation = alike ? scene->animation : a;
        alike++;
    }
    if (desc->animation && !alike)
        return refuse_name(desc, scene, error);
    if (alike > 1)
        ffd_log_line(desc->log, FFD_LOG_WARNING, "{animation}: %zu have this name, and the first is shown",
                     alike);
    return FFD_OK;
}

/* Interns the names of a skeleton's animations. first: of each name the first animation. */
static ffd_status intern_names(const mesh_skeleton *skeleton, intern_table *names, size_t *first,
                               ffd_error *error)
{
    for (size_t a = 0; a < skeleton->animation_count; a++) {
        const char *const name = skeleton->animations[a].name ? skeleton->animations[a].name : "";
        const size_t known = names->count;
        uint32_t index;
        if (!ffd_intern(names, name, strlen(name), &index))
            return ffd_fail_memory(error);
        if (index == known)
            first[index] = a;
    }
    return FFD_OK;
}

static bool has_name(const rig_animation *animation, const char *name)
{
    return strcmp(animation->name ? animation->name : "", name) == 0;
}

/* Matches the animations of the deformed file by name: the one of the same number if it has the name, else
   the first of that name. Unnamed animations match by number. */
static ffd_status match(const view_scene *scene, ffd_error *error)
{
    const mesh_skeleton *const own = scene->rigs[0].skeleton, *const other = scene->rigs[1].skeleton;
    const size_t count = other ? other->animation_count : 0;
    intern_table names = {0};
    size_t *const first = ffd_alloc(count, sizeof *first);
    ffd_status status;
    TRY_END(!first ? ffd_fail_memory(error) : other ? intern_names(other, &names, first, error) : FFD_OK);
    for (size_t a = 0; a < scene->animation_count; a++) {
        const char *const name = own->animations[a].name ? own->animations[a].name : "";
        size_t *const of = &scene->animations[a].of[1];
        uint32_t index;
        *of = RIG_NONE;
        if (a < count && has_name(&other->animations[a], name))
            *of = a;
        else if (*name && ffd_intern_find(&names, name, strlen(name), &index))
            *of = first[index];
    }
end:
    ffd_intern_free(&names);
    ffd_free(first);
    return status;
}

static bool is_wanted(const view_rigs_desc *desc, const view_scene *scene, size_t animation)
{
    return desc->all || animation == scene->animation;
}

/* Loads the keys of an animation on one side. An invalid one that was not asked for is left out. */
static ffd_status load(const view_rigs_desc *desc, view_scene *scene, int side, size_t animation,
                       ffd_error *error)
{
    mesh_skeleton *const skeleton = scene->rigs[side].skeleton;
    size_t *const of = &scene->animations[animation].of[side];
    ffd_error own = {0};
    if (!skeleton || *of == RIG_NONE)
        return FFD_OK;
    const ffd_status status = skeleton->load(skeleton, *of, &own);
    const bool is_broken = status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED;
    if (is_broken && animation != scene->animation) {
        char name[NAME];
        ffd_name_shown(scene->animations[animation].name, name, sizeof name);
        ffd_log_line(desc->log, FFD_LOG_WARNING, "the animation \"%s\" is left out: %s: %s", name,
                     own.pointer, own.message);
        *of = RIG_NONE;
        return FFD_OK;
    }
    if (status && error)
        *error = own;
    return status;
}

static ffd_status load_all(const view_rigs_desc *desc, view_scene *scene, ffd_error *error)
{
    for (size_t a = 0; a < scene->animation_count; a++) {
        if (!is_wanted(desc, scene, a))
            continue;
        TRY(load(desc, scene, 0, a, error));
        if (scene->rigs[1].skeleton != scene->rigs[0].skeleton)
            TRY(load(desc, scene, 1, a, error));
        if (scene->rigs[1].skeleton == scene->rigs[0].skeleton)
            scene->animations[a].of[1] = scene->animations[a].of[0];
    }
    return FFD_OK;
}

static ffd_status read_anchors(const view_rigs_desc *desc, mesh_document *document, bool after, view_rig *rig,
                               ffd_error *error)
{
    if (!rig->skeleton || !rig->skeleton->starts)
        return FFD_OK;
    return document->format->rig->read_anchors(rig->skeleton, desc->state, after, &rig->anchors, error);
}

/* A job that deforms the shape with default weights has no deformed targets. Transform their offsets by the
   gradient: to first order, and exact where the deformation is affine. */
static void turn_offsets(const view_rigs_desc *desc, mesh_anchors *anchors)
{
    for (size_t t = 0; t < anchors->target_count && anchors->keeps_offsets && desc->gradients; t++)
        for (size_t i = 0; i < anchors->targets[t].count; i++) {
            const double *const g = desc->gradients + 9 * (anchors->targets[t].first + i);
            double *const offset = anchors->targets[t].offsets + 3 * i, by[3];
            mat_apply(g, offset, by);
            for (int a = 0; a < 3; a++)
                offset[a] += isfinite(by[a]) ? by[a] : 0;
        }
}

/* Adds to the anchors after what the shape has beside that before, which goes back through the pose at rest.
   A vertex whose bones have no inverse stays. */
static ffd_status shift_anchors(const view_rigs_desc *desc, view_rig *rig, ffd_error *error)
{
    mesh_skeleton *const s = rig->skeleton;
    double *const matrices = ffd_view_rest_matrices(s, error);
    if (!matrices)
        return FFD_E_MEMORY;
    for (size_t v = 0; v < s->vertex_count; v++) {
        double inverse[9], by[3];
        if (!mat_invert(matrices + 9 * v, inverse))
            continue;
        mat_apply(inverse, desc->shift + 3 * v, by);
        for (size_t a = 0; a < 3; a++)
            rig->anchors.points[3 * v + a] += by[a];
    }
    ffd_free(matrices);
    return FFD_OK;
}

/* Warns of parts of the shown animations that are left out. */
static void warn(const view_rigs_desc *desc, const view_scene *scene)
{
    size_t left = 0, unmatched = 0;
    for (size_t a = 0; a < scene->animation_count; a++) {
        if (!is_wanted(desc, scene, a) || scene->animations[a].of[0] == RIG_NONE)
            continue;
        left += scene->rigs[0].skeleton->animations[scene->animations[a].of[0]].left;
        unmatched += scene->rigs[1].skeleton != scene->rigs[0].skeleton && desc->after &&
                     scene->animations[a].of[1] == RIG_NONE;
    }
    if (left)
        ffd_log_line(
            desc->log, FFD_LOG_WARNING,
            "not played: %zu %s no translation, rotation, scale or weight for each morph target of a "
            "node that is there",
            left, ffd_plural(left, "channel that drives", "channels that drive"));
    if (unmatched)
        ffd_log_line(desc->log, FFD_LOG_WARNING, "%s lacks %zu of the animations: it stands still there",
                     desc->after_name, unmatched);
    if (scene->rigs[1].anchors.keeps_offsets)
        ffd_log_line(
            desc->log, FFD_LOG_WARNING,
            "after: animated morph targets are turned by the gradient of the deformation, which is exact to "
            "first order only: default weights are shown");
}

static ffd_status make_both(const view_rigs_desc *desc, view_scene *scene, ffd_error *error)
{
    view_rig *const before = &scene->rigs[0], *const after = &scene->rigs[1];
    TRY(read_skeleton(desc->before, false, before, error));
    if (desc->after || desc->follows)
        TRY(read_skeleton(desc->after ? desc->after : desc->before, desc->follows, after, error));
    else
        after->skeleton = before->skeleton;
    TRY(list_animations(scene, error));
    TRY(choose(desc, scene, error));
    if (desc->after || desc->follows)
        TRY(match(scene, error));
    TRY(load_all(desc, scene, error));
    TRY(read_anchors(desc, desc->before, false, before, error));
    if (desc->after || desc->deformed || desc->shift)
        TRY(read_anchors(desc, desc->after ? desc->after : desc->before, desc->deformed, after, error));
    if (desc->shift && after->anchors.points)
        TRY(shift_anchors(desc, after, error));
    turn_offsets(desc, &after->anchors);
    warn(desc, scene);
    return FFD_OK;
}

/* Animations that nobody asked for do not make the view fail at a limit. */
ffd_status ffd_view_make_rigs(const view_rigs_desc *desc, view_scene *scene, ffd_error *error)
{
    ffd_error own = {0};
    scene->animation = RIG_NONE;
    if (!desc->all && !desc->animation)
        return FFD_OK;
    const ffd_status status = make_both(desc, scene, &own);
    if (status == FFD_E_LIMIT && !desc->animation) {
        ffd_log_line(desc->log, FFD_LOG_WARNING, "the animations are left out: %s", own.message);
        ffd_view_scene_free_rigs(scene);
        return FFD_OK;
    }
    if (status && error)
        *error = own;
    if (status && error)
        ffd_fail_name_file(error, desc->before_name);
    return status;
}
