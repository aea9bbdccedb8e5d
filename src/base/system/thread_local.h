/* thread_local.h - variables of a thread in libraries that are loaded while threads run. */
#ifndef FFD_BASE_SYSTEM_THREAD_LOCAL_H
#define FFD_BASE_SYSTEM_THREAD_LOCAL_H

#include <stdlib.h> /* __GLIBC__ */

/* Behind the variable: its memory is there as soon as the library is loaded. glibc allocates it together with
   each thread in the static TLS model; in the dynamic one it does so at first use, and ends the program if
   memory runs out. musl allocates it when it loads the library, and loads none that has the static model. */
#ifdef __GLIBC__
#define FFD_ALLOCATED_WITH_THREAD __attribute__((tls_model("initial-exec")))
#else
#define FFD_ALLOCATED_WITH_THREAD
#endif

#endif
