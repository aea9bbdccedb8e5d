#include "lattice/formats/zip.h"
#include "base/crc.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/deflate/inflate.h"
#include <inttypes.h>
#include <string.h>

#define END_SIGN 0x06054b50u
#define END_SIZE 22
#define ENTRY_SIGN 0x02014b50u
#define ENTRY_SIZE 46
#define LOCAL_SIGN 0x04034b50u
#define LOCAL_SIZE 30
/* The longest comment behind the end. */
#define COMMENT 65535
enum { STORED = 0, DEFLATED = 8 };

static unsigned load_u16(const unsigned char *bytes)
{
    return bytes[0] | (unsigned)bytes[1] << 8;
}

static ffd_status refuse(const char *name, const char *what, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, name, "is not a whole ZIP file: %s", what);
}

/* Finds the end record, which is the last thing in the file but for a comment. Returns NULL if there is none.
 */
static const unsigned char *find_end(const file_input *file)
{
    const size_t size = file->size;
    for (size_t behind = END_SIZE; behind <= size && behind <= END_SIZE + COMMENT; behind++)
        if (load_u32(file->data + size - behind) == END_SIGN)
            return file->data + size - behind;
    return NULL;
}

static ffd_status take_entry(const unsigned char *entry, const char *name, zip_member *member,
                             ffd_error *error)
{
    const unsigned flags = load_u16(entry + 8), method = load_u16(entry + 10);
    member->is_deflated = method == DEFLATED;
    member->crc = load_u32(entry + 16);
    member->packed = load_u32(entry + 20);
    member->size = load_u32(entry + 24);
    member->header = load_u32(entry + 42);
    member->name.first = (const char *)entry + ENTRY_SIZE;
    member->name.last = member->name.first + load_u16(entry + 28);
    if (flags & 1)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, name, "has an encrypted member \"%s\"",
                             ffd_text_shown(member->name).text);
    if (method != STORED && method != DEFLATED)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, name, "has a member \"%s\" of the compression %u",
                             ffd_text_shown(member->name).text, method);
    if (member->packed == UINT32_MAX || member->size == UINT32_MAX || member->header == UINT32_MAX)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, name, "has a member \"%s\" of 4 GB or more",
                             ffd_text_shown(member->name).text);
    return FFD_OK;
}

static bool is_listed(const zip_list *list, text_word name)
{
    const size_t length = (size_t)(name.last - name.first);
    for (size_t m = 0; m < list->count; m++) {
        const text_word other = list->members[m].name;
        if ((size_t)(other.last - other.first) == length && memcmp(other.first, name.first, length) == 0)
            return true;
    }
    return false;
}

ffd_status ffd_zip_list(const file_input *file, const char *name, zip_list *list, ffd_error *error)
{
    const unsigned char *const end = find_end(file);
    list->count = 0;
    if (!end)
        return refuse(name, "it has no end record", error);
    const size_t count = load_u16(end + 10);
    uint64_t at = load_u32(end + 16);
    if (count > ZIP_MEMBERS)
        return ffd_fail_file(error, FFD_E_LIMIT, name, "has %zu members; at most %d are read", count,
                             ZIP_MEMBERS);
    for (size_t m = 0; m < count; m++) {
        const unsigned char *const entry = file->data + at;
        if (at + ENTRY_SIZE > file->size || load_u32(entry) != ENTRY_SIGN)
            return refuse(name, "its directory is broken", error);
        const size_t size =
            ENTRY_SIZE + (size_t)load_u16(entry + 28) + load_u16(entry + 30) + load_u16(entry + 32);
        if (size > file->size - at)
            return refuse(name, "its directory is broken", error);
        zip_member *const member = &list->members[list->count];
        TRY(take_entry(entry, name, member, error));
        if (is_listed(list, member->name))
            return ffd_fail_file(error, FFD_E_INVALID, name, "has the member \"%s\" twice",
                                 ffd_text_shown(member->name).text);
        list->count++;
        at += size;
    }
    return FFD_OK;
}

const zip_member *ffd_zip_find(const zip_list *list, const char *name)
{
    for (size_t m = 0; m < list->count; m++)
        if (ffd_text_is(list->members[m].name, name))
            return &list->members[m];
    return NULL;
}

/* Finds the bytes of a member, behind its own header. */
static ffd_status find_bytes(const file_input *file, const char *name, const zip_member *member,
                             const unsigned char **bytes, ffd_error *error)
{
    const unsigned char *const local = file->data + member->header;
    if (member->header + LOCAL_SIZE > file->size || load_u32(local) != LOCAL_SIGN)
        return refuse(name, "a member has no header", error);
    const uint64_t at = member->header + LOCAL_SIZE + load_u16(local + 26) + load_u16(local + 28);
    if (at > file->size || member->packed > file->size - at)
        return refuse(name, "a member ends early", error);
    *bytes = file->data + at;
    return FFD_OK;
}

ffd_status ffd_zip_unpack(const file_input *file, const char *name, const zip_member *member, uint64_t most,
                          file_input *content, ffd_error *error)
{
    const unsigned char *bytes = NULL;
    *content = (file_input){0};
    TRY(find_bytes(file, name, member, &bytes, error));
    if (member->size > most)
        return ffd_fail_file(error, FFD_E_LIMIT, name,
                             "has a member \"%s\" of %" PRIu64 " bytes; at most %" PRIu64 " are read",
                             ffd_text_shown(member->name).text, member->size, most);
    if (!member->is_deflated && member->packed != member->size)
        return refuse(name, "a stored member has two sizes", error);
    unsigned char *const room = ffd_alloc((size_t)member->size + 1, 1);
    if (!room)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    if (member->is_deflated)
        status = ffd_inflate(bytes, (size_t)member->packed, true, room, (size_t)member->size, error);
    else
        memcpy(room, bytes, (size_t)member->size);
    if (!status && ffd_crc(0, room, (size_t)member->size) != member->crc)
        status = ffd_fail_file(error, FFD_E_INVALID, name, "has a member \"%s\" whose check sum is wrong",
                               ffd_text_shown(member->name).text);
    if (status)
        ffd_free(room);
    else
        *content = (file_input){.data = room, .size = (size_t)member->size, .block = room};
    return status;
}
