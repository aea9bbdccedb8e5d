#include "job/input/setting_lists.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "job/input/settings.h"
#include <string.h>

/* In front of the elements of a list. */
typedef union list_head {
    struct {
        size_t capacity;
        intern_table known; /* names so far */
        char **names;       /* copies of them */
        size_t name_count, name_capacity;
    } list;
    long double aligned; /* elements of any type follow */
} list_head;

static size_t element_size(const ffd_member *member)
{
    return member->kind == FFD_MEMBER_VALUES     ? sizeof(ffd_setting)
           : member->kind == FFD_MEMBER_LATTICES ? sizeof(ffd_lattice_source)
                                                 : sizeof(const char *);
}

static void **items_of(const ffd_member *member, void *base)
{
    return (void **)(void *)((char *)base + member->offset);
}

static size_t *count_of(const ffd_member *member, void *base)
{
    return (size_t *)(void *)((char *)base + member->second);
}

static list_head *head_of(const ffd_member *member, void *base)
{
    char *const items = *items_of(member, base);
    return items ? (list_head *)(void *)(items - sizeof(list_head)) : NULL;
}

/* Gives a list room for `needed` elements; new ones are zeros. */
static bool grow(const ffd_member *member, void *base, size_t needed)
{
    const size_t size = element_size(member);
    list_head *head = head_of(member, base);
    const size_t before = head ? head->list.capacity : 0;
    if (needed <= before)
        return true;
    const size_t capacity = needed + needed / 2;
    size_t bytes;
    if (!ffd_multiply_size(capacity, size, &bytes) || !ffd_add_size(bytes, sizeof *head, &bytes))
        return false;
    list_head *const grown = ffd_realloc(head, bytes, 1);
    if (!grown)
        return false;
    if (!head)
        *grown = (list_head){.list = {0}};
    grown->list.capacity = capacity;
    char *const items = (char *)(grown + 1);
    memset(items + before * size, 0, (capacity - before) * size);
    *items_of(member, base) = items;
    return true;
}

void *ffd_setting_list_add(const ffd_member *member, void *base)
{
    size_t *const count = count_of(member, base);
    if (!grow(member, base, *count + 1))
        return NULL;
    return (char *)*items_of(member, base) + element_size(member) * (*count)++;
}

void ffd_setting_list_drop(const ffd_member *member, void *base)
{
    const size_t size = element_size(member);
    memset((char *)*items_of(member, base) + size * --*count_of(member, base), 0, size);
}

const char *ffd_setting_list_name(const ffd_member *member, void *base, const char *name, size_t length,
                                  bool *is_new)
{
    list_head *const head = head_of(member, base);
    const size_t before = head->list.known.count;
    uint32_t index;
    if (!ffd_grow((void **)&head->list.names, &head->list.name_capacity, head->list.name_count + 1,
                  sizeof *head->list.names) ||
        !ffd_intern(&head->list.known, name, length, &index))
        return NULL;
    *is_new = index == before;
    if (!*is_new)
        return head->list.names[index];
    char *const copy = ffd_alloc(length + 1, 1);
    if (!copy)
        return NULL;
    memcpy(copy, name, length);
    copy[length] = 0;
    return head->list.names[head->list.name_count++] = copy;
}

/* Frees a list of this file. */
static void free_list(const ffd_member *member, void *base)
{
    list_head *const head = head_of(member, base);
    for (size_t i = 0; head && i < head->list.name_count; i++)
        ffd_free(head->list.names[i]);
    if (head) {
        ffd_free(head->list.names);
        ffd_intern_free(&head->list.known);
    }
    ffd_free(head);
    *items_of(member, base) = NULL;
    *count_of(member, base) = 0;
}

void ffd_setting_lists_free(ffd_deform_desc *desc)
{
    const ffd_member *member;
    for (size_t index = 0; (member = ffd_deform_member(index)) != NULL; index++)
        if (ffd_member_is_list(member))
            free_list(member, desc);
}

void ffd_deform_desc_clear(ffd_deform_desc *desc)
{
    const ffd_member *member;
    ffd_deform_desc defaults;
    ffd_deform_desc_init(&defaults, sizeof defaults);
    ffd_setting_lists_free(desc);
    for (size_t index = 0; (member = ffd_deform_member(index)) != NULL; index++)
        if (!ffd_member_is_list(member))
            ffd_member_copy(member, &defaults, desc);
}

static const ffd_member *find(ffd_member_kind kind)
{
    size_t index = 0;
    while (ffd_deform_member(index)->kind != kind)
        index++;
    return ffd_deform_member(index);
}

bool ffd_setting_lattice_add(ffd_deform_desc *desc, const char *path)
{
    if (desc->morphs && !grow(find(FFD_MEMBER_MORPHS), desc, desc->lattice_count + 1))
        return false;
    ffd_lattice_source *const lattice = ffd_setting_list_add(find(FFD_MEMBER_LATTICES), desc);
    if (lattice)
        lattice->path = path;
    return lattice;
}

bool ffd_setting_morph_add(ffd_deform_desc *desc, const char *name, const char *path, bool *is_new)
{
    const ffd_member *const morphs = find(FFD_MEMBER_MORPHS);
    const size_t index = desc->lattice_count;
    if (!grow(morphs, desc, index + 1))
        return false;
    const char *const copy = ffd_setting_list_name(morphs, desc, name, strlen(name), is_new);
    if (!copy || !*is_new)
        return copy;
    if (!ffd_setting_lattice_add(desc, path))
        return false;
    ((const char **)*items_of(morphs, desc))[index] = copy;
    return true;
}
