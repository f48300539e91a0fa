/*
 * Calls all that an FMU of FMI 2.0 keeps memory for, with values that are fine and such that are not: to be
 * compiled with its sources by a compiler that looks at every access. Called with the token and how many variables there are.
 */
#include "fmi2Functions.h"

#include <stdio.h>
#include <stdlib.h>

enum { MOST = 200, STEPS = 20 };

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    (void)environment, (void)name, (void)category;
    printf("%d %s\n", status, message);
}

static void initialise(fmi2Component c)
{
    fmi2SetupExperiment(c, 1, 1.0e-8, 0.0, 0, 0.0);
    fmi2EnterInitializationMode(c);
}

static void evaluate(fmi2Component c)
{
    double states[2], rates[2], events[MOST], seed[2] = {1.0, 2.0};
    const unsigned knowns[2] = {1, 2}, unknowns[2] = {3, 4};
    fmi2EventInfo info;
    fmi2NewDiscreteStates(c, &info);
    fmi2EnterContinuousTimeMode(c);
    fmi2GetContinuousStates(c, states, 2);
    fmi2SetContinuousStates(c, states, 2);
    fmi2GetDerivatives(c, rates, 2);
    fmi2GetDerivatives(c, rates, 3);
    for (int i = 0; i < MOST && fmi2GetEventIndicators(c, events, (size_t)i); ++i) {
    }
    fmi2GetDirectionalDerivative(c, unknowns, 2, knowns, 2, seed, rates);
}

static void step(fmi2Component c)
{
    const unsigned input = 5;
    const int order = 1;
    const double slope = 0.5;
    fmi2SetRealInputDerivatives(c, &input, 1, &order, &slope);
    for (int k = 0; k < STEPS; ++k) {
        fmi2DoStep(c, 0.01 * k, 0.01, 1);
    }
}

static void keep(fmi2Component c, fmi2FMUstate first)
{
    fmi2FMUstate again = NULL, none = NULL;
    size_t size;
    fmi2SerializedFMUstateSize(c, first, &size);
    char *bytes = malloc(size);
    fmi2SerializeFMUstate(c, first, bytes, size);
    fmi2DeSerializeFMUstate(c, bytes, size, &again);
    fmi2DeSerializeFMUstate(c, bytes, size - 1, &none);
    free(bytes);
    fmi2SetFMUstate(c, again);
    fmi2FreeFMUstate(c, &again);
}

int main(int count, char **given)
{
    const fmi2CallbackFunctions functions = {logger, calloc, free, NULL, NULL};
    double values[MOST];
    unsigned references[MOST], variables = count == 3 ? (unsigned)atoi(given[2]) : 0;
    for (unsigned i = 0; i < MOST; ++i) {
        references[i] = i;
    }
    if (!variables || variables >= MOST || fmi2Instantiate("other", fmi2CoSimulation, "", "", &functions, 0, 0)) {
        return 1;
    }
    for (int kind = 0; kind < 2; ++kind) {
        fmi2Component c = fmi2Instantiate("one", (fmi2Type)kind, given[1], "", &functions, 0, 1);
        fmi2FMUstate first = NULL;
        initialise(c);
        fmi2ExitInitializationMode(c);
        fmi2GetReal(c, references, variables, values);
        fmi2GetReal(c, references, variables + 1, values);
        fmi2GetFMUstate(c, &first);
        if (kind == fmi2CoSimulation) {
            step(c);
        } else {
            evaluate(c);
        }
        keep(c, first);
        fmi2FreeFMUstate(c, &first);
        fmi2Reset(c);
        initialise(c);
        values[0] = -1.0;
        fmi2SetReal(c, &references[variables - 3], 1, values);
        fmi2ExitInitializationMode(c);
        fmi2FreeInstance(c);
    }
    puts("done");
    return 0;
}
