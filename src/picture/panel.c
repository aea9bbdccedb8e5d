#include "picture/panel.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"

/* Radius of the points of a cage, in widths of its lines. */
#define POINT_RADIUS 2.1
/* Opacity of the parts of a cage that the mesh hides. */
#define HIDDEN_SHARE 0.22

static bool rows_between(double low, double high, int64_t *first, int64_t *last)
{
    /* Strokes that are farther away are not drawn. */
    if (!(low > -1e9 && high < 1e9))
        return false;
    *first = integer_below(low);
    *last = integer_below(high);
    return true;
}

static bool segment_rows(const void *context, size_t item, int64_t *first, int64_t *last)
{
    const panel_cage *const c = context;
    const uint32_t *const ends = c->cage->segments + 2 * item;
    if (ends[0] >= c->cage->point_count || ends[1] >= c->cage->point_count)
        return false;
    const double a = c->points[3 * (size_t)ends[0] + 1], b = c->points[3 * (size_t)ends[1] + 1];
    return rows_between(lesser_of(a, b) - c->half_width - 2, larger_of(a, b) + c->half_width + 2, first,
                        last);
}

static bool disc_rows(const void *context, size_t item, int64_t *first, int64_t *last)
{
    const panel_cage *const c = context;
    const double y = c->points[3 * item + 1];
    return rows_between(y - c->radius - 2, y + c->radius + 2, first, last);
}

static ffd_status make_mesh(const picture_mesh *mesh, const projection *by, const layout *in,
                            const band_means *means, panel_mesh *result, ffd_error *error)
{
    TRY(ffd_surface_make(mesh, by, means, &result->surface, error));
    result->surface.stripe = in->stripe;
    return ffd_bands_make(0, in->of->height, mesh->triangle_count, ffd_raster_rows, &result->surface, means,
                          &result->triangles, error);
}

static ffd_status make_points(const picture_points *points, const projection *by, const layout *in,
                              const band_means *means, panel_points *result, ffd_error *error)
{
    TRY(ffd_points_make(points, by, means->threads, &result->placed, error));
    return ffd_bands_make(0, in->of->height, points->count, ffd_points_rows, &result->placed, means,
                          &result->list, error);
}

static ffd_status make_cage(const picture_cage *cage, const projection *by, const layout *in,
                            const band_means *means, panel_cage *result, ffd_error *error)
{
    const double width = cage->width > 0 ? cage->width : in->line;
    *result =
        (panel_cage){.cage = cage,
                     .stripe = in->stripe,
                     .half_width = width / 2,
                     .radius = cage->radius > 0 || cage->radius < 0 ? cage->radius : POINT_RADIUS * width,
                     .points = ffd_alloc(cage->point_count, 3 * sizeof *result->points)};
    if (!result->points)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < cage->point_count; i++)
        projection_apply(by, cage->points + 3 * i, result->points + 3 * i);
    TRY(ffd_bands_make(0, in->of->height, cage->segment_count, segment_rows, result, means, &result->segments,
                       error));
    return ffd_bands_make(0, in->of->height, result->radius > 0 ? cage->point_count : 0, disc_rows, result,
                          means, &result->discs, error);
}

ffd_status ffd_panel_make(const layout *by, size_t index, const ffd_bounds *seen, const band_means *means,
                          panel *result, ffd_error *error)
{
    const picture_panel *const of = &by->of->panels[index];
    *result = (panel){.of = of,
                      .layout = by,
                      .left = ffd_layout_column(by, index % by->columns),
                      .right = ffd_layout_column(by, index % by->columns + 1),
                      .top = ffd_layout_row(by, index / by->columns),
                      .bottom = ffd_layout_row(by, index / by->columns + 1),
                      .meshes = ffd_alloc_zero(of->mesh_count, sizeof *result->meshes),
                      .points = ffd_alloc_zero(of->point_count, sizeof *result->points),
                      .cages = ffd_alloc_zero(of->cage_count, sizeof *result->cages)};
    /* The same width for all panels, so that panels whose widths differ by a pixel have the same scale. */
    const double width = floor_of((double)by->of->width / (double)by->columns) - 2 * by->margin;
    const projection to =
        ffd_camera_fit(&by->of->camera, seen, floor_of((result->left + result->right) / 2.0),
                       result->top + (by->top + by->bottom) / 2, width, by->bottom - by->top);
    ffd_status status;
    TRY_END(result->meshes && result->points && result->cages ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < of->mesh_count; i++)
        TRY_END(make_mesh(&of->meshes[i], &to, by, means, &result->meshes[i], error));
    for (size_t i = 0; i < of->point_count; i++)
        TRY_END(make_points(&of->points[i], &to, by, means, &result->points[i], error));
    for (size_t i = 0; i < of->cage_count; i++)
        TRY_END(make_cage(&of->cages[i], &to, by, means, &result->cages[i], error));
end:
    if (status)
        ffd_panel_free(result);
    return status;
}

