/* deflate_module.h - the function table of the module with zlib. deflate_module.c is part of the module,
   inflate_load.c of the program that loads it. */
#ifndef FFD_IO_DEFLATE_DEFLATE_MODULE_H
#define FFD_IO_DEFLATE_DEFLATE_MODULE_H

#include "base/system/module.h"
#include "io/deflate/inflate.h"
#include <ffd/version.h>

#define DEFLATE_IDENTITY                                                                                     \
    {                                                                                                        \
        "ffd-deflate.so", FFD_VERSION, 2                                                                     \
    }

typedef struct deflate_module {
    module_head head;
    ffd_status (*inflate)(const unsigned char *bytes, size_t size, bool is_raw, unsigned char *out,
                          size_t wanted, ffd_error *error);
    ffd_status (*deflate)(const unsigned char *bytes, size_t size, unsigned char *out, size_t *made,
                          ffd_error *error);
} deflate_module;

#endif
