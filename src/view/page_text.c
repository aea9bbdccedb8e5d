#include "view/page_text.h"
#include "json/json_chars.h"
#include <string.h>

#define LONGEST 200
#define ELLIPSIS "\xe2\x80\xa6"
#define REPLACEMENT "\xef\xbf\xbd"

/* Whether a character is a control or formatting character: it breaks the line, changes the direction of the
   text, or is invisible. The joiners U+200C and U+200D are not among them, as words need them. */
static bool is_hidden(uint32_t code)
{
    static const uint32_t ranges[][2] = {{0, 0x1f},        {0x7f, 0x9f},      {0xad, 0xad},
                                         {0x61c, 0x61c},   {0x200b, 0x200b},  {0x200e, 0x200f},
                                         {0x2028, 0x202e}, {0x2060, 0x206f},  {0xfeff, 0xfeff},
                                         {0xfff9, 0xfffb}, {0xe0000, 0xe007f}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (code >= ranges[i][0] && code <= ranges[i][1])
            return true;
    return false;
}

char *ffd_page_name(const char *name)
{
    byte_buffer out = {0};
    const char *const last = name + strlen(name);
    size_t count = 0;
    for (const char *c = name, *next; c < last; c = next, count++) {
        uint32_t code = 0;
        if (count == LONGEST) {
            ffd_buffer_text(&out, ELLIPSIS);
            break;
        }
        next = ffd_utf8_read(c, last, &code);
        if (!next) {
            ffd_buffer_text(&out, REPLACEMENT);
            next = c + 1;
        } else if (code == '\n')
            ffd_buffer_text(&out, "\\n");
        else if (is_hidden(code))
            ffd_buffer_format(&out, "\\u{%x}", (unsigned)code);
        else
            ffd_buffer_append(&out, c, (size_t)(next - c));
    }
    return ffd_buffer_finish(&out);
}

static void append_escaped(byte_buffer *out, const char *text, bool in_quotes)
{
    for (const char *c = text; *c; c++)
        if (*c == '&')
            ffd_buffer_text(out, "&amp;");
        else if (*c == '<')
            ffd_buffer_text(out, "&lt;");
        else if (*c == '"' && in_quotes)
            ffd_buffer_text(out, "&quot;");
        else
            ffd_buffer_append(out, c, 1);
}

void ffd_page_html(byte_buffer *out, const char *text)
{
    append_escaped(out, text, false);
}

void ffd_page_attribute(byte_buffer *out, const char *text)
{
    append_escaped(out, text, true);
}

void ffd_page_address(byte_buffer *out, const char *path)
{
    for (const char *c = path; *c; c++) {
        const bool is_plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                              (*c >= '0' && *c <= '9') || strchr("-._~/", *c);
        ffd_buffer_format(out, is_plain ? "%c" : "%%%02X", (unsigned char)*c);
    }
}

void ffd_page_json(byte_buffer *out, const char *text, size_t size)
{
    const char *const end = text + size;
    for (const char *c = text; c < end;) {
        const char *const found = memchr(c, '<', (size_t)(end - c)), *const stop = found ? found : end;
        ffd_buffer_append(out, c, (size_t)(stop - c));
        if (found)
            ffd_buffer_text(out, "\\u003c");
        c = found ? found + 1 : end;
    }
}
