#include "io/gltf/file/gltf_uri.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include <string.h>

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool ffd_uri_starts_with(const char *text, const char *word)
{
    for (; *word; text++, word++)
        if (*text != *word && !(is_letter(*text) && (*text | 0x20) == *word))
            return false;
    return true;
}

bool ffd_uri_is_data(const char *uri)
{
    return ffd_uri_starts_with(uri, "data:");
}

bool ffd_uri_is_absolute(const char *uri)
{
    if (uri[0] == '/' || uri[0] == '\\')
        return true;
    if (!is_letter(uri[0]))
        return false;
    while (is_letter(*uri) || is_digit(*uri) || *uri == '+' || *uri == '-' || *uri == '.')
        uri++;
    return *uri == ':';
}

static int hex_value(char c)
{
    if (is_digit(c))
        return c - '0';
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

size_t ffd_uri_decode(char *text, size_t size)
{
    const char *const escape = memchr(text, '%', size);
    size_t length = escape ? (size_t)(escape - text) : size;
    for (size_t i = length; i < size; i++) {
        const int high = text[i] == '%' && size - i > 2 ? hex_value(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
        if (low >= 0) {
            text[length++] = (char)(high * 16 + low);
            i += 2;
        } else {
            text[length++] = text[i];
        }
    }
    return length;
}

char *ffd_uri_encode(const char *path)
{
    byte_buffer out = {0};
    for (const char *c = path; *c; c++) {
        if (is_letter(*c) || is_digit(*c) || strchr("-._~/", *c))
            ffd_buffer_append(&out, c, 1);
        else
            ffd_buffer_format(&out, "%%%02X", (unsigned)(unsigned char)*c);
    }
    return ffd_buffer_finish(&out);
}

ffd_status ffd_gltf_uri_path(const json_tree *tree, uint32_t uri, const file_folder *mesh, char **path,
                             ffd_error *error)
{
    *path = NULL;
    if (uri == JSON_NONE || tree->values[uri].kind != JSON_STRING)
        return FFD_OK;
    size_t size;
    char *text = ffd_json_tree_string(tree, uri, &size);
    if (!text)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    if (!ffd_uri_is_data(text) && !ffd_uri_is_absolute(text)) {
        size = ffd_uri_decode(text, size);
        text[size] = 0;
        if (!memchr(text, 0, size) && size > 0) {
            ffd_folder_turn_slashes(mesh, text);
            *path = ffd_path_normalize(text);
            status = *path ? FFD_OK : ffd_fail_memory(error);
        }
    }
    ffd_free(text);
    return status;
}

ffd_status ffd_gltf_file_path(const json_tree *tree, uint32_t value, const file_folder *mesh, char **path,
                              ffd_error *error)
{
    return ffd_gltf_uri_path(tree, ffd_json_tree_member(tree, value, "uri"), mesh, path, error);
}

ffd_status ffd_gltf_add_sibling(const file_folder *mesh, char *relative, path_list *files, ffd_error *error)
{
    char *const path = relative ? ffd_path_sibling(mesh->file, relative) : NULL;
    const ffd_status status = path       ? ffd_paths_add(files, path, error)
                              : relative ? ffd_fail_memory(error)
                                         : FFD_OK;
    ffd_free(path);
    ffd_free(relative);
    return status;
}

/* Returns the extension inside which a value is; JSON_NONE: none. */
static uint32_t extension_around(const json_tree *tree, uint32_t v)
{
    uint32_t found = JSON_NONE;
    for (; tree->values[v].parent != JSON_NONE; v = tree->values[v].parent) {
        if (ffd_json_tree_key_is(tree, v, "extras"))
            return JSON_NONE;
        if (found == JSON_NONE && ffd_json_tree_key_is(tree, tree->values[v].parent, "extensions"))
            found = v;
    }
    return found;
}

/* Whether a value is a string whose key is "uri" or ends with "Uri". */
static bool is_uri(const json_tree *tree, uint32_t v)
{
    const json_value *const value = &tree->values[v];
    const char *const end = tree->text + value->key_end;
    return value->kind == JSON_STRING && value->key_end - value->key_begin >= sizeof "uri" + 1 &&
           (memcmp(end - 4, "Uri\"", 4) == 0 || ffd_json_tree_key_is(tree, v, "uri"));
}

uint32_t ffd_gltf_next_linked(const json_tree *tree, uint32_t v, uint32_t *extension)
{
    *extension = JSON_NONE;
    for (; v < tree->count && *extension == JSON_NONE; v++)
        *extension = is_uri(tree, v) ? extension_around(tree, v) : JSON_NONE;
    return *extension == JSON_NONE ? JSON_NONE : v - 1;
}

ffd_status ffd_gltf_find_linked(const json_tree *tree, const file_folder *mesh, path_list *files,
                                ffd_error *error)
{
    uint32_t extension, v = ffd_gltf_next_linked(tree, 0, &extension);
    for (; v != JSON_NONE; v = ffd_gltf_next_linked(tree, v + 1, &extension)) {
        char *relative;
        TRY(ffd_gltf_uri_path(tree, v, mesh, &relative, error));
        TRY(ffd_gltf_add_sibling(mesh, relative, files, error));
    }
    return FFD_OK;
}
