/* json_setting.h - a value as people write it in an argument or a cell: JSON, or else a text without quotes.
 */
#ifndef FFD_JSON_JSON_SETTING_H
#define FFD_JSON_JSON_SETTING_H

#include "json/json_span.h"

/* All zeros: empty. */
typedef struct json_setting {
    json_span tree; /* the value is its top */
    char *quoted;   /* the text as a JSON string, where it is not JSON itself; or NULL */
} json_setting;

/* Parses a text, which must outlive the setting, by rules of json_parse.h. What breaks them is a text too.
   Errors: FFD_E_INVALID where it is neither JSON nor UTF-8, FFD_E_MEMORY. */
ffd_status ffd_json_setting_parse(const char *text, unsigned rules, json_setting *setting);
/* Leaves an empty setting. */
void ffd_json_setting_free(json_setting *setting);

#endif
