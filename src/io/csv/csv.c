#include "io/csv/csv.h"
#include "json/json_chars.h"
#include <string.h>

static bool is_blank(char separator, char c)
{
    return (c == ' ' || c == '\t') && c != separator;
}

static size_t skip_blanks(char separator, const char *text, size_t i, size_t size)
{
    while (i < size && is_blank(separator, text[i]))
        i++;
    return i;
}

/* Reads a quoted cell that begins at the quote text[i]. Returns the index behind its closing quote; 0: there
   is none. */
static size_t take_quoted(const char *text, size_t i, size_t size, byte_buffer *cell)
{
    for (i++; i < size; i++) {
        if (text[i] == '"' && i + 1 < size && text[i + 1] == '"')
            i++;
        else if (text[i] == '"')
            return i + 1;
        ffd_buffer_append(cell, text + i, 1);
    }
    return 0;
}

/* Returns the end of an unquoted cell at text[i]. */
static size_t skip_plain(char separator, const char *text, size_t i, size_t size)
{
    while (i < size && text[i] != separator && text[i] != '"')
        i++;
    return i;
}

bool ffd_csv_is_open(csv_scan *scan, const char *separators, const char *text, size_t size)
{
    for (; scan->at < size; scan->at++) {
        const char c = text[scan->at];
        if (scan->state == CSV_QUOTED)
            scan->state = c == '"' ? CSV_QUOTE_ENDS : CSV_QUOTED;
        else if (c == '"' && (scan->state == CSV_CELL_BEGINS || scan->state == CSV_QUOTE_ENDS)) {
            scan->opened = scan->state == CSV_CELL_BEGINS ? scan->at : scan->opened;
            scan->state = CSV_QUOTED; /* opening quote, or the second of a doubled one */
        } else if (c && strchr(separators, c) && scan->state != CSV_BROKEN)
            scan->state = CSV_CELL_BEGINS;
        else if (c == ' ' || c == '\t')
            scan->state = scan->state == CSV_QUOTE_ENDS ? CSV_CELL_ENDS : scan->state;
        else if (c == '"' || scan->state == CSV_QUOTE_ENDS || scan->state == CSV_CELL_ENDS)
            scan->state = CSV_BROKEN; /* not a valid row, whatever follows */
        else if (scan->state == CSV_CELL_BEGINS)
            scan->state = CSV_PLAIN;
    }
    return scan->state == CSV_QUOTED;
}

char ffd_csv_separator(const char *text, size_t size)
{
    bool quoted = false;
    size_t semicolons = 0, tabs = 0, bars = 0;
    for (size_t i = 0; i < size; i++) {
        quoted = quoted != (text[i] == '"');
        if (!quoted && text[i] == ',')
            return ',';
        semicolons += !quoted && text[i] == ';';
        tabs += !quoted && text[i] == '\t';
        bars += !quoted && text[i] == '|';
    }
    return tabs > semicolons ? '\t' : semicolons ? ';' : bars ? '|' : ',';
}

char ffd_csv_named_separator(const char *text, size_t size)
{
    char line[sizeof "\"sep=;\""] = "";
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == '\r'))
        size--;
    if (size >= sizeof line)
        return 0;
    memcpy(line, text, size);
    const bool quoted = line[0] == '"';
    const char *const word = line + quoted;
    if (strncmp(word, "sep=", 4) != 0 || !word[4] || !strchr(CSV_SEPARATORS, word[4]))
        return 0;
    return strcmp(word + 5, quoted ? "\"" : "") == 0 ? word[4] : 0;
}

/* Reads the cell at text[*at]; *at becomes the index of its separator, or the size. Returns false if it is
   not valid. */
