#include "picture/linear.h"
#include "mesh/srgb.h"

void ffd_linear_fill(linear_tables *tables)
{
    const uint32_t count = 1 << LINEAR_BITS;
    uint32_t next = 0;
    for (unsigned byte = 0; byte < 256; byte++) {
        tables->light[byte] = ffd_srgb_byte_to_linear(byte);
        tables->shares[byte] = tables->light[byte] * (1.0 / LINEAR_ONE);
        tables->alphas[byte] = byte * (1.0 / 255);
        /* From this light on, the next byte is nearer. */
        const double end = byte < 255 ? ffd_srgb_to_linear((byte + 0.5) / 255) * count : count;
        while (next < count && next + 0.5 < end)
            tables->bytes[next++] = (uint8_t)byte;
    }
}
