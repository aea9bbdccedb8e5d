/* settings.h - extracts the values of placeholders from the words of a job ("--set=NAME=VALUE"). */
#ifndef FFD_BATCH_MANIFEST_SETTINGS_H
#define FFD_BATCH_MANIFEST_SETTINGS_H

#include "base/text/buffer.h"

/* Appends them as a JSON object on one line, terminated by 0. words: count words, each terminated by 0. */
void ffd_settings_json(const char *words, size_t count, byte_buffer *text);
/* Appends "NAME=VALUE, NAME=VALUE", truncated if long; nothing if there are none. */
void ffd_settings_show(const char *words, size_t count, byte_buffer *text);

#endif
