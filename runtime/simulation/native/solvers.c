/* The solvers by the numbers of their methods, and the version of SUNDIALS. */
#include "versions.h"
#include "worker.h"

static const kt_solver *const SOLVERS[] = {
    [KT_BDF] = &kt_cvode, [KT_ADAMS] = &kt_cvode, [KT_DORMAND_PRINCE] = &kt_dormand_prince,
    [KT_RK4] = &kt_rk4, [KT_RODASP] = &kt_rodasp, [KT_RUNGE_KUTTA] = &kt_erk,
};

const kt_solver *kt_solver_of(int method) { return SOLVERS[method]; }

const char *kt_version(void) { return SUNDIALS_VERSION; }
