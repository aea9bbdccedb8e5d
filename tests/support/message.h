/* message.h - the line that an error is told as. */
#ifndef FFD_TESTS_MESSAGE_H
#define FFD_TESTS_MESSAGE_H

#include <ffd/error.h>

/* Good until the next call. */
static inline const char *message_of(const ffd_error *error)
{
    static char text[2048];
    ffd_error_format(error, text, sizeof text);
    return text;
}

#endif
