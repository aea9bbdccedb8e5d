/* size.h - sizes in bytes as users write them. */
#ifndef FFD_BASE_TEXT_SIZE_H
#define FFD_BASE_TEXT_SIZE_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a number of bytes, which K, M or G after it multiply by 10^3, 10^6 or 10^9: "700M". Returns false if
   the text is none, or less than 1 or not less than 2^63. */
bool ffd_size_parse(const char *text, uint64_t *bytes);

#endif
