#include "base/text/xml_scan.h"
#include <string.h>

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static bool begins(const xml_scan *scan, const char *text)
{
    const size_t length = strlen(text);
    return (size_t)(scan->last - scan->at) >= length && memcmp(scan->at, text, length) == 0;
}

static ffd_status refuse(const xml_scan *scan, const char *what, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, scan->file, "is not XML that is read here: %s", what);
}

/* Moves past a comment or an instruction, if there is one. */
static ffd_status skip(xml_scan *scan, bool *skipped, ffd_error *error)
{
    const bool is_comment = begins(scan, "<!--");
    *skipped = is_comment || begins(scan, "<?");
    if (!*skipped)
        return begins(scan, "<!") ? refuse(scan, "it has a document type, or CDATA", error) : FFD_OK;
    const char *const end = ffd_find_text(scan->at, scan->last, is_comment ? "-->" : "?>");
    if (!end)
        return refuse(scan, "a comment or an instruction does not end", error);
    scan->at = end + (is_comment ? 3 : 2);
    return FFD_OK;
}

/* The end of a tag, which is no > within quotes; NULL: there is none. */
static const char *find_end(const xml_scan *scan)
{
    char quote = 0;
    for (const char *at = scan->at; at < scan->last; at++) {
        if (quote ? *at == quote : *at == '"' || *at == '\'')
            quote = quote ? 0 : *at;
        else if (!quote && *at == '>')
            return at;
    }
    return NULL;
}

ffd_status ffd_xml_next(xml_scan *scan, xml_tag *tag, bool *found, ffd_error *error)
{
    bool skipped = true;
    while (skipped) {
        scan->at = memchr(scan->at, '<', (size_t)(scan->last - scan->at));
        *found = scan->at != NULL;
        if (!*found) {
            scan->at = scan->last;
            return FFD_OK;
        }
        TRY(skip(scan, &skipped, error));
    }
    const char *const end = find_end(scan);
    if (!end)
        return refuse(scan, "a tag does not end", error);
    *tag = (xml_tag){.is_end = scan->at[1] == '/', .is_empty = end[-1] == '/'};
    tag->name.first = tag->name.last = scan->at + 1 + tag->is_end;
    while (tag->name.last < end && !is_space(*tag->name.last) && *tag->name.last != '/')
        tag->name.last++;
    tag->attributes = (text_word){tag->name.last, end};
    scan->at = end + 1;
    return !scan->takes_entities && memchr(tag->attributes.first, '&', (size_t)(end - tag->attributes.first))
               ? refuse(scan, "it has entities", error)
               : FFD_OK;
}

bool ffd_xml_attribute(const xml_tag *tag, const char *name, text_word *value)
{
    const char *at = tag->attributes.first;
    *value = (text_word){at, at};
    while (at < tag->attributes.last) {
        while (at < tag->attributes.last && is_space(*at))
            at++;
        const text_word key = {at, memchr(at, '=', (size_t)(tag->attributes.last - at))};
        if (!key.last || tag->attributes.last - key.last < 2)
            return false;
        const char quote = key.last[1];
        const char *const first = key.last + 2;
        const char *const last = memchr(first, quote, (size_t)(tag->attributes.last - first));
        if ((quote != '"' && quote != '\'') || !last)
            return false;
        if (ffd_text_is(key, name)) {
            *value = (text_word){first, last};
            return true;
        }
        at = last + 1;
    }
    return false;
}
