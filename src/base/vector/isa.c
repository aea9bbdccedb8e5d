#include "base/vector/isa.h"
#if defined(__has_include) && defined(FFD_X86)
#if __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>
#endif
#endif

#ifdef FFD_X86
/* Features that the processor and the operating system support, as the C library has found them at program
   start. The compiler's built-in would execute CPUID again, which is slow in virtual machines. */
#ifdef CPU_FEATURE_ACTIVE
#define HAS(feature, name) has(x86_cpu_##feature)

/* As x86_cpu_active in the C library's header, but without a shift into the sign bit. */
static bool has(unsigned feature)
{
    const struct cpuid_feature *const leaf = __x86_get_cpuid_feature_leaf(feature / 128);
    return leaf->active_array[feature % 128 / 32] >> feature % 32 & 1;
}
#else
#define HAS(feature, name) __builtin_cpu_supports(name)
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
        return HAS(SSE2, "sse2");
    case FFD_ISA_AVX2:
        return HAS(AVX2, "avx2");
    case FFD_ISA_AVX512:
        return HAS(AVX512F, "avx512f") && HAS(AVX512DQ, "avx512dq") && HAS(AVX512VL, "avx512vl");
#endif
    default:
        return false;
    }
}

ffd_isa ffd_isa_best(void)
{
    ffd_isa best = FFD_ISA_SCALAR;
    for (ffd_isa isa = FFD_ISA_SSE2; isa <= FFD_ISA_AVX512; isa++)
        if (ffd_isa_available(isa))
            best = isa;
    return best;
}

const char *ffd_isa_name(ffd_isa isa)
{
    static const char *const names[] = {"auto", "scalar", "sse2", "avx2", "avx512"};
    return (unsigned)isa < sizeof names / sizeof *names ? names[isa] : "unknown";
}
