#include "base/vector/isa.h"

bool ffd_isa_available(ffd_isa isa)
{
    switch (isa) {
    case FFD_ISA_AUTO:
    case FFD_ISA_SCALAR:
        return true;
#ifdef FFD_X86
    case FFD_ISA_SSE2:
        return __builtin_cpu_supports("sse2");
    case FFD_ISA_AVX2:
        return __builtin_cpu_supports("avx2");
    case FFD_ISA_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
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
