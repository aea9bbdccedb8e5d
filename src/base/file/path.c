#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#ifdef _WIN32
#include "base/windows/names.h"
#endif
#include <string.h>

/* A byte that is in no character of UTF-8 counts as a character beyond the last one. */
#define BEYOND 0x110000u

bool ffd_is_separator(char c)
{
#ifdef _WIN32
    return c == '/' || c == '\\';
#else
    return c == '/';
#endif
}

static uint32_t fold_case(uint32_t c)
{
#ifdef _WIN32
    return ffd_small_letter(c);
#else
    return c;
#endif
}

uint32_t ffd_take_character(const char **text)
{
    const unsigned char *const at = (const unsigned char *)*text;
    const size_t length = at[0] < 0x80 ? 1 : at[0] >= 0xf0 ? 4 : at[0] >= 0xe0 ? 3 : at[0] >= 0xc0 ? 2 : 0;
    uint32_t value = length == 1 ? at[0] : length ? at[0] & (0x7fu >> length) : 0;
    for (size_t i = 1; i < length; i++) {
        if ((at[i] & 0xc0) != 0x80) {
            *text += 1;
            return BEYOND + at[0];
        }
        value = value << 6 | (at[i] & 0x3fu);
    }
    *text += length ? length : 1;
    return length ? fold_case(value) : BEYOND + at[0];
}

