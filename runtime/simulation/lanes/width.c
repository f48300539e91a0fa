#include "ensemble.h"

int kt_widest(void)
{
#if defined __x86_64__ && (defined __GNUC__ || defined __clang__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
        && __builtin_cpu_supports("avx512vl")) {
        return 8;
    }
    if (__builtin_cpu_supports("avx2")) {
        return 4;
    }
#endif
    return 2;
}
