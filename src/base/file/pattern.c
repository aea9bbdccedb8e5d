#include "base/file/pattern.h"
#include "base/file/path.h"
#include <stdint.h>
#include <string.h>

#ifdef _WIN32
#define ESCAPES false
#else
#define ESCAPES true
#endif

/* Takes the next character of text; a backslash before it is passed over. */
static uint32_t take_escaped(const char **text, const char *end)
{
    if (ESCAPES && **text == '\\' && *text + 1 < end)
        ++*text;
    return ffd_take_character(text);
}

/* Returns the end of the bracket expression at `at`, behind its ']'; NULL: there is none, and '[' is a
   character. */
static const char *end_of_bracket(const char *at, const char *end)
{
    const char *first = at + 1;
    first += first < end && (*first == '!' || *first == '^');
    for (const char *c = first; c < end; c++) {
        if (*c == ']' && c > first)
            return c + 1;
        const char *const closed = *c == '[' && c + 1 < end && c[1] == ':' ? strstr(c, ":]") : NULL;
        if (closed && closed < end - 2)
            c = closed + 1;
        else if (ESCAPES && *c == '\\' && c + 1 < end)
            c++;
    }
    return NULL;
}

static bool is_of_class(const char *name, size_t length, uint32_t c)
{
    const bool lower = c >= 'a' && c <= 'z', upper = c >= 'A' && c <= 'Z', digit = c >= '0' && c <= '9',
               graph = c > ' ' && c < 0x7f, blank = c == ' ' || c == '\t';
    const struct {
        const char *name;
        bool holds;
    } classes[] = {
        {"alpha", lower || upper},
        {"digit", digit},
        {"alnum", lower || upper || digit},
        {"lower", lower},
        {"upper", upper},
        {"xdigit", digit || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')},
        {"space", blank || (c >= '\n' && c <= '\r')},
        {"blank", blank},
        {"punct", graph && !(lower || upper || digit)},
        {"graph", graph},
        {"print", graph || c == ' '},
        {"cntrl", c < ' ' || c == 0x7f},
    };
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++)
        if (strlen(classes[i].name) == length && strncmp(classes[i].name, name, length) == 0)
            return classes[i].holds;
    return false;
}

/* Whether a character is in the bracket expression from `at` to `end`. */
static bool is_in_bracket(const char *at, const char *end, uint32_t c)
{
    bool found = false;
    const char *const last = end - 1; /* the ']' */
    at++;
    const bool inverse = *at == '!' || *at == '^';
    at += inverse;
    do {
        const char *const closed = at[0] == '[' && at[1] == ':' ? strstr(at, ":]") : NULL;
        if (closed && closed < last) {
            found = found || is_of_class(at + 2, (size_t)(closed - at) - 2, c);
            at = closed + 2;
            continue;
        }
        const uint32_t first = take_escaped(&at, last);
        const bool is_range = at[0] == '-' && at + 1 < last;
        at += is_range;
        const uint32_t until = is_range ? take_escaped(&at, last) : first;
        found = found || (c >= first && c <= until);
    } while (at < last);
    return found != inverse;
}

/* Matches one character of a name by what is at *pattern, which is no '*', and passes over both. */
static bool match_one(const char **pattern, const char *end, const char **name)
{
    const char *const bracket = **pattern == '[' ? end_of_bracket(*pattern, end) : NULL;
    if (!**name)
        return false;
    const uint32_t c = ffd_take_character(name);
    if (bracket) {
        const char *const at = *pattern;
        *pattern = bracket;
        return is_in_bracket(at, bracket, c);
    }
    if (**pattern == '?') {
        ++*pattern;
        return true;
    }
    return take_escaped(pattern, end) == c;
}

bool ffd_pattern_matches(const char *pattern, size_t length, const char *name)
{
    const char *const end = pattern + length;
    const char *star = NULL, *from = NULL; /* behind the last '*', and where what follows it was tried */
    if (*name == '.' && !(length > 0 && (*pattern == '.' || (ESCAPES && strncmp(pattern, "\\.", 2) == 0))))
        return false;
    for (;;) {
        if (pattern < end && *pattern == '*') {
            star = ++pattern;
            from = name;
        } else if (pattern == end && !*name) {
            return true;
        } else if (pattern == end || !match_one(&pattern, end, &name)) {
            if (!star || !*from)
                return false;
            ffd_take_character(&from);
            pattern = star;
            name = from;
        }
    }
}

bool ffd_pattern_has_wildcards(const char *pattern, size_t length)
{
    const char *const end = pattern + length;
    for (const char *c = pattern; c < end; c++) {
        if (*c == '*' || *c == '?' || (*c == '[' && end_of_bracket(c, end)))
            return true;
        c += ESCAPES && *c == '\\' && c + 1 < end;
    }
    return false;
}

void ffd_pattern_unescape(char *text)
{
    char *to = text;
    for (const char *from = text; ESCAPES && *from; from++) {
        from += *from == '\\' && from[1];
        *to++ = *from;
    }
    if (ESCAPES)
        *to = 0;
}
