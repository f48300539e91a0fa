/*
 * Differences between versions of SUNDIALS (6.4 and 7.x), with the names of the newest.
 */
#ifndef KINTRAFO_VERSIONS_H
#define KINTRAFO_VERSIONS_H

#include <stdio.h> /* FILE, which SUNDIALS 6.4 uses undeclared */

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

/* The steppers of ARKODE have common functions since 7.1. */
#if SUNDIALS_VERSION_MAJOR < 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR < 1)
#define ARKodeEvolve ERKStepEvolve
#define ARKodeFree ERKStepFree
#define ARKodeGetCurrentStep ERKStepGetCurrentStep
#define ARKodeGetDky ERKStepGetDky
#define ARKodeGetNumErrTestFails ERKStepGetNumErrTestFails
#define ARKodeGetNumSteps ERKStepGetNumSteps
#define ARKodeSetInitStep ERKStepSetInitStep
#define ARKodeSetInterpolantDegree ERKStepSetInterpolantDegree
#define ARKodeSetMaxNumSteps ERKStepSetMaxNumSteps
#define ARKodeSetMaxStep ERKStepSetMaxStep
#define ARKodeSetStopTime ERKStepSetStopTime
#define ARKodeSetUserData ERKStepSetUserData
#define ARKodeSVtolerances ERKStepSVtolerances
#endif

/* Evaluations are counted for each part of the right-hand side since 7.2. */
#if SUNDIALS_VERSION_MAJOR < 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR < 2)
#define ARKodeGetNumRhsEvals(solver, part, count) ERKStepGetNumRhsEvals(solver, count)
#endif

/* Errors are reported by return codes only: messages are silenced, since 7.0 by the context. */
#if SUNDIALS_VERSION_MAJOR < 7

static inline void be_silent(int code, const char *module, const char *function, char *message, void *data)
{
    (void)code, (void)module, (void)function, (void)message, (void)data;
}

static inline int open_silent_context(SUNContext *context) { return SUNContext_Create(NULL, context); }

static inline void silence_cvode(void *solver) { CVodeSetErrHandlerFn(solver, be_silent, NULL); }

static inline void silence_arkode(void *solver) { ERKStepSetErrHandlerFn(solver, be_silent, NULL); }

#else

static inline int open_silent_context(SUNContext *context)
{
    int code = SUNContext_Create(SUN_COMM_NULL, context);
    return code ? code : SUNContext_ClearErrHandlers(*context);
}

static inline void silence_cvode(void *solver) { (void)solver; }

static inline void silence_arkode(void *solver) { (void)solver; }

#endif

#endif
