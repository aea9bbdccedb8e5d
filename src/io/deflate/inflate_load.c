/* inflate_load.c - decompresses and compresses with the module, which is loaded on first use. */
#include "io/deflate/deflate_module.h"

static module deflate = {DEFLATE_IDENTITY, "compressed data", NULL};

ffd_status ffd_inflate(const unsigned char *bytes, size_t size, bool is_raw, unsigned char *out,
                       size_t wanted, ffd_error *error)
{
    const module_head *head;
    TRY(ffd_module_load(&deflate, &head, error));
    return ((const deflate_module *)head)->inflate(bytes, size, is_raw, out, wanted, error);
}

ffd_status ffd_deflate(const unsigned char *bytes, size_t size, unsigned char *out, size_t *made,
                       ffd_error *error)
{
    const module_head *head;
    TRY(ffd_module_load(&deflate, &head, error));
    return ((const deflate_module *)head)->deflate(bytes, size, out, made, error);
}
