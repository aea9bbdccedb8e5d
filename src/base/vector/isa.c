#include "base/vector/isa.h"
/* <stdlib.h> tells which C library it is. glibc has the header below since 2.33. */
#include <stdlib.h>
#if defined(FFD_X86) && defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
#include <sys/platform/x86.h>
#endif
#endif

#ifdef FFD_X86
/* Features that the processor and the operating system support, as the C library has found them at program
   start: to execute CPUID again is slow in virtual machines. */
#ifdef CPU_FEATURE_ACTIVE
#define HAS(feature) has(x86_cpu_##feature)

/* As x86_cpu_active in the C library's header, but without a shift into the sign bit. */
static bool has(unsigned feature)
{
    const struct cpuid_feature *const leaf = __x86_get_cpuid_feature_leaf(feature / 128);
    return leaf->active_array[feature % 128 / 32] >> feature % 32 & 1;
}
#else
/* C libraries that do not tell, and compilers whose runtime library lacks what __builtin_cpu_supports calls.
   Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, 14.3, 15.2 to 15.4. */
#include <cpuid.h>
#include <stdatomic.h>
#define HAS(feature) (find_features() & FEATURE_##feature)

enum {
    FEATURE_KNOWN = 1,
    FEATURE_SSE2 = 2,
    FEATURE_AVX2 = 4,
    FEATURE_AVX512F = 8,
    FEATURE_AVX512DQ = 16,
    FEATURE_AVX512VL = 32
};

/* The registers that the operating system saves (XCR0): 6 are those of AVX, 0xe6 those of AVX-512 as well. */
static unsigned find_saved(void)
{
    unsigned low, high;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

static unsigned find_features(void)
{
    static atomic_uint known;
    unsigned a, b, c, d, saved = 0, found = atomic_load_explicit(&known, memory_order_relaxed);
    if (found)
        return found;
    found = FEATURE_KNOWN;
    if (__get_cpuid(1, &a, &b, &c, &d)) {
        found |= d & bit_SSE2 ? FEATURE_SSE2 : 0;
        saved = c & bit_OSXSAVE ? find_saved() : 0;
    }
    if (__get_cpuid_count(7, 0, &a, &b, &c, &d)) {
        if ((saved & 6) == 6)
            found |= b & bit_AVX2 ? FEATURE_AVX2 : 0;
        if ((saved & 0xe6) == 0xe6)
            found |= (b & bit_AVX512F ? FEATURE_AVX512F : 0) | (b & bit_AVX512DQ ? FEATURE_AVX512DQ : 0) |
                     (b & bit_AVX512VL ? FEATURE_AVX512VL : 0);
    }
    atomic_store_explicit(&known, found, memory_order_relaxed);
    return found;
}
#endif
#endif

bool ffd_isa_available(ffd_isa isa)
{
    switch (isa) {
    case FFD_ISA_AUTO:
    case FFD_ISA_SCALAR:
        return true;
#ifdef FFD_X86
    case FFD_ISA_SSE2:
        return HAS(SSE2);
    case FFD_ISA_AVX2:
        return HAS(AVX2);
    case FFD_ISA_AVX512:
        return HAS(AVX512F) && HAS(AVX512DQ) && HAS(AVX512VL);
#elif defined(FFD_ARM64)
    case FFD_ISA_NEON:
        return true;
#endif
    default:
        return false;
    }
}

ffd_isa ffd_isa_best(void)
{
    ffd_isa best = FFD_ISA_SCALAR;
    for (ffd_isa isa = FFD_ISA_SSE2; isa <= FFD_ISA_NEON; isa++)
        if (ffd_isa_available(isa))
            best = isa;
    return best;
}

const char *ffd_isa_name(ffd_isa isa)
{
    static const char *const names[] = {"auto", "scalar", "sse2", "avx2", "avx512", "neon"};
    return (unsigned)isa < sizeof names / sizeof *names ? names[isa] : "unknown";
}
