#include "io/gltf/file/gltf_buffer.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include "io/gltf/file/gltf_uri.h"
#include <stdbool.h>
#include <string.h>

/* The most bytes that pad a BIN chunk (glTF 2.0, 4.4.3.3). */
#define GLB_PADDING 3

typedef struct loader {
    const json_tree *tree;
    uint32_t value, uri; /* JSON values: the buffer and its uri */
    const file_folder *model;
    const char *name; /* for messages */
    size_t *most_read;
    ffd_error *error;
} loader;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\f' || c == '\r';
}

static bool is_separator(char c)
{
    return c == ';' || c == ',' || is_blank(c);
}

/* Whether the word at uri[i], which ends before uri[end], is a whole parameter. Blanks around it may be
   escaped. */
static bool is_parameter(const char *uri, size_t i, size_t end)
{
    const bool begins = i > 0 && (is_separator(uri[i - 1]) || (i >= 3 && memcmp(uri + i - 3, "%20", 3) == 0));
    return begins && (is_separator(uri[end]) || strncmp(uri + end, "%20", 3) == 0);
}

size_t ffd_data_uri_payload(const char *uri, size_t size, data_uri_coding *coding)
{
    static const char word[] = "base64";
    const size_t length = sizeof word - 1;
    const char *comma = memchr(uri, ',', size);
    *coding = DATA_PLAIN;
    if (!comma)
        return SIZE_MAX;
    const size_t head = (size_t)(comma - uri);
    for (size_t i = 0; i + length <= head && *coding == DATA_PLAIN; i++)
        if (ffd_uri_starts_with(uri + i, word) && is_parameter(uri, i, i + length)) {
            const bool exact = uri[i - 1] == ';' && i + length == head && memcmp(uri + i, word, length) == 0;
            *coding = exact ? DATA_BASE64 : DATA_BASE64_ODD;
        }
    return head + 1;
}

/* Removes blanks, which browsers skip in base64; returns the new size. */
static size_t take_blanks(char *text, size_t size)
{
    size_t blanks = 0, kept = 0;
    for (size_t i = 0; i < size; i++)
        blanks += is_blank(text[i]);
    for (size_t i = 0; i < size && blanks > 0; i++)
        if (!is_blank(text[i]))
            text[kept++] = text[i];
    return size - blanks;
}

static ffd_status load_data_uri(const loader *l, char *uri, size_t size, gltf_buffer *buffer)
{
    data_uri_coding coding;
    const size_t head = ffd_data_uri_payload(uri, size, &coding);
    if (head == SIZE_MAX)
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the data URI has no comma");
    if (coding == DATA_PLAIN)
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the data URI of a buffer must say \";base64\" before its comma");
    size = ffd_uri_decode(uri + head, size - head);
    const size_t digits = take_blanks(uri + head, size);
    buffer->flaws = (coding == DATA_BASE64_ODD ? BUFFER_ODD_MARKER : 0) | (digits < size ? BUFFER_BLANKS : 0);
    size = digits;
    buffer->kind = BUFFER_DATA;
    buffer->decoded = ffd_alloc(ffd_base64_capacity(size), 1);
    buffer->data = buffer->decoded;
    if (!buffer->decoded)
        return ffd_fail_memory(l->error);
    if (!ffd_base64_decode(uri + head, size, buffer->decoded, &buffer->size))
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the data URI is not valid base64");
    return FFD_OK;
}

ffd_status ffd_gltf_load_data_uri(const json_tree *tree, uint32_t uri, const char *name, gltf_buffer *buffer,
                                  ffd_error *error)
{
    const loader l = {.tree = tree, .uri = uri, .name = name, .error = error};
    size_t size;
    char *const text = ffd_json_tree_string(tree, uri, &size);
    *buffer = (gltf_buffer){.kind = BUFFER_EMPTY};
    const ffd_status status = text ? load_data_uri(&l, text, size, buffer) : ffd_fail_memory(error);
    if (status)
        ffd_gltf_free_buffer(buffer);
    ffd_free(text);
    return status;
}

static ffd_status load_file(const loader *l, char *uri, size_t size, gltf_buffer *buffer)
{
    if (ffd_file_is_stream(l->model->file))
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_IO, l->error,
                                  "the buffer is the file \"%s\", and standard input has no folder", uri);
    if (ffd_uri_is_absolute(uri))
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_IO, l->error,
                                  "the buffer \"%s\" is outside the model's folder", uri);
    size = ffd_uri_decode(uri, size);
    uri[size] = 0;
    if (memchr(uri, 0, size))
        return ffd_json_tree_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the buffer's name holds a NUL character");
    buffer->path = ffd_text_copy(uri);
    if (!buffer->path)
        return ffd_fail_memory(l->error);
    buffer->flaws = ffd_folder_turn_slashes(l->model, buffer->path) ? BUFFER_BACKSLASH : 0;
    TRY(ffd_folder_load(l->model, buffer->path, l->name, l->most_read, &buffer->file, l->error));
    buffer->kind = BUFFER_FILE;
    buffer->data = buffer->file.data;
    buffer->size = buffer->file.size;
    return FFD_OK;
}

