#include "job/report/depfile.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "job/report/replace.h"
#include <string.h>

struct ffd_depfile {
    char *path;
    file_output *output; /* begun by ffd_depfile_create */
    byte_buffer rules;
    size_t written;  /* bytes of the rules that output has */
    bool is_spoiled; /* output has others, or an error: it is to be begun again */
};

/* Begins the file; one that was begun is dropped. */
static ffd_status begin(ffd_depfile *depfile, ffd_error *error)
{
    ffd_output_destroy(&depfile->output);
    depfile->written = 0;
    depfile->is_spoiled = false;
    TRY(ffd_output_create(&depfile->output, error));
    return ffd_output_begin(depfile->output, depfile->path, true, error);
}

/* Whether a file looks like a depfile: each of its lines names targets, the last of which ends in a colon,
   and is neither a comment nor JSON. */
static bool is_depfile(const file_input *old)
{
    const char *const text = (const char *)old->data;
    size_t word = 0; /* characters of the word so far */
    bool has_colon = false, is_empty = true;
    for (size_t i = 0; i < old->size; i++) {
        const bool is_json = text[i] == '{' && i + 1 < old->size && text[i + 1] == '"';
        if (text[i] == 0 || (is_empty && (text[i] == '#' || is_json)))
            return false;
        if (text[i] == '\n' && !has_colon && !is_empty && !(word > 1 && text[i - 1] == ':'))
            return false;
        if (text[i] == '\n')
            has_colon = false;
        else if (strchr(" \t\r", text[i]))
            has_colon = has_colon || (word > 1 && text[i - 1] == ':');
        is_empty = text[i] == '\n' || (is_empty && strchr(" \t\r", text[i]));
        word = strchr(" \t\r\n", text[i]) ? 0 : word + 1;
        if (text[i] == '\\') { /* the next character is escaped, be it a line break */
            i++;
            word++;
        }
    }
    return is_empty || has_colon || (word > 1 && text[old->size - 1] == ':');
}

ffd_status ffd_depfile_create(const char *path, ffd_depfile **depfile, ffd_error *error)
{
    *depfile = NULL;
    TRY(ffd_replace_check(path, is_depfile, "depfile", error));
    ffd_depfile *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    ffd_status status;
    made->path = ffd_text_copy(path);
    TRY_END(made->path ? begin(made, error) : ffd_fail_memory(error));
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
    ffd_free((*depfile)->path);
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

ffd_status ffd_depfile_rule(const path_list *outputs, const path_list *inputs, byte_buffer *rules,
                            ffd_error *error)
{
    TRY(put_names(rules, outputs, false, error));
    ffd_buffer_text(rules, inputs->count ? ": " : ":");
    TRY(put_names(rules, inputs, true, error));
    ffd_buffer_text(rules, "\n");
    return !rules->failed ? FFD_OK : ffd_fail_memory(error);
}

void ffd_depfile_add(ffd_depfile *depfile, const byte_buffer *rules)
{
    ffd_buffer_append(&depfile->rules, rules->data, rules->size);
}

/* Writes the rules that the file does not have yet. */
static ffd_status write_rules(ffd_depfile *depfile, ffd_error *error)
{
    const byte_buffer *const rules = &depfile->rules;
    TRY(rules->failed ? ffd_fail_memory(error) : FFD_OK);
    TRY(depfile->is_spoiled ? begin(depfile, error) : FFD_OK);
    if (depfile->written < rules->size)
        TRY(ffd_output_write(depfile->output, rules->data + depfile->written, rules->size - depfile->written,
                             error));
    depfile->written = rules->size;
    return FFD_OK;
}

ffd_status ffd_depfile_offer(ffd_depfile *depfile, const byte_buffer *rules, ffd_error *error)
{
    ffd_depfile_add(depfile, rules);
    if (ffd_output_is_stream(depfile->path))
        return FFD_OK;
    TRY(write_rules(depfile, error));
    return ffd_output_flush(depfile->output, error);
}

void ffd_depfile_withdraw(ffd_depfile *depfile, const byte_buffer *rules)
{
    if (!depfile->rules.failed)
        depfile->rules.size -= rules->size;
    depfile->is_spoiled = !ffd_output_is_stream(depfile->path);
}

ffd_status ffd_depfile_write(ffd_depfile *depfile, ffd_error *error)
{
    TRY(write_rules(depfile, error));
    return ffd_output_commit(depfile->output, error);
}
