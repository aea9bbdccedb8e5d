#include "io/su2/su2_sections.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <inttypes.h>
#include <string.h>

typedef struct finder {
    text_scan scan;
    const char *name;
    su2_sections *sections;
    text_word tag;
    bool has_tag;
    bool is_full; /* the lines that a key has stated are all there, so that no others may follow */
    ffd_error *error;
} finder;

#define REFUSE(f, line, ...) ffd_fail_line((f)->error, FFD_E_INVALID, (f)->name, line, __VA_ARGS__)

bool ffd_su2_line(text_scan *scan)
{
    while (ffd_text_find(scan)) {
        if (*scan->at != SU2_COMMENT)
            return true;
        if (!ffd_text_next_line(scan))
            break;
    }
    return false;
}

bool ffd_su2_word(text_scan *scan, text_word *word)
{
    const text_scan before = *scan;
    if (!ffd_text_word(scan, word))
        return false;
    const char *const comment = memchr(word->first, SU2_COMMENT, (size_t)(word->last - word->first));
    if (!comment)
        return true;
    word->last = comment;
    *scan = before;
    scan->at = comment;
    return comment > word->first;
}

/* Takes KEY of a line KEY= VALUE, and moves to the value. */
static bool take_key(text_scan *scan, text_word *key)
{
    const char *at = scan->at;
    while (at < scan->last && *at != '=' && *at != '\n' && *at != '\r' && *at != SU2_COMMENT)
        at++;
    if (at == scan->last || *at != '=')
        return false;
    *key = (text_word){scan->at, at};
    while (key->last > key->first && ffd_text_is_blank(key->last[-1]))
        key->last--;
    scan->at = at + 1;
    return true;
}

static ffd_status take_whole(finder *f, text_word key, uint64_t *number)
{
    text_word word = {"", ""};
    return ffd_su2_word(&f->scan, &word) && ffd_text_whole(word, number)
               ? FFD_OK
               : REFUSE(f, f->scan.line, "%s is not a whole number: \"%s\"", ffd_text_shown(key).text,
                        ffd_text_shown(word).text);
}

/* Moves past the line SEND_RECV= that a marker between two processors or periodic sides may have. */
static void skip_send(finder *f)
{
    text_scan ahead = f->scan;
    text_word key;
    if (!ffd_su2_line(&ahead) || !take_key(&ahead, &key) || !ffd_text_is(key, "SEND_RECV"))
        return;
    ffd_text_next_line(&ahead);
    f->scan = ahead;
}

/* Adds a section, whose lines follow, and moves past these. */
static ffd_status add(finder *f, su2_kind kind, text_word key)
{
    su2_sections *const s = f->sections;
    const size_t line = f->scan.line;
    uint64_t count;
    TRY(take_whole(f, key, &count));
    ffd_text_next_line(&f->scan);
    if (kind == SU2_MARKER)
        skip_send(f);
    if (!ffd_grow((void **)&s->list, &s->capacity, s->count + 1, sizeof *s->list))
        return ffd_fail_memory(f->error);
    s->list[s->count++] = (su2_section){kind, count, f->scan, f->tag, s->zones ? (size_t)s->zones - 1 : 0};
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, f->error));
        if (!ffd_su2_line(&f->scan))
            return REFUSE(f, line, "%s states %" PRIu64 " lines, but only %" PRIu64 " follow",
                          ffd_text_shown(key).text, count, i);
        ffd_text_next_line(&f->scan);
    }
    f->is_full = true;
    return FFD_OK;
}

static ffd_status take_dimensions(finder *f, text_word key)
{
    su2_sections *const s = f->sections;
    uint64_t dimensions;
    TRY(take_whole(f, key, &dimensions));
    if (dimensions != 2 && dimensions != 3)
        return REFUSE(f, f->scan.line, "NDIME is %" PRIu64 ", not 2 or 3", dimensions);
    if (s->dimensions && s->dimensions != dimensions)
        return ffd_fail_line(f->error, FFD_E_UNSUPPORTED, f->name, f->scan.line,
                             "zones of two and of three dimensions in one file are not supported");
    s->dimensions = dimensions;
    return FFD_OK;
}

static ffd_status take_value(finder *f, text_word key)
{
    uint64_t number;
    f->is_full = false;
    if (ffd_text_is(key, "NELEM"))
        return add(f, SU2_ELEMENTS, key);
    if (ffd_text_is(key, "NPOIN"))
        return add(f, SU2_POINTS, key);
    if (ffd_text_is(key, "NDIME"))
        return take_dimensions(f, key);
    if (ffd_text_is(key, "IZONE")) {
        f->sections->zones++;
        return FFD_OK;
    }
    if (ffd_text_is(key, "MARKER_TAG")) {
        f->has_tag = ffd_su2_word(&f->scan, &f->tag);
        return f->has_tag ? FFD_OK : REFUSE(f, f->scan.line, "MARKER_TAG has no name");
    }
    if (ffd_text_is(key, "MARKER_ELEMS"))
        return f->has_tag ? add(f, SU2_MARKER, key)
                          : REFUSE(f, f->scan.line, "MARKER_ELEMS are there before MARKER_TAG");
    if (ffd_text_is(key, "FFD_NBOX")) {
        TRY(take_whole(f, key, &number));
        f->sections->has_ffd_boxes = f->sections->has_ffd_boxes || number > 0;
    }
    return FFD_OK;
}

ffd_status ffd_su2_find(const text_scan *file, const char *name, su2_sections *sections, ffd_error *error)
{
    finder f = {.scan = *file, .name = name, .sections = sections, .error = error};
    while (ffd_su2_line(&f.scan)) {
        const size_t line = f.scan.line;
        text_word key;
        if (!take_key(&f.scan, &key)) {
            if (f.is_full || (sections->count == 0 && !sections->dimensions && !sections->zones))
                return REFUSE(&f, line, "a line KEY= VALUE is expected here");
            ffd_text_next_line(&f.scan);
            continue;
        }
        TRY(take_value(&f, key));
        if (f.scan.line == line)
            ffd_text_next_line(&f.scan);
    }
    if (!sections->dimensions)
        return ffd_fail_file(error, FFD_E_INVALID, name, "has no NDIME= (the number of dimensions)");
    return FFD_OK;
}
