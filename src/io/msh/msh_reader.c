#include "io/msh/msh_reader.h"
#include <inttypes.h>

ffd_status ffd_msh_word(msh_reader *r, const char *what, text_word *word)
{
    return ffd_text_find(&r->scan) && ffd_text_word(&r->scan, word)
               ? FFD_OK
               : MSH_REFUSE(r, "the file ends where %s is expected", what);
}

static ffd_status take_bytes(msh_reader *r, const char *what, size_t size, const char **bytes)
{
    *bytes = r->scan.at;
    if ((size_t)(r->scan.last - r->scan.at) < size)
        return MSH_REFUSE(r, "the file ends where %s is expected", what);
    r->scan.at += size;
    return FFD_OK;
}

ffd_status ffd_msh_int(msh_reader *r, const char *what, int64_t *number)
{
    const char *bytes;
    text_word word;
    uint64_t value;
    if (r->is_binary) {
        TRY(take_bytes(r, what, 4, &bytes));
        *number = (int64_t)ffd_type_load(NUMBER_INT32, r->is_big, bytes);
        return FFD_OK;
    }
    TRY(ffd_msh_word(r, what, &word));
    const bool is_negative = *word.first == '-';
    const text_word digits = {word.first + is_negative, word.last};
    if (!ffd_text_whole(digits, &value) || value > INT32_MAX)
        return MSH_REFUSE(r, "\"%s\" is not %s", ffd_text_shown(word).text, what);
    *number = is_negative ? -(int64_t)value : (int64_t)value;
    return FFD_OK;
}

ffd_status ffd_msh_size(msh_reader *r, const char *what, uint64_t *number)
{
    const char *bytes;
    text_word word;
    if (r->is_binary) {
        const size_t size = r->is_new ? r->word : 4;
        TRY(take_bytes(r, what, size, &bytes));
        ffd_type_load_whole(size == 8 ? NUMBER_UINT64 : NUMBER_UINT32, r->is_big, bytes, number);
        return FFD_OK;
    }
    TRY(ffd_msh_word(r, what, &word));
    return ffd_text_whole(word, number) ? FFD_OK
                                        : MSH_REFUSE(r, "\"%s\" is not %s", ffd_text_shown(word).text, what);
}

ffd_status ffd_msh_count(msh_reader *r, const char *what, size_t least, uint64_t *number)
{
    TRY(ffd_msh_size(r, what, number));
    return *number <= (uint64_t)(r->scan.last - r->scan.at) / least + 1
               ? FFD_OK
               : MSH_REFUSE(r, "%s is %" PRIu64 ", more than the file can hold", what, *number);
}

ffd_status ffd_msh_skip(msh_reader *r, size_t count)
{
    const char *bytes;
    text_word word;
    if (r->is_binary)
        return take_bytes(r, "a coordinate", 8 * count, &bytes);
    for (size_t i = 0; i < count; i++)
        TRY(ffd_msh_word(r, "a coordinate", &word));
    return FFD_OK;
}
