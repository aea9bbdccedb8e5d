/* setting_bytes.c - a job's settings as bytes: for a process that is to do the job, and for a hash of what
   its output depends on. */
#include "base/fail.h"
#include "base/memory/memory.h"
#include "job/input/setting_lists.h"
#include "job/input/settings.h"
#include <string.h>

/* Behind the last member. */
#define END 0xff

static void append_text(byte_buffer *bytes, const char *text)
{
    const char *const there = text ? text : "";
    ffd_buffer_append(bytes, there, strlen(there) + 1);
}

static size_t count_of(const ffd_deform_desc *desc, const ffd_member *member)
{
    size_t count;
    memcpy(&count, (const char *)desc + member->second, sizeof count);
    return count;
}

/* has_files: with the names of files. */
static void append_list(const ffd_deform_desc *desc, const ffd_member *member, bool has_files,
                        byte_buffer *bytes)
{
    const size_t count = count_of(desc, member);
    const void *items;
    memcpy(&items, (const char *)desc + member->offset, sizeof items);
    ffd_buffer_append(bytes, &count, sizeof count);
    for (size_t i = 0; i < count; i++) {
        if (member->kind == FFD_MEMBER_VALUES) {
            append_text(bytes, ((const ffd_setting *)items)[i].name);
            append_text(bytes, ((const ffd_setting *)items)[i].value);
        } else if (member->kind != FFD_MEMBER_LATTICES) {
            append_text(bytes, ((const char *const *)items)[i]);
        } else if (has_files) {
            append_text(bytes, ((const ffd_lattice_source *)items)[i].path);
        }
    }
}

static void append_pieces(const ffd_deform_desc *desc, const ffd_member *member, byte_buffer *bytes)
{
    member_piece pieces[MEMBER_PIECES];
    const size_t count = ffd_member_pieces(member, pieces);
    for (size_t i = 0; i < count; i++)
        ffd_buffer_append(bytes, (const char *)desc + pieces[i].offset, pieces[i].size);
}

static bool is_text(const ffd_member *member)
{
    return member->kind == FFD_MEMBER_TEXT || member->kind == FFD_MEMBER_WEIGHT;
}

/* has_files: with the names of files. */
static void append_member_text(const ffd_member *member, const char *text, bool has_files, byte_buffer *bytes)
{
    const char *const file = member->kind == FFD_MEMBER_WEIGHT ? ffd_weight_file(text) : NULL;
    if (file && !has_files)
        ffd_buffer_append(bytes, text, (size_t)(file - text));
    append_text(bytes, has_files || !(file || member->traits & FFD_MEMBER_IS_PATH) ? text : "");
}

void ffd_settings_write(const ffd_deform_desc *desc, settings_use use, byte_buffer *bytes)
{
    const unsigned char end = END;
    const bool is_all = use == SETTINGS_ALL;
    const ffd_member *member;
    for (size_t m = 0; (member = ffd_deform_member(m)) != NULL; m++) {
        const unsigned char index = (unsigned char)m;
        if (!ffd_member_is_set(desc, member) || member->kind == FFD_MEMBER_OBJECT ||
            (!is_all && member->traits & FFD_MEMBER_IS_IDLE))
            continue;
        ffd_buffer_append(bytes, &index, 1);
        if (ffd_member_is_list(member)) {
            append_list(desc, member, is_all, bytes);
        } else if (is_text(member)) {
            const char *text;
            memcpy(&text, (const char *)desc + member->offset, sizeof text);
            append_member_text(member, text, is_all, bytes);
        } else {
            append_pieces(desc, member, bytes);
        }
    }
    ffd_buffer_append(bytes, &end, 1);
}

static const char *take_text(const char **at)
{
    const char *const text = *at;
    *at += strlen(text) + 1;
    return text;
}

static void take(const char **at, void *to, size_t size)
{
    memcpy(to, *at, size);
    *at += size;
}

/* Returns false if memory runs out. A list of morph targets comes after that of their lattices. */
static bool take_list(const char **at, const ffd_member *member, ffd_deform_desc *desc)
{
    size_t count;
    take(at, &count, sizeof count);
    if (member->kind == FFD_MEMBER_MORPHS)
        desc->lattice_count = 0;
    for (size_t i = 0; i < count; i++) {
        void *const element = ffd_setting_list_add(member, desc);
        if (!element)
            return false;
        const char *const text = take_text(at);
        if (member->kind == FFD_MEMBER_VALUES)
            *(ffd_setting *)element = (ffd_setting){text, take_text(at)};
        else if (member->kind == FFD_MEMBER_LATTICES)
            ((ffd_lattice_source *)element)->path = text;
        else
            *(const char **)element = text;
    }
    return true;
}

ffd_status ffd_settings_take(const char **at, ffd_deform_desc *desc, ffd_error *error)
{
    unsigned char index;
    for (take(at, &index, 1); index != END; take(at, &index, 1)) {
        const ffd_member *const member = ffd_deform_member(index);
        if (ffd_member_is_list(member)) {
            if (!take_list(at, member, desc))
                return ffd_fail_memory(error);
        } else if (is_text(member)) {
            const char *const text = take_text(at);
            memcpy((char *)desc + member->offset, &text, sizeof text);
        } else {
            member_piece pieces[MEMBER_PIECES];
            const size_t count = ffd_member_pieces(member, pieces);
            for (size_t i = 0; i < count; i++)
                take(at, (char *)desc + pieces[i].offset, pieces[i].size);
        }
    }
    return FFD_OK;
}
