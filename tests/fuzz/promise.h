/* promise.h - what a fuzz target asserts: the message, then the end of the program. */
#ifndef FFD_TESTS_FUZZ_PROMISE_H
#define FFD_TESTS_FUZZ_PROMISE_H

#include <stdio.h>
#include <stdlib.h>

/* PROMISE(condition, format, ...): what holds for every input. */
#define PROMISE(condition, ...)                                                                              \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            fprintf(stderr, "%s:%d: broken promise: ", __FILE__, __LINE__);                                  \
            fprintf(stderr, __VA_ARGS__);                                                                    \
            fputc('\n', stderr);                                                                             \
            abort();                                                                                         \
        }                                                                                                    \
    } while (0)

#endif
