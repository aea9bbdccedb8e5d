/* csv.c - a table of the control points. */
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "base/text/number.h"
#include "base/text/text_scan.h"
#include "lattice/formats/grid_arrays.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/written_text.h"
#include <math.h>
#include <string.h>

static const char *const columns[] = {
    "i", "j", "k", "x", "y", "z", "dx", "dy", "dz", "weight", "weight_deformed"};
enum { INDICES = 3, PLACE = 3, OFFSET = 6, LEAST = 9, WEIGHT = 9, MOVED_WEIGHT = 10, MOST = 11 };
#define HEADER "i,j,k,x,y,z,dx,dy,dz[,weight[,weight_deformed]]"

typedef struct csv_point {
    size_t index[INDICES], line;
    double numbers[MOST - INDICES];
} csv_point;

/* What comment lines tell of a direction. */
typedef struct csv_knots {
    double *list;
    size_t count, line; /* line 0: not told */
} csv_knots;

typedef struct csv_reader {
    const char *name;
    text_scan scan;
    csv_knots knots[3];
    int degree[3];
    bool closed[3];
    size_t degree_line, closed_line, width; /* line 0: not told */
    csv_point *points;
    size_t count, capacity;
    ffd_error *error;
} csv_reader;

#define REFUSE(reader, line, ...)                                                                            \
    ffd_fail_line((reader)->error, FFD_E_INVALID, (reader)->name, line, __VA_ARGS__)

/* Takes the rest of the line. Returns false at the end of the file. */
static bool take_line(csv_reader *r, text_scan *line)
{
    *line = r->scan;
    if (r->scan.at == r->scan.last)
        return false;
    ffd_text_next_line(&r->scan);
    line->last = r->scan.at;
    while (line->last > line->at && (line->last[-1] == '\n' || line->last[-1] == '\r'))
        line->last--;
    return true;
}

/* Takes the text up to the next comma, without blanks round it. Returns false behind the last one. */
static bool take_cell(text_scan *line, bool *is_over, text_word *cell)
{
    if (*is_over)
        return false;
    const char *comma = memchr(line->at, ',', (size_t)(line->last - line->at));
    *is_over = !comma;
    comma = comma ? comma : line->last;
    *cell = (text_word){line->at, comma};
    while (cell->first < cell->last && ffd_text_is_blank(*cell->first))
        cell->first++;
    while (cell->last > cell->first && ffd_text_is_blank(cell->last[-1]))
        cell->last--;
    line->at = *is_over ? comma : comma + 1;
    return true;
}

static ffd_status refuse_cell(csv_reader *r, size_t line, text_word cell, const char *what)
{
    return REFUSE(r, line, "\"%s\" is not %s", ffd_text_shown(cell).text, what);
}

static ffd_status take_knots(csv_reader *r, text_scan *line)
{
    text_word word;
    size_t capacity = 0;
    if (!ffd_text_word(line, &word) || word.last - word.first != 1 || !strchr("uvw", *word.first))
        return REFUSE(r, line->line, "# knots is followed by u, v or w, then by numbers");
    csv_knots *const knots = &r->knots[strchr("uvw", *word.first) - "uvw"];
    if (knots->line)
        return REFUSE(r, line->line, "the knots of %c are told twice, first in line %zu", *word.first,
                      knots->line);
    knots->line = line->line;
    while (ffd_text_word(line, &word)) {
        if (!ffd_grow((void **)&knots->list, &capacity, knots->count + 1, sizeof *knots->list))
            return ffd_fail_memory(r->error);
        if (!ffd_text_number(word, &knots->list[knots->count++]))
            return refuse_cell(r, line->line, word, "a number");
    }
    return FFD_OK;
}

/* Reads three whole numbers up to `most`. *told: the line that told them before, which becomes this one. */
static ffd_status take_three(csv_reader *r, text_scan *line, const char *what, uint64_t most,
                             uint64_t numbers[3], size_t *told)
{
    text_word word;
    if (*told)
        return REFUSE(r, line->line, "# %s is there twice, first in line %zu", what, *told);
    *told = line->line;
    for (int a = 0; a < 3; a++)
        if (!ffd_text_word(line, &word) || !ffd_text_whole(word, &numbers[a]) || numbers[a] > most)
            return REFUSE(r, line->line, "# %s is followed by three whole numbers up to %llu", what,
                          (unsigned long long)most);
    return ffd_text_word(line, &word) ? refuse_cell(r, line->line, word, "the end of the line") : FFD_OK;
}

