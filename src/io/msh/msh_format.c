#include "io/msh/msh_format.h"
#include "base/memory/memory.h"
#include "io/msh/msh_reader.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The byte order, as a 1 behind the line of the format. */
static ffd_status take_order(msh_reader *r)
{
    int64_t one;
    r->is_binary = true;
    r->d->encoding = "binary little endian";
    TRY(ffd_msh_int(r, "the number 1", &one));
    if (one == 1)
        return FFD_OK;
    r->is_big = true;
    r->d->encoding = "binary big endian";
    return one == 1 << 24 ? FFD_OK
                          : MSH_REFUSE(r, "the number behind the format is not 1 in either byte order");
}

/* version, 1 for binary, bytes of a number */
static ffd_status take_format(msh_reader *r)
{
    text_word version, word;
    double number;
    int64_t is_binary, size;
    TRY(ffd_msh_word(r, "a version", &version));
    TRY(ffd_msh_int(r, "0 for text or 1 for binary", &is_binary));
    TRY(ffd_msh_int(r, "the size of a number", &size));
    if (!ffd_text_number(version, &number))
        return MSH_REFUSE(r, "\"%s\" is not a version", ffd_text_shown(version).text);
    r->is_new = number > 4.05 && number < 4.15;
    if (!r->is_new && !(number >= 2 && number < 3))
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, r->scan.line,
                             "the version \"%s\" is not supported: only 2.2 and 4.1 are",
                             ffd_text_shown(version).text);
    if (size != 8 && !(r->is_new && size == 4))
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, r->scan.line,
                             "numbers of %" PRId64 " bytes are not supported", size);
    r->word = (size_t)size;
    r->has_format = true;
    r->d->content = r->is_new ? "4.1" : "2.2";
    ffd_text_word(&r->scan, &word);
    if (!is_binary)
        return FFD_OK;
    ffd_text_next_line(&r->scan);
    return take_order(r);
}

/* Moves behind the end of a section. In binary its data may look like anything: only their end is looked
   for, where it is known. */
static ffd_status end_section(msh_reader *r, text_word name)
{
    char end[64];
    const int length = snprintf(end, sizeof end, "$End%.*s", (int)(name.last - name.first), name.first);
    const char *const found = ffd_find_text(r->scan.at, r->scan.last, end);
    if (!found)
        return MSH_REFUSE(r, "the section $%.*s has no %s", (int)(name.last - name.first), name.first, end);
    for (const char *at = r->scan.at; at < found && !r->is_binary; at++)
        r->scan.line += *at == '\n';
    r->scan.at = found + length;
    return FFD_OK;
}

/* What is between the data of a section that was read and its end. */
static ffd_status check_end(msh_reader *r, text_word name)
{
    text_word word;
    TRY(ffd_msh_word(r, "the end of a section", &word));
    if (word.last - word.first > 4 && memcmp(word.first, "$End", 4) == 0)
        return FFD_OK;
    return MSH_REFUSE(r, "\"%s\" is in the place of the end of the section $%.*s", ffd_text_shown(word).text,
                      (int)(name.last - name.first), name.first);
}

static ffd_status take_section(msh_reader *r, text_word name)
{
    static const char *const known[] = {"MeshFormat", "Nodes",         "ParametricNodes",
                                        "Elements",   "PhysicalNames", "Entities"};
    size_t section = 0;
    while (section < sizeof known / sizeof *known && !ffd_text_is(name, known[section]))
        section++;
    if (section > 0 && !r->has_format)
        return MSH_REFUSE(r, "the first section is not $MeshFormat");
    ffd_text_next_line(&r->scan);
    switch (section) {
    case 0:
        TRY(take_format(r));
        break;
    case 1:
    case 2:
        TRY(ffd_msh_nodes(r, section == 2));
        break;
    case 3:
        TRY(ffd_msh_elements(r));
        break;
    case 4:
        TRY(ffd_msh_names(r));
        break;
    case 5:
        TRY(ffd_msh_entities(r));
        break;
    default:
        return end_section(r, name);
    }
    return check_end(r, name);
}

static ffd_status take_sections(msh_reader *r)
{
    text_word word;
    while (ffd_text_find(&r->scan) && ffd_text_word(&r->scan, &word)) {
        if (*word.first != '$' || word.last - word.first > 40)
            return MSH_REFUSE(r, "\"%s\" is in the place of the beginning of a section, such as $Nodes",
                              ffd_text_shown(word).text);
        TRY(take_section(r, (text_word){word.first + 1, word.last}));
    }
    return r->has_nodes ? FFD_OK : ffd_fail_file(r->error, FFD_E_INVALID, r->d->file.name, "has no $Nodes");
}

static ffd_status open_msh(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    msh_reader r = {.d = ffd_volume_make(sizeof(volume_document), input, source, error), .error = error};
    if (!r.d)
        return FFD_E_MEMORY;
    r.d->encoding = "ascii";
    ffd_text_begin(&r.scan, input->data, input->size, false);
    const ffd_status status = take_sections(&r);
    ffd_free(r.tags);
    ffd_free(r.names);
    ffd_free(r.entities);
    if (status)
        ffd_volume_free(r.d);
    else
        *document = ffd_volume_ready(r.d, !r.is_binary, source);
    return status;
}

const mesh_format ffd_msh_format = {
    .format = FFD_FORMAT_MSH,
    .name = "Gmsh",
    .open = open_msh,
    .close = ffd_volume_close,
    .save = ffd_volume_save,
    .selectors = &ffd_volume_selectors,
    VOLUME_CALLS,
};
