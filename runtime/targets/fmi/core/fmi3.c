/* The functions of FMI 3.0, as calls of an instance. */
#include "fmi3Functions.h"
#include "instance.h"

#include <stdlib.h>

typedef struct {
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} callbacks;

static void report(const ku_instance *u, int status, const char *category, const char *message)
{
    const callbacks *known = u->front;
    if (known->log) {
        known->log(known->environment, (fmi3Status)status, category, message);
    }
}

/* Return from a function that is called without an instance, or in a wrong state. */
#define NEEDS(modes)                                                              \
    ku_instance *u = instance;                                                    \
    if (!u || !ku_may(u, __func__, modes)) {                                      \
        return fmi3Error;                                                         \
    }

#define NEEDS_KIND(cosimulates, modes)                                            \
    ku_instance *u = instance;                                                    \
    if (!u || !ku_is(u, __func__, cosimulates) || !ku_may(u, __func__, modes)) {  \
        return fmi3Error;                                                         \
    }

/* -- instances -------------------------------------------------------------------------------- */

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    (void)nCategories, (void)categories;
    NEEDS(KU_ANY)
    u->logging = loggingOn;
    return fmi3OK;
}

static fmi3Instance open_one(fmi3String name, fmi3String token, int co_simulation, int logging,
                             fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    callbacks *known = malloc(sizeof *known);
    if (!known) {
        return NULL;
    }
    known->log = log;
    known->environment = environment;
    ku_instance *u = ku_open(name, token, co_simulation, logging, report, known);
    if (!u) {
        free(known);
    }
    return u;
}

fmi3Instance fmi3InstantiateModelExchange(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage)
{
    (void)resourcePath, (void)visible;
    return open_one(instanceName, instantiationToken, 0, loggingOn, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed, const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    (void)resourcePath, (void)visible, (void)eventModeUsed, (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables, (void)nRequiredIntermediateVariables, (void)intermediateUpdate;
    return open_one(instanceName, instantiationToken, 1, loggingOn, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
    fmi3LockPreemptionCallback lockPreemption, fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    (void)clockUpdate, (void)lockPreemption, (void)unlockPreemption;
    if (logMessage) {
        logMessage(instanceEnvironment, fmi3Error, "logStatusError",
                   "there is no Scheduled Execution of this model, which has no clocks: instantiate it for Model "
                   "Exchange or Co-Simulation.");
    }
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance)
{
    ku_instance *u = instance;
    if (u) {
        free(u->front);
        ku_close(u);
    }
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined,
                                       fmi3Float64 tolerance, fmi3Float64 startTime,
                                       fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)stopTimeDefined, (void)stopTime;
    NEEDS(KU_INSTANTIATED)
    int status = ku_start(u, startTime, toleranceDefined, tolerance);
    if (status == KU_OK) {
        ku_enter(u, KU_INITIALISING);
    }
    return (fmi3Status)status;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    NEEDS(KU_INITIALISING)
    return (fmi3Status)ku_begin(u);
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    NEEDS(KU_RUNNING)
    ku_enter(u, KU_TERMINATED);
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    NEEDS(KU_ANY)
    ku_reset(u);
    return fmi3OK;
}

/* -- values ----------------------------------------------------------------------------------- */

static int same_count(ku_instance *u, const char *function, size_t references, size_t values)
{
    if (references == values) {
        return 1;
    }
    ku_say(u, KU_ERROR, "%s: %lu values are given for %lu variables, each of which is one number.", function,
           (unsigned long)values, (unsigned long)references);
    return 0;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[], size_t nValues)
{
    NEEDS(KU_ANY)
    if (!same_count(u, __func__, nValueReferences, nValues)) {
        return fmi3Error;
    }
    return (fmi3Status)ku_get(u, valueReferences, nValueReferences, values);
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[], size_t nValues)
{
    NEEDS(KU_SET_UP | KU_RUNNING)
    if (!same_count(u, __func__, nValueReferences, nValues)) {
        return fmi3Error;
    }
    return (fmi3Status)ku_set(u, valueReferences, nValueReferences, values);
}

/* All variables are Float64: there are none of other types. */
static fmi3Status of_another_type(ku_instance *u, const char *function, size_t count)
{
    if (count) {
        ku_say(u, KU_ERROR, "%s: there are no variables of this type, all are Float64.", function);
    }
    return count ? fmi3Error : fmi3OK;
}

#define OTHER_TYPE(name, type)                                                                      \
    fmi3Status fmi3Get##name(fmi3Instance instance, const fmi3ValueReference valueReferences[],     \
                             size_t nValueReferences, type values[], size_t nValues)                \
    {                                                                                               \
        (void)valueReferences, (void)values, (void)nValues;                                         \
        NEEDS(KU_ANY)                                                                               \
        return of_another_type(u, __func__, nValueReferences);                                      \
    }                                                                                               \
                                                                                                    \
    fmi3Status fmi3Set##name(fmi3Instance instance, const fmi3ValueReference valueReferences[],     \
                             size_t nValueReferences, const type values[], size_t nValues)          \
    {                                                                                               \
        (void)valueReferences, (void)values, (void)nValues;                                         \
        NEEDS(KU_ANY)                                                                               \
        return of_another_type(u, __func__, nValueReferences);                                      \
    }

