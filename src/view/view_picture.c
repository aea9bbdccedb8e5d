#include "view/view_picture.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "mesh/bounds.h"
#include "mesh/twins.h"
#include "picture/image/image.h"
#include "view/view_cages.h"
#include "view/view_dots.h"
#include "view/view_fit.h"
#include "view/view_ground.h"
#include "view/view_palette.h"
#include "view/view_pose.h"
#include "view/view_surface.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Bytes per vertex: position and colour; and of a mesh with points: its colour, number and splat. */
#define VERTEX_BYTES (3 * sizeof(double) + 4)
#define DOT_BYTES (4 + sizeof(uint32_t) + 6 * sizeof(float))
/* Bytes per triangle: a material index. */
#define TRIANGLE_BYTES 4
/* Meshes in a panel: the ordinary triangles, and the flipped ones if there are any. */
#define MESHES 2

/* Size of a caption in bytes. */
#define CAPTION 40

/* One step from before to after, or one pose of an animation. */
typedef struct step {
    double share; /* of the way from before (0) to after (1) */
    double *positions;
    bool owns_positions;
    uint8_t *colors;
    picture_mesh meshes[MESHES];
    view_cages cages;
    view_dots dots;
} step;

typedef struct picture_work {
    const view_scene *scene;
    const view_picture_options *options;
    memory_budget budget; /* what is left of that of the options: all that is held is taken from it */
    view_palette palette;
    view_surface surface;
    uint8_t *used;           /* of each vertex: whether an element uses it; NULL: all are used */
    uint8_t *framed;         /* of each vertex: whether the camera has to show it; NULL: as `used` */
    uint32_t *twins, *white; /* white: a material index of 0 for each triangle that a palette colours */
    step step;               /* the one being drawn */
    picture_panel *panels;
    char (*captions)[CAPTION]; /* one for each panel */
    size_t step_count;
    camera camera;
    view_frame frame; /* of the scene, or that of the options */
    ffd_bounds seen;  /* bounds along the camera's axes */
    double ground[3 * GROUND_CORNERS];
    bool has_ground;
    picture_mark marks[PALETTE_MARKS];
    size_t mark_count;
    ffd_error *error;
} picture_work;

/* Folded volume has an alpha of 0. */
static const picture_material white_material = {
    .color = {1, 1, 1, 1}, .is_double_sided = true, .stripes = STRIPES_FALLING};

static uint32_t width_of(const view_picture_options *options)
{
    return options->width ? options->width : VIEW_PICTURE_WIDTH;
}

static uint32_t height_of(const view_picture_options *options)
{
    return options->height ? options->height : VIEW_PICTURE_HEIGHT;
}

ffd_status ffd_view_picture_check(const view_picture_options *options, ffd_error *error)
{
    const uint32_t width = width_of(options), frames = options->frames;
    const uint64_t height = (uint64_t)height_of(options) * (options->rows ? options->rows : 1);
    const uint64_t all = (uint64_t)width * (frames ? frames : 1);
    if (frames == 1 || frames > VIEW_FRAMES)
        return ffd_fail(error, FFD_E_ARGUMENT, "%u frames are not possible: 2 to %d are", (unsigned)frames,
                        VIEW_FRAMES);
    if (all > PICTURE_MOST_SIDE || height > PICTURE_MOST_SIDE || all * height > PICTURE_MOST_PIXELS)
        return ffd_fail(
            error, FFD_E_ARGUMENT,
            "a picture of %llu x %llu pixels is not possible: %d is the longest side, %llu the most "
            "pixels",
            (unsigned long long)all, (unsigned long long)height, PICTURE_MOST_SIDE,
            (unsigned long long)PICTURE_MOST_PIXELS);
    return FFD_OK;
}

/* A mesh without a deformation has a single step. */
static size_t count_steps(const view_scene *scene, const view_picture_options *options)
{
    if (options->frames)
        return options->frames * (options->rows ? options->rows : 1);
    return scene->statuses || scene->output || scene->cage_count ? 2 : 1;
}

/* Marks the vertices that an element uses: the camera need not show the others. *used stays NULL if all are
   used. */
