#include "base/spelling.h"
#include <stdio.h>
#include <string.h>

/* The characters of a member's name. */
#define NAME "abcdefghijklmnopqrstuvwxyz_."

static void spell_as_in_c(const char *member, const char *value, char *text, size_t capacity)
{
    snprintf(text, capacity, "%s%s%s", member, value ? " = " : "", value ? value : "");
}

static ffd_spell_function spell = spell_as_in_c;

void ffd_spell_members(ffd_spell_function function)
{
    spell = function ? function : spell_as_in_c;
}

ffd_spell_function ffd_spelling(void)
{
    return spell;
}

/* Spells the member in braces at the start of a text. Returns the length that it has in the text; 0: it is
   none. */
static size_t spell_one(const char *text, char *spelled, size_t capacity)
{
    char copy[128];
    const size_t name = strspn(text + 1, NAME);
    const size_t length = 1 + name + (text[1 + name] == '=' ? strcspn(text + 1 + name, "{}") : 0);
    if (name == 0 || text[length] != '}' || length > sizeof copy)
        return 0;
    memcpy(copy, text + 1, length - 1);
    copy[length - 1] = 0;
    copy[name] = 0;
    spell(copy, length > 1 + name ? copy + name + 1 : NULL, spelled, capacity);
    return length + 1;
}

const char *ffd_spelled(const char *text, char *buffer, size_t capacity)
{
    size_t used = 0;
    if (!strchr(text, '{'))
        return text;
    while (*text && used + 1 < capacity) {
        const size_t length = *text == '{' ? spell_one(text, buffer + used, capacity - used) : 0;
        if (length > 0)
            used += strlen(buffer + used);
        else
            buffer[used++] = *text;
        text += length > 0 ? length : 1;
    }
    buffer[used] = 0;
    return buffer;
}
