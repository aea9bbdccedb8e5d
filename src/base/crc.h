/* crc.h - the check sum of the members of a ZIP file. */
#ifndef FFD_BASE_CRC_H
#define FFD_BASE_CRC_H

#include <stddef.h>
#include <stdint.h>

/* Continues a CRC-32 (ISO 3309, with ZIP's polynomial, reflected), which begins with 0, by more bytes. */
uint32_t ffd_crc(uint32_t crc, const unsigned char *bytes, size_t size);

#endif
