#include "mesh/mesh_log.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include <stdarg.h>
#include <stdio.h>

void ffd_log_line(const mesh_log *log, ffd_log_level level, const char *format, ...)
{
    char line[1024];
    va_list arguments;
    if (!log || !log->function)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, SPELLED(format), arguments);
    va_end(arguments);
    log->function(log->user, level, line);
}

static void send_labelled(void *user, ffd_log_level level, const char *line)
{
    const mesh_log_label *const label = user;
    ffd_log_line(&label->log, level, "morph target \"%s\": %s", label->name, line);
}

mesh_log ffd_log_morph(const mesh_log *log, const char *name, mesh_log_label *label)
{
    label->log = log ? *log : (mesh_log){0};
    ffd_name_shown(name, label->name, sizeof label->name);
    return (mesh_log){label->log.function ? send_labelled : NULL, label};
}
