#include "picture/layout.h"
#include "base/vector/vec.h"
#include "picture/letters.h"
#include "picture/stripes.h"

/* sRGB. Grey enough that a white surface stands out, and light enough for dark ones. */
static const uint8_t background_top[3] = {205, 212, 221}, background_bottom[3] = {197, 205, 216};
static const uint8_t ink[3] = {38, 43, 50}, divider[3] = {160, 167, 176};

/* Heights of the parts of a scale, and gaps, in dots. */
#define BAR_HEIGHT 6
#define GAP 3
#define TITLE_GAP 3
#define MARGIN 4
/* Width of the field of a mark. */
#define MARK_WIDTH 14

/* Dots in a panel and in a row, by which letters have their size: so many that before and after side by side
   can still be read where the picture is shrunk to 320 pixels, as in the page of a batch. */
#define PANEL_DOTS 144
#define ROW_DOTS 162

static uint64_t from_bytes(const linear_tables *tables, const uint8_t color[3])
{
    return linear_pack(tables->light[color[0]], tables->light[color[1]], tables->light[color[2]]);
}

/* Returns the height of the scale and of the marks, in dots. */
static double legend_height(const picture *of)
{
    const picture_scale *const scale = of->scale;
    double height = of->mark_count || of->has_mark_row ? LETTER_ROWS + MARGIN : 0;
    if (scale)
        height += (scale->title ? LETTER_ROWS + TITLE_GAP : 0) +
                  (scale->is_fields ? LETTER_ROWS : BAR_HEIGHT) + (scale->is_fields ? 0 : GAP + LETTER_ROWS) +
                  MARGIN;
    return height;
}

