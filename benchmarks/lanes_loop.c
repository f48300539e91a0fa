/* Calls a right-hand side again and again: of one system, or of as many as a vector has lanes. */
typedef int (*one_by_one)(const double *, const double *, const double *, double *);

double call_one(one_by_one rhs, const double *constants, double *state, const double *inputs,
                double *out, long times)
{
    for (long i = 0; i < times; ++i) {
        rhs(constants, state, inputs, out);
        state[1] += 1e-9 * out[0]; /* so that no call is like the one before */
    }
    return state[1];
}

/* as what is called is compiled: a processor changes slowly between kinds of instructions */
#if defined __x86_64__
#define COMPILED_FOR(features) __attribute__((target(features)))
#else
#define COMPILED_FOR(features)
#endif

#define LANES(width, features)                                                                  \
    typedef double real_##width __attribute__((vector_size(8 * width)));                        \
    typedef long long bits_##width __attribute__((vector_size(8 * width)));                     \
    typedef bits_##width (*in_lanes_##width)(const real_##width *, const real_##width *,        \
                                             const real_##width *, real_##width *);             \
    COMPILED_FOR(features)                                                                      \
    double call_##width(in_lanes_##width rhs, const real_##width *constants, real_##width *state, \
                        const real_##width *inputs, real_##width *out, long times)              \
    {                                                                                           \
        for (long i = 0; i < times; ++i) {                                                      \
            rhs(constants, state, inputs, out);                                                 \
            state[1] += 1e-9 * out[0];                                                          \
        }                                                                                       \
        return state[1][0];                                                                     \
    }

LANES(2, "sse2")
LANES(4, "avx2")
LANES(8, "avx512f,avx512vl,avx512dq")
