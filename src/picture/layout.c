#include "picture/layout.h"
#include "base/vector/vec.h"
#include "picture/letters.h"

/* sRGB. */
static const uint8_t background_top[3] = {251, 252, 253}, background_bottom[3] = {229, 233, 238};
static const uint8_t ink[3] = {52, 58, 66}, divider[3] = {203, 209, 216};

/* Heights of the parts of a scale, and gaps, in dots. */
#define BAR_HEIGHT 6
#define GAP 4
#define TITLE_GAP 5
#define MARGIN 8

static uint64_t from_bytes(const linear_tables *tables, const uint8_t color[3])
{
    return linear_pack(tables->light[color[0]], tables->light[color[1]], tables->light[color[2]]);
}

static double scale_height(const picture_scale *scale)
{
    return (scale->title ? LETTER_ROWS + TITLE_GAP : 0) + BAR_HEIGHT +
           (scale->is_fields ? 1 : GAP + LETTER_ROWS) + MARGIN;
}

layout ffd_layout_make(const picture *of)
{
    layout by = {.of = of, .rows = of->rows ? of->rows : 1};
    by.columns = of->panel_count > by.rows ? of->panel_count / by.rows : 1;
    const double panel = (double)of->width / (double)by.columns, row = of->height / (double)by.rows;
    /* The dot size follows the height, in steps of half a pixel, so that letters are sharp. */
    by.dot = larger_of(1, lesser_of(4, floor(lesser_of(row / 360.0, panel / 240) * 2) / 2));
    by.line = larger_of(0.6, lesser_of(3, lesser_of(row, panel) / 500));
    by.margin = MARGIN * by.dot;
    by.top = by.margin;
    for (size_t i = 0; i < of->panel_count; i++)
        if (of->panels[i].caption)
            by.top = (2 * MARGIN + LETTER_ROWS) * by.dot;
    by.row_height = of->height - (of->scale ? (scale_height(of->scale) + GAP) * by.dot : 0);
    if (by.rows > 1)
        by.row_height = floor(by.row_height / (double)by.rows);
    by.bottom = by.row_height - by.margin;
    return by;
}

int32_t ffd_layout_column(const layout *by, size_t column)
{
    return (int32_t)((uint64_t)by->of->width * column / by->columns);
}

int32_t ffd_layout_row(const layout *by, size_t row)
{
    return row < by->rows ? (int32_t)(by->row_height * (double)row) : (int32_t)by->of->height;
}

uint64_t ffd_layout_background(const layout *by, const linear_tables *tables, int32_t row)
{
    uint32_t light[3];
    for (int c = 0; c < 3; c++) {
        const int32_t top = tables->light[background_top[c]], bottom = tables->light[background_bottom[c]];
        light[c] = (uint32_t)(top + (int64_t)(bottom - top) * row / (int64_t)by->of->height);
    }
    return linear_pack(light[0], light[1], light[2]);
}

static void fill(const stroke_target *into, double left, double top, double right, double bottom,
                 uint64_t color)
{
    for (int32_t y = into->top; y < into->top + into->rows; y++)
        for (int32_t x = into->left; y + 0.5 >= top && y + 0.5 < bottom && x < into->left + into->width; x++)
            if (x + 0.5 >= left && x + 0.5 < right)
                into->pixels[(size_t)(y - into->top) * (size_t)into->width + (size_t)(x - into->left)] =
                    color;
}

static void write_middle(const layout *by, const stroke_target *into, const char *text, double middle,
                         double top, uint64_t color)
{
    ffd_letters_draw(into, text, floor(middle - by->dot * ffd_letters_width(text) / 2), floor(top), by->dot,
                     color);
}

static void draw_bar(const layout *by, const linear_tables *tables, const stroke_target *into, double top)
{
    const picture_scale *const scale = by->of->scale;
    const double width = floor(by->of->width * (by->of->panel_count > 1 ? 0.4 : 0.5)),
                 left = floor((by->of->width - width) / 2), bottom = top + BAR_HEIGHT * by->dot;
    for (size_t i = 0; i < scale->color_count; i++) {
        const double count = (double)scale->color_count, index = (double)i;
        fill(into, left + width * index / count, top, left + width * (index + 1) / count, bottom,
             from_bytes(tables, scale->colors[i]));
    }
    /* Labels that would overlap are omitted, except those at both ends. */
    double room = 0;
    for (size_t i = 0; i < scale->label_count; i++)
        room = larger_of(room, by->dot * (ffd_letters_width(scale->labels[i]) + LETTER_STEP));
    const bool is_full = room * ((double)scale->label_count - 1) > width;
    for (size_t i = 0; i < scale->label_count; i++) {
        if (is_full && i > 0 && i + 1 < scale->label_count)
            continue;
        const double share = scale->label_count > 1 ? (double)i / (double)(scale->label_count - 1) : 0.5;
        write_middle(by, into, scale->labels[i], left + share * width, bottom + GAP * by->dot,
                     from_bytes(tables, ink));
    }
}

static void draw_fields(const layout *by, const linear_tables *tables, const stroke_target *into, double top)
{
    const picture_scale *const scale = by->of->scale;
    const size_t count = scale->color_count < scale->label_count ? scale->color_count : scale->label_count;
    double width = 0;
    for (size_t i = 0; i < count; i++)
        width += by->dot * (BAR_HEIGHT + GAP + ffd_letters_width(scale->labels[i]) + (i > 0 ? 3 * GAP : 0));
    double left = floor((by->of->width - width) / 2);
    for (size_t i = 0; i < count; i++) {
        const double right = left + BAR_HEIGHT * by->dot;
        fill(into, left, top, right, top + BAR_HEIGHT * by->dot, from_bytes(tables, scale->colors[i]));
        ffd_letters_draw(into, scale->labels[i], right + GAP * by->dot, floor(top - by->dot / 2), by->dot,
                         from_bytes(tables, ink));
        left = right + by->dot * (4 * GAP + ffd_letters_width(scale->labels[i]));
    }
}

static void draw_scale(const layout *by, const linear_tables *tables, const stroke_target *into)
{
    const picture_scale *const scale = by->of->scale;
    double top = floor(by->of->height - scale_height(scale) * by->dot);
    if (into->top + into->rows <= top)
        return;
    if (scale->title) {
        write_middle(by, into, scale->title, by->of->width / 2.0, top, from_bytes(tables, ink));
        top += floor((LETTER_ROWS + TITLE_GAP) * by->dot);
    }
    if (scale->is_fields)
        draw_fields(by, tables, into, top);
    else
        draw_bar(by, tables, into, top);
}

void ffd_layout_draw(const layout *by, const linear_tables *tables, const stroke_target *into)
{
    const double divided = by->of->scale ? by->row_height * (double)by->rows : by->of->height;
    for (size_t i = 0; i < by->of->panel_count; i++) {
        const size_t column = i % by->columns, row = i / by->columns;
        const int32_t left = ffd_layout_column(by, column), right = ffd_layout_column(by, column + 1),
                      top = ffd_layout_row(by, row);
        if (column > 0 && row == 0)
            fill(into, left, 0, left + 1, divided, from_bytes(tables, divider));
        if (row > 0 && column == 0)
            fill(into, 0, top, by->of->width, top + 1, from_bytes(tables, divider));
        if (by->of->panels[i].caption && into->top < top + by->top)
            write_middle(by, into, by->of->panels[i].caption, (left + right) / 2.0, top + by->margin,
                         from_bytes(tables, ink));
    }
    if (by->of->scale)
        draw_scale(by, tables, into);
}
