#include "base/system/processors.h"
#include <windows.h>

int ffd_processor_count(void)
{
    DWORD_PTR own, all;
    int count = 0;
    /* Both are 0 for a process with threads in several groups of 64 processors. */
    if (GetProcessAffinityMask(GetCurrentProcess(), &own, &all))
        for (; own; own &= own - 1)
            count++;
    if (count == 0)
        count = (int)GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return count > 0 ? count : 1;
}
