#include "view/view_palette.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The second colour of surfaces is STRIPE_DARK of the first one's light. */
const uint8_t ffd_view_flipped[2][3] = {{250, 115, 15}, {55, 22, 1}},
              ffd_view_folded[2][3] = {{217, 31, 184}, {46, 2, 38}},
              ffd_view_torn[2][3] = {{214, 40, 40}, {255, 255, 255}};
static const uint8_t unknown_color[3] = {148, 153, 161};

/* By ffd_vertex_status. */
static const uint8_t status_colors[FFD_VERTEX_STATUS_COUNT][3] = {
    {74, 144, 217}, {160, 164, 170}, {240, 160, 32}, {150, 96, 210}, {214, 40, 40}};

/* viridis (van der Walt, Smith), and a diverging ramp from blue over white to red. */
static const uint32_t sequential[] = {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e,
                                      0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};
static const uint32_t diverging[] = {0x1d3f8f, 0x2f66b8, 0x5b95d3, 0x9cc3e6, 0xd7e6f2, 0xf6f6f4,
                                     0xf7dccb, 0xf0b08f, 0xdd7757, 0xbd3a33, 0x8a1222};
/* The scale of det F ends at 1 / most and most, where most is between these two. Values beyond get the end
   colours. */
#define LEAST_DET 1.04
#define MOST_DET 16

static void make_ramp(const uint32_t *stops, unsigned count, uint8_t ramp[PALETTE_COLORS][3])
{
    for (unsigned i = 0; i < PALETTE_COLORS; i++) {
        const unsigned at = i * (count - 1), last = PALETTE_COLORS - 1,
                       low = i == last ? count - 2 : at / last, part = at - low * last;
        for (unsigned c = 0; c < 3; c++) {
            const unsigned shift = 8 * (2 - c), a = stops[low] >> shift & 255,
                           b = stops[low + 1] >> shift & 255;
            ramp[i][c] = (uint8_t)((a * (last - part) + b * part + last / 2) / last);
        }
    }
}

/* Maps det F to 0 .. 1 along the scale, 1 to the middle, det F and 1 / det F to mirror images. */
static double place_of_det(double det, double most)
{
    return 0.5 + (det - 1) / (det + 1) * (most + 1) / (most - 1) / 2;
}

static double det_at(double place, double most)
{
    const double x = (2 * place - 1) * (most - 1) / (most + 1);
    return (1 + x) / (1 - x);
}

double ffd_view_most_det(const view_scene *scene)
{
    double most = 0;
    for (size_t v = 0; v < scene->vertex_count && scene->dets; v++) {
        const double det = scene->dets[v];
        if (det > most)
            most = det;
        if (det > 0 && 1 / det > most)
            most = 1 / det;
    }
    return most;
}

static void make_bar(view_palette *p, const char *title)
{
    for (int i = 0; i < PALETTE_LABELS; i++) {
        const double share = (double)i / (PALETTE_LABELS - 1);
        const double value = p->color == FFD_VIEW_DET ? det_at(share, p->most) : share * p->most;
        snprintf(p->texts[i], sizeof p->texts[i], "%s", ffd_number_digits(value, 3).text);
        p->labels[i] = p->texts[i];
    }
    p->scale = (picture_scale){.title = title,
                               .colors = (const uint8_t(*)[3])p->ramp,
                               .color_count = PALETTE_COLORS,
                               .labels = p->labels,
                               .label_count = PALETTE_LABELS};
    p->has_scale = true;
}