static ffd_status load_uri(const loader *l, gltf_buffer *buffer)
{
    size_t size;
    char *uri = ffd_json_tree_string(l->tree, l->uri, &size);
    if (!uri)
        return ffd_fail_memory(l->error);
    const ffd_status status =
        ffd_uri_is_data(uri) ? load_data_uri(l, uri, size, buffer) : load_file(l, uri, size, buffer);
    ffd_free(uri);
    return status;
}

ffd_status ffd_gltf_load_buffer(const json_tree *tree, uint32_t value, const unsigned char *bin,
                                size_t bin_size, const file_folder *model, const char *name,
                                size_t *most_read, gltf_buffer *buffer, ffd_error *error)
{
    *buffer = (gltf_buffer){.kind = BUFFER_EMPTY};
    const loader l = {tree, value, ffd_json_tree_member(tree, value, "uri"), model, name, most_read, error};
    double length = 0;
    ffd_json_tree_number(tree, ffd_json_tree_member(tree, value, "byteLength"), &length);
    buffer->length = buffer->stated = (size_t)length;
    size_t padding = 0;
    ffd_status status = FFD_OK;
    if (l.uri != JSON_NONE) {
        TRY_END(load_uri(&l, buffer));
    } else if (bin) {
        padding = GLB_PADDING;
        buffer->kind = BUFFER_BIN;
        buffer->data = bin;
        buffer->size = bin_size;
    }
    if (buffer->kind != BUFFER_EMPTY && buffer->size < buffer->length) {
        buffer->flaws |= BUFFER_SHORT;
        buffer->length = buffer->size;
    }
    if (buffer->kind != BUFFER_EMPTY && buffer->size - buffer->length > padding)
        buffer->flaws |= BUFFER_LONG;
end:
    if (status)
        ffd_gltf_free_buffer(buffer);
    return status;
}

void ffd_gltf_free_buffer(gltf_buffer *buffer)
{
    ffd_free(buffer->decoded);
    ffd_free(buffer->path);
    if (buffer->file.data)
        ffd_file_unload(&buffer->file);
    *buffer = (gltf_buffer){0};
}

/* The content of a string, without its quotes. */
typedef struct quoted {
    const char *begin, *end;
} quoted;

/* Reads the string whose opening quote is at c; returns the character after it. */
static const char *take_string(const char *c, const char *end, quoted *string)
{
    string->begin = ++c;
    for (;;) {
        const char *const quote = memchr(c, '"', (size_t)(end - c));
        const char *before = quote;
        while (before && before > string->begin && before[-1] == '\\')
            before--;
        string->end = quote ? quote : end;
        if (!quote || (quote - before) % 2 == 0)
            return quote ? quote + 1 : end;
        c = quote + 1;
    }
}

static bool is_word(const quoted *string, const char *word)
{
    const size_t length = strlen(word);
    return (size_t)(string->end - string->begin) == length && memcmp(string->begin, word, length) == 0;
}

static bool is_data(const quoted *string)
{
    char start[8] = "";
    const size_t length = (size_t)(string->end - string->begin);
    memcpy(start, string->begin, length < sizeof start - 1 ? length : sizeof start - 1);
    return ffd_uri_is_data(start);
}

size_t ffd_gltf_count_buffer_files(const char *text, size_t size)
{
    const char *c = text, *const end = text + size;
    size_t count = 0, depth = 0;
    bool in_buffers = false, is_uri = false; /* is_uri: the next value is that of "uri" */
    quoted string;
    while (c < end) {
        if (*c == '"') {
            c = take_string(c, end, &string);
            count += is_uri && !is_data(&string);
            is_uri = in_buffers && depth == 3 && !is_uri && is_word(&string, "uri");
            if (depth == 1)
                in_buffers = is_word(&string, "buffers");
            continue;
        }
        if (*c == '{' || *c == '[')
            depth++;
        else if ((*c == '}' || *c == ']') && depth > 0)
            depth--;
        if (*c == ',' && depth == 1)
            in_buffers = false;
        is_uri = is_uri && (*c == ':' || strchr(" \t\r\n", *c));
        c++;
    }
    return count;
}
