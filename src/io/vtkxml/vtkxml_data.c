#include "io/vtkxml/vtkxml_data.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/base64.h"
#include "io/deflate/inflate.h"
#include <inttypes.h>
#include <string.h>

/* The most bytes that zlib makes of one (zlib's technical details: 1032). */
#define LARGEST_GAIN 1040

#define REFUSE(d, array, ...)                                                                                \
    ffd_fail_line(error, FFD_E_INVALID, (d)->volume.file.name, (array)->line, __VA_ARGS__)

/* Bytes of the file: as they are, or in base64. */
typedef struct byte_source {
    bool is_raw;
    const char *at, *last;
} byte_source;

static bool take(byte_source *from, unsigned char *bytes, size_t count)
{
    if (!from->is_raw)
        return ffd_base64_take(&from->at, from->last, bytes, count) == count;
    if ((size_t)(from->last - from->at) < count)
        return false;
    memcpy(bytes, from->at, count);
    from->at += count;
    return true;
}

/* The most bytes that are left, at least. */
static uint64_t left_in(const byte_source *from)
{
    const uint64_t left = (uint64_t)(from->last - from->at);
    return from->is_raw ? left : left / 4 * 3;
}

static uint64_t word_at(const vtkxml_document *d, const unsigned char *bytes)
{
    uint64_t value;
    ffd_type_load_whole(d->word == 8 ? NUMBER_UINT64 : NUMBER_UINT32, d->is_big, (const char *)bytes, &value);
    return value;
}

static void store_word(const vtkxml_document *d, uint64_t value, unsigned char *bytes)
{
    for (size_t i = 0; i < d->word; i++)
        bytes[d->is_big ? d->word - 1 - i : i] = (unsigned char)(value >> (8 * i));
}

static ffd_status find_source(const vtkxml_document *d, const vtkxml_array *array, byte_source *from,
                              ffd_error *error)
{
    *from = (byte_source){false, array->text.first, array->text.last};
    if (array->place == VTKXML_APPENDED) {
        const uint64_t size = (uint64_t)(d->appended.last - d->appended.first);
        if (!d->appended.first || array->offset > size)
            return REFUSE(d, array, "an array is at the offset %" PRIu64 " of the appended data, which %s",
                          array->offset, d->appended.first ? "end before" : "are missing");
        *from = (byte_source){d->is_raw, d->appended.first + array->offset, d->appended.last};
    }
    while (!from->is_raw && from->at < from->last &&
           (*from->at == ' ' || *from->at == '\n' || *from->at == '\r' || *from->at == '\t'))
        from->at++;
    return FFD_OK;
}

static ffd_status check_size(const vtkxml_document *d, const vtkxml_array *array, uint64_t found,
                             uint64_t wanted, ffd_error *error)
{
    if (wanted != VTKXML_ANY_SIZE && found != wanted)
        return REFUSE(d, array, "an array has %" PRIu64 " bytes, not %" PRIu64, found, wanted);
    return ffd_budget_check(&d->volume.file.base.budget, found, 1, error);
}

/* Whether the header of an array in base64 is a text of its own, with padding at its end. */
static bool has_own_header(const byte_source *from, const unsigned char *header, size_t word)
{
    byte_source own = *from;
    unsigned char again[12];
    size_t made;
    (void)header;
    if (from->is_raw)
        return false;
    const size_t length = ffd_base64_length(word);
    return (size_t)(own.last - own.at) >= length && own.at[length - 1] == '=' &&
           ffd_base64_decode(own.at, length, again, &made) && made == word;
}

/* Data that are not compressed have their size in front. */
static ffd_status decode_plain(const vtkxml_document *d, const vtkxml_array *array, byte_source *from,
                               uint64_t size, vtkxml_data *data, ffd_error *error)
{
    unsigned char header[8];
    byte_source ahead = *from;
    if (!take(&ahead, header, d->word))
        return REFUSE(d, array, "the file ends within the data of an array");
    const uint64_t found = word_at(d, header);
    TRY(check_size(d, array, found, size, error));
    if (found > left_in(from))
        return REFUSE(d, array, "an array states %" PRIu64 " bytes, but only %" PRIu64 " are left", found,
                      left_in(from));
    data->size = (size_t)found;
    if (from->is_raw) {
        if (found > left_in(&ahead))
            return REFUSE(d, array, "the file ends within the data of an array");
        data->bytes = (const unsigned char *)ahead.at;
        from->at = ahead.at + found;
        return FFD_OK;
    }
    data->has_own_header = has_own_header(from, header, d->word);
    data->block = ffd_alloc(data->size + d->word, 1);
    if (!data->block)
        return ffd_fail_memory(error);
    if (!take(from, data->block, data->size + d->word))
        return REFUSE(d, array, "the file ends within the data of an array, or they are not base64");
    data->bytes = data->block + d->word;
    return FFD_OK;
}

