/* The functions of FMI 2.0, as calls of an instance. */
#include "fmi2Functions.h"
#include "instance.h"

#include <stdlib.h>

enum { LINE = 2000 };

/*
 * The message is the format itself, without conversions: importers that ignore further arguments show it, too.
 */
static void report(const ku_instance *u, int status, const char *category, const char *message)
{
    const fmi2CallbackFunctions *functions = u->front;
    char line[LINE];
    int length = 0;
    for (const char *c = message; *c && length < LINE - 2; ++c) {
        line[length++] = *c;
        if (*c == '%') {
            line[length++] = '%';
        }
    }
    line[length] = 0;
    if (functions && functions->logger) {
        functions->logger(functions->componentEnvironment, u->label, (fmi2Status)status, category, line);
    }
}

/* Return from a function that is called without an instance, or in a wrong state. */
#define NEEDS(modes)                                                              \
    ku_instance *u = c;                                                           \
    if (!u || !ku_may(u, __func__, modes)) {                                      \
        return fmi2Error;                                                         \
    }

#define NEEDS_KIND(cosimulates, modes)                                            \
    ku_instance *u = c;                                                           \
    if (!u || !ku_is(u, __func__, cosimulates) || !ku_may(u, __func__, modes)) {  \
        return fmi2Error;                                                         \
    }

/* -- instances -------------------------------------------------------------------------------- */

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    (void)nCategories, (void)categories;
    NEEDS(KU_ANY)
    u->logging = loggingOn;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    (void)fmuResourceLocation, (void)visible;
    return ku_open(instanceName, fmuGUID, fmuType == fmi2CoSimulation, loggingOn, report, (void *)functions);
}

void fmi2FreeInstance(fmi2Component c)
{
    if (c) {
        ku_close(c);
    }
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    (void)stopTimeDefined, (void)stopTime;
    NEEDS(KU_INSTANTIATED)
    return (fmi2Status)ku_start(u, startTime, toleranceDefined, tolerance);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    NEEDS(KU_INSTANTIATED)
    ku_enter(u, KU_INITIALISING);
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    NEEDS(KU_INITIALISING)
    return (fmi2Status)ku_begin(u);
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    NEEDS(KU_RUNNING)
    ku_enter(u, KU_TERMINATED);
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    NEEDS(KU_ANY)
    ku_reset(u);
    return fmi2OK;
}

/* -- values ----------------------------------------------------------------------------------- */

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    NEEDS(KU_ANY)
    return (fmi2Status)ku_get(u, vr, nvr, value);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    NEEDS(KU_SET_UP | KU_RUNNING)
    return (fmi2Status)ku_set(u, vr, nvr, value);
}

/* All variables are real numbers: there are none of other types. */
static fmi2Status of_another_type(ku_instance *u, const char *function, size_t count)
{
    if (count) {
        ku_say(u, KU_ERROR, "%s: there are no variables of this type, all are Real.", function);
    }
    return count ? fmi2Error : fmi2OK;
}

#define OTHER_TYPE(name, type)                                                                      \
    fmi2Status fmi2Get##name(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,            \
                             type value[])                                                          \
    {                                                                                               \
        (void)vr, (void)value;                                                                      \
        NEEDS(KU_ANY)                                                                               \
        return of_another_type(u, __func__, nvr);                                                   \
    }                                                                                               \
                                                                                                    \
    fmi2Status fmi2Set##name(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,            \
                             const type value[])                                                    \
    {                                                                                               \
        (void)vr, (void)value;                                                                      \
        NEEDS(KU_ANY)                                                                               \
        return of_another_type(u, __func__, nvr);                                                   \
    }

OTHER_TYPE(Integer, fmi2Integer)
OTHER_TYPE(Boolean, fmi2Boolean)
OTHER_TYPE(String, fmi2String)

