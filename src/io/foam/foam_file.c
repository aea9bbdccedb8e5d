#include "io/foam/foam_file.h"
#include "base/text/content.h"
#include <string.h>

text_shown ffd_foam_next(const foam_file *f)
{
    text_scan scan = f->scan;
    text_word word;
    if (!ffd_code_find(&scan))
        return (text_shown){"the end of the file"};
    if (!ffd_code_word(&scan, &word))
        word = (text_word){scan.at, scan.at + 1};
    text_shown shown = ffd_text_shown(word);
    const size_t length = strlen(shown.text);
    if (length + 2 < sizeof shown.text) {
        memmove(shown.text + 1, shown.text, length);
        shown.text[0] = shown.text[length + 1] = '"';
        shown.text[length + 2] = 0;
    }
    return shown;
}

ffd_status ffd_foam_mark(foam_file *f, char mark, const char *what)
{
    return ffd_code_mark(&f->scan, mark)
               ? FFD_OK
               : FOAM_REFUSE(f, "%s is in the place of the \"%c\" of %s", ffd_foam_next(f).text, mark, what);
}

ffd_status ffd_foam_name(foam_file *f, const char *what, text_word *name)
{
    return ffd_code_string(&f->scan, name) || ffd_code_word(&f->scan, name)
               ? FFD_OK
               : FOAM_REFUSE(f, "%s is in the place of %s", ffd_foam_next(f).text, what);
}

ffd_status ffd_foam_whole(foam_file *f, const char *what, uint64_t *value)
{
    text_word word;
    (void)ffd_code_find(&f->scan);
    const text_scan before = f->scan;
    if (ffd_code_word(&f->scan, &word) && ffd_text_whole(word, value))
        return FFD_OK;
    f->scan = before;
    return FOAM_REFUSE(f, "%s is not %s", ffd_foam_next(f).text, what);
}

/* Takes whatever is next. depth: how many brackets are open. *ends: whether the value ends with it. */
static bool take_any(foam_file *f, size_t *depth, bool *ends)
{
    text_word word;
    *ends = false;
    if (ffd_code_string(&f->scan, &word) || ffd_code_word(&f->scan, &word))
        return true;
    if (!ffd_code_find(&f->scan) || *f->scan.at == '"')
        return false;
    const char mark = *f->scan.at;
    const bool opens = strchr("([{", mark), closes = strchr(")]}", mark);
    if (closes && *depth == 0)
        return false;
    *depth = *depth + opens - closes;
    *ends = *depth == 0 && (mark == ';' || mark == '}');
    f->scan.at++;
    return true;
}

ffd_status ffd_foam_skip(foam_file *f)
{
    size_t depth = 0;
    bool ends = false;
    while (!ends)
        if (!take_any(f, &depth, &ends))
            return FOAM_REFUSE(f, "%s is in the place of the end of an entry", ffd_foam_next(f).text);
    return FFD_OK;
}

/* Finds the size behind a key, such as "label=", in bits. bits: that of files that do not state it. */
static uint64_t size_of(text_word arch, const char *key, uint64_t bits)
{
    const char *const found = ffd_find_text(arch.first, arch.last, key);
    if (!found)
        return bits;
    const char *const first = found + strlen(key), *last = first;
    while (last < arch.last && *last >= '0' && *last <= '9')
        last++;
    return ffd_text_whole((text_word){first, last}, &bits) ? bits : 0;
}

/* "LSB;label=32;scalar=64" */
static ffd_status take_arch(foam_file *f, text_word arch)
{
    const uint64_t label = size_of(arch, "label=", 32), scalar = size_of(arch, "scalar=", 64);
    if ((label != 32 && label != 64) || (scalar != 32 && scalar != 64) ||
        ffd_find_text(arch.first, arch.last, "MSB"))
        return ffd_fail_line(f->error, FFD_E_UNSUPPORTED, f->name, f->scan.line,
                             "binary numbers of the arch \"%s\" are not supported: only LSB, with 32 or 64 "
                             "bits, is",
                             ffd_text_shown(arch).text);
    f->label = label == 32 ? NUMBER_INT32 : NUMBER_INT64;
    f->scalar = scalar == 32 ? NUMBER_FLOAT : NUMBER_DOUBLE;
    return FFD_OK;
}

/* What the header says of binary numbers, which comes before it is known whether there are any. */
typedef struct foam_header {
    text_word format, arch;
} foam_header;

static ffd_status take_entry(foam_file *f, foam_header *header)
{
    text_word key, value;
    TRY(ffd_foam_name(f, "an entry of the header", &key));
    const text_scan before = f->scan;
    if (ffd_code_string(&f->scan, &value) || ffd_code_word(&f->scan, &value)) {
        if (ffd_text_is(key, "format"))
            header->format = value;
        else if (ffd_text_is(key, "arch"))
            header->arch = value;
        else if (ffd_text_is(key, "class"))
            f->class = value;
        else if (ffd_text_is(key, "note"))
            f->note = value;
    }
    f->scan = before;
    return ffd_foam_skip(f);
}

ffd_status ffd_foam_begin(foam_file *f, const void *data, size_t size)
{
    const text_word none = {"", ""};
    foam_header header = {none, none};
    text_word word = none;
    f->is_binary = false;
    f->class = f->note = none;
    ffd_text_begin(&f->scan, data, size, false);
    if (size > 1 && memcmp(data, "\x1f\x8b", 2) == 0)
        return ffd_fail_file(f->error, FFD_E_UNSUPPORTED, f->name,
                             "is compressed, which is not supported: unpack it with gunzip");
    if (!ffd_code_word(&f->scan, &word) || !ffd_text_is(word, "FoamFile"))
        return ffd_fail_file(f->error, FFD_E_INVALID, f->name, "does not begin with FoamFile");
    TRY(ffd_foam_mark(f, '{', "the header"));
    while (!ffd_code_mark(&f->scan, '}'))
        TRY(take_entry(f, &header));
    const bool is_binary = ffd_text_is(header.format, "binary");
    if (!is_binary && header.format.last > header.format.first && !ffd_text_is(header.format, "ascii"))
        return ffd_fail_file(f->error, FFD_E_UNSUPPORTED, f->name,
                             "the format \"%s\" is not supported: only ascii and binary are",
                             ffd_text_shown(header.format).text);
    if (is_binary)
        TRY(take_arch(f, header.arch));
    f->is_binary = is_binary;
    return FFD_OK;
}

ffd_status ffd_foam_check_class(const foam_file *f, const char *first, const char *second)
{
    if (ffd_text_is(f->class, first) || (second && ffd_text_is(f->class, second)))
        return FFD_OK;
    /* The files of all processors in one. */
    const bool is_collated = ffd_text_is(f->class, "decomposedBlockData");
    return ffd_fail_file(f->error, is_collated ? FFD_E_UNSUPPORTED : FFD_E_INVALID, f->name,
                         "the class is \"%s\", not %s%s%s", ffd_text_shown(f->class).text, first,
                         second ? " or " : "", second ? second : "");
}