/* Passes over a character in both paths. Returns false if these differ. Not at an end of either. */
static bool pass_same(const char **a, const char **b)
{
#ifdef _WIN32
    return ffd_take_character(a) == ffd_take_character(b);
#else
    return *(*a)++ == *(*b)++;
#endif
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

const char *ffd_path_name(const char *path)
{
    const char *name = path;
    for (const char *c = path; *c; c++)
        if (ffd_is_separator(*c))
            name = c + 1;
    return name;
}

bool ffd_path_is_absolute(const char *path)
{
#ifdef _WIN32
    if (path[0] && path[1] == ':')
        return true;
#endif
    return ffd_is_separator(path[0]);
}

/* Returns the length of the part of an absolute path that ".." does not leave: "/", and on Windows "C:/" and
   the first two separators of "//server/share"; 0: the path is relative. */
static size_t root_length(const char *path)
{
    size_t length = 0;
#ifdef _WIN32
    if (path[0] && path[1] == ':')
        length = 2;
    else if (ffd_is_separator(path[0]) && ffd_is_separator(path[1]))
        return 2;
#endif
    return length + ffd_is_separator(path[length]);
}

const char *ffd_path_ending(const char *path)
{
    const char *name = ffd_path_name(path);
    const char *dot = strrchr(name, '.');
    return dot && dot != name ? dot : path + strlen(path);
}

bool ffd_path_has_ending(const char *path, const char *ending)
{
    const char *own = ffd_path_ending(path);
    while (*own && lower(*own) == lower(*ending)) {
        own++;
        ending++;
    }
    return *own == 0 && *ending == 0;
}

static char *copy_range(const char *first, size_t length)
{
    char *text = ffd_alloc(length + 1, 1);
    if (!text)
        return NULL;
    memcpy(text, first, length);
    text[length] = 0;
    return text;
}

char *ffd_path_folder(const char *path)
{
    const char *name = ffd_path_name(path);
    if (name == path)
        return copy_range(".", 1);
    const size_t root = root_length(path);
    size_t length = (size_t)(name - path);
    while (length > root && ffd_is_separator(path[length - 1]))
        length--;
    return copy_range(path, length);
}

char *ffd_path_stem(const char *path)
{
    const char *name = ffd_path_name(path), *ending = ffd_path_ending(path);
    return copy_range(name, (size_t)(ending - name));
}

char *ffd_path_join(const char *folder, const char *name)
{
    const size_t a = strlen(folder), b = strlen(name);
    const bool separator = a > 0 && !ffd_is_separator(folder[a - 1]);
    char *text = ffd_alloc(a + separator + b + 1, 1);
    if (!text)
        return NULL;
    memcpy(text, folder, a);
    if (separator)
        text[a] = '/';
    memcpy(text + a + separator, name, b + 1);
    return text;
}

char *ffd_path_sibling(const char *path, const char *name)
{
    const size_t folder = (size_t)(ffd_path_name(path) - path), length = strlen(name);
    char *text = ffd_alloc(folder + length + 1, 1);
    if (!text)
        return NULL;
    memcpy(text, path, folder);
    memcpy(text + folder, name, length + 1);
    return text;
}

char *ffd_path_with_ending(const char *path, const char *ending)
{
    const size_t kept = (size_t)(ffd_path_ending(path) - path), length = strlen(ending);
    const size_t dot = *ending == '.';
    char *text = ffd_alloc(kept + length + 2, 1);
    if (!text)
        return NULL;
    memcpy(text, path, kept);
    text[kept] = '.';
    for (size_t i = dot; i <= length; i++)
        text[kept + 1 + i - dot] = lower(ending[i]);
    return text;
}

char *ffd_text_copy(const char *text)
{
    return copy_range(text, strlen(text));
}

/* Returns the length of the name at the beginning of a path. */
static size_t name_length(const char *path)
{
    size_t length = 0;
    while (path[length] && !ffd_is_separator(path[length]))
        length++;
    return length;
}

char *ffd_path_normalize(const char *path)
{
    char *out = ffd_alloc(strlen(path) + 1, 1);
    if (!out)
        return NULL;
    size_t length = 0, kept = 0; /* kept: length of the leading "/" or "../" sequence */
    const bool absolute = ffd_path_is_absolute(path);
    for (size_t root = root_length(path); root > 0; root--, path++)
        out[length++] = (char)(ffd_is_separator(*path) ? '/' : *path);
    kept = length;
    while (*path) {
        size_t part = name_length(path);
        const bool up = part == 2 && path[0] == '.' && path[1] == '.';
        if (up && length > kept) {
            while (length > kept && out[length - 1] != '/')
                length--;
            if (length > kept)
                length--;
        } else if (part > 0 && !(part == 1 && path[0] == '.') && !(up && absolute)) {
            if (length > 0 && out[length - 1] != '/')
                out[length++] = '/';
            memmove(out + length, path, part);
            length += part;
            if (up)
                kept = length;
        }
        path += part;
        path += ffd_is_separator(*path);
    }
    out[length] = 0;
    return out;
}

bool ffd_path_is_inside(const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    const bool is_root = length > 0 && folder[length - 1] == '/';
    while (*folder && *path)
        if (!pass_same(&folder, &path))
            return false;
    return !*folder && (is_root || *path == '/');
}

bool ffd_path_leads_out(const char *path)
{
    return strcmp(path, "..") == 0 || strncmp(path, "../", 3) == 0;
}

char *ffd_path_relative(const char *from, const char *to)
{
    /* Behind the names that both have. */
    const char *from_rest = from, *to_rest = to;
    for (bool same = true; same;) {
        const bool from_ends = *from == 0 || *from == '/', to_ends = *to == 0 || *to == '/';
        if (from_ends && to_ends) {
            from_rest = from;
            to_rest = to;
        }
        same = *from && *to && pass_same(&from, &to);
    }
    byte_buffer out = {0};
    for (const char *c = from_rest; *c; c++)
        if (*c == '/' && c[1])
            ffd_buffer_text(&out, "../");
    ffd_buffer_text(&out, *to_rest == '/' ? to_rest + 1 : to_rest);
    return ffd_buffer_finish(&out);
}

bool ffd_names_equal(const char *a, const char *b)
{
#ifdef _WIN32
    return ffd_equal_without_case(a, b);
#else
    return strcmp(a, b) == 0;
#endif
}
