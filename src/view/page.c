#include "view/page.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include "view/page_assets.h"
#include "view/page_images.h"
#include "view/page_reduce.h"
#include "view/page_scene.h"
#include "view/page_splats.h"
#include "view/page_texcoords.h"
#include "view/page_text.h"
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct page_work {
    const view_scene *scene;
    const view_page_options *options;
    page_mesh mesh;
    page_data data;
    page_texcoords texcoords;
    page_images images;
    page_rig rig;
    page_targets targets;
    page_edit edit;
    page_description description;
    bool *has_cage;
    page_writer writer;
} page_work;

/* Adds a notice that something is not shown, on the page and in the log. */
static void FFD_PRINTF(2, 3) give_notice(page_work *work, const char *format, ...)
{
    page_description *const page = &work->description;
    if (page->notice_count == PAGE_NOTICES)
        return;
    char *const notice = page->notices[page->notice_count++];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(notice, sizeof page->notices[0], SPELLED(format), arguments);
    va_end(arguments);
    ffd_log_line(work->options->log, FFD_LOG_WARNING, "the page: %s", notice);
}

/* Chooses the cages whose points the page gets: in order, as long as the limit allows. */
static ffd_status choose_cages(page_work *work, ffd_error *error)
{
    const view_scene *const scene = work->scene;
    size_t points = 0, left_out = 0;
    work->has_cage = ffd_alloc_zero(scene->cage_count, sizeof *work->has_cage);
    work->description.has_cage = work->has_cage;
    if (!work->has_cage)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < scene->cage_count; i++) {
        const size_t *const size = scene->cages[i].size;
        size_t count = 0, all = 0;
        const bool fits = ffd_multiply_size(size[0], size[1], &count) &&
                          ffd_multiply_size(count, size[2], &count) && ffd_add_size(points, count, &all) &&
                          (work->options->full || all <= VIEW_PAGE_CONTROLS);
        work->has_cage[i] = fits;
        points = fits ? all : points;
        left_out += !fits;
    }
    if (left_out)
        give_notice(work, "%zu of %zu %s not drawn: more than %d control points (see {full})", left_out,
                    scene->cage_count, ffd_plural(scene->cage_count, "lattice is", "lattices are"),
                    VIEW_PAGE_CONTROLS);
    return FFD_OK;
}

static void log_omissions(page_work *work, size_t used)
{
    const page_mesh *const mesh = &work->mesh;
    if (mesh->not_finite)
        give_notice(work, "%" PRIu64 " %s not finite, and %zu %s not drawn", mesh->not_finite,
                    ffd_plural(mesh->not_finite, "vertex is", "vertices are"), mesh->triangles_lost,
                    ffd_plural(mesh->triangles_lost, "triangle there is", "triangles there are"));
    if (mesh->vertex_count < used)
        give_notice(work, "%zu of %zu vertices are drawn: the mesh is simplified (see {full})",
                    mesh->vertex_count, used);
    if (work->scene->tear_edges > work->scene->tear_count)
        give_notice(work, "%zu of %" PRIu64 " torn edges are marked, those with the largest steps",
                    work->scene->tear_count, work->scene->tear_edges);
    if (work->scene->vertex_count == 0)
        give_notice(work, "the mesh has no vertices");
}

/* Animations that exceed a limit are left out, with a notice. */
static ffd_status make_rig(page_work *work, ffd_error *error)
{
    ffd_error own = {0};
    const ffd_status status = ffd_page_rig_make(&work->mesh, &work->rig, &own);
    if (work->rig.reduced)
        give_notice(work, "%zu %s more than %d joints (up to %zu): animations move %s by the largest weights",
                    work->rig.reduced, ffd_plural(work->rig.reduced, "vertex follows", "vertices follow"),
                    PAGE_BONES, work->rig.most_bones, ffd_plural(work->rig.reduced, "it", "them"));
    if (status == FFD_E_LIMIT) {
        ffd_page_rig_free(&work->rig);
        give_notice(work, "the animations are left out: %s", own.message);
        return FFD_OK;
    }
    if (status && error)
        *error = own;
    return status;
}

static ffd_status make_textures(page_work *work, ffd_error *error)
{
    const page_images *const images = &work->images;
    TRY(ffd_page_texcoords_make(&work->mesh, &work->texcoords, error));
    TRY(ffd_page_images_take(&work->mesh, work->options->full, work->options->budget, &work->images, error));
    if (images->smaller_count)
        give_notice(
            work, "%zu of %zu textures are smaller than in the model: %.1f in place of %.1f MB (see {full})",
            images->smaller_count, images->count, (double)images->bytes / 1e6,
            (double)images->all_bytes / 1e6);
    return FFD_OK;
}

static ffd_status make_targets(page_work *work, ffd_error *error)
{
    const page_targets *const targets = &work->targets;
    TRY(ffd_page_targets_make(&work->mesh, work->options->full, &work->targets, error));
    if (targets->left_out)
        give_notice(work, "%zu of %zu morph targets have no slider: more than %d offsets (see {full})",
                    targets->left_out, work->scene->slider_count, VIEW_PAGE_OFFSETS);
    return FFD_OK;
}