OTHER_TYPE(Float32, fmi3Float32)
OTHER_TYPE(Int8, fmi3Int8)
OTHER_TYPE(UInt8, fmi3UInt8)
OTHER_TYPE(Int16, fmi3Int16)
OTHER_TYPE(UInt16, fmi3UInt16)
OTHER_TYPE(Int32, fmi3Int32)
OTHER_TYPE(UInt32, fmi3UInt32)
OTHER_TYPE(Int64, fmi3Int64)
OTHER_TYPE(UInt64, fmi3UInt64)
OTHER_TYPE(Boolean, fmi3Boolean)
OTHER_TYPE(String, fmi3String)

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, size_t valueSizes[], fmi3Binary values[],
                         size_t nValues)
{
    (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
    NEEDS(KU_ANY)
    return of_another_type(u, __func__, nValueReferences);
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const size_t valueSizes[],
                         const fmi3Binary values[], size_t nValues)
{
    (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
    NEEDS(KU_ANY)
    return of_another_type(u, __func__, nValueReferences);
}

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Clock values[])
{
    (void)valueReferences, (void)values;
    NEEDS(KU_ANY)
    return of_another_type(u, __func__, nValueReferences);
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Clock values[])
{
    (void)valueReferences, (void)values;
    NEEDS(KU_ANY)
    return of_another_type(u, __func__, nValueReferences);
}

/* -- saved instances -------------------------------------------------------------------------- */

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    NEEDS(KU_ANY)
    *FMUState = ku_save(u, *FMUState);
    return *FMUState ? fmi3OK : fmi3Error;
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState)
{
    NEEDS(KU_ANY)
    return FMUState ? (fmi3Status)ku_restore(u, FMUState) : fmi3Error;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    NEEDS(KU_ANY)
    if (FMUState) {
        free(*FMUState);
        *FMUState = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size)
{
    (void)FMUState;
    NEEDS(KU_ANY)
    *size = ku_size();
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState,
                                 fmi3Byte serializedState[], size_t size)
{
    NEEDS(KU_ANY)
    return (fmi3Status)ku_serialise(u, FMUState, serializedState, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[],
                                   size_t size, fmi3FMUState *FMUState)
{
    NEEDS(KU_ANY)
    *FMUState = ku_deserialise(u, serializedState, size);
    return *FMUState ? fmi3OK : fmi3Error;
}

/* -- derivatives ------------------------------------------------------------------------------ */

fmi3Status fmi3GetDirectionalDerivative(
    fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    NEEDS(KU_INITIALISING | KU_RUNNING | KU_TERMINATED)
    if (!same_count(u, __func__, nKnowns, nSeed) || !same_count(u, __func__, nUnknowns, nSensitivity)) {
        return fmi3Error;
    }
    return (fmi3Status)ku_derivative(u, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity, 0);
}

fmi3Status fmi3GetAdjointDerivative(
    fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    NEEDS(KU_INITIALISING | KU_RUNNING | KU_TERMINATED)
    if (!same_count(u, __func__, nUnknowns, nSeed) || !same_count(u, __func__, nKnowns, nSensitivity)) {
        return fmi3Error;
    }
    return (fmi3Status)ku_derivative(u, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity, 1);
}

/* -- features without an implementation ------------------------------------------------------- */

static fmi3Status missing(fmi3Instance instance, const char *function)
{
    if (instance) {
        ku_say(instance, KU_ERROR, "%s: this model has none of it, as its description says.", function);
    }
    return fmi3Error;
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference valueReference,
                                               size_t *nDependencies)
{
    (void)valueReference, (void)nDependencies;
    return missing(instance, __func__);
}

fmi3Status fmi3GetVariableDependencies(
    fmi3Instance instance, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
    fmi3ValueReference independents[], size_t elementIndicesOfIndependents[],
    fmi3DependencyKind dependencyKinds[], size_t nDependencies)
{
    (void)dependent, (void)elementIndicesOfDependent, (void)independents, (void)elementIndicesOfIndependents;
    (void)dependencyKinds, (void)nDependencies;
    return missing(instance, __func__);
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) { return missing(instance, __func__); }

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) { return missing(instance, __func__); }

fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, fmi3Float64 intervals[],
                                  fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals, (void)qualifiers;
    return missing(instance, __func__);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, fmi3UInt64 counters[],
                                   fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions, (void)qualifiers;
    return missing(instance, __func__);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    return missing(instance, __func__);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, fmi3UInt64 counters[],
                                fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    return missing(instance, __func__);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, const fmi3Float64 intervals[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals;
    return missing(instance, __func__);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, const fmi3UInt64 counters[],
                                   const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    return missing(instance, __func__);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, const fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    return missing(instance, __func__);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, const fmi3UInt64 counters[],
                                const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    return missing(instance, __func__);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clockReference,
                                      fmi3Float64 activationTime)
{
    (void)clockReference, (void)activationTime;
    return missing(instance, __func__);
}

/* -- Model Exchange --------------------------------------------------------------------------- */

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    NEEDS_KIND(0, KU_EVENTS | KU_CONTINUOUS)
    ku_enter(u, KU_EVENTS);
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    NEEDS(KU_INITIALISING | KU_EVENTS)
    return fmi3OK; /* there are none */
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation,
                                    fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged,
                                    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    int over = 0;
    NEEDS_KIND(0, KU_EVENTS)
    int status = ku_update(u, &over);
    *discreteStatesNeedUpdate = *nominalsOfContinuousStatesChanged = fmi3False;
    *valuesOfContinuousStatesChanged = *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    *terminateSimulation = over;
    return (fmi3Status)status;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    NEEDS_KIND(0, KU_EVENTS)
    ku_enter(u, KU_CONTINUOUS);
    ku_mark(u);
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance,
                                       fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    int over = 0;
    NEEDS_KIND(0, KU_CONTINUOUS)
    int status = ku_completed(u, &over);
    *enterEventMode = fmi3False;
    *terminateSimulation = over;
    return (fmi3Status)status;
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time)
{
    NEEDS_KIND(0, KU_EVENTS | KU_CONTINUOUS)
    return (fmi3Status)ku_set_time(u, time);
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    NEEDS_KIND(0, KU_CONTINUOUS)
    return (fmi3Status)ku_set_states(u, continuousStates, nContinuousStates);
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[],
                                             size_t nContinuousStates)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi3Status)ku_get_rates(u, derivatives, nContinuousStates);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 eventIndicators[],
                                  size_t nEventIndicators)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi3Status)ku_get_events(u, eventIndicators, nEventIndicators);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    NEEDS_KIND(0, KU_INITIALISING | KU_EVENTS | KU_CONTINUOUS | KU_TERMINATED)
    return (fmi3Status)ku_get_states(u, continuousStates, nContinuousStates);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[],
                                             size_t nContinuousStates)
{
    NEEDS_KIND(0, KU_ANY)
    return (fmi3Status)ku_get_nominals(u, nominals, nContinuousStates);
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *nEventIndicators)
{
    NEEDS(KU_ANY)
    *nEventIndicators = (size_t)km_this.events;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *nContinuousStates)
{
    NEEDS(KU_ANY)
    *nContinuousStates = (size_t)km_this.states;
    return fmi3OK;
}

/* -- Co-Simulation ---------------------------------------------------------------------------- */

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return missing(instance, __func__); /* there is no event mode */
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t nValues)
{
    (void)valueReferences, (void)nValueReferences, (void)orders, (void)values, (void)nValues;
    return missing(instance, __func__);
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    NEEDS_KIND(1, KU_STEPPING)
    int status = ku_step(u, currentCommunicationPoint, communicationStepSize);
    *eventHandlingNeeded = *earlyReturn = fmi3False;
    *terminateSimulation = u->stopped;
    *lastSuccessfulTime = u->last_time;
    return (fmi3Status)status;
}