layout ffd_layout_make(const picture *of)
{
    layout by = {.of = of, .rows = of->rows ? of->rows : 1};
    by.columns = of->panel_count > by.rows ? of->panel_count / by.rows : 1;
    const double panel = (double)of->width / (double)by.columns, row = of->height / (double)by.rows;
    /* In steps of half a pixel, so that letters are sharp. */
    by.dot = larger_of(1, floor_of(lesser_of(row / ROW_DOTS, panel / PANEL_DOTS) * 2) / 2);
    by.line = larger_of(0.6, lesser_of(3, lesser_of(row, panel) / 500));
    by.stripe = (int32_t)larger_of(6, floor_of(lesser_of(row, panel) / 80));
    by.margin = MARGIN * by.dot;
    by.top = by.margin;
    for (size_t i = 0; i < of->panel_count; i++)
        if (of->panels[i].caption)
            by.top = (2 * MARGIN + LETTER_ROWS) * by.dot;
    by.row_height = of->height - (legend_height(of) > 0 ? (legend_height(of) + GAP) * by.dot : 0);
    if (by.rows > 1)
        by.row_height = floor_of(by.row_height / (double)by.rows);
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

/* Letters are smaller where a text would not fit into the picture. */
static void write_middle(const layout *by, const stroke_target *into, const char *text, double middle,
                         double top, uint64_t color)
{
    const double width = ffd_letters_width(text), room = by->of->width - 2 * by->margin,
                 dot = width > 0 ? lesser_of(by->dot, room / width) : by->dot;
    ffd_letters_draw(into, text, floor_of(middle - dot * width / 2), floor_of(top), dot, color);
}

static void draw_bar(const layout *by, const linear_tables *tables, const stroke_target *into, double top)
{
    const picture_scale *const scale = by->of->scale;
    const double width = floor_of(by->of->width * 0.6), left = floor_of((by->of->width - width) / 2),
                 bottom = top + BAR_HEIGHT * by->dot;
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

/* A row of fields with labels, in the middle of the picture. Where they need more than its width, letters are
   smaller. */
typedef struct field_row {
    double left, dot;
    double field; /* width of a field, in dots */
} field_row;

static field_row begin_fields(const layout *by, double field, double letters, size_t count)
{
    const double dots = letters + (double)count * (field + GAP) + (double)(count - 1) * 3 * GAP,
                 most = by->of->width - 2 * by->margin;
    field_row row = {0, lesser_of(by->dot, most / dots), field};
    row.left = larger_of(0, floor_of((by->of->width - row.dot * dots) / 2));
    return row;
}

/* Writes the label of the field at row->left, and goes on to the next one. */
static void label_field(field_row *row, const linear_tables *tables, const stroke_target *into,
                        const char *label, double top)
{
    const double at = row->left + (row->field + GAP) * row->dot;
    ffd_letters_draw(into, label, floor_of(at), floor_of(top), row->dot, from_bytes(tables, ink));
    row->left = at + row->dot * (3 * GAP + ffd_letters_width(label));
}

static void draw_fields(const layout *by, const linear_tables *tables, const stroke_target *into, double top)
{
    const picture_scale *const scale = by->of->scale;
    const size_t count = scale->color_count < scale->label_count ? scale->color_count : scale->label_count;
    double letters = 0;
    for (size_t i = 0; i < count; i++)
        letters += ffd_letters_width(scale->labels[i]);
    field_row row = begin_fields(by, BAR_HEIGHT, letters, count);
    for (size_t i = 0; i < count; i++) {
        fill(into, row.left, top, row.left + BAR_HEIGHT * row.dot, top + LETTER_ROWS * row.dot,
             from_bytes(tables, scale->colors[i]));
        label_field(&row, tables, into, scale->labels[i], top);
    }
}

/* Fills the field of a mark with its stripes, as they are on the mesh: a whole field, or a line. */
static void fill_mark(const layout *by, const linear_tables *tables, const stroke_target *into,
                      const picture_mark *mark, double left, double top, double dot)
{
    const double middle = top + LETTER_ROWS / 2.0 * dot;
    const double from = mark->is_line ? middle - dot : top,
                 to = mark->is_line ? middle + dot : top + LETTER_ROWS * dot;
    const uint64_t colors[2] = {from_bytes(tables, mark->colors[0]), from_bytes(tables, mark->colors[1])};
    for (int32_t y = into->top; y < into->top + into->rows; y++)
        for (int32_t x = into->left; y + 0.5 >= from && y + 0.5 < to && x < into->left + into->width; x++)
            if (x + 0.5 >= left && x + 0.5 < left + MARK_WIDTH * dot)
                into->pixels[(size_t)(y - into->top) * (size_t)into->width + (size_t)(x - into->left)] =
                    colors[ffd_stripes_second(mark->stripes, by->stripe, x, y)];
}

static void draw_marks(const layout *by, const linear_tables *tables, const stroke_target *into)
{
    const double top = floor_of(by->of->height - (LETTER_ROWS + MARGIN) * by->dot);
    double letters = 0;
    if (by->of->mark_count == 0 || into->top + into->rows <= top)
        return;
    for (size_t i = 0; i < by->of->mark_count; i++)
        letters += ffd_letters_width(by->of->marks[i].label);
    field_row row = begin_fields(by, MARK_WIDTH, letters, by->of->mark_count);
    for (size_t i = 0; i < by->of->mark_count; i++) {
        fill_mark(by, tables, into, &by->of->marks[i], row.left, top, row.dot);
        label_field(&row, tables, into, by->of->marks[i].label, top);
    }
}

static void draw_scale(const layout *by, const linear_tables *tables, const stroke_target *into)
{
    const picture_scale *const scale = by->of->scale;
    double top = floor_of(by->of->height - legend_height(by->of) * by->dot);
    if (into->top + into->rows <= top)
        return;
    if (scale->title) {
        write_middle(by, into, scale->title, by->of->width / 2.0, top, from_bytes(tables, ink));
        top += floor_of((LETTER_ROWS + TITLE_GAP) * by->dot);
    }
    if (scale->is_fields)
        draw_fields(by, tables, into, top);
    else
        draw_bar(by, tables, into, top);
}

void ffd_layout_draw(const layout *by, const linear_tables *tables, const stroke_target *into)
{
    const double divided = legend_height(by->of) > 0 ? by->row_height * (double)by->rows : by->of->height;
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
    draw_marks(by, tables, into);
}
