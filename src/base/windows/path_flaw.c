#include "base/windows/path_flaw.h"
#include <stdbool.h>
#include <string.h>

static char upper(char c)
{
    return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

/* Whether the first `length` characters are a word of capitals. */
static bool is_word(const char *name, size_t length, const char *word)
{
    if (strlen(word) != length)
        return false;
    for (size_t i = 0; i < length; i++)
        if (upper(name[i]) != word[i])
            return false;
    return true;
}

/* Whether a name is that of a device, whatever ending it has: NUL, con.obj, "aux .bin", COM1. Windows takes
   the superscripts 1 to 3 for digits here. */
static bool is_device(const char *name, size_t length)
{
    static const char *const words[] = {"CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"};
    static const char *const ports[] = {"COM", "LPT"};
    size_t stem = 0;
    while (stem < length && name[stem] != '.' && name[stem] != ':')
        stem++;
    while (stem > 0 && name[stem - 1] == ' ')
        stem--;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (is_word(name, stem, words[i]))
            return true;
    for (size_t i = 0; i < sizeof ports / sizeof *ports && stem > 3; i++) {
        const char *const digit = name + 3;
        const bool is_superscript = stem == 5 && digit[0] == '\xc2' &&
                                    (digit[1] == '\xb9' || digit[1] == '\xb2' || digit[1] == '\xb3');
        if (is_word(name, 3, ports[i]) && (is_superscript || (stem == 4 && *digit >= '0' && *digit <= '9')))
            return true;
    }
    return false;
}

static const char *flaw_of(const char *name, size_t length)
{
    const bool is_dots = (length == 1 || length == 2) && strncmp(name, "..", length) == 0;
    if (length == 0 || is_dots)
        return NULL;
    if (is_device(name, length))
        return "is the name of a device in Windows, not of a file";
    if (memchr(name, ':', length))
        return "is the name of a stream in Windows, not of a file";
    return name[length - 1] == '.' || name[length - 1] == ' '
               ? "ends in a dot or a blank, which Windows leaves out"
               : NULL;
}

const char *ffd_path_flaw(const char *path)
{
    if (strncmp(path, "\\\\?\\", 4) == 0 || strncmp(path, "//?/", 4) == 0)
        path += 4;
    if (((path[0] >= 'a' && path[0] <= 'z') || (path[0] >= 'A' && path[0] <= 'Z')) && path[1] == ':')
        path += 2;
    for (const char *flaw; *path; path += *path != 0) {
        const size_t length = strcspn(path, "/\\");
        flaw = flaw_of(path, length);
        if (flaw)
            return flaw;
        path += length;
    }
    return NULL;
}