static ffd_status find_used(const view_scene *scene, uint8_t **used, ffd_error *error)
{
    const struct {
        const uint32_t *list;
        size_t count;
    } uses[] = {{scene->triangles, 3 * scene->triangle_count},
                {scene->segments, 2 * scene->segment_count},
                {scene->points, scene->point_count}};
    size_t found = 0;
    uint8_t *const marks = ffd_alloc_zero(scene->vertex_count, 1);
    if (!marks)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
        for (size_t i = 0; i < uses[k].count; i++) {
            found += !marks[uses[k].list[i]];
            marks[uses[k].list[i]] = 1;
        }
    if (found > 0 && found < scene->vertex_count)
        *used = marks;
    else
        ffd_free(marks);
    return FFD_OK;
}

static bool is_finite(const double *p)
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

/* Logs the triangles that are not drawn (each picture leaves out those with a vertex that is not finite) and
   the torn edges that are not marked. */
static void log_omissions(const picture_work *w)
{
    const view_scene *const scene = w->scene;
    size_t lost = 0;
    for (size_t t = 0; t < scene->triangle_count; t++) {
        bool finite = true;
        for (size_t c = 0; c < 3 && finite; c++) {
            const size_t at = 3 * (size_t)scene->triangles[3 * t + c];
            finite = is_finite(scene->before + at) && is_finite(scene->after + at);
        }
        lost += !finite;
    }
    if (lost)
        ffd_log_line(w->options->log, FFD_LOG_WARNING,
                     "the picture: %zu %s not drawn where a vertex is not finite", lost,
                     ffd_plural(lost, "triangle is", "triangles are"));
    if (scene->tear_edges > scene->tear_count)
        ffd_log_line(w->options->log, FFD_LOG_WARNING,
                     "the picture: %zu of %" PRIu64 " torn edges are marked, those with the largest steps",
                     scene->tear_count, scene->tear_edges);
}

/* Returns the time that a panel shows. The panels of a row go from the first key to the last. */
static double time_of(const picture_work *w, size_t index)
{
    const view_scene *const scene = w->scene;
    const size_t count = w->options->frames, i = index % count;
    const rig_animation *const of =
        &scene->rigs[0].skeleton->animations[scene->animations[scene->animation].of[0]];
    return i + 1 == count ? of->end : of->begin + (of->end - of->begin) * (double)i / (double)(count - 1);
}

/* Computes the pose of a panel: the first row is the mesh before, the second the mesh after. */
static ffd_status pose(picture_work *w, size_t index, step *s)
{
    const int side = index < w->options->frames ? 0 : 1;
    const ffd_status status =
        ffd_view_pose(w->scene, side, w->scene->animation, time_of(w, index), &s->positions, w->error);
    s->share = side;
    s->owns_positions = true;
    for (size_t i = 0; w->used && s->positions && i < 3 * w->scene->vertex_count; i++)
        if (!w->used[i / 3])
            s->positions[i] = NAN;
    return status;
}

static ffd_status place(picture_work *w, size_t index, step *s)
{
    const view_scene *const scene = w->scene;
    if (w->options->rows)
        return pose(w, index, s);
    s->share = index + 1 == w->step_count && index ? 1
               : index                             ? (double)index / (double)(w->step_count - 1)
                                                   : 0;
    if (!w->used && (s->share <= 0 || s->share >= 1)) {
        s->positions = s->share <= 0 ? scene->before : scene->after;
        return FFD_OK;
    }
    s->owns_positions = true;
    s->positions = ffd_alloc(scene->vertex_count, 3 * sizeof *s->positions);
    for (size_t i = 0; s->positions && i < 3 * scene->vertex_count; i++)
        s->positions[i] = w->used && !w->used[i / 3] ? NAN
                          : s->share >= 1
                              ? scene->after[i]
                              : scene->before[i] + s->share * (scene->after[i] - scene->before[i]);
    return s->positions ? FFD_OK : ffd_fail_memory(w->error);
}

/* At rest the mesh has its own colours; once it has moved, those of the palette. */
static ffd_status paint(picture_work *w, step *s, view_palette *own)
{
    const view_scene *const scene = w->scene;
    *own = (view_palette){.color = FFD_VIEW_PLAIN};
    if (s->share > 0)
        *own = w->palette;
    if (own->color == FFD_VIEW_PLAIN && !scene->colors)
        return FFD_OK;
    s->colors = ffd_alloc(scene->vertex_count, 4);
    if (!s->colors)
        return ffd_fail_memory(w->error);
    ffd_view_palette_fill(own, scene, s->share, s->colors);
    return FFD_OK;
}