/* How many blocks there are, the size of a whole one, of the last if it is shorter, and of each when
   compressed. */
static ffd_status decode_head(const vtkxml_document *d, const vtkxml_array *array, byte_source *from,
                              vtkxml_data *data, ffd_error *error)
{
    unsigned char first[3 * 8];
    byte_source ahead = *from;
    if (!take(&ahead, first, 3 * d->word))
        return REFUSE(d, array, "the file ends within the data of an array");
    const uint64_t blocks = word_at(d, first);
    if (blocks > left_in(from) / d->word)
        return REFUSE(d, array, "an array states %" PRIu64 " compressed blocks, more than the file has",
                      blocks);
    const size_t count = 3 + (size_t)blocks;
    unsigned char *const bytes = ffd_alloc(count, d->word);
    data->head = ffd_alloc(count, sizeof *data->head);
    ffd_status status = bytes && data->head ? FFD_OK : ffd_fail_memory(error);
    if (!status && !take(from, bytes, count * d->word))
        status = REFUSE(d, array, "the file ends within the data of an array");
    for (size_t i = 0; i < count && !status; i++)
        data->head[i] = word_at(d, bytes + i * d->word);
    ffd_free(bytes);
    return status;
}

static uint64_t block_size(const vtkxml_data *data, uint64_t block)
{
    return block + 1 == data->head[0] && data->head[2] ? data->head[2] : data->head[1];
}

/* The sizes of all blocks, together, as they are and compressed; UINT64_MAX: too large. */
static void sum_blocks(const vtkxml_data *data, uint64_t *whole, uint64_t *packed)
{
    *whole = *packed = 0;
    for (uint64_t b = 0; b < data->head[0]; b++) {
        const uint64_t size = block_size(data, b);
        *whole = size > UINT64_MAX - *whole ? UINT64_MAX : *whole + size;
        *packed = data->head[3 + b] > UINT64_MAX - *packed ? UINT64_MAX : *packed + data->head[3 + b];
    }
}

static ffd_status inflate_blocks(const vtkxml_data *data, ffd_error *error)
{
    const unsigned char *at = data->packed;
    unsigned char *to = data->block;
    for (uint64_t b = 0; b < data->head[0]; b++) {
        const size_t size = (size_t)block_size(data, b), packed = (size_t)data->head[3 + b];
        TRY(ffd_deadline_check(error));
        TRY(ffd_inflate(at, packed, false, to, size, error));
        at += packed;
        to += size;
    }
    return FFD_OK;
}

static ffd_status decode_packed(const vtkxml_document *d, const vtkxml_array *array, byte_source *from,
                                uint64_t size, vtkxml_data *data, ffd_error *error)
{
    uint64_t whole, packed;
    TRY(decode_head(d, array, from, data, error));
    sum_blocks(data, &whole, &packed);
    TRY(check_size(d, array, whole, size, error));
    if (packed > left_in(from) || whole / LARGEST_GAIN > packed)
        return REFUSE(d, array,
                      "the compressed blocks of an array state %" PRIu64 " bytes of %" PRIu64
                      ", which the file does not have",
                      packed, whole);
    data->size = (size_t)whole;
    data->packed = ffd_alloc((size_t)packed + 1, 1);
    data->block = ffd_alloc((size_t)whole + 1, 1);
    if (!data->packed || !data->block)
        return ffd_fail_memory(error);
    data->bytes = data->block;
    if (!take(from, data->packed, (size_t)packed))
        return REFUSE(d, array, "the file ends within the data of an array");
    return ffd_volume_at_line(&d->volume, array->line, inflate_blocks(data, error), error);
}

ffd_status ffd_vtkxml_decode(const vtkxml_document *d, const vtkxml_array *array, uint64_t size,
                             vtkxml_data *data, ffd_error *error)
{
    byte_source from;
    memset(data, 0, sizeof *data);
    TRY(find_source(d, array, &from, error));
    data->is_raw = from.is_raw;
    data->first = from.at;
    TRY(d->is_compressed ? decode_packed(d, array, &from, size, data, error)
                         : decode_plain(d, array, &from, size, data, error));
    data->last = from.at;
    return FFD_OK;
}

