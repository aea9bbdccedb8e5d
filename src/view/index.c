#include "view/index.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "view/page_assets.h"
#include "view/page_text.h"
#include <inttypes.h>
#include <math.h>

/* Size of a job's picture in pixels: it reserves the row's height before the picture is loaded. */
#define PICTURE_WIDTH 1600
#define PICTURE_HEIGHT 900

#define NOT_KNOWN "\">not known</td>"

/* Appends a name, made fit to be shown. escape: for text, or for the value of an attribute. */
static void append_name(byte_buffer *html, const char *name, void (*escape)(byte_buffer *, const char *))
{
    char *const shown = ffd_page_name(name ? name : "");
    if (shown)
        escape(html, shown);
    html->failed = html->failed || !shown;
    ffd_free(shown);
}

/* An absolute path would disclose the folders of the page's maker: of it the name is shown. */
static const char *shown_path(const char *path)
{
    return path && ffd_path_is_absolute(path) ? ffd_path_name(path) : path;
}

/* Appends the beginning of a link. */
static void append_link(byte_buffer *html, const char *to)
{
    ffd_buffer_text(html, "<a href=\"");
    ffd_page_address(html, to);
    ffd_buffer_text(html, "\">");
}

static void append_picture(byte_buffer *html, const index_row *row)
{
    if (!row->picture) {
        ffd_buffer_text(html, "<td class=\"picture none\">no picture</td>");
        return;
    }
    ffd_buffer_text(html, "<td class=\"picture\">");
    append_link(html, row->picture);
    ffd_buffer_text(html, "<img src=\"");
    ffd_page_address(html, row->picture);
    ffd_buffer_format(html, "\" loading=\"lazy\" width=\"%d\" height=\"%d\" alt=\"before and after: ",
                      PICTURE_WIDTH, PICTURE_HEIGHT);
    append_name(html, shown_path(row->output), ffd_page_attribute);
    ffd_buffer_text(html, "\"></a></td>");
}

/* Each cell holds its sort keys in data-key: numbers, of which a later one decides where the earlier ones are
   equal. The key is empty where a figure is not known. */
static void append_job(byte_buffer *html, const index_row *row)
{
    ffd_buffer_format(html, "<td data-label=\"Line\" data-key=\"%" PRIu64 "\">%" PRIu64 "</td>", row->line,
                      row->line);
    ffd_buffer_text(html, "<th scope=\"row\" data-label=\"Output\"><span class=\"name\">");
    append_name(html, shown_path(row->output), ffd_page_html);
    ffd_buffer_text(html, "</span> <span class=\"from\">from ");
    append_name(html, shown_path(row->input), ffd_page_html);
    ffd_buffer_text(html, "</span>");
    if (row->page) {
        ffd_buffer_text(html, " ");
        append_link(html, row->page);
        ffd_buffer_text(html, "page</a>");
    }
    if (row->frame)
        ffd_buffer_format(html, " <span class=\"from warn\">in a frame of its own: %s</span>", row->frame);
    ffd_buffer_text(html, "</th><td data-label=\"Parameters\" class=\"settings\">");
    append_name(html, row->settings, ffd_page_html);
    ffd_buffer_text(html, "</td>");
}

/* Returns a number in the digits that a row shows. */
static number_text shown(double value)
{
    return ffd_number_digits(value, 6);
}

static void append_displacement(byte_buffer *html, const ffd_job_result *figures)
{
    ffd_buffer_text(html, "<td data-label=\"Largest displacement\" data-key=\"");
    if (!figures || !isfinite(figures->displacement.max)) {
        ffd_buffer_text(html, NOT_KNOWN);
        return;
    }
    ffd_buffer_number(html, figures->displacement.max);
    ffd_buffer_format(html, "\">%s</td>", shown(figures->displacement.max).text);
}

static void append_tear(byte_buffer *html, const ffd_job_result *figures)
{
    ffd_buffer_text(html, "<td data-label=\"Torn edges\" data-key=\"");
    if (!figures || !figures->tear.is_known || !isfinite(figures->tear.largest)) {
        ffd_buffer_text(html, NOT_KNOWN);
        return;
    }
    const ffd_tear_figures *const tear = &figures->tear;
    ffd_buffer_format(html, "%" PRIu64 " ", tear->edges);
    ffd_buffer_number(html, tear->largest);
    if (tear->edges > 0)
        ffd_buffer_format(html, "\" class=\"bad\">%" PRIu64 ", step to %s</td>", tear->edges,
                          shown(tear->largest).text);
    else
        ffd_buffer_text(html, "\">none</td>");
}

static void append_folds(byte_buffer *html, const ffd_job_result *figures)
{
    static const int ranks[] = {[FFD_FOLDS_NONE] = 1, [FFD_FOLDS_UNKNOWN] = 2, [FFD_FOLDS_SOME] = 3};
    ffd_buffer_text(html, "<td data-label=\"Folds\" data-key=\"");
    if (!figures || !figures->folds.is_known) {
        ffd_buffer_text(html, NOT_KNOWN);
        return;
    }
    const ffd_folds *const folds = &figures->folds;
    ffd_buffer_format(html, "%d %" PRIu64 " ", ranks[folds->verdict], folds->folded_cells);
    ffd_buffer_number(html, -folds->min_det);
    if (folds->verdict == FFD_FOLDS_SOME)
        ffd_buffer_format(html, "\" class=\"bad\">%" PRIu64 " %s, det J to %s</td>", folds->folded_cells,
                          ffd_plural(folds->folded_cells, "cell", "cells"), shown(folds->min_det).text);
    else if (folds->verdict == FFD_FOLDS_UNKNOWN)
        ffd_buffer_text(html, "\" class=\"warn\">undecided</td>");
    else
        ffd_buffer_format(html, "\">none, det J at least %s</td>", shown(folds->min_det).text);
}