static void make_meshes(const picture_work *w, step *s, bool is_plain)
{
    static const picture_material flipped = {
        .color = {0.9559, 0.1714, 0.0048, 0}, .is_double_sided = true, .stripes = STRIPES_RISING};
    const view_surface *const from = &w->surface;
    const size_t marked = s->share > 0 ? from->flipped_count : 0;
    picture_mesh mesh = {.positions = s->positions,
                         .vertex_count = w->scene->vertex_count,
                         .triangles = from->triangles,
                         .triangle_count = w->scene->triangle_count - marked,
                         .colors = s->colors,
                         .twins = w->twins};
    if (is_plain) {
        mesh.texcoords = from->texcoords;
        mesh.glow_texcoords = from->glow_texcoords;
        mesh.materials = from->materials;
        mesh.material_list = from->list;
        mesh.material_count = from->list_count;
    } else {
        mesh.materials = w->white;
        mesh.material_list = &white_material;
        mesh.material_count = 1;
    }
    s->meshes[0] = mesh;
    mesh.triangles += 3 * mesh.triangle_count;
    mesh.triangle_count = marked;
    mesh.texcoords = mesh.glow_texcoords = NULL;
    mesh.colors = NULL;
    mesh.materials = w->white;
    mesh.material_list = &flipped;
    mesh.material_count = 1;
    s->meshes[1] = mesh;
}

static void name_step(const picture_work *w, size_t index, char caption[CAPTION])
{
    if (w->options->rows)
        snprintf(caption, CAPTION, "%s%s s",
                 w->options->rows == 1        ? ""
                 : index < w->options->frames ? "before "
                                              : "after ",
                 ffd_number_decimals(time_of(w, index), 2).text);
    else if (w->step_count == 2)
        snprintf(caption, CAPTION, "%s", index ? "after" : "before");
    else
        snprintf(caption, CAPTION, "%zu %%", (100 * index + (w->step_count - 1) / 2) / (w->step_count - 1));
}

static void free_step(picture_work *w)
{
    step *const s = &w->step;
    if (s->owns_positions)
        ffd_free(s->positions);
    ffd_free(s->colors);
    ffd_view_cages_free(&s->cages);
    ffd_view_dots_free(&s->dots);
    *s = (step){0};
}

/* Called for the first step only: all steps leave out the same lattices. */
static void log_omitted_lattices(const picture_work *w)
{
    const size_t left_out = w->step.cages.left_out, all = w->scene->cage_count;
    if (left_out)
        ffd_log_line(w->options->log, FFD_LOG_WARNING,
                     "the picture: %zu of %zu %s not drawn: more than %d control points", left_out, all,
                     ffd_plural(all, "lattice is", "lattices are"), VIEW_PICTURE_CONTROLS);
}

/* Poses are drawn without lattices and witness, which belong to the mesh at rest. */
static ffd_status make_cages(const picture_work *w, step *s, ffd_error *error)
{
    view_scene scene = *w->scene;
    if (w->options->rows) {
        scene.cage_count = 0;
        scene.witness.is_there = false;
    }
    const view_cages_desc of = {.scene = &scene,
                                .share = s->share,
                                .positions = s->positions,
                                .colors = s->dots.points.colors,
                                .ground = w->has_ground ? w->ground : NULL,
                                .height = height_of(w->options),
                                .most = VIEW_PICTURE_CONTROLS};
    return ffd_view_cages_make(&of, &s->cages, error);
}

/* Makes the step of a panel. Only one step is in memory at a time, as each has its own positions and
   colours. */
static ffd_status make_step(void *context, size_t index, ffd_error *error)
{
    picture_work *const w = context;
    step *const s = &w->step;
    view_palette own;
    free_step(w);
    TRY(place(w, index, s));
    TRY(paint(w, s, &own));
    const bool is_plain = own.color == FFD_VIEW_PLAIN;
    make_meshes(w, s, is_plain);
    TRY(ffd_view_dots_make(w->scene, s->share, s->positions, s->colors, is_plain, height_of(w->options),
                           &s->dots, error));
    TRY(make_cages(w, s, error));
    if (index == 0)
        log_omitted_lattices(w);
    picture_panel *const panel = &w->panels[index];
    panel->meshes = s->meshes;
    panel->mesh_count = !w->scene->vertex_count ? 0 : s->meshes[1].triangle_count ? MESHES : 1;
    panel->cages = s->cages.list;
    panel->cage_count = s->cages.count;
    panel->points = &s->dots.points;
    panel->point_count = s->dots.points.count > 0;
    return FFD_OK;
}

