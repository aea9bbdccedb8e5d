#include "json/json_setting.h"
#include "base/memory/memory.h"
#include "json/json_chars.h"
#include "json/json_parse.h"
#include "json/json_text.h"
#include <string.h>

ffd_status ffd_json_setting_parse(const char *text, unsigned rules, json_setting *setting)
{
    json_input input = {.text = text, .size = strlen(text), .name = "", .rules = rules};
    *setting = (json_setting){0};
    const ffd_status status = ffd_json_parse(&input, &setting->tree, NULL);
    if (status != FFD_E_INVALID || !ffd_utf8_is_valid(text, input.size))
        return status;
    byte_buffer quoted = {0};
    json_text writer;
    ffd_json_begin(&writer, &quoted);
    ffd_json_string(&writer, NULL, text);
    input.size = quoted.size;
    input.text = setting->quoted = ffd_buffer_finish(&quoted);
    ffd_buffer_free(&quoted);
    return setting->quoted ? ffd_json_parse(&input, &setting->tree, NULL) : FFD_E_MEMORY;
}

void ffd_json_setting_free(json_setting *setting)
{
    ffd_json_tree_free(&setting->tree);
    ffd_free(setting->quoted);
    *setting = (json_setting){0};
}