/* Other comments than these three mean nothing here. */
static ffd_status take_comment(csv_reader *r, text_scan *line)
{
    text_word word;
    uint64_t numbers[3];
    line->at++;
    if (!ffd_text_word(line, &word))
        return FFD_OK;
    if (ffd_text_is(word, "knots"))
        return take_knots(r, line);
    if (ffd_text_is(word, "degree")) {
        TRY(take_three(r, line, "degree", FFD_MAX_DEGREE, numbers, &r->degree_line));
        for (int a = 0; a < 3; a++)
            r->degree[a] = (int)numbers[a];
    } else if (ffd_text_is(word, "closed")) {
        TRY(take_three(r, line, "closed", 1, numbers, &r->closed_line));
        for (int a = 0; a < 3; a++)
            r->closed[a] = numbers[a];
    }
    return FFD_OK;
}

static ffd_status take_header(csv_reader *r, text_scan *line)
{
    bool is_over = false;
    text_word cell;
    while (take_cell(line, &is_over, &cell)) {
        if (r->width == MOST || !ffd_text_is_any_case(cell, columns[r->width]))
            return REFUSE(r, line->line, "\"%s\" is column %zu of the header, which is %s",
                          ffd_text_shown(cell).text, r->width + 1, HEADER);
        r->width++;
    }
    return r->width >= LEAST
               ? FFD_OK
               : REFUSE(r, line->line, "the header has %zu columns, but it is %s", r->width, HEADER);
}

static ffd_status take_point(csv_reader *r, text_scan *line)
{
    bool is_over = false;
    text_word cell;
    uint64_t index;
    if (!ffd_grow((void **)&r->points, &r->capacity, r->count + 1, sizeof *r->points))
        return ffd_fail_memory(r->error);
    csv_point *const point = &r->points[r->count++];
    point->line = line->line;
    for (size_t c = 0; c < r->width; c++) {
        if (!take_cell(line, &is_over, &cell))
            return REFUSE(r, line->line, "the row has %zu cells, but the header has %zu", c, r->width);
        if (c >= INDICES) {
            if (!ffd_text_number(cell, &point->numbers[c - INDICES]) ||
                !isfinite(point->numbers[c - INDICES]))
                return refuse_cell(r, line->line, cell, "a finite number");
            continue;
        }
        if (!ffd_text_whole(cell, &index) || index >= FFD_MAX_CONTROL_POINTS)
            return refuse_cell(r, line->line, cell, "a whole number from 0 on below 2^26");
        point->index[c] = (size_t)index;
    }
    if (take_cell(line, &is_over, &cell))
        return refuse_cell(r, line->line, cell, "a cell of the header's columns");
    return FFD_OK;
}

static bool is_blank(const text_scan *line)
{
    text_scan copy = *line;
    text_word word;
    return !ffd_text_word(&copy, &word);
}

static ffd_status read_lines(csv_reader *r)
{
    text_scan line;
    while (take_line(r, &line)) {
        if (is_blank(&line))
            continue;
        const bool is_comment = *line.at == '#';
        TRY(is_comment && !r->width ? take_comment(r, &line)
            : is_comment            ? FFD_OK
            : !r->width             ? take_header(r, &line)
                                    : take_point(r, &line));
    }
    if (!r->width)
        return REFUSE(r, r->scan.line, "there is no header %s", HEADER);
    return r->count ? FFD_OK : REFUSE(r, r->scan.line, "there are no control points");
}

static void find_size(const csv_reader *r, size_t size[3])
{
    size[0] = size[1] = size[2] = 0;
    for (size_t i = 0; i < r->count; i++)
        for (int a = 0; a < 3; a++)
            size[a] = r->points[i].index[a] >= size[a] ? r->points[i].index[a] + 1 : size[a];
}

/* Refuses sizes of which not every point can be there, before memory is taken for them. */
static ffd_status check_count(const csv_reader *r, const size_t size[3])
{
    const size_t line = r->points[r->count - 1].line;
    if (size[0] > r->count || size[1] > r->count / size[0] || size[2] > r->count / (size[0] * size[1]))
        return REFUSE(r, line, "there are %zu control points, but the indices are those of %zu by %zu by %zu",
                      r->count, size[0], size[1], size[2]);
    return FFD_OK;
}

static size_t place_of(const size_t size[3], const csv_point *point)
{
    return point->index[0] + size[0] * (point->index[1] + size[1] * point->index[2]);
}

