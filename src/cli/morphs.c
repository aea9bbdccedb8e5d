#include "cli/morphs.h"
#include <stdlib.h>
#include <string.h>

/* Copies a quoted name, in which a doubled quote stands for one. Returns the position behind it; NULL: the
   closing quote is missing. */
static const char *copy_quoted(const char *text, char *name)
{
    for (const char *c = text + 1; *c; c++) {
        if (*c == '\'' && c[1] != '\'') {
            *name = 0;
            return c + 1;
        }
        c += *c == '\'';
        *name++ = *c;
    }
    return NULL;
}

/* Copies a name up to '='. */
static const char *copy_name(const char *text, char *name)
{
    const size_t length = strcspn(text, "=");
    memcpy(name, text, length);
    name[length] = 0;
    return strpbrk(name, " \t,") ? NULL : text + length;
}

bool cli_add_morph(void *settings, const cli_option *option, const char *value)
{
    cli_job *const job = settings;
    char *const name = malloc(strlen(value) + 1);
    const char **const grown = realloc(job->morphs, (job->morph_count + 1) * sizeof *grown);
    job->morphs = grown ? grown : job->morphs;
    if (!name || !grown) {
        free(name);
        cli_complain("out of memory");
        return false;
    }
    uint32_t index = 0;
    const char *const rest = *value == '\'' ? copy_quoted(value, name) : copy_name(value, name);
    const char *why = !rest || *rest != '=' || !*name
                          ? "is not NAME=LATTICE (a name with blanks, '=' or ',' is in single quotes)"
                      : !rest[1] ? "names no lattice"
                                 : NULL;
    if (!why && !ffd_intern(&job->morph_names, name, strlen(name), &index))
        why = "is one too many: out of memory";
    else if (!why && index < job->morph_count)
        why = "has the name of another morph target";
    if (why) {
        cli_complain("--%s: \"%s\" %s", option->name, value, why);
        free(name);
        return false;
    }
    job->morphs[job->morph_count++] = name;
    job->lattices[job->lattice_count++].path = rest + 1;
    return true;
}

bool cli_add_clip(void *settings, const cli_option *option, const char *value)
{
    cli_job *const job = settings;
    ffd_error error;
    if (!ffd_clip_check(value, &error))
        return cli_add_name(&job->clips, &(cli_option){.name = option->name}, value);
    cli_fail(&error);
    return false;
}

bool cli_morphs_describe(cli_job *job, ffd_deform_desc *desc)
{
    if (job->morph_count == 0)
        return true;
    if (!job->morph_results)
        job->morph_results = calloc(job->morph_count, sizeof *job->morph_results);
    desc->morph_results = job->morph_results;
    if (!job->morph_results)
        cli_complain("out of memory");
    return job->morph_results;
}
