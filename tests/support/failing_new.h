/* failing_new.h - makes operator new fail on request, like ffd_alloc (base/memory/memory.h). */
#ifndef FFD_TESTS_FAILING_NEW_H
#define FFD_TESTS_FAILING_NEW_H

#ifdef __cplusplus
extern "C" {
#endif

/* After `successes` more calls, each operator new throws std::bad_alloc; negative: never. Returns the number
   of calls since the last time. */
long new_fail_after(long successes);

#ifdef __cplusplus
}
#endif

#endif
