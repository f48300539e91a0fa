/*
 * Loads the library of an FMU of FMI 2.0 and prints the bits of all it computes, by both kinds: to be compiled for
 * Linux, and for Windows. Called with the library, the token, and the numbers of states, variables and parameters.
 */
#include "fmi2Functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define LOADED(path) (void *)LoadLibraryA(path)
#define FOUND(library, name) (void *)GetProcAddress((HMODULE)library, name)
#else
#include <dlfcn.h>
#define LOADED(path) dlopen(path, RTLD_NOW)
#define FOUND(library, name) dlsym(library, name)
#endif

enum { MOST = 400, STEPS = 50 };

static void *library;

static void *function(const char *name)
{
    void *found = FOUND(library, name);
    if (!found) {
        printf("%s is missing\n", name);
        exit(1);
    }
    return found;
}

#define CALL(name) ((name##TYPE *)function(#name))

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    (void)environment, (void)name, (void)category;
    printf("%d %s\n", status, message);
}

static void print_bits(const char *what, const double *values, int count)
{
    printf("%s", what);
    for (int i = 0; i < count; ++i) {
        unsigned long long bits;
        memcpy(&bits, values + i, sizeof bits);
        printf(" %08x%08x", (unsigned)(bits >> 32), (unsigned)bits);
    }
    printf("\n");
}

int main(int count, char **given)
{
    const fmi2CallbackFunctions functions = {logger, calloc, free, NULL, NULL};
    double values[MOST];
    unsigned references[MOST];
    library = count == 5 ? LOADED(given[1]) : NULL;
    int states = library ? atoi(given[3]) : 0, variables = library ? atoi(given[4]) : MOST;
    if (!library || variables >= MOST) {
        printf("cannot be loaded\n");
        return 1;
    }
    for (unsigned i = 0; i < MOST; ++i) {
        references[i] = i;
    }
    for (int kind = 0; kind < 2; ++kind) {
        fmi2Component c = CALL(fmi2Instantiate)("one", (fmi2Type)kind, given[2], "", &functions, 0, 1);
        CALL(fmi2SetupExperiment)(c, 1, 1.0e-8, 0.0, 0, 0.0);
        CALL(fmi2EnterInitializationMode)(c);
        CALL(fmi2ExitInitializationMode)(c);
        CALL(fmi2GetReal)(c, references, (size_t)variables, values);
        print_bits("start", values, variables);
        if (kind == fmi2ModelExchange) {
            CALL(fmi2GetContinuousStates)(c, values, (size_t)states);
            CALL(fmi2GetDerivatives)(c, values, (size_t)states);
            print_bits("rates", values, states);
        }
        for (int k = 0; kind == fmi2CoSimulation && k < STEPS; ++k) {
            int status = CALL(fmi2DoStep)(c, 0.01 * k, 0.01, 1);
            CALL(fmi2GetReal)(c, references, (size_t)variables, values);
            printf("%d ", status);
            print_bits("step", values, variables);
        }
        CALL(fmi2FreeInstance)(c);
    }
    return 0;
}