void ffd_vtkxml_data_free(vtkxml_data *data)
{
    ffd_free(data->head);
    ffd_free(data->packed);
    ffd_free(data->block);
    memset(data, 0, sizeof *data);
}

/* Appends bytes as they are, or in base64. */
static void append(const vtkxml_data *data, const unsigned char *bytes, size_t size, byte_buffer *text)
{
    if (data->is_raw) {
        ffd_buffer_append(text, bytes, size);
        return;
    }
    const size_t length = ffd_base64_length(size);
    char *const at = ffd_buffer_reserve(text, length);
    if (!at)
        return;
    ffd_base64_encode(bytes, size, at);
    text->size += length;
}

/* Puts white space between characters of base64 back to where it was. */
static void keep_space(const vtkxml_data *data, byte_buffer *text)
{
    byte_buffer spaced = {0};
    size_t at = 0;
    if (data->is_raw || text->failed)
        return;
    for (const char *c = data->first; c < data->last; c++) {
        const bool is_space = *c == ' ' || *c == '\n' || *c == '\r' || *c == '\t';
        if (is_space)
            ffd_buffer_append(&spaced, c, 1);
        else if (at < text->size)
            ffd_buffer_append(&spaced, text->data + at++, 1);
    }
    ffd_buffer_append(&spaced, text->data + at, text->size - at);
    ffd_buffer_free(text);
    *text = spaced;
}

static ffd_status encode_plain(const vtkxml_document *d, const vtkxml_data *data, const unsigned char *bytes,
                               byte_buffer *text, ffd_error *error)
{
    unsigned char *const all = ffd_alloc(data->size + d->word, 1);
    if (!all)
        return ffd_fail_memory(error);
    store_word(d, data->size, all);
    memcpy(all + d->word, bytes, data->size);
    if (data->has_own_header) {
        append(data, all, d->word, text);
        append(data, bytes, data->size, text);
    } else
        append(data, all, data->size + d->word, text);
    ffd_free(all);
    return FFD_OK;
}

/* Compresses the blocks that changed into a buffer, with the new sizes in sizes. */
static ffd_status pack_blocks(const vtkxml_data *data, const unsigned char *bytes, uint64_t *sizes,
                              byte_buffer *packed, ffd_error *error)
{
    size_t at = 0, old = 0;
    for (uint64_t b = 0; b < data->head[0]; b++) {
        const size_t size = (size_t)block_size(data, b), old_size = (size_t)data->head[3 + b];
        size_t made = old_size;
        if (memcmp(bytes + at, data->bytes + at, size) == 0)
            ffd_buffer_append(packed, data->packed + old, old_size);
        else {
            char *const room = ffd_buffer_reserve(packed, ffd_deflate_most(size));
            if (!room)
                return ffd_fail_memory(error);
            TRY(ffd_deflate(bytes + at, size, (unsigned char *)room, &made, error));
            packed->size += made;
        }
        sizes[b] = made;
        at += size;
        old += old_size;
    }
    return FFD_OK;
}

static ffd_status encode_packed(const vtkxml_document *d, const vtkxml_data *data, const unsigned char *bytes,
                                byte_buffer *text, ffd_error *error)
{
    const size_t blocks = (size_t)data->head[0];
    uint64_t *const sizes = ffd_alloc(blocks, sizeof *sizes);
    unsigned char *const head = ffd_alloc(3 + blocks, d->word);
    byte_buffer packed = {0};
    ffd_status status = sizes && head ? FFD_OK : ffd_fail_memory(error);
    if (!status)
        status = pack_blocks(data, bytes, sizes, &packed, error);
    for (size_t i = 0; i < 3 + blocks && !status; i++)
        store_word(d, i < 3 ? data->head[i] : sizes[i - 3], head + i * d->word);
    if (!status) {
        append(data, head, (3 + blocks) * d->word, text);
        append(data, (const unsigned char *)packed.data, packed.size, text);
    }
    if (!status && packed.failed)
        status = ffd_fail_memory(error);
    ffd_buffer_free(&packed);
    ffd_free(sizes);
    ffd_free(head);
    return status;
}

ffd_status ffd_vtkxml_encode(const vtkxml_document *d, const vtkxml_data *data, const unsigned char *bytes,
                             byte_buffer *text, ffd_error *error)
{
    if (data->head)
        TRY(encode_packed(d, data, bytes, text, error));
    else {
        TRY(encode_plain(d, data, bytes, text, error));
        keep_space(data, text);
    }
    return text->failed ? ffd_fail_memory(error) : FFD_OK;
}