static ffd_status name_panels(picture_work *w)
{
    w->panels = ffd_alloc_zero(w->step_count, sizeof *w->panels);
    w->captions = ffd_alloc_zero(w->step_count, sizeof *w->captions);
    if (!w->panels || !w->captions)
        return ffd_fail_memory(w->error);
    for (size_t i = 0; i < w->step_count && w->step_count > 1; i++) {
        name_step(w, i, w->captions[i]);
        w->panels[i].caption = w->captions[i];
    }
    return FFD_OK;
}

/* Extends a frame by all poses. */
static ffd_status frame_poses(picture_work *w, view_frame *frame)
{
    for (size_t i = 0; i < w->step_count; i++) {
        free_step(w);
        TRY(pose(w, i, &w->step));
        ffd_camera_widen(&w->camera, w->step.positions, w->scene->vertex_count, &frame->mesh);
    }
    if (w->has_ground)
        ffd_camera_widen(&w->camera, w->ground, GROUND_CORNERS, &frame->mesh);
    return FFD_OK;
}

static view_fit describe_fit(const picture_work *w)
{
    return (view_fit){.scene = w->scene,
                      .framed = w->framed ? w->framed : w->used,
                      .ground = w->has_ground ? w->ground : NULL,
                      .camera = &w->camera,
                      .most = VIEW_PICTURE_CONTROLS};
}

/* Finds what of the scene a picture has to show. */
static ffd_status find_frame(picture_work *w, view_frame *frame)
{
    const view_scene *const scene = w->scene;
    const view_fit fit = describe_fit(w);
    picture_mark marks[PALETTE_MARKS];
    *frame = ffd_view_frame_none();
    frame->displacement = scene->displacement_max;
    frame->det = ffd_view_most_det(scene);
    frame->away = ffd_view_away(&fit);
    frame->has_marks = w->step_count > 1 && ffd_view_marks(scene, w->options->color, marks) > 0;
    if (w->options->rows)
        return frame_poses(w, frame);
    ffd_view_fit(&fit, frame);
    return FFD_OK;
}

static void find_seen(picture_work *w)
{
    const view_fit fit = describe_fit(w);
    size_t points, beyond;
    w->seen = ffd_view_seen(&w->frame);
    if (w->options->rows)
        return;
    ffd_view_count_beyond(&fit, &w->seen, &points, &beyond);
    if (beyond)
        ffd_log_line(w->options->log, FFD_LOG_WARNING,
                     "the picture: %zu of %zu control points %s beyond its sides, so that the mesh is not "
                     "too small",
                     beyond, points, ffd_plural(beyond, "is", "are"));
}

static uint64_t pixel_count(const view_picture_options *options)
{
    return (uint64_t)width_of(options) * (options->frames ? options->frames : 1) * height_of(options) *
           (options->rows ? options->rows : 1);
}

/* Where splats are nearly clear, the camera need not show them. */
static ffd_status find_framed(picture_work *w)
{
    const view_scene *const scene = w->scene;
    size_t left = 0;
    if (!scene->splats[0])
        return FFD_OK;
    uint8_t *const marks = ffd_alloc(scene->vertex_count, 1);
    if (!marks)
        return ffd_fail_memory(w->error);
    for (size_t v = 0; v < scene->vertex_count; v++)
        marks[v] = !w->used || w->used[v];
    ffd_view_drop_faint(scene, marks);
    for (size_t v = 0; v < scene->vertex_count; v++)
        left += marks[v];
    if (left > 0)
        w->framed = marks;
    else
        ffd_free(marks);
    return FFD_OK;
}

static ffd_status take_memory(picture_work *w)
{
    const view_scene *const scene = w->scene;
    w->budget = *w->options->budget;
    if (ffd_view_has_dots(scene))
        TRY(ffd_budget_take(&w->budget, scene->vertex_count, DOT_BYTES, w->error));
    TRY(ffd_budget_take(&w->budget, scene->vertex_count, VERTEX_BYTES, w->error));
    return ffd_budget_take(&w->budget, scene->triangle_count, TRIANGLE_BYTES, w->error);
}

