#include "mesh/selector.h"
#include "base/text/words.h"
#include <stdio.h>
#include <string.h>

/* In the order of selector_kind. */
static const char *const kind_names[SELECTOR_KINDS] = {"node", "mesh", "material", "group", "object"};

const char *ffd_selector_kind_name(selector_kind kind)
{
    return kind_names[kind];
}

ffd_status ffd_selector_parse(const char *text, mesh_selector *selector, ffd_error *error)
{
    const char *colon = strchr(text, ':');
    char word[40];
    if (!colon)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "{only}: \"%.60s\" is not KIND:NAME (node, mesh, material, group or object)", text);
    snprintf(word, sizeof word, "%.*s", (int)(colon - text < 39 ? colon - text : 39), text);
    for (int kind = 0; kind < SELECTOR_KINDS; kind++)
        if (strcmp(kind_names[kind], word) == 0) {
            if (!colon[1])
                return ffd_fail(error, FFD_E_ARGUMENT, "{only}: \"%s\" has no name after the colon", text);
            *selector = (mesh_selector){(selector_kind)kind, colon + 1, strlen(colon + 1)};
            return FFD_OK;
        }
    const char *const meant = ffd_word_meant(word, kind_names, SELECTOR_KINDS);
    return meant ? ffd_fail(error, FFD_E_ARGUMENT, "{only}: unknown kind \"%s\" (nearest: %s)", word, meant)
                 : ffd_fail(error, FFD_E_ARGUMENT,
                            "{only}: unknown kind \"%s\", not node, mesh, material, group or object", word);
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
    if (kinds == 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, file,
                             "{only=%s}: a file of format %s is one part without names",
                             kind_names[selector->kind], format_name);
    list_kinds(kinds, list, sizeof list);
    return ffd_fail_file(error, FFD_E_ARGUMENT, file, "{only=%s}: a file of format %s has only %s",
                         kind_names[selector->kind], format_name, list);
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
    const char *kind = kind_names[nearest->selector->kind];
    if (!nearest->offered)
        return ffd_fail_file(error, FFD_E_ARGUMENT, file,
                             "{only}: no %s has a name here, so none is called \"%.120s\"", kind,
                             nearest->selector->name);
    return ffd_fail_file(error, FFD_E_ARGUMENT, file, "{only}: no %s is called \"%.120s\" (nearest: \"%s\")",
                         kind, nearest->selector->name, nearest->name);
}