number_run ffd_vtkxml_run(const vtkxml_document *d, const vtkxml_array *array, size_t tuples,
                          const vtkxml_data *data)
{
    const bool is_text = array->place == VTKXML_TEXT;
    const char *const bytes = (const char *)data->bytes;
    return (number_run){.type = array->type,
                        .is_text = is_text,
                        .is_big = d->is_big,
                        .count = tuples,
                        .width = array->width,
                        .stride = array->width * ffd_type_size(array->type),
                        .first = is_text ? array->text.first : bytes,
                        .last = is_text ? array->text.last : bytes + data->size,
                        .line = array->line};
}

ffd_status ffd_vtkxml_read(const vtkxml_document *d, const vtkxml_array *array, uint64_t tuples,
                           const char *what, double *values, const char **first, const char **last,
                           ffd_error *error)
{
    const size_t size = array->width * ffd_type_size(array->type);
    vtkxml_data data = {0};
    size_t line;
    ffd_status status = FFD_OK;
    *first = array->text.first;
    *last = array->text.last;
    if (array->place != VTKXML_TEXT) {
        TRY_END(ffd_vtkxml_decode(d, array, tuples * size, &data, error));
        *first = data.first;
        *last = data.last;
    }
    const number_run run = ffd_vtkxml_run(d, array, (size_t)tuples, &data);
    const char *end;
    TRY_END(ffd_run_read(&run, d->volume.file.name, what, values, &end, &line, error));
end:
    ffd_vtkxml_data_free(&data);
    return status;
}

static ffd_status read_text_wholes(const vtkxml_document *d, const vtkxml_array *array, uint64_t count,
                                   uint64_t **values, uint64_t *found, ffd_error *error)
{
    text_scan scan = {.at = array->text.first, .last = array->text.last, .line = array->line};
    size_t capacity = 0;
    text_word word;
    while (*found < count && ffd_text_find(&scan) && ffd_text_word(&scan, &word)) {
        uint64_t value;
        double number;
        TRY(ffd_deadline_check_at((size_t)*found, error));
        if (!ffd_text_whole(word, &value)) {
            if (!ffd_text_number(word, &number) || !(number < 0))
                return ffd_fail_line(error, FFD_E_INVALID, d->volume.file.name, scan.line,
                                     "\"%s\" is not a whole number", ffd_text_shown(word).text);
            value = UINT64_MAX;
        }
        if (!ffd_grow((void **)values, &capacity, (size_t)*found + 1, sizeof **values))
            return ffd_fail_memory(error);
        (*values)[(*found)++] = value;
    }
    return FFD_OK;
}

static ffd_status read_binary_wholes(const vtkxml_document *d, const vtkxml_array *array, uint64_t **values,
                                     uint64_t *found, ffd_error *error)
{
    const size_t size = ffd_type_size(array->type);
    vtkxml_data data;
    ffd_status status;
    TRY_END(ffd_vtkxml_decode(d, array, VTKXML_ANY_SIZE, &data, error));
    *found = data.size / size;
    TRY_END(ffd_budget_check(&d->volume.file.base.budget, *found, sizeof **values, error));
    *values = ffd_alloc((size_t)*found, sizeof **values);
    if (!*values)
        TRY_END(ffd_fail_memory(error));
    for (size_t i = 0; i < *found; i++)
        if (!ffd_type_load_whole(array->type, d->is_big, (const char *)data.bytes + i * size, &(*values)[i]))
            (*values)[i] = UINT64_MAX;
end:
    ffd_vtkxml_data_free(&data);
    return status;
}

ffd_status ffd_vtkxml_wholes(const vtkxml_document *d, const vtkxml_array *array, uint64_t count,
                             uint64_t **values, uint64_t *found, ffd_error *error)
{
    *values = NULL;
    *found = 0;
    if (!array->is_number || number_is_real(array->type))
        return REFUSE(d, array, "an array of cells is not of whole numbers");
    TRY(array->place == VTKXML_TEXT ? read_text_wholes(d, array, count, values, found, error)
                                    : read_binary_wholes(d, array, values, found, error));
    return count == VTKXML_ANY_SIZE || *found >= count
               ? FFD_OK
               : REFUSE(d, array, "an array of cells has %" PRIu64 " numbers, not %" PRIu64, *found, count);
}