static ffd_status refuse_double(const csv_reader *r, const csv_point *second, const csv_point *first)
{
    return REFUSE(r, second->line, "%zu,%zu,%zu is there twice, first in line %zu", second->index[0],
                  second->index[1], second->index[2], first->line);
}

/* Finds the row of every control point. rows: one for each, zeros. */
static ffd_status find_rows(const csv_reader *r, const lattice_spec *spec, const csv_point **rows)
{
    for (size_t i = 0; i < r->count; i++) {
        const csv_point **const row = &rows[place_of(spec->size, &r->points[i])];
        if (*row)
            return refuse_double(r, &r->points[i], *row);
        *row = &r->points[i];
    }
    for (size_t i = 0; i < spec->count; i++)
        if (!rows[i])
            return REFUSE(r, r->points[r->count - 1].line, "%zu,%zu,%zu is missing", i % spec->size[0],
                          i / spec->size[0] % spec->size[1], i / (spec->size[0] * spec->size[1]));
    return FFD_OK;
}

static ffd_status fill(const csv_reader *r, const csv_point **rows, lattice_spec *spec)
{
    spec->deformed_offsets = ffd_alloc(spec->count, 3 * sizeof *spec->deformed_offsets);
    spec->weights = r->width > WEIGHT ? ffd_alloc(spec->count, sizeof *spec->weights) : NULL;
    spec->deformed_weights =
        r->width > MOVED_WEIGHT ? ffd_alloc(spec->count, sizeof *spec->deformed_weights) : NULL;
    if (!spec->deformed_offsets || (r->width > WEIGHT && !spec->weights) ||
        (r->width > MOVED_WEIGHT && !spec->deformed_weights))
        return ffd_fail_memory(r->error);
    for (size_t i = 0; i < spec->count; i++) {
        const double *const numbers = rows[i]->numbers;
        memcpy(spec->points + 3 * i, numbers + PLACE - INDICES, 3 * sizeof *numbers);
        memcpy(spec->deformed_offsets + 3 * i, numbers + OFFSET - INDICES, 3 * sizeof *numbers);
        for (size_t w = WEIGHT; w < r->width; w++) {
            const double weight = numbers[w - INDICES];
            if (!(weight > 0))
                return REFUSE(r, rows[i]->line, "the weight %g is not positive", weight);
            (w == WEIGHT ? spec->weights : spec->deformed_weights)[i] = weight;
        }
    }
    return FFD_OK;
}

/* Gives the spec the knots that comments tell; lists are handed over. */
static ffd_status set_knots(csv_reader *r, const format_wish *wish, lattice_spec *spec)
{
    for (int a = 0; a < 3; a++) {
        csv_knots *const knots = &r->knots[a];
        const size_t n = spec->size[a];
        if ((r->degree_line || knots->line) && wish->degree[a])
            return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name,
                                 "tells its degree in line %zu: {degree} is not for it",
                                 r->degree_line ? r->degree_line : knots->line);
        if (r->degree_line && r->degree[a] < 1)
            return REFUSE(r, r->degree_line, "the degree %d of %c is not 1 to %d", r->degree[a], "uvw"[a],
                          FFD_MAX_DEGREE);
        if (r->degree_line && (size_t)r->degree[a] >= n)
            return REFUSE(r, r->degree_line, "the degree %d of %c needs at least %d control points, not %zu",
                          r->degree[a], "uvw"[a], r -> degree[a] + 1, n);
        spec->degree[a] = r->degree_line ? r->degree[a] : spec->degree[a];
        spec->kind[a] = r->closed[a] ? KNOTS_CLOSED : KNOTS_CLAMPED;
        if (!knots->line)
            continue;
        const size_t needed = r->closed[a] ? n + 1 : n + (size_t)spec->degree[a] + 1;
        if (knots->count != needed)
            return REFUSE(r, knots->line,
                          "there are %zu knots of %c, but %zu control points of degree %d need %zu",
                          knots->count, "uvw"[a], n, spec -> degree[a], needed);
        spec->kind[a] = r->closed[a] ? KNOTS_CLOSED_LIST : KNOTS_LIST;
        spec->knots_line[a] = knots->line;
        spec->list[a] = knots->list;
        spec->list_count[a] = knots->count;
        knots->list = NULL;
    }
    return FFD_OK;
}