static ffd_status prepare(page_work *work, ffd_error *error)
{
    TRY(ffd_page_mesh_take(work->scene, &work->mesh, error));
    const size_t used = ffd_page_mesh_mark(&work->mesh);
    if (!work->options->full && used > VIEW_PAGE_VERTICES) {
        TRY(ffd_page_reduce(&work->mesh, VIEW_PAGE_VERTICES, error));
        ffd_free(work->mesh.continues); /* a triangle is no longer a part of one polygon */
        work->mesh.continues = NULL;
    }
    TRY(ffd_page_mesh_index(&work->mesh, error));
    TRY(ffd_page_edit_make(&work->mesh, &work->edit, error));
    ffd_page_data_measure(&work->mesh, &work->data);
    log_omissions(work, used);
    TRY(make_textures(work, error));
    TRY(make_rig(work, error));
    TRY(make_targets(work, error));
    return choose_cages(work, error);
}

static void write_json(page_work *work, const char *id, byte_buffer *json)
{
    static const char tail[] = "</script>\n";
    byte_buffer head = {0};
    ffd_buffer_format(&head, "<script type=\"application/json\" id=\"%s\">", id);
    ffd_page_write_buffer(&work->writer, &head);
    ffd_page_write_buffer(&work->writer, json);
    ffd_page_write(&work->writer, tail, sizeof tail - 1);
}

static void write_title(page_work *work)
{
    byte_buffer title = {0};
    char *const name = ffd_page_name(work->scene->name ? work->scene->name : "");
    if (name)
        ffd_page_html(&title, name);
    title.failed = title.failed || !name;
    ffd_free(name);
    ffd_page_write_buffer(&work->writer, &title);
}

static void write_data(page_work *work)
{
    const view_scene *const scene = work->scene;
    byte_buffer report = {0}, description = {0};
    if (scene->report)
        ffd_page_json(&report, scene->report, strlen(scene->report));
    else
        ffd_buffer_text(&report, "null");
    write_json(work, "report", &report);
    ffd_page_describe(&work->description, &description);
    write_json(work, "scene", &description);
    ffd_page_data_write(&work->data, &work->writer);
    ffd_page_splats_write(&work->mesh, &work->writer);
    ffd_page_texcoords_write(&work->texcoords, &work->writer);
    ffd_page_images_write(&work->images, &work->writer);
    ffd_page_rig_write(&work->rig, &work->writer);
    ffd_page_targets_write(&work->targets, &work->writer);
    ffd_page_edit_write(&work->edit, &work->writer);
    for (size_t i = 0; i < scene->cage_count; i++) {
        char id[40];
        snprintf(id, sizeof id, "data-cage-%zu", i);
        if (work->has_cage[i])
            ffd_page_data_write_cage(&scene->cages[i], id, &work->writer);
    }
}

/* The title goes between the first two, the data between the last two. */
typedef struct page_pieces {
    const unsigned char *start, *middle, *end;
    const size_t *start_size, *middle_size, *end_size;
} page_pieces;

static const page_pieces view_page = {ffd_page_start,       ffd_page_middle,       ffd_page_end,
                                      &ffd_page_start_size, &ffd_page_middle_size, &ffd_page_end_size};
static const page_pieces edit_page = {ffd_edit_start,       ffd_edit_middle,       ffd_edit_end,
                                      &ffd_edit_start_size, &ffd_edit_middle_size, &ffd_edit_end_size};

ffd_status ffd_view_page_write(const view_scene *scene, const view_page_options *options, file_output *output,
                               ffd_error *error)
{
    page_work work = {.scene = scene, .options = options};
    work.description.data = &work.data;
    work.description.texcoords = &work.texcoords;
    work.description.images = &work.images;
    work.description.rig = &work.rig;
    work.description.targets = &work.targets;
    work.description.edit = &work.edit;
    work.description.options = options;
    ffd_status status;
    TRY_END(prepare(&work, error));
    if (!ffd_page_writer_begin(&work.writer, output, error)) {
        const page_pieces *const page = scene->edit ? &edit_page : &view_page;
        ffd_page_write(&work.writer, page->start, *page->start_size);
        write_title(&work);
        ffd_page_write(&work.writer, page->middle, *page->middle_size);
        write_data(&work);
        ffd_page_write(&work.writer, page->end, *page->end_size);
    }
    TRY_END(ffd_page_writer_end(&work.writer));
end:
    ffd_page_texcoords_free(&work.texcoords);
    ffd_page_images_free(&work.images);
    ffd_page_mesh_free(&work.mesh);
    ffd_page_rig_free(&work.rig);
    ffd_page_targets_free(&work.targets);
    ffd_page_edit_free(&work.edit);
    ffd_free(work.has_cage);
    return status;
}
