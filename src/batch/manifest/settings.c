#include "batch/manifest/settings.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include "json/json_setting.h"
#include "json/json_text.h"
#include <string.h>

/* The most bytes that a message shows. */
#define SHOWN ((size_t)160)

static void write_setting(json_text *json, const ffd_setting *setting)
{
    json_setting value = {0};
    if (ffd_json_setting_parse(setting->value, JSON_NO_NUL | JSON_DOUBLES, &value) == FFD_E_MEMORY)
        json->out->failed = true;
    else if (value.tree.count)
        ffd_json_raw(json, setting->name, value.tree.text + value.tree.values[0].begin,
                     value.tree.values[0].end - value.tree.values[0].begin);
    else
        ffd_json_null(json, setting->name); /* neither JSON nor UTF-8: the job fails anyway */
    ffd_json_setting_free(&value);
}

void ffd_settings_json(const ffd_deform_desc *desc, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, true);
    for (size_t i = 0; i < desc->set_count; i++)
        write_setting(&json, &desc->set[i]);
    ffd_json_end(&json, '}');
    if (!whole.failed)
        ffd_json_join_lines(whole.data, whole.size, text);
    text->failed = text->failed || whole.failed;
    ffd_buffer_append(text, "", 1);
    ffd_buffer_free(&whole);
}

/* Truncates UTF-8 that is too long, at a character. */
static void shorten(byte_buffer *text, size_t most)
{
    if (text->size <= most)
        return;
    text->size = most;
    while (text->size > 0 && ((unsigned char)text->data[text->size] & 0xc0) == 0x80)
        text->size--;
    ffd_buffer_text(text, "...");
}

void ffd_settings_show(const ffd_deform_desc *desc, byte_buffer *text)
{
    byte_buffer shown = {0};
    for (size_t i = 0; i < desc->set_count; i++)
        ffd_buffer_format(&shown, "%s%s=%s", i ? ", " : "", desc->set[i].name, desc->set[i].value);
    shorten(&shown, SHOWN);
    ffd_buffer_append(text, shown.data, shown.size);
    text->failed = text->failed || shown.failed;
    ffd_buffer_free(&shown);
}
