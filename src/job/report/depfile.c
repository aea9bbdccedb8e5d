#include "job/report/depfile.h"
#include "base/file/output.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "job/report/replace.h"
#include <string.h>

struct ffd_depfile {
    file_output *output; /* begun by ffd_depfile_create */
    byte_buffer rules;
};

/* Whether a file looks like a depfile: its first word ends in a colon. */
static bool is_depfile(const file_input *old)
{
    const char *text = (const char *)old->data;
    for (size_t i = 0; i < old->size; i++) {
        if (text[i] == '#' || (text[i] == '{' && i + 1 < old->size && text[i + 1] == '"'))
            return false; /* a comment, or JSON */
        if (text[i] == '\\')
            i++;
        else if (strchr(" \t\r\n", text[i])) /* also excludes NUL */
            return i > 1 && text[i - 1] == ':';
    }
    return false;
}

ffd_status ffd_depfile_create(const char *path, ffd_depfile **depfile, ffd_error *error)
{
    *depfile = NULL;
    TRY(ffd_replace_check(path, is_depfile, "depfile", error));
    ffd_depfile *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(ffd_output_create(&made->output, error));
    TRY_END(ffd_output_begin(made->output, path, true, error));
end:
    if (status)
        ffd_depfile_destroy(&made);
    *depfile = made;
    return status;
}

void ffd_depfile_destroy(ffd_depfile **depfile)
{
    if (!depfile || !*depfile)
        return;
    ffd_output_destroy(&(*depfile)->output);
    ffd_buffer_free(&(*depfile)->rules);
    ffd_free(*depfile);
    *depfile = NULL;
}

/* Escapes a name. Backslashes stay single, except before a character that needs escaping: there they are
   doubled. */
static void put_name(byte_buffer *rules, const char *name)
{
    size_t backslashes = 0;
    for (; *name; name++) {
        if (strchr(" \t#:", *name))
            for (size_t i = 0; i <= backslashes; i++)
                ffd_buffer_append(rules, "\\", 1);
        else if (*name == '$')
            ffd_buffer_append(rules, "$", 1);
        ffd_buffer_append(rules, name, 1);
        backslashes = *name == '\\' ? backslashes + 1 : 0;
    }
    while (backslashes-- > 0) /* a blank or the end of the line follows */
        ffd_buffer_append(rules, "\\", 1);
}

bool ffd_depfile_troubles(const char *name)
{
    for (const char *backslash = strchr(name, '\\'); backslash; backslash = strchr(backslash + 1, '\\'))
        if (strchr("#:$", backslash[1])) /* or at the end of the name */
            return true;
    return name[strcspn(name, "\"%&'*;<=>?^`|\t")] != 0;
}

/* once: skip duplicates. */
static ffd_status put_names(byte_buffer *rules, const path_list *names, bool once, ffd_error *error)
{
    intern_table known = {0};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < names->count; i++) {
        const char *const name = names->paths[i];
        const size_t before = known.count;
        uint32_t index;
        if (name[strcspn(name, "\r\n")])
            TRY_END(ffd_fail_file(error, FFD_E_IO, name,
                                  "cannot be written in a depfile: its name has a line break"));
        else if (once && !ffd_intern(&known, name, strlen(name), &index))
            TRY_END(ffd_fail_memory(error));
        if (once && known.count == before)
            continue;
        ffd_buffer_text(rules, i ? " " : "");
        put_name(rules, name);
    }
end:
    ffd_intern_free(&known);
    return status;
}

ffd_status ffd_depfile_common_rule(const path_list *outputs, const path_list *inputs, byte_buffer *rules,
                                   ffd_error *error)
{
    TRY(put_names(rules, outputs, false, error));
    ffd_buffer_text(rules, inputs->count ? ": " : ":");
    TRY(put_names(rules, inputs, true, error));
    ffd_buffer_text(rules, "\n");
    return !rules->failed ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_depfile_rule(const char *output, const path_list *inputs, byte_buffer *rules, ffd_error *error)
{
    path_list outputs = {0};
    ffd_status status;
    TRY_END(ffd_paths_add(&outputs, output, error));
    TRY_END(ffd_depfile_common_rule(&outputs, inputs, rules, error));
end:
    ffd_paths_free(&outputs);
    return status;
}

void ffd_depfile_add(ffd_depfile *depfile, const byte_buffer *rules)
{
    ffd_buffer_append(&depfile->rules, rules->data, rules->size);
}

ffd_status ffd_depfile_write(ffd_depfile *depfile, ffd_error *error)
{
    const byte_buffer *rules = &depfile->rules;
    TRY(rules->failed ? ffd_fail_memory(error) : FFD_OK);
    TRY(ffd_output_write(depfile->output, rules->data, rules->size, error));
    return ffd_output_commit(depfile->output, error);
}
