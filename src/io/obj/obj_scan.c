#include "io/obj/obj_scan.h"
#include "base/bytes.h"
#include <string.h>

const unsigned char ffd_obj_classes[256] = {
    ['\t'] = OBJ_BLANK,    ['\v'] = OBJ_BLANK,    ['\f'] = OBJ_BLANK,     [' '] = OBJ_BLANK,
    ['\n'] = OBJ_LINE_END, ['\r'] = OBJ_LINE_END, ['\\'] = OBJ_BACKSLASH, ['#'] = OBJ_HASH,
};

size_t ffd_obj_line_end_size(const char *at, const char *last)
{
    return *at == '\r' && last - at > 1 && at[1] == '\n' ? 2 : 1;
}

void ffd_obj_scan_begin(obj_scan *scan, const void *data, size_t size)
{
    const char *first = data;
    *scan = (obj_scan){.at = first, .last = first + size, .line = 1};
    if (ffd_text_has_mark(data, size))
        scan->at += TEXT_MARK_SIZE;
}

static bool takes_names(obj_keyword keyword)
{
    return keyword >= OBJ_GROUP;
}

/* What follows the backslash at `at`: the first character that is not a blank where numbers are expected. */
static const char *after_backslash(const obj_scan *scan, const char *at)
{
    const bool numbers = scan->inside && scan->keyword != OBJ_OTHER && !takes_names(scan->keyword);
    for (at++; numbers && at < scan->last && ffd_obj_class(at) == OBJ_BLANK;)
        at++;
    return at;
}

/* Whether the backslash at `at` continues its line; one at the very end of the file counts too, though it
   joins nothing. */
static bool continues(const obj_scan *scan, const char *at)
{
    const char *const next = after_backslash(scan, at);
    return next == scan->last || ffd_obj_class(next) == OBJ_LINE_END;
}

static void pass_line_end(obj_scan *scan)
{
    scan->at += ffd_obj_line_end_size(scan->at, scan->last);
    scan->line++;
}

static obj_keyword keyword_of(text_word word)
{
    static const struct {
        char text[8];
        size_t size;
        obj_keyword keyword;
    } known[] = {
        {"v", 1, OBJ_VERTEX},       {"f", 1, OBJ_FACE},   {"vn", 2, OBJ_NORMAL},
        {"vt", 2, OBJ_TEXCOORD},    {"l", 1, OBJ_LINE},   {"p", 1, OBJ_POINT},
        {"g", 1, OBJ_GROUP},        {"o", 1, OBJ_OBJECT}, {"usemtl", 6, OBJ_MATERIAL},
        {"mtllib", 6, OBJ_LIBRARY},
    };
    const size_t size = (size_t)(word.last - word.first);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].size == size && known[i].text[0] == *word.first &&
            memcmp(known[i].text, word.first, size) == 0)
            return known[i].keyword;
    return OBJ_OTHER;
}

bool ffd_obj_is_known(text_word name)
{
    static const char *const others[] = {
        "s",         "mg",    "vp",       "cstype",   "deg",  "bmat",   "step",   "curv",
        "curv2",     "surf",  "parm",     "trim",     "hole", "scrv",   "sp",     "end",
        "con",       "bevel", "c_interp", "d_interp", "lod",  "usemap", "maplib", "shadow_obj",
        "trace_obj", "ctech", "stech",    "call",     "csh",  "bsp",    "bzp",    "cdc",
        "cdp",       "res",   "fo",       "vc",       "vw",   "t"};
    bool known = keyword_of(name) != OBJ_OTHER;
    for (size_t i = 0; i < sizeof others / sizeof *others && !known; i++)
        known = ffd_text_is(name, others[i]);
    return known;
}

/* Whether a line begins with a keyword and a blank. */
static bool is_statement(const char *at, const char *last)
{
    while (at < last && ffd_obj_class(at) == OBJ_BLANK)
        at++;
    text_word word = {at, at};
    while (word.last < last && ffd_obj_class(word.last) == OBJ_ORDINARY)
        word.last++;
    return word.first < word.last && word.last < last && ffd_obj_class(word.last) == OBJ_BLANK &&
           keyword_of(word) != OBJ_OTHER;
}

static void note_oddity(obj_oddity *oddity, size_t line)
{
    if (oddity->count++ == 0)
        oddity->line = line;
}

static void pass_continuation(obj_scan *scan)
{
    const char *const next = after_backslash(scan, scan->at);
    const size_t line = scan->line;
    if (next - scan->at > 1)
        note_oddity(&scan->loose, line);
    scan->at = next;
    if (scan->at < scan->last)
        pass_line_end(scan);
    if (scan->inside && is_statement(scan->at, scan->last))
        note_oddity(&scan->joined, line);
}

static void pass_comment(obj_scan *scan)
{
    while (scan->at < scan->last && ffd_obj_class(scan->at) != OBJ_LINE_END)
        scan->at++;
}

bool ffd_obj_is_plain(const char *first, const char *last)
{
    const size_t size = (size_t)(last - first);
    return size == 0 ||
           (!memchr(first, '\r', size) && !memchr(first, '\\', size) && !memchr(first, '#', size));
}

static void pass_plain_line(obj_scan *scan)
{
    const char *end = scan->at < scan->last ? memchr(scan->at, '\n', (size_t)(scan->last - scan->at)) : NULL;
    scan->line += end != NULL;
    scan->at = end ? end + 1 : scan->last;
}

