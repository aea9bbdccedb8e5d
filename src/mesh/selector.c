#include "mesh/selector.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include <stdio.h>
#include <string.h>

/* In the order of selector_kind. */
static const char *const kind_names[SELECTOR_KINDS] = {"node",  "mesh",   "material",
                                                       "group", "object", "joint"};

const char *ffd_selector_kind_name(selector_kind kind)
{
    return kind_names[kind];
}

/* A setting as messages name it, with the word behind "=" if it is not NULL. */
typedef struct option_name {
    char text[120];
} option_name;

static option_name name_option(const char *option, const char *word)
{
    char braced[60];
    option_name name;
    snprintf(braced, sizeof braced, "{%s%s%s}", option, word ? "=" : "", word ? word : "");
    snprintf(name.text, sizeof name.text, "%s", SPELLED(braced));
    return name;
}

ffd_status ffd_selector_parse(const char *option, const char *text, mesh_selector *selector, ffd_error *error)
{
    const bool is_only = strcmp(option, "only") == 0;
    const int kinds = is_only ? SELECT_JOINT : SELECTOR_KINDS;
    const char *const list = is_only ? "node, mesh, material, group or object"
                                     : "node, mesh, material, group, object, joint or component";
    const option_name name = name_option(option, NULL);
    const char *colon = strchr(text, ':');
    char word[40];
    if (!colon)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s: \"%.60s\" is not KIND:NAME (%s)", name.text, text, list);
    snprintf(word, sizeof word, "%.*s", (int)(colon - text < 39 ? colon - text : 39), text);
    for (int kind = 0; kind < kinds; kind++)
        if (strcmp(kind_names[kind], word) == 0) {
            if (!colon[1])
                return ffd_fail(error, FFD_E_ARGUMENT, "%s: \"%s\" has no name after the colon", name.text,
                                text);
            *selector = (mesh_selector){(selector_kind)kind, colon + 1, strlen(colon + 1), option};
            return FFD_OK;
        }
    const char *const meant = ffd_word_meant(word, kind_names, (size_t)kinds);
    return meant ? ffd_fail(error, FFD_E_ARGUMENT, "%s: unknown kind \"%s\" (nearest: %s)", name.text, word,
                            meant)
                 : ffd_fail(error, FFD_E_ARGUMENT, "%s: unknown kind \"%s\", not %s", name.text, word, list);
}

bool ffd_selector_is(const mesh_selector *selector, const char *name, size_t size)
{
    return selector->size == size && memcmp(selector->name, name, size) == 0;
}

/* "group, object or material" */
static void list_kinds(unsigned kinds, char *list, size_t capacity)
{
    size_t length = 0;
    *list = 0;
    for (int kind = 0; kind < SELECTOR_KINDS; kind++) {
        const bool last = kinds >> kind == 1;
        if (kinds & SELECTOR_BIT(kind) && length < capacity)
            length += (size_t)snprintf(list + length, capacity - length, "%s%s",
                                       !length ? ""
                                       : last  ? " and "
                                               : ", ",
                                       kind_names[kind]);
    }
}

ffd_status ffd_selector_check_kind(const mesh_selector *selector, unsigned kinds, const char *format_name,
                                   const char *file, ffd_error *error)
{
    char list[80];
    if (kinds & SELECTOR_BIT(selector->kind))
        return FFD_OK;
    const option_name name = name_option(selector->option, kind_names[selector->kind]);
    if (kinds == 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, file, "%s: a file of format %s is one part without names",
                             name.text, format_name);
    list_kinds(kinds, list, sizeof list);
    return ffd_fail_file(error, FFD_E_ARGUMENT, file, "%s: a file of format %s has only %s", name.text,
                         format_name, list);
}

void ffd_selector_offer(selector_nearest *nearest, const char *name, size_t size)
{
    char offered[sizeof nearest->name];
    ffd_bytes_shown(name, size, offered, sizeof offered);
    const size_t distance = ffd_word_distance(nearest->selector->name, nearest->selector->size, offered);
    if (nearest->offered && distance >= nearest->distance)
        return;
    nearest->offered = true;
    nearest->distance = distance;
    memcpy(nearest->name, offered, sizeof offered);
}

ffd_status ffd_selector_unknown(const selector_nearest *nearest, const char *file, ffd_error *error)
{
    const char *const kind = kind_names[nearest->selector->kind];
    const option_name name = name_option(nearest->selector->option, NULL);
    if (!nearest->offered)
        return ffd_fail_file(error, FFD_E_ARGUMENT, file,
                             "%s: no %s has a name here, so none is called \"%.120s\"", name.text, kind,
                             nearest->selector->name);
    return ffd_fail_file(error, FFD_E_ARGUMENT, file, "%s: no %s is called \"%.120s\" (nearest: \"%s\")",
                         name.text, kind, nearest->selector->name, nearest->name);
}
