/* leak_check_pages.c - makes the leak check of the address sanitizer cheap, in programs that run.sh links
   with this.

   The check reads all global variables at the end of a program. 10 MB of them are the sanitizer's own tables,
   nearly all zeros that nothing has touched: each page would be a page fault. One call maps them all
   beforehand. */
#include <stdint.h>
#include <sys/mman.h>

#define PAGE ((uintptr_t)4096)

/* Set by the linker: where the variables that begin as zeros are. */
extern char __bss_start[], _end[];

/* Called by the sanitizer before it checks. Returns 0: the check is wanted. */
int __lsan_is_turned_off(void);
int __lsan_is_turned_off(void)
{
#ifdef MADV_POPULATE_READ
    const uintptr_t first = ((uintptr_t)__bss_start + PAGE - 1) / PAGE * PAGE,
                    last = (uintptr_t)_end / PAGE * PAGE;
    if (first < last)
        (void)madvise((void *)first, last - first,
                      MADV_POPULATE_READ); /* without it the check only takes longer */
#endif
    return 0;
}
