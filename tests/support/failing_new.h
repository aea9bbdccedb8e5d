/* failing_new.h - makes C++'s operator new fail, as base/memory/memory.h makes ffd_alloc. */
#ifndef FFD_TESTS_FAILING_NEW_H
#define FFD_TESTS_FAILING_NEW_H

#ifdef __cplusplus
extern "C" {
#endif

/* After `successes` further calls of operator new every one throws std::bad_alloc; a negative number turns
   this off. Returns the calls since the last time. */
long new_fail_after(long successes);

#ifdef __cplusplus
}
#endif

#endif
