/* module.h - parts of the program that are loaded (dlopen) when a file first needs them. Each module wraps a
   library and exports a table of C functions (and, where it is bound to the system's library, allocators:
   base/memory/process_allocator.h). So a run that does not need the library does not spend
   time on loading it and the C++ runtime. */
#ifndef FFD_BASE_SYSTEM_MODULE_H
#define FFD_BASE_SYSTEM_MODULE_H

#include "base/fail.h"
#include <ffd/program.h>
#include <stdatomic.h>
#include <stdint.h>

/* What identifies a module. */
typedef struct module_identity {
    const char *file;    /* file name, in one of the folders that src/meson.build lists */
    const char *version; /* FFD_VERSION that it was built with, because it shares structs */
    uint32_t interface;  /* number of the module's interface: to be raised when its functions or their structs
                            change */
} module_identity;

/* The first members of a module's table. */
typedef struct module_head {
    module_identity identity;
    void (*prepare)(void); /* each thread must call it while memory is available; NULL: not needed */
    void (*spell_members)(ffd_spell_function); /* the module has messages of its own: ffd_spell_members */
    void (*ask)(ffd_status (*check)(ffd_error *error)); /* and loops that take long: ffd_deadline_ask */
} module_head;

/* A module that can be loaded. */
typedef struct module {
    module_identity wanted;
    const char *what;                  /* what it is needed for, in messages */
    _Atomic(const module_head *) head; /* NULL: not loaded yet */
} module;

/* The symbol of a module's table, a struct that begins with a module_head. */
#define MODULE_SYMBOL "ffd_module"

/* Loads a module, once. *head is its table, which is valid until the process ends. Thread-safe. Errors:
   FFD_E_UNSUPPORTED (missing, cannot be loaded, or of another version), FFD_E_MEMORY. */
ffd_status ffd_module_load(module *of, const module_head **head, ffd_error *error);

#endif