/* Moves past the line that the statement is in, and those that go on with it. */
static void pass_rest(obj_scan *scan)
{
    const bool names = takes_names(scan->keyword);
    while (scan->at < scan->last) {
        const int class = ffd_obj_class(scan->at);
        if (class == OBJ_LINE_END) {
            pass_line_end(scan);
            return;
        }
        if (class == OBJ_BACKSLASH && continues(scan, scan->at))
            pass_continuation(scan);
        else if (class == OBJ_HASH && !names)
            pass_comment(scan);
        else
            scan->at++;
    }
}

void ffd_obj_scan_finish(obj_scan *scan)
{
    if (scan->inside && scan->plain)
        pass_plain_line(scan);
    else if (scan->inside)
        pass_rest(scan);
    scan->inside = false;
}

void ffd_obj_scan_pass_blanks(obj_scan *scan)
{
    while (scan->at < scan->last) {
        const int class = ffd_obj_class(scan->at);
        if (class == OBJ_BLANK)
            scan->at++;
        else if (class == OBJ_BACKSLASH && continues(scan, scan->at))
            pass_continuation(scan);
        else
            return;
    }
}

static bool ends_word(const obj_scan *scan, const char *first, const char *at, bool names)
{
    switch (ffd_obj_class(at)) {
    case OBJ_BLANK:
    case OBJ_LINE_END:
        return true;
    case OBJ_HASH:
        return !names && !ffd_text_hash_is_of_word(first, at, scan->last);
    case OBJ_BACKSLASH:
        return continues(scan, at);
    default:
        return false;
    }
}

/* Returns the next character of a plain text that may not be ordinary: one below '!'. */
static const char *pass_ordinary(const char *at, const char *last)
{
    for (; last - at >= 8; at += 8) {
        const uint64_t low = bytes_low(load_u64((const unsigned char *)at));
        if (low)
            return at + __builtin_ctzll(low) / 8;
    }
    return at;
}

static text_word take_word(obj_scan *scan, bool names)
{
    const char *const first = scan->at, *const last = scan->last;
    const char *at = scan->plain ? pass_ordinary(first, last) : first;
    while (at < last && (ffd_obj_class(at) == OBJ_ORDINARY || !ends_word(scan, first, at, names)))
        at++;
    scan->at = at;
    return (text_word){first, at};
}

static bool is_blank_at(const obj_scan *scan, ptrdiff_t offset)
{
    return scan->last - scan->at > offset && ffd_obj_class(scan->at + offset) == OBJ_BLANK;
}

static void begin_statement(obj_scan *scan, text_word name)
{
    scan->inside = true;
    scan->keyword_line = scan->line;
    scan->name = name;
    scan->at = name.last;
}

/* The statements that files consist of. */
static bool take_common_keyword(obj_scan *scan)
{
    const char c = *scan->at;
    ptrdiff_t size = 1;
    if (c == 'v' && is_blank_at(scan, 1)) {
        scan->keyword = OBJ_VERTEX;
    } else if (c == 'f' && is_blank_at(scan, 1)) {
        scan->keyword = OBJ_FACE;
    } else if (c == 'v' && is_blank_at(scan, 2) && (scan->at[1] == 'n' || scan->at[1] == 't')) {
        scan->keyword = scan->at[1] == 'n' ? OBJ_NORMAL : OBJ_TEXCOORD;
        size = 2;
    } else {
        return false;
    }
    begin_statement(scan, (text_word){scan->at, scan->at + size});
    return true;
}

/* Most often a statement's arguments are all taken, and the next line begins with one of these. */
static bool take_next_line(obj_scan *scan)
{
    if (scan->at == scan->last || *scan->at != '\n' || !scan->inside)
        return false;
    scan->inside = false;
    scan->at++;
    scan->line++;
    return scan->at < scan->last && take_common_keyword(scan);
}

bool ffd_obj_scan_next(obj_scan *scan)
{
    if (take_next_line(scan))
        return true;
    ffd_obj_scan_finish(scan);
    for (;;) {
        ffd_obj_scan_pass_blanks(scan);
        if (scan->at == scan->last)
            return false;
        const int class = ffd_obj_class(scan->at);
        if (class == OBJ_LINE_END)
            pass_line_end(scan);
        else if (class == OBJ_HASH)
            pass_comment(scan);
        else
            break;
    }
    if (take_common_keyword(scan))
        return true;
    begin_statement(scan, take_word(scan, false));
    scan->keyword = keyword_of(scan->name);
    return true;
}

/* Three words with a blank before each, and something that ends the last, all within 64 bytes. */
static bool take_three(obj_scan *scan, text_word words[3])
{
    const char *const at = scan->at;
    if (!scan->plain || scan->last - at < 64 || *at != ' ')
        return false;
    uint64_t ends = bytes_low_of_64(at);
    const char *end = at;
    for (int i = 0; i < 3; i++) {
        ends &= ends - 1;
        if (!ends || ffd_obj_class(end) != OBJ_BLANK)
            return false;
        words[i].first = end + 1;
        end = words[i].last = at + __builtin_ctzll(ends);
        if (words[i].first == end)
            return false;
    }
    scan->at = end;
    return ffd_obj_class(end) != OBJ_ORDINARY;
}

size_t ffd_obj_scan_words(obj_scan *scan, text_word words[3])
{
    const char *const at = scan->at;
    size_t count = 0;
    if (take_three(scan, words))
        return 3;
    for (scan->at = at; count < 3 && ffd_obj_scan_word(scan, &words[count]);)
        count++;
    return count;
}

bool ffd_obj_scan_word(obj_scan *scan, text_word *word)
{
    const bool names = takes_names(scan->keyword);
    ffd_obj_scan_argument(scan);
    *word = take_word(scan, names);
    return word->first < word->last;
}
