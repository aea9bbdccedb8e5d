#include "job/author/fit_csv.h"
#include "base/memory/memory.h"
#include "base/text/text_scan.h"
#include "io/csv/csv.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { X, Y, Z, PX, PY, PZ, VERTEX, WEIGHT, COLUMNS };
static const char *const names[] = {"x", "y", "z", "px", "py", "pz", "vertex", "weight"};
#define KNOWN "x, y, z, with px, py, pz or vertex, and weight"

typedef struct csv_reader {
    const char *name, *at, *end; /* name: of the file */
    size_t line, next;           /* first line of the row, and of the next one */
    csv_row row;
    size_t width;         /* cells of the header */
    int columns[COLUMNS]; /* what stands in each cell */
    size_t capacity, exact_capacity;
    fit_table *table;
    ffd_error *error;
} csv_reader;

#define REFUSE(reader, ...)                                                                                  \
    ffd_fail_line((reader)->error, FFD_E_INVALID, (reader)->name, (reader)->line, __VA_ARGS__)

static text_word word_of(const char *cell)
{
    return (text_word){cell, cell + strlen(cell)};
}

/* Takes the text of a row, which goes on in the next line where a line ends in quotes; *size: without its
   line break. Returns false at the end of the file. */
static bool take_text(csv_reader *r, const char **text, size_t *size)
{
    csv_scan scan = {.at = 0};
    *text = r->at;
    r->line = r->next;
    while (r->at < r->end) {
        const char *const line = memchr(r->at, '\n', (size_t)(r->end - r->at));
        r->at = line ? line + 1 : r->end;
        r->next++;
        *size = (size_t)(r->at - *text);
        while (*size > 0 && ((*text)[*size - 1] == '\n' || (*text)[*size - 1] == '\r'))
            --*size;
        if (!ffd_csv_is_open(&scan, ",", *text, (size_t)(r->at - *text)))
            return true;
    }
    return *text < r->end;
}

/* Takes the next row that is not blank. *taken: there is one. */
static ffd_status take_row(csv_reader *r, bool *taken)
{
    const char *text;
    size_t size = 0;
    *taken = false;
    do {
        if (!take_text(r, &text, &size))
            return FFD_OK;
    } while (size == 0);
    *taken = true;
    if (!ffd_csv_split(',', text, size, &r->row))
        return REFUSE(r, "a quote is not closed, or stands inside a cell without quotes");
    if (r->row.text.failed || r->row.ways.failed)
        return ffd_fail_memory(r->error);
    if (!ffd_csv_is_text(&r->row))
        return REFUSE(r, "the text is not UTF-8, or has a NUL character");
    return FFD_OK;
}

static ffd_status take_column(csv_reader *r, const char *cell, bool has[COLUMNS])
{
    int column = 0;
    while (column < COLUMNS && !ffd_text_is_any_case(word_of(cell), names[column]))
        column++;
    if (column == COLUMNS)
        return REFUSE(r, "there is no column \"%s\": they are " KNOWN, ffd_text_shown(word_of(cell)).text);
    if (r->width == COLUMNS || has[column])
        return REFUSE(r, "the column %s is there twice", names[column]);
    has[column] = true;
    r->columns[r->width++] = column;
    return FFD_OK;
}

static ffd_status take_header(csv_reader *r)
{
    bool has[COLUMNS] = {false}, taken;
    const char *cell = NULL;
    TRY(take_row(r, &taken));
    if (!taken) {
        r->line = 1;
        return REFUSE(r, "there is no header");
    }
    for (size_t i = 0; i < r->row.count; i++)
        TRY(take_column(r, cell = ffd_csv_next(&r->row, cell), has));
    for (int c = X; c <= Z; c++)
        if (!has[c])
            return REFUSE(r, "there is no column %s: the columns are " KNOWN, names[c]);
    const int places = has[PX] + has[PY] + has[PZ];
    if (has[VERTEX] && places > 0)
        return REFUSE(r, "there are both vertices and places (px, py, pz) as sources");
    if (!has[VERTEX] && places < 3)
        return REFUSE(r, "there are no sources: a column vertex, or px, py and pz");
    return FFD_OK;
}

