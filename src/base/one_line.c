/* one_line.c - texts that become one line of a message, whatever names are in them (public: ffd/program.h).
 */
#include <ffd/program.h>
#include <string.h>

/* Returns the size of the character to replace at the start of a text; 0 if it may stay. */
static size_t harmful(const unsigned char *text, size_t size)
{
    if (text[0] < 0x20 || text[0] == 0x7f)
        return 1;
    if (size >= 2 && text[0] == 0xc2 && text[1] >= 0x80 && text[1] <= 0x9f)
        return 2;
    if (size < 3 || text[0] != 0xe2)
        return 0;
    return (text[1] == 0x80 && text[2] >= 0xa8 && text[2] <= 0xae) ||
                   (text[1] == 0x81 && text[2] >= 0xa6 && text[2] <= 0xa9)
               ? 3
               : 0;
}

void ffd_make_one_line(char *text, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        const size_t found = harmful((const unsigned char *)text + i, size - i);
        memset(text + i, '?', found);
        i += found > 1 ? found - 1 : 0;
    }
}
