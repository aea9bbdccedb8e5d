#include "base/text/text_scan.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include <stdio.h>
#include <string.h>

#define SHOWN_MAX 40

enum { ORDINARY = 0, BLANK, LINE_END, HASH };

static const unsigned char classes[256] = {
    ['\t'] = BLANK,    ['\v'] = BLANK,    ['\f'] = BLANK, [' '] = BLANK,
    ['\n'] = LINE_END, ['\r'] = LINE_END, ['#'] = HASH,
};

static int class_of(const text_scan *scan, const char *at)
{
    const int class = classes[(unsigned char)*at];
    return class == HASH && !scan->comments ? ORDINARY : class;
}

bool ffd_text_has_mark(const void *data, size_t size)
{
    return size >= TEXT_MARK_SIZE && memcmp(data, "\xEF\xBB\xBF", TEXT_MARK_SIZE) == 0;
}

#define CTRL_Z '\x1a'

size_t ffd_text_size(const void *data, size_t size)
{
    const char *const first = data, *at = first + size;
    size_t text = size;
    for (; at > first; at--) {
        const int class = classes[(unsigned char)at[-1]];
        if (at[-1] == CTRL_Z)
            text = (size_t)(at - 1 - first);
        else if (class != BLANK && class != LINE_END)
            break;
    }
    return text;
}

bool ffd_text_hash_is_of_word(const char *first, const char *at, const char *last)
{
    static const char *const marks[] = {"#QNAN", "#SNAN", "#IND", "#INF"};
    bool found = false;
    for (size_t i = 0; at > first && at[-1] == '.' && i < sizeof marks / sizeof *marks && !found; i++)
        found = (size_t)(last - at) >= strlen(marks[i]) && memcmp(at, marks[i], strlen(marks[i])) == 0;
    return found;
}

void ffd_text_begin(text_scan *scan, const void *data, size_t size, bool comments)
{
    const char *first = data;
    *scan = (text_scan){.at = first, .last = first + size, .line = 1, .comments = comments};
    if (ffd_text_has_mark(data, size))
        scan->at += TEXT_MARK_SIZE;
}

static const char *pass_blanks(const char *at, const char *last)
{
    while (at < last && classes[(unsigned char)*at] == BLANK)
        at++;
    return at;
}

/* Returns the end of the word that begins at first. */
static const char *find_word_end(const text_scan *scan, const char *first)
{
    const char *const last = scan->last;
    for (const char *at = first;; at++) {
        while (at < last && classes[(unsigned char)*at] == ORDINARY)
            at++;
        if (at == last || *at != '#' || (scan->comments && !ffd_text_hash_is_of_word(first, at, last)))
            return at;
    }
}

bool ffd_text_word(text_scan *scan, text_word *word)
{
    word->first = pass_blanks(scan->at, scan->last);
    word->last = scan->at = find_word_end(scan, word->first);
    return word->first < word->last;
}

bool ffd_text_short_whole(text_scan *scan, text_word *word, uint64_t *value)
{
    const char *const last = scan->last, *const first = pass_blanks(scan->at, last), *at = first;
    uint64_t number = 0;
    for (unsigned digit; at < last && (digit = (unsigned)(*at - '0')) < 10; at++)
        number = number * 10 + digit;
    const ptrdiff_t digits = at - first;
    if (digits == 0 || digits > TEXT_SHORT_DIGITS || (at < last && class_of(scan, at) == ORDINARY))
        return false;
    *word = (text_word){first, at};
    scan->at = at;
    *value = number;
    return true;
}

static const char *find_line_end(const char *at, const char *last)
{
    while (at < last && classes[(unsigned char)*at] != LINE_END)
        at++;
    return at;
}

bool ffd_text_next_line(text_scan *scan)
{
    const char *const last = scan->last, *const end = find_line_end(scan->at, last);
    scan->at = end;
    if (end == last)
        return false;
    scan->at += *end == '\r' && last - end > 1 && end[1] == '\n' ? 2 : 1;
    scan->line++;
    return true;
}

bool ffd_text_find(text_scan *scan)
{
    do {
        scan->at = pass_blanks(scan->at, scan->last);
        if (scan->at < scan->last && class_of(scan, scan->at) == ORDINARY)
            return true;
    } while (ffd_text_next_line(scan));
    return false;
}

const char *ffd_find_text(const char *first, const char *last, const char *text)
{
    const size_t length = strlen(text);
    for (; (size_t)(last - first) >= length; first++) {
        first = memchr(first, text[0], (size_t)(last - first) - length + 1);
        if (!first || memcmp(first, text, length) == 0)
            return first;
    }
    return NULL;
}

bool ffd_text_is(text_word word, const char *text)
{
    const size_t size = strlen(text);
    return (size_t)(word.last - word.first) == size && memcmp(word.first, text, size) == 0;
}

bool ffd_text_is_any_case(text_word word, const char *text)
{
    const size_t size = strlen(text);
    if ((size_t)(word.last - word.first) != size)
        return false;
    for (size_t i = 0; i < size; i++) {
        const char c = word.first[i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != text[i])
            return false;
    }
    return true;
}

bool ffd_text_same(text_word a, text_word b)
{
    const size_t size = (size_t)(a.last - a.first);
    return size == (size_t)(b.last - b.first) && (size == 0 || memcmp(a.first, b.first, size) == 0);
}

bool ffd_text_number(text_word word, double *value)
{
    return ffd_number_parse(word.first, word.last, value) == word.last;
}

bool ffd_text_whole(text_word word, uint64_t *value)
{
    *value = 0;
    for (const char *at = word.first; at < word.last; at++) {
        const unsigned digit = (unsigned)(*at - '0');
        if (*at < '0' || *at > '9')
            return false;
        *value = *value > (UINT64_MAX - digit) / 10 ? UINT64_MAX : *value * 10 + digit;
    }
    return word.first < word.last;
}

int ffd_text_display_size(text_word word)
{
    const ptrdiff_t size = word.last - word.first;
    if (size <= SHOWN_MAX)
        return (int)size;
    int shown = SHOWN_MAX;
    while (shown > 0 && ((unsigned char)word.first[shown] & 0xc0) == 0x80)
        shown--;
    return shown;
}

text_shown ffd_text_shown(text_word word)
{
    text_shown shown;
    ffd_bytes_shown(word.first, (size_t)ffd_text_display_size(word), shown.text, sizeof shown.text);
    return shown;
}

void ffd_text_lines(size_t a, size_t b, char text[TEXT_LINES_CAPACITY])
{
    if (a == b)
        snprintf(text, TEXT_LINES_CAPACITY, " (line %zu)", a);
    else
        snprintf(text, TEXT_LINES_CAPACITY, " (lines %zu and %zu)", a, b);
}

const char *ffd_text_line_ends(const void *data, size_t size)
{
    static const char *const names[8] = {"none", "LF", "CRLF", "mixed", "CR", "mixed", "mixed", "mixed"};
    const char *at = data, *last = at + size;
    unsigned seen = 0;
    for (; at < last; at++) {
        if (*at == '\r' && last - at > 1 && at[1] == '\n') {
            seen |= 2;
            at++;
        } else if (*at == '\n' || *at == '\r')
            seen |= *at == '\n' ? 1 : 4;
    }
    return names[seen];
}