/* Legend of the statuses: inside and outside always, each other one if a vertex has it. */
static void make_fields(const view_scene *scene, view_palette *p)
{
    size_t counts[FFD_VERTEX_STATUS_COUNT] = {0}, fields = 0;
    for (size_t v = 0; v < scene->vertex_count; v++)
        if (scene->statuses[v] < FFD_VERTEX_STATUS_COUNT)
            counts[scene->statuses[v]]++;
    for (size_t s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        if (s < 2 || counts[s] > 0) {
            snprintf(p->texts[fields], sizeof p->texts[fields], "%s %zu",
                     ffd_vertex_status_name((ffd_vertex_status)s), counts[s]);
            p->labels[fields] = p->texts[fields];
            memcpy(p->ramp[fields++], status_colors[s], sizeof status_colors[s]);
        }
    p->scale = (picture_scale){.title = "status of the vertices",
                               .colors = (const uint8_t(*)[3])p->ramp,
                               .color_count = fields,
                               .labels = p->labels,
                               .label_count = fields,
                               .is_fields = true};
    p->has_scale = true;
}

void ffd_view_palette_make(const view_scene *scene, const view_frame *frame, ffd_view_color color,
                           view_palette *p)
{
    *p = (view_palette){.color = color};
    if ((color == FFD_VIEW_STATUS && !scene->statuses) || (color == FFD_VIEW_DET && !scene->dets))
        p->color = FFD_VIEW_DISPLACEMENT;
    if (p->color == FFD_VIEW_DISPLACEMENT && !(frame->displacement > 0))
        p->color = FFD_VIEW_PLAIN;
    if (p->color == FFD_VIEW_STATUS)
        make_fields(scene, p);
    if (p->color == FFD_VIEW_DISPLACEMENT) {
        p->most = frame->displacement;
        make_ramp(sequential, sizeof sequential / sizeof *sequential, p->ramp);
        make_bar(p, "displacement, in units of the file");
    }
    if (p->color == FFD_VIEW_DET) {
        p->most = larger_of(LEAST_DET, lesser_of(frame->det, MOST_DET));
        make_ramp(diverging, sizeof diverging / sizeof *diverging, p->ramp);
        make_bar(p, "det F: volume after, relative to before");
    }
}

static const uint8_t *ramp_at(const view_palette *p, double place)
{
    const double at = place * (PALETTE_COLORS - 1) + 0.5;
    return p->ramp[at > 0 ? at < PALETTE_COLORS ? (int)at : PALETTE_COLORS - 1 : 0];
}

static const uint8_t *color_of(const view_palette *p, const view_scene *scene, size_t v, double share)
{
    if (p->color == FFD_VIEW_STATUS)
        return scene->statuses[v] < FFD_VERTEX_STATUS_COUNT ? status_colors[scene->statuses[v]]
                                                            : unknown_color;
    if (p->color == FFD_VIEW_DET) {
        const double det = scene->dets[v];
        return isnan(det) ? unknown_color
               : det <= 0 ? ffd_view_folded[0]
                          : ramp_at(p, place_of_det(det, p->most));
    }
    double along[3];
    for (size_t a = 0; a < 3; a++)
        along[a] = scene->after[3 * v + a] - scene->before[3 * v + a];
    const double length = share * vec_length(along);
    return isnan(length) ? unknown_color : ramp_at(p, length / p->most);
}

static void fill_own(const view_scene *scene, uint8_t *colors)
{
    for (size_t i = 0; i < 4 * scene->vertex_count; i++) {
        const double x = scene->colors[i];
        colors[i] = (uint8_t)(x > 0 ? x < 1 ? 255 * x + 0.5 : 255 : 0);
    }
}

void ffd_view_palette_fill(const view_palette *palette, const view_scene *scene, double share,
                           uint8_t *colors)
{
    if (palette->color == FFD_VIEW_PLAIN) {
        fill_own(scene, colors);
        return;
    }
    for (size_t v = 0; v < scene->vertex_count; v++) {
        const uint8_t *const color = color_of(palette, scene, v, share);
        memcpy(colors + 4 * v, color, 3);
        colors[4 * v + 3] = color == ffd_view_folded[0] ? 0 : 255;
    }
}

static bool shows_folds(const view_scene *scene, ffd_view_color color)
{
    bool found = scene->witness.is_there;
    for (size_t v = 0; v < scene->vertex_count && !found && color == FFD_VIEW_DET && scene->dets; v++)
        found = scene->dets[v] <= 0;
    return found;
}

static void add_mark(picture_mark *mark, const char *label, const uint8_t colors[2][3],
                     picture_stripes stripes, bool is_line)
{
    *mark = (picture_mark){.label = label, .stripes = stripes, .is_line = is_line};
    memcpy(mark->colors, colors, sizeof mark->colors);
}

size_t ffd_view_marks(const view_scene *scene, ffd_view_color color, picture_mark marks[PALETTE_MARKS])
{
    size_t count = 0;
    if (scene->flipped)
        add_mark(&marks[count++], "flipped", ffd_view_flipped, STRIPES_RISING, false);
    if (scene->tear_count)
        add_mark(&marks[count++], "torn", ffd_view_torn, STRIPES_RISING, true);
    if (shows_folds(scene, color))
        add_mark(&marks[count++], "fold", ffd_view_folded, STRIPES_FALLING, false);
    return count;
}
