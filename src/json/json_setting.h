/* json_setting.h - a value as users write it in an argument or a table cell: JSON, or text without quotes. */
#ifndef FFD_JSON_JSON_SETTING_H
#define FFD_JSON_JSON_SETTING_H

#include "json/json_tree.h"

/* All zeros: empty. */
typedef struct json_setting {
    json_tree tree; /* its root is the value */
    char *quoted;   /* if the text is not JSON: the text as a JSON string; else NULL */
} json_setting;

/* Parses a text, which must outlive the setting, with rules of json_parse.h. A text that violates them stands
   for itself as a string. Errors: FFD_E_INVALID (neither JSON nor UTF-8), FFD_E_MEMORY. */
ffd_status ffd_json_setting_parse(const char *text, unsigned rules, json_setting *setting);
/* Frees the setting and empties it. */
void ffd_json_setting_free(json_setting *setting);

#endif
