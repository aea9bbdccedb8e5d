#include "job/info.h"
#include "base/memory.h"
#include "base/path.h"
#include "job/source.h"
#include <math.h>

ffd_bounds ffd_info_no_bounds(void)
{
    return (ffd_bounds){.min = {INFINITY, INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY, -INFINITY}};
}

void ffd_info_widen(ffd_bounds *bounds, const double point[3])
{
    for (int c = 0; c < 3; c++) {
        bounds->min[c] = point[c] < bounds->min[c] ? point[c] : bounds->min[c];
        bounds->max[c] = point[c] > bounds->max[c] ? point[c] : bounds->max[c];
    }
}

void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *bounds)
{
    if (bounds->min[0] > bounds->max[0]) {
        ffd_json_null(json, key);
        return;
    }
    ffd_json_object(json, key, false);
    ffd_json_vector(json, "min", bounds->min, 3);
    ffd_json_vector(json, "max", bounds->max, 3);
    ffd_json_end(json, '}');
}

/* The length of the UTF-8 sequence at the start of text (RFC 3629), 0 where there is none. */
static size_t utf8_length(const unsigned char *text, size_t left)
{
    const unsigned char lead = text[0];
    if (lead < 0x80)
        return 1;
    const size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || length > left)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80)
            return 0;
    const unsigned char second = text[1];
    const bool too_long = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool surrogate = lead == 0xed && second >= 0xa0, too_large = lead == 0xf4 && second >= 0x90;
    return too_long || surrogate || too_large ? 0 : length;
}

/* Names in old files are not all UTF-8, but JSON must be. */
static void make_utf8(byte_buffer *buffer)
{
    unsigned char *text = (unsigned char *)buffer->data;
    for (size_t i = 0; i < buffer->size;) {
        const size_t length = utf8_length(text + i, buffer->size - i);
        if (length == 0)
            text[i] = '?';
        i += length ? length : 1;
    }
}

static ffd_status write_facts(const ffd_source *file, byte_buffer *out, ffd_error *error)
{
    const bool lattice = file->format == FFD_FORMAT_AUTO && ffd_path_has_ending(file->path, ".json");
    json_text json;
    ffd_json_begin(&json, out);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "format", "ffd-info");
    ffd_json_count(&json, "version", 1);
    ffd_json_string(&json, "file", file->path);
    ffd_json_string(&json, "kind", lattice ? "lattice" : "mesh");
    const ffd_status status =
        lattice ? ffd_info_lattice(file->path, &json, error) : ffd_info_mesh(file, &json, error);
    if (status != FFD_OK)
        return status;
    ffd_json_end(&json, '}');
    make_utf8(out);
    return out->failed ? ffd_fail_memory(error) : FFD_OK;
}

ffd_status ffd_info_run(const ffd_source *file, bool json, char **text, ffd_error *error)
{
    byte_buffer facts = {0};
    *text = NULL;
    ffd_status status = write_facts(file, &facts, error);
    if (status == FFD_OK && !json)
        status = ffd_info_render(facts.data, facts.size, text, error);
    else if (status == FFD_OK) {
        *text = ffd_buffer_finish(&facts);
        status = *text ? FFD_OK : ffd_fail_memory(error);
    }
    if (status != FFD_OK && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(file));
    ffd_buffer_free(&facts);
    return status;
}

void ffd_text_free(char *text)
{
    ffd_free(text);
}
