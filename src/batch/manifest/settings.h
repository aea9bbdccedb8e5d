/* settings.h - shows the values of placeholders of a job. */
#ifndef FFD_BATCH_MANIFEST_SETTINGS_H
#define FFD_BATCH_MANIFEST_SETTINGS_H

#include "base/text/buffer.h"
#include <ffd/job.h>

/* Appends them as a JSON object on one line, terminated by 0. */
void ffd_settings_json(const ffd_deform_desc *desc, byte_buffer *text);
/* Appends "NAME=VALUE, NAME=VALUE", truncated if long; nothing if there are none. */
void ffd_settings_show(const ffd_deform_desc *desc, byte_buffer *text);

#endif