static void append_flipped(byte_buffer *html, const ffd_job_result *figures)
{
    ffd_buffer_text(html, "<td data-label=\"Flipped faces\" data-key=\"");
    if (!figures || !figures->has_flipped)
        ffd_buffer_text(html, NOT_KNOWN);
    else
        ffd_buffer_format(html, "%" PRIu64 "\"%s>%" PRIu64 "</td>", figures->flipped_faces,
                          figures->flipped_faces > 0 ? " class=\"bad\"" : "", figures->flipped_faces);
}

/* Whether an absolute path begins here: at the beginning of a message, or after a blank or a quote. A JSON
   pointer looks like one. */
static bool begins_path(const char *message, size_t i, const char *pointer)
{
    const size_t length = pointer ? strlen(pointer) : 0;
    if (length > 0 && strncmp(message + i, pointer, length) == 0 && message[i + length] == ':')
        return false;
    return (i == 0 || message[i - 1] == ' ' || message[i - 1] == '"') && ffd_path_is_absolute(message + i);
}

/* Appends a message without the folders of the absolute paths in it. A path ends at a quote or colon; within
   a message, where it is not quoted, at a blank too. pointer: as of a row. */
static void append_message(byte_buffer *html, const char *message, const char *pointer)
{
    byte_buffer text = {0};
    for (size_t i = 0, end; message[i]; i = end) {
        end = i + 1;
        if (begins_path(message, i, pointer)) {
            /* the colon of a drive is part of it */
            const size_t drive = message[i] != '/' && message[i] != '\\' ? 2 : 0;
            end = i + drive + strcspn(message + i + drive, i == 0 ? "\":" : "\": ");
        }
        size_t from = i;
        for (size_t k = i; k + 1 < end; k++)
            if (end > i + 1 && (message[k] == '/' || message[k] == '\\'))
                from = k + 1;
        ffd_buffer_append(&text, message + from, end - from);
    }
    char *const shown = ffd_buffer_finish(&text);
    append_name(html, shown ? shown : "", ffd_page_html);
    html->failed = html->failed || !shown;
    ffd_free(shown);
}

static void append_state(byte_buffer *html, const index_row *row)
{
    static const char *const words[] = {
        [INDEX_SKIPPED] = "up to date", [INDEX_DONE] = "done", [INDEX_FAILED] = "failed"};
    ffd_buffer_format(html, "<td data-label=\"State\" data-key=\"%d\"%s>%s", (int)row->state,
                      row->state == INDEX_FAILED ? " class=\"bad\"" : "", words[row->state]);
    if (row->error) {
        ffd_buffer_text(html, ": <span class=\"error\">");
        append_message(html, row->error, row->pointer);
        ffd_buffer_text(html, "</span>");
    }
    ffd_buffer_text(html, "</td>");
}

ffd_status ffd_index_begin(view_index *index, const char *name, file_output *output, ffd_error *error)
{
    byte_buffer title = {0};
    *index = (view_index){0};
    if (ffd_page_writer_begin(&index->writer, output, error))
        return index->writer.status;
    append_name(&title, shown_path(name), ffd_page_html);
    ffd_page_write(&index->writer, ffd_compare_start, ffd_compare_start_size);
    ffd_page_write_buffer(&index->writer, &title);
    ffd_page_write(&index->writer, ffd_compare_middle, ffd_compare_middle_size);
    return index->writer.status;
}

ffd_status ffd_index_add(view_index *index, const index_row *row, ffd_error *error)
{
    byte_buffer html = {0};
    index->writer.error = error;
    index->jobs++;
    index->skipped += row->state == INDEX_SKIPPED;
    index->failed += row->state == INDEX_FAILED;
    ffd_buffer_text(&html, "<tr>");
    append_picture(&html, row);
    append_job(&html, row);
    append_displacement(&html, row->figures);
    append_tear(&html, row->figures);
    append_folds(&html, row->figures);
    append_flipped(&html, row->figures);
    append_state(&html, row);
    ffd_buffer_text(&html, "</tr>\n");
    ffd_page_write_buffer(&index->writer, &html);
    return index->writer.status;
}

ffd_status ffd_index_end(view_index *index, ffd_error *error)
{
    byte_buffer counts = {0};
    index->writer.error = error;
    ffd_buffer_format(&counts,
                      "</tbody>\n</table>\n<p id=\"counts\">%" PRIu64 " %s: %" PRIu64 " done, %" PRIu64
                      " up to date, %" PRIu64 " failed</p>\n",
                      index->jobs, ffd_plural(index->jobs, "job", "jobs"),
                      index->jobs - index->skipped - index->failed, index->skipped, index->failed);
    ffd_page_write_buffer(&index->writer, &counts);
    ffd_page_write(&index->writer, ffd_compare_end, ffd_compare_end_size);
    return index->writer.status;
}

void ffd_index_free(view_index *index)
{
    ffd_page_writer_end(&index->writer);
}