/* Grows the arrays by a row. */
static bool grow(csv_reader *r, bool has_vertices)
{
    fit_table *const t = r->table;
    const size_t n = t->count + 1;
    size_t capacities[] = {r->capacity, r->capacity, r->capacity, r->capacity};
    const bool grown =
        (has_vertices ? ffd_grow((void **)&t->vertices, &capacities[0], n, sizeof *t->vertices)
                      : ffd_grow((void **)&t->sources, &capacities[0], n, 3 * sizeof *t->sources)) &&
        ffd_grow((void **)&t->targets, &capacities[1], n, 3 * sizeof *t->targets) &&
        ffd_grow((void **)&t->weights, &capacities[2], n, sizeof *t->weights) &&
        ffd_grow((void **)&t->lines, &capacities[3], n, sizeof *t->lines);
    r->capacity = capacities[3];
    return grown;
}

static ffd_status take_weight(csv_reader *r, const char *cell, double *weight)
{
    fit_table *const t = r->table;
    *weight = 1;
    if (!*cell)
        return FFD_OK;
    if (ffd_text_is_any_case(word_of(cell), "exact")) {
        if (!ffd_grow((void **)&t->exact, &r->exact_capacity, t->exact_count + 1, sizeof *t->exact))
            return ffd_fail_memory(r->error);
        t->exact[t->exact_count++] = t->count;
        return FFD_OK;
    }
    return ffd_text_number(word_of(cell), weight) && isfinite(*weight) && *weight > 0
               ? FFD_OK
               : REFUSE(r, "the weight \"%s\" is neither a positive number nor exact",
                        ffd_text_shown(word_of(cell)).text);
}

static ffd_status take_cell(csv_reader *r, int column, const char *cell)
{
    fit_table *const t = r->table;
    const text_word word = word_of(cell);
    uint64_t vertex;
    if (column == WEIGHT)
        return take_weight(r, cell, &t->weights[t->count]);
    if (column == VERTEX) {
        if (!ffd_text_whole(word, &vertex) || vertex >= SIZE_MAX)
            return REFUSE(r, "\"%s\" is not the number of a vertex, which counts from 0",
                          ffd_text_shown(word).text);
        t->vertices[t->count] = (size_t)vertex;
        return FFD_OK;
    }
    double *const number = column < PX ? &t->targets[3 * t->count + (size_t)(column - X)]
                                       : &t->sources[3 * t->count + (size_t)(column - PX)];
    return ffd_text_number(word, number) && isfinite(*number)
               ? FFD_OK
               : REFUSE(r, "\"%s\" is not a number, in column %s", ffd_text_shown(word).text, names[column]);
}

static ffd_status take_pair(csv_reader *r)
{
    const char *cell = NULL;
    bool has_vertices = false;
    if (r->row.count != r->width)
        return REFUSE(r, "has %zu cells, but the header has %zu", r->row.count, r->width);
    for (size_t i = 0; i < r->width; i++)
        has_vertices = has_vertices || r->columns[i] == VERTEX;
    if (!grow(r, has_vertices))
        return ffd_fail_memory(r->error);
    r->table->weights[r->table->count] = 1;
    r->table->lines[r->table->count] = r->line;
    for (size_t i = 0; i < r->width; i++)
        TRY(take_cell(r, r->columns[i], cell = ffd_csv_next(&r->row, cell)));
    r->table->count++;
    return FFD_OK;
}

static ffd_status read_rows(csv_reader *r)
{
    bool taken;
    TRY(take_header(r));
    const size_t header = r->line;
    for (;;) {
        TRY(take_row(r, &taken));
        if (!taken)
            break;
        TRY(take_pair(r));
    }
    r->line = header;
    return r->table->count > 0 ? FFD_OK : REFUSE(r, "there are no rows below the header");
}

ffd_status ffd_fit_table_read(const file_input *file, const char *name, fit_table *table, ffd_error *error)
{
    const char *const text = (const char *)file->data;
    const size_t mark = ffd_text_has_mark(text, file->size) ? TEXT_MARK_SIZE : 0;
    csv_reader reader = {.name = name,
                         .at = text + mark,
                         .end = text + file->size,
                         .line = 1,
                         .next = 1,
                         .table = table,
                         .error = error};
    *table = (fit_table){.count = 0};
    const ffd_status status = read_rows(&reader);
    ffd_csv_free(&reader.row);
    return status;
}

void ffd_fit_table_free(fit_table *table)
{
    ffd_free(table->sources);
    ffd_free(table->vertices);
    ffd_free(table->lines);
    ffd_free(table->targets);
    ffd_free(table->weights);
    ffd_free(table->exact);
    *table = (fit_table){.count = 0};
}