static bool take_cell(char separator, const char *text, size_t *at, size_t size, csv_row *row)
{
    const size_t begin = *at, first = skip_blanks(separator, text, begin, size);
    char way = first > begin ? CSV_HAD_BLANKS : 0;
    size_t i = first;
    if (first < size && text[first] == '"') {
        const size_t end = take_quoted(text, first, size, &row->text);
        i = end ? skip_blanks(separator, text, end, size) : 0;
        way = (char)(way | CSV_IN_QUOTES | (i > end ? CSV_HAD_BLANKS : 0));
        if (i == 0 || (i < size && text[i] != separator))
            return false;
    } else {
        i = skip_plain(separator, text, first, size);
        if (i < size && text[i] == '"')
            return false;
        size_t end = i;
        while (end > first && is_blank(separator, text[end - 1]))
            end--;
        ffd_buffer_append(&row->text, text + first, end - first);
        way = (char)(way | (end < i ? CSV_HAD_BLANKS : 0));
    }
    ffd_buffer_append(&row->text, "", 1);
    ffd_buffer_append(&row->ways, &way, 1);
    *at = i;
    return true;
}

bool ffd_csv_split(char separator, const char *text, size_t size, csv_row *row)
{
    row->text.size = row->ways.size = row->count = 0;
    for (size_t i = 0;; i++) {
        if (!take_cell(separator, text, &i, size, row))
            return false;
        row->count++;
        if (i >= size)
            return true;
    }
}

bool ffd_csv_is_text(const csv_row *row)
{
    const char *cell = row->text.data;
    const char *const end = cell + row->text.size;
    size_t count = 0;
    for (; cell < end; cell = ffd_csv_next(row, cell), count++)
        if (!ffd_utf8_is_valid(cell, strlen(cell)))
            return false;
    return count == row->count; /* else a cell has NUL bytes */
}

const char *ffd_csv_next(const csv_row *row, const char *cell)
{
    return cell ? cell + strlen(cell) + 1 : row->text.data;
}

static size_t count_digits(const char *text)
{
    return strspn(text, "0123456789");
}

bool ffd_csv_number(const char *cell, bool decimal_comma, byte_buffer *json)
{
    const char *c = cell + strspn(cell, " \t");
    const bool is_negative = *c == '-', has_sign = is_negative || *c == '+';
    const char *const whole = c + has_sign;
    const size_t digits = count_digits(whole);
    const char *const point = whole + digits;
    const bool has_point = *point == '.' || (decimal_comma && *point == ',');
    const size_t decimals = has_point ? count_digits(point + 1) : 0;
    const char *const power = point + has_point + decimals;
    const bool has_power = *power == 'e' || *power == 'E';
    const char *const exponent = power + has_power + (has_power && power[1] && strchr("+-", power[1]));
    const size_t power_digits = has_power ? count_digits(exponent) : 0;
    const char *const end = exponent + power_digits;
    if (digits + decimals == 0 || (has_power && power_digits == 0) || end[strspn(end, " \t")])
        return false;
    const size_t zeros = strspn(whole, "0");
    ffd_buffer_text(json, is_negative ? "-" : "");
    ffd_buffer_text(json, zeros >= digits ? "0" : "");
    if (zeros < digits)
        ffd_buffer_append(json, whole + zeros, digits - zeros);
    if (decimals) {
        ffd_buffer_text(json, ".");
        ffd_buffer_append(json, point + 1, decimals);
    }
    ffd_buffer_append(json, power, (size_t)(end - power));
    return true;
}

csv_point ffd_csv_point(const char *cell)
{
    const char *const dot = strchr(cell, '.');
    const size_t digits = dot ? count_digits(dot + 1) : 0;
    if (strchr(cell, ','))
        return CSV_DECIMAL_COMMA;
    return digits == 3 && !dot[4 + strspn(dot + 4, " \t")] ? CSV_DOT_OF_THREE : (csv_point)0;
}

void ffd_csv_free(csv_row *row)
{
    ffd_buffer_free(&row->text);
    ffd_buffer_free(&row->ways);
    *row = (csv_row){0};
}
