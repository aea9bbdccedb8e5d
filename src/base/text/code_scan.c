#include "base/text/code_scan.h"
#include <string.h>

static bool begins(const text_scan *scan, const char *at, char second)
{
    return scan->last - at > 1 && at[0] == '/' && at[1] == second;
}

/* Moves to a place further on, and counts the lines up to there. */
static void move_to(text_scan *scan, const char *to)
{
    text_scan passed = *scan;
    passed.last = to;
    while (ffd_text_next_line(&passed))
        ;
    scan->at = to;
    scan->line = passed.line;
}

/* Moves past a comment of several lines. Returns false if it does not end. */
static bool pass_comment(text_scan *scan)
{
    const char *const end = ffd_find_text(scan->at + 2, scan->last, "*/");
    move_to(scan, end ? end + 2 : scan->last);
    return end;
}

bool ffd_code_find(text_scan *scan)
{
    while (ffd_text_find(scan)) {
        if (begins(scan, scan->at, '/')) {
            if (!ffd_text_next_line(scan))
                return false;
        } else if (!begins(scan, scan->at, '*'))
            return true;
        else if (!pass_comment(scan))
            return false;
    }
    return false;
}

static bool is_of_word(const text_scan *scan, const char *at)
{
    switch (*at) {
    case '(':
    case ')':
    case '[':
    case ']':
    case '{':
    case '}':
    case ';':
    case '"':
    case '\n':
    case '\r':
        return false;
    case '/':
        return !begins(scan, at, '/') && !begins(scan, at, '*');
    default:
        return !ffd_text_is_blank(*at);
    }
}

bool ffd_code_word(text_scan *scan, text_word *word)
{
    if (!ffd_code_find(scan))
        return false;
    const char *at = scan->at;
    while (at < scan->last && is_of_word(scan, at))
        at++;
    if (at == scan->at)
        return false;
    *word = (text_word){scan->at, at};
    scan->at = at;
    return true;
}

bool ffd_code_mark(text_scan *scan, char mark)
{
    if (!ffd_code_find(scan) || *scan->at != mark)
        return false;
    scan->at++;
    return true;
}

bool ffd_code_string(text_scan *scan, text_word *word)
{
    if (!ffd_code_find(scan) || *scan->at != '"')
        return false;
    const char *const first = scan->at + 1, *end = first;
    while (end < scan->last && *end != '"')
        end += *end == '\\' && scan->last - end > 1 ? 2 : 1;
    if (end >= scan->last)
        return false;
    *word = (text_word){first, end};
    move_to(scan, end + 1);
    return true;
}
