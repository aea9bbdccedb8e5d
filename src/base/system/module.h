/* module.h - parts of the program that are loaded when a file first needs them. Each stands between the C of
   all the rest and a C++ library, and shows nothing but a table of C functions: whoever does not need the
   library does not wait until it, and the C++ runtime that it needs, are loaded. */
#ifndef FFD_BASE_SYSTEM_MODULE_H
#define FFD_BASE_SYSTEM_MODULE_H

#include "base/fail.h"
#include <stdatomic.h>
#include <stdint.h>

/* What a module is. */
typedef struct module_identity {
    const char *file;    /* its name in one of the folders of src/meson.build */
    const char *version; /* FFD_VERSION, whose structs it knows */
    uint32_t interface;  /* of this module: to be raised when its functions or their structs change */
} module_identity;

/* How a module's table begins. */
typedef struct module_head {
    module_identity identity;
    void (*prepare)(void); /* to be called by each thread, with memory to spare; NULL: needs not */
} module_head;

/* A module that may be loaded. */
typedef struct module {
    module_identity wanted;
    const char *what;                  /* it is needed for, for messages */
    _Atomic(const module_head *) head; /* NULL: not loaded yet */
} module;

/* The symbol of a module's table, a struct that begins with a module_head. */
#define MODULE_SYMBOL "ffd_module"

/* Loads a module, once; *head is its table, which stays until the process ends. Any thread may call it.
   Errors: FFD_E_UNSUPPORTED (it is not there, cannot be loaded or is of another version), FFD_E_MEMORY. */
ffd_status ffd_module_load(module *of, const module_head **head, ffd_error *error);

#endif