void ffd_panel_free(panel *of)
{
    for (size_t i = 0; of->meshes && i < of->of->mesh_count; i++) {
        ffd_surface_free(&of->meshes[i].surface);
        ffd_bands_free(&of->meshes[i].triangles);
    }
    for (size_t i = 0; of->points && i < of->of->point_count; i++) {
        ffd_points_free(&of->points[i].placed);
        ffd_bands_free(&of->points[i].list);
    }
    for (size_t i = 0; of->cages && i < of->of->cage_count; i++) {
        ffd_free(of->cages[i].points);
        ffd_bands_free(&of->cages[i].segments);
        ffd_bands_free(&of->cages[i].discs);
    }
    ffd_free(of->meshes);
    ffd_free(of->points);
    ffd_free(of->cages);
    *of = (panel){.of = NULL};
}

static void draw_points(const panel *of, const linear_tables *tables, size_t band, bool splats, samples *into)
{
    for (size_t p = 0; p < of->of->point_count; p++) {
        const bands *const list = &of->points[p].list;
        for (size_t i = list->starts[band]; i < list->starts[band + 1]; i++)
            if (of->points[p].placed.list[list->items[i]].is_splat == splats)
                ffd_points_draw(&of->points[p].placed, tables, list->items[i], into);
    }
}

static void draw_triangles(const panel_mesh *mesh, const linear_tables *tables, size_t band, bool see_through,
                           samples *into)
{
    const surface *const of = &mesh->surface;
    const bands *const list = &mesh->triangles;
    if (see_through && !of->has_see_through)
        return;
    for (size_t i = list->starts[band]; i < list->starts[band + 1]; i++)
        if (!of->has_see_through ||
            ffd_shade_material(of->mesh, list->items[i])->is_see_through == see_through)
            ffd_raster_triangle(of, tables, list->items[i], into);
}

void ffd_panel_draw_meshes(const panel *of, const linear_tables *tables, size_t band, samples *into)
{
    for (int see_through = 0; see_through < 2; see_through++) {
        for (size_t m = 0; m < of->of->mesh_count; m++)
            draw_triangles(&of->meshes[m], tables, band, see_through, into);
        draw_points(of, tables, band, see_through, into);
    }
}

static uint64_t light_of(const linear_tables *tables, const uint8_t *color)
{
    return linear_pack(tables->light[color[0]], tables->light[color[1]], tables->light[color[2]]);
}

static void draw_cage(const panel_cage *c, const linear_tables *tables, size_t band,
                      const stroke_target *into)
{
    const picture_cage *const of = c->cage;
    stroke with = {.color = light_of(tables, of->color),
                   .end = light_of(tables, of->color),
                   .second = light_of(tables, of->second),
                   .stripes = of->stripes,
                   .period = c->stripe,
                   .half_width = c->half_width,
                   .hidden = of->is_covered ? 0 : HIDDEN_SHARE};
    for (size_t i = c->segments.starts[band]; i < c->segments.starts[band + 1]; i++) {
        const uint32_t *const ends = of->segments + 2 * (size_t)c->segments.items[i];
        if (of->colors) {
            with.color = light_of(tables, of->colors + 4 * (size_t)ends[0]);
            with.end = light_of(tables, of->colors + 4 * (size_t)ends[1]);
        }
        ffd_stroke_draw(into, &with, c->points + 3 * (size_t)ends[0], c->points + 3 * (size_t)ends[1]);
    }
    with.half_width = c->radius;
    for (size_t i = c->discs.starts[band]; i < c->discs.starts[band + 1]; i++) {
        const double *const point = c->points + 3 * (size_t)c->discs.items[i];
        ffd_stroke_draw(into, &with, point, point);
    }
}

void ffd_panel_draw_cages(const panel *of, const linear_tables *tables, size_t band,
                          const stroke_target *into)
{
    for (size_t i = 0; i < of->of->cage_count; i++)
        draw_cage(&of->cages[i], tables, band, into);
}
