#include "mesh/mesh_log.h"
#include <stdarg.h>
#include <stdio.h>

void ffd_log_line(const mesh_log *log, ffd_log_level level, const char *format, ...)
{
    char line[1024];
    va_list arguments;
    if (!log || !log->function)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    log->function(log->user, level, line);
}