static ffd_status make_spec(csv_reader *r, const format_wish *wish, lattice_spec **spec)
{
    size_t size[3];
    find_size(r, size);
    TRY(check_count(r, size));
    TRY(ffd_format_begin(size, r->name, wish, spec, r->error));
    const csv_point **const rows = ffd_alloc_zero((*spec)->count, sizeof *rows);
    ffd_status status;
    TRY_END(rows ? FFD_OK : ffd_fail_memory(r->error));
    TRY_END(find_rows(r, *spec, rows));
    TRY_END(fill(r, rows, *spec));
    TRY_END(set_knots(r, wish, *spec));
end:
    ffd_free((void *)rows);
    return status;
}

ffd_status ffd_lattice_read_csv(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    csv_reader r = {.name = name, .error = error};
    ffd_status status;
    *spec = NULL;
    ffd_text_begin(&r.scan, file->data, ffd_text_size(file->data, file->size), false);
    TRY_END(read_lines(&r));
    TRY_END(make_spec(&r, wish, spec));
end:
    if (status) {
        ffd_spec_free(*spec);
        *spec = NULL;
    }
    for (int a = 0; a < 3; a++)
        ffd_free(r.knots[a].list);
    ffd_free(r.points);
    return status;
}

static void append_knots(const knot_vector *knots, char direction, byte_buffer *text)
{
    size_t count;
    const double *const t = ffd_grid_knots(knots, &count);
    ffd_buffer_format(text, "# knots %c", direction);
    for (size_t i = 0; i < count; i++) {
        ffd_buffer_append(text, " ", 1);
        ffd_buffer_number(text, t[i]);
    }
    ffd_buffer_append(text, "\n", 1);
}

static void append_front(const ffd_lattice *lattice, size_t width, byte_buffer *text)
{
    const knot_vector *const knots = lattice->knots;
    ffd_buffer_format(text, "# degree %d %d %d\n", knots[0].degree, knots[1].degree, knots[2].degree);
    if (ffd_knots_closed(&knots[0]) || ffd_knots_closed(&knots[1]) || ffd_knots_closed(&knots[2]))
        ffd_buffer_format(text, "# closed %d %d %d\n", ffd_knots_closed(&knots[0]),
                          ffd_knots_closed(&knots[1]), ffd_knots_closed(&knots[2]));
    for (int a = 0; a < 3; a++)
        append_knots(&knots[a], "uvw"[a], text);
    for (size_t c = 0; c < width; c++)
        ffd_buffer_format(text, "%s%s", c ? "," : "", columns[c]);
    ffd_buffer_append(text, "\n", 1);
}

/* Appends an index and a comma, without printf: a table has three for each control point. */
static void append_index(size_t index, byte_buffer *text)
{
    char digits[24];
    size_t first = sizeof digits;
    digits[--first] = ',';
    do
        digits[--first] = (char)('0' + index % 10);
    while (index /= 10);
    ffd_buffer_append(text, digits + first, sizeof digits - first);
}

static void append_point(const ffd_lattice *lattice, size_t i, size_t width, byte_buffer *text)
{
    const size_t *const n = lattice->size;
    double numbers[MOST - INDICES];
    memcpy(numbers, lattice->rest + 3 * i, 3 * sizeof *numbers);
    memcpy(numbers + 3, lattice->difference + 3 * i, 3 * sizeof *numbers);
    if (width > WEIGHT)
        numbers[WEIGHT - INDICES] = lattice->rest_weights[i];
    if (width > MOVED_WEIGHT)
        numbers[MOVED_WEIGHT - INDICES] = lattice->deformed_weights[i];
    append_index(i % n[0], text);
    append_index(i / n[0] % n[1], text);
    append_index(i / (n[0] * n[1]), text);
    for (size_t c = INDICES; c < width; c++) {
        ffd_buffer_number(text, numbers[c - INDICES]);
        ffd_buffer_append(text, c + 1 < width ? "," : "\n", 1);
    }
}

static size_t find_width(const ffd_lattice *lattice)
{
    const double *const rest = lattice->rest_weights;
    if (!rest)
        return WEIGHT;
    return memcmp(rest, lattice->deformed_weights, lattice->count * sizeof *rest) == 0 ? MOVED_WEIGHT : MOST;
}

ffd_status ffd_lattice_write_csv(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    const size_t width = find_width(lattice);
    byte_buffer text = {0};
    ffd_status status = FFD_OK;
    append_front(lattice, width, &text);
    for (size_t i = 0; i < lattice->count && !status; i++) {
        append_point(lattice, i, width, &text);
        status = ffd_text_written(&text, i + 1 == lattice->count, output, error);
    }
    ffd_buffer_free(&text);
    return status;
}