/* Finds from where the scene is seen, and what of it. */
static ffd_status look_at(picture_work *w)
{
    const view_scene *const scene = w->scene;
    const view_picture_options *const options = w->options;
    w->step_count = count_steps(scene, options);
    if (!ffd_camera_from(options->camera, options->up, &w->camera))
        w->camera = ffd_camera_iso(options->up);
    TRY(find_used(scene, &w->used, w->error));
    TRY(find_framed(w));
    w->has_ground = ffd_view_ground(scene, w->framed ? w->framed : w->used, options->up, w->ground);
    return FFD_OK;
}

/* Makes everything that the steps share. */
static ffd_status prepare(picture_work *w)
{
    const view_scene *const scene = w->scene;
    const view_picture_options *const options = w->options;
    const bool has_texture = scene->texcoords && scene->materials.image_count;
    const uint64_t drawing =
        ffd_picture_bytes(pixel_count(options), scene->vertex_count, scene->triangle_count);
    TRY(take_memory(w));
    TRY(ffd_view_surface_make(scene, has_texture, &w->budget, drawing, options->threads, options->log,
                              &w->surface, w->error));
    w->twins = ffd_alloc(scene->vertex_count, sizeof *w->twins);
    w->white = ffd_alloc_zero(scene->triangle_count, sizeof *w->white);
    if (!w->twins || !w->white)
        return ffd_fail_memory(w->error);
    log_omissions(w);
    TRY(ffd_positions_twins(scene->before, scene->vertex_count, options->threads, w->twins, w->error));
    TRY(look_at(w));
    if (options->frame)
        w->frame = *options->frame;
    else
        TRY(find_frame(w, &w->frame));
    ffd_view_palette_make(scene, &w->frame, options->color, &w->palette);
    w->mark_count = w->step_count > 1 ? ffd_view_marks(scene, w->palette.color, w->marks) : 0;
    TRY(name_panels(w));
    find_seen(w);
    return FFD_OK;
}

static void free_picture(picture_work *w)
{
    free_step(w);
    ffd_free(w->panels);
    ffd_free(w->captions);
    ffd_free(w->used);
    ffd_free(w->framed);
    ffd_free(w->twins);
    ffd_free(w->white);
    ffd_view_surface_free(&w->surface);
}

static ffd_status append(void *context, const void *bytes, size_t size, ffd_error *error)
{
    return ffd_output_write(context, bytes, size, error);
}

static ffd_status draw(picture_work *w, file_output *output)
{
    const view_picture_options *const options = w->options;
    const picture of = {.width = width_of(options) * (options->frames ? options->frames : 1),
                        .height = height_of(options) * (options->rows ? options->rows : 1),
                        .panels = w->panels,
                        .panel_count = w->step_count,
                        .rows = options->rows,
                        .scale = w->palette.has_scale ? &w->palette.scale : NULL,
                        .marks = w->marks,
                        .mark_count = w->mark_count,
                        .has_mark_row = w->frame.has_marks > 0,
                        .sees_through = w->surface.sees_through || w->scene->splats[0],
                        .camera = w->camera,
                        .seen = &w->seen,
                        .fill = make_step,
                        .context = w,
                        .threads = options->threads};
    uint8_t *pixels = NULL;
    ffd_status status = ffd_picture_draw(&of, &w->budget, &pixels, w->error);
    free_step(w);
    TRY(status);
    status = ffd_png_write(pixels, of.width, of.height, 3, append, output, w->error);
    ffd_free(pixels);
    return status;
}

ffd_status ffd_view_picture_measure(const view_scene *scene, const view_picture_options *options,
                                    view_frame *frame, ffd_error *error)
{
    picture_work w = {.scene = scene, .options = options, .error = error};
    TRY(ffd_view_picture_check(options, error));
    ffd_status status;
    TRY_END(look_at(&w));
    TRY_END(find_frame(&w, frame));
end:
    free_picture(&w);
    return status;
}

ffd_status ffd_view_picture_write(const view_scene *scene, const view_picture_options *options,
                                  file_output *output, ffd_error *error)
{
    picture_work w = {.scene = scene, .options = options, .error = error};
    TRY(ffd_view_picture_check(options, error));
    ffd_status status;
    TRY_END(prepare(&w));
    TRY_END(draw(&w, output));
end:
    free_picture(&w);
    return status;
}