/* -- saved instances -------------------------------------------------------------------------- */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    NEEDS(KU_ANY)
    *FMUstate = ku_save(u, *FMUstate);
    return *FMUstate ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    NEEDS(KU_ANY)
    return FMUstate ? (fmi2Status)ku_restore(u, FMUstate) : fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    NEEDS(KU_ANY)
    if (FMUstate) {
        free(*FMUstate);
        *FMUstate = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    (void)FMUstate;
    NEEDS(KU_ANY)
    *size = ku_size();
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[],
                                 size_t size)
{
    NEEDS(KU_ANY)
    return (fmi2Status)ku_serialise(u, FMUstate, (unsigned char *)serializedState, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate)
{
    NEEDS(KU_ANY)
    *FMUstate = ku_deserialise(u, (const unsigned char *)serializedState, size);
    return *FMUstate ? fmi2OK : fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[], fmi2Real dvUnknown[])
{
    NEEDS(KU_INITIALISING | KU_RUNNING | KU_TERMINATED)
    return (fmi2Status)ku_derivative(u, vUnknown_ref, nUnknown, vKnown_ref, nKnown, dvKnown, dvUnknown, 0);
}

/* -- Model Exchange --------------------------------------------------------------------------- */

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    NEEDS_KIND(0, KU_EVENTS | KU_CONTINUOUS)
    ku_enter(u, KU_EVENTS);
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *eventInfo)
{
    int over = 0;
    NEEDS_KIND(0, KU_EVENTS)
    int status = ku_update(u, &over);
    *eventInfo = (fmi2EventInfo){.terminateSimulation = over};
    return (fmi2Status)status;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    NEEDS_KIND(0, KU_EVENTS)
    ku_enter(u, KU_CONTINUOUS);
    ku_mark(u);
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    int over = 0;
    NEEDS_KIND(0, KU_CONTINUOUS)
    int status = ku_completed(u, &over);
    *enterEventMode = fmi2False;
    *terminateSimulation = over;
    return (fmi2Status)status;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    NEEDS_KIND(0, KU_EVENTS | KU_CONTINUOUS)
    return (fmi2Status)ku_set_time(u, time);
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    NEEDS_KIND(0, KU_CONTINUOUS)
    return (fmi2Status)ku_set_states(u, x, nx);
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi2Status)ku_get_rates(u, derivatives, nx);
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi2Status)ku_get_events(u, eventIndicators, ni);
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi2Status)ku_get_states(u, x, nx);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx)
{
    NEEDS_KIND(0, KU_ANY)
    return (fmi2Status)ku_get_nominals(u, x_nominal, nx);
}

/* -- Co-Simulation ---------------------------------------------------------------------------- */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    NEEDS_KIND(1, KU_SET_UP | KU_STEPPING)
    return (fmi2Status)ku_set_slopes(u, vr, nvr, order, value);
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)nvr, (void)order, (void)value;
    NEEDS_KIND(1, KU_ANY)
    ku_say(u, KU_ERROR, "%s: outputs have no derivatives here (maxOutputDerivativeOrder = 0).", __func__);
    return fmi2Error;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize, fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    NEEDS_KIND(1, KU_STEPPING)
    return (fmi2Status)ku_step(u, currentCommunicationPoint, communicationStepSize);
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    NEEDS_KIND(1, KU_STEPPING)
    ku_say(u, KU_ERROR, "%s: no step is pending, fmi2DoStep returns when it is done.", __func__);
    return fmi2Error;
}

static fmi2Status no_such_status(ku_instance *u, const char *function)
{
    ku_say(u, KU_DISCARD, "%s: there is no such status, fmi2DoStep returns when it is done.", function);
    return fmi2Discard;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value)
{
    (void)s, (void)value;
    NEEDS_KIND(1, KU_ANY)
    return no_such_status(u, __func__);
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    NEEDS_KIND(1, KU_ANY)
    if (s != fmi2LastSuccessfulTime) {
        return no_such_status(u, __func__);
    }
    *value = u->last_time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    (void)s, (void)value;
    NEEDS_KIND(1, KU_ANY)
    return no_such_status(u, __func__);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    NEEDS_KIND(1, KU_ANY)
    if (s != fmi2Terminated) {
        return no_such_status(u, __func__);
    }
    *value = u->stopped;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    (void)s, (void)value;
    NEEDS_KIND(1, KU_ANY)
    return no_such_status(u, __func__);
}
