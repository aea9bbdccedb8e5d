#include "cli/reported.h"
#include "cli/command.h"
#include <string.h>

int cli_run_reported(const cli_report *asked, cli_reported *run, void *context)
{
    ffd_output_set *files = NULL;
    ffd_report *report = NULL;
    ffd_error error;
    int code;
    if (ffd_output_set_create(&files, &error) ||
        (asked->path && ffd_report_create(asked->path, asked->stable, files, &report, &error)))
        code = cli_fail(&error);
    else
        code = run(context, files, report);
    if (report && ffd_report_write(report, &error)) {
        const int own = cli_fail(&error);
        code = code ? code : own;
    }
    ffd_report_destroy(&report);
    ffd_output_set_destroy(&files);
    return code;
}

const char *cli_report_mistake(const cli_report *asked, const char *output)
{
    if (asked->stable && !asked->path)
        return "--report-stable needs --report";
    if (asked->path && strcmp(asked->path, "-") == 0 && strcmp(output, "-") == 0)
        return "-o and --report both name standard output";
    return NULL;
}

bool cli_report_meets(const cli_report *asked, const char *path)
{
    return asked->path && path && strcmp(asked->path, "-") != 0 && ffd_paths_meet(asked->path, path);
}
