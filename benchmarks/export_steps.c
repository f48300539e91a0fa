/*
 * What a communication step of a functional mock-up unit takes above its arithmetic, and what instances take
 * in memory. Called with the libraries of FMI 2.0 and 3.0, and their tokens.
 *
 * The arithmetic of a step of Dormand and Prince is seven evaluations of the right-hand side and three of the
 * margins: at the begin, a short time later, and at the end. EQUATIONS is the name of the equations, ROUNDS how often all is measured.
 */
#define _POSIX_C_SOURCE 200809L

#include VALUES
#include FMI2
#include FMI3

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { STEPS = 20000, INSTANCES = 1000 };

#define LENGTH 1.0e-5 /* s: one step of the solver each */
#define JOINED(a, b) a##b
#define NAME(a, b) JOINED(a, b)

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1.0e-9 * (double)t.tv_nsec;
}

static double resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*s %ld", &pages) != 1) {
        exit(1);
    }
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

static void *function(void *library, const char *name)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s is missing\n", name);
        exit(1);
    }
    return found;
}

#define CALL(library, name) ((name##TYPE *)function(library, #name))

static void check(int status)
{
    if (status) {
        fprintf(stderr, "status %d\n", status);
        exit(1);
    }
}

static double arithmetic(void)
{
    double rates[100], margins[100], sum = 0.0, best = 1.0e9;
    for (int round = 0; round < ROUNDS; ++round) {
        double begin = now();
        for (int k = 0; k < STEPS; ++k) {
            for (int i = 0; i < 7; ++i) {
                sum += NAME(EQUATIONS, _rhs)(NAME(EQUATIONS, _constants), NAME(EQUATIONS, _start),
                                             NAME(EQUATIONS, _inputs), rates);
            }
            for (int i = 0; i < 3; ++i) {
                sum += NAME(EQUATIONS, _margins)(NAME(EQUATIONS, _constants), NAME(EQUATIONS, _start),
                                                 NAME(EQUATIONS, _inputs), margins);
            }
        }
        double taken = (now() - begin) / STEPS;
        best = taken < best ? taken : best;
    }
    return sum < 0.0 ? 0.0 : best;
}

static fmi2Component open2(void *library, const char *token)
{
    static const fmi2CallbackFunctions functions;
    fmi2Component c = CALL(library, fmi2Instantiate)("one", fmi2CoSimulation, token, "", &functions, 0, 0);
    check(!c);
    check((int)CALL(library, fmi2SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0));
    check((int)CALL(library, fmi2EnterInitializationMode)(c));
    check((int)CALL(library, fmi2ExitInitializationMode)(c));
    return c;
}

static double steps2(void *library, const char *token)
{
    fmi2Component c = open2(library, token);
    fmi2DoStepTYPE *step = CALL(library, fmi2DoStep);
    double best = 1.0e9;
    for (int round = 0; round < ROUNDS; ++round) {
        double begin = now();
        for (int k = 0; k < STEPS; ++k) {
            check((int)step(c, (round * STEPS + k) * LENGTH, LENGTH, 1));
        }
        double taken = (now() - begin) / STEPS;
        best = taken < best ? taken : best;
    }
    CALL(library, fmi2FreeInstance)(c);
    return best;
}

static double steps3(void *library, const char *token)
{
    fmi3Instance c = CALL(library, fmi3InstantiateCoSimulation)("one", token, NULL, 0, 0, 0, 0, NULL, 0, NULL,
                                                               NULL, NULL);
    check(!c);
    check((int)CALL(library, fmi3EnterInitializationMode)(c, 0, 0.0, 0.0, 0, 0.0));
    check((int)CALL(library, fmi3ExitInitializationMode)(c));
    fmi3DoStepTYPE *step = CALL(library, fmi3DoStep);
    double best = 1.0e9, reached;
    fmi3Boolean events, ends, early;
    for (int round = 0; round < ROUNDS; ++round) {
        double begin = now();
        for (int k = 0; k < STEPS; ++k) {
            check((int)step(c, (round * STEPS + k) * LENGTH, LENGTH, 1, &events, &ends, &early, &reached));
        }
        double taken = (now() - begin) / STEPS;
        best = taken < best ? taken : best;
    }
    CALL(library, fmi3FreeInstance)(c);
    return best;
}

int main(int count, char **given)
{
    check(count != 5);
    void *two = dlopen(given[1], RTLD_NOW), *three = dlopen(given[3], RTLD_NOW);
    check(!two || !three);
    double bare = arithmetic();
    printf("%.4g %.4g %.4g ", 1.0e6 * bare, 1.0e6 * steps2(two, given[2]), 1.0e6 * steps3(three, given[4]));
    double before = resident();
    for (int i = 0; i < INSTANCES; ++i) {
        fmi2Component c = open2(two, given[2]);
        check((int)CALL(two, fmi2DoStep)(c, 0.0, LENGTH, 1));
    }
    printf("%.4g\n", 1.0e-6 * (resident() - before));
    return 0;
}
