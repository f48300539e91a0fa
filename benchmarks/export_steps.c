/*
 * What a communication step of a functional mock-up unit takes above its arithmetic, and what instances take
 * in memory. Called with the libraries of FMI 2.0 and 3.0, and their tokens.
 *
 * The arithmetic of a step of Dormand and Prince is seven evaluations of the right-hand side, the sums of the
 * method and of its error, and one evaluation of the margins. EQUATIONS is the name of the equations, STATES the
 * number of their states, ROUNDS how often all is measured.
 */
#define _POSIX_C_SOURCE 200809L

#include VALUES
#include FMI2
#include FMI3
#include METHOD

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { STEPS = 2000, INSTANCES = 1000 };

#define LENGTH 1.0e-5 /* s: one step of the solver each */
#define JOINED(a, b) a##b
#define NAME(a, b) JOINED(a, b)

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
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

/* Compute a step with nothing around it; returns what no compiler can leave out. */
static double bare_step(const double *state)
{
    double rates[STAGES][STATES], stage[STATES], margins[100], error = 0.0;
    int status = 0;
    for (int s = 0; s < STAGES; ++s) {
        for (int i = 0; i < STATES; ++i) {
            double sum = 0.0;
            for (int k = 0; k < s; ++k) {
                sum += TABLE[s][k] * rates[k][i];
            }
            stage[i] = state[i] + LENGTH * sum;
        }
        status += NAME(EQUATIONS, _rhs)(NAME(EQUATIONS, _constants), stage, NAME(EQUATIONS, _inputs), rates[s]);
    }
    for (int i = 0; i < STATES; ++i) {
        double sum = 0.0;
        for (int s = 0; s < STAGES; ++s) {
            sum += ERROR[s] * rates[s][i];
        }
        double measured = LENGTH * sum / (1.0e-9 + 1.0e-6 * (state[i] < 0.0 ? -state[i] : state[i]));
        error += measured * measured;
    }
    status += NAME(EQUATIONS, _margins)(NAME(EQUATIONS, _constants), stage, NAME(EQUATIONS, _inputs), margins);
    return error + status + stage[0] + margins[0] + NODES[1] + DENSE[0];
}

/* Seconds of a step in one round. All are measured in turn, since the machine may be faster in one round than another. */

static double arithmetic(double *state)
{
    double sum = 0.0, begin = now();
    for (int k = 0; k < STEPS; ++k) {
        state[0] += 1.0e-12;
        sum += bare_step(state);
    }
    return sum == 0.5 ? 0.0 : (now() - begin) / STEPS;
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

static double steps2(fmi2DoStepTYPE *step, fmi2Component c, int round)
{
    double begin = now();
    for (int k = 0; k < STEPS; ++k) {
        check((int)step(c, (round * STEPS + k) * LENGTH, LENGTH, 1));
    }
    return (now() - begin) / STEPS;
}

static fmi3Instance open3(void *library, const char *token)
{
    fmi3Instance c = CALL(library, fmi3InstantiateCoSimulation)("one", token, NULL, 0, 0, 0, 0, NULL, 0, NULL,
                                                               NULL, NULL);
    check(!c);
    check((int)CALL(library, fmi3EnterInitializationMode)(c, 0, 0.0, 0.0, 0, 0.0));
    check((int)CALL(library, fmi3ExitInitializationMode)(c));
    return c;
}

static double steps3(fmi3DoStepTYPE *step, fmi3Instance c, int round)
{
    double begin = now(), reached;
    fmi3Boolean events, ends, early;
    for (int k = 0; k < STEPS; ++k) {
        check((int)step(c, (round * STEPS + k) * LENGTH, LENGTH, 1, &events, &ends, &early, &reached));
    }
    return (now() - begin) / STEPS;
}

int main(int count, char **given)
{
    check(count != 5);
    void *two = dlopen(given[1], RTLD_NOW), *three = dlopen(given[3], RTLD_NOW);
    check(!two || !three);
    fmi2Component second = open2(two, given[2]);
    fmi3Instance third = open3(three, given[4]);
    fmi2DoStepTYPE *step2 = CALL(two, fmi2DoStep);
    fmi3DoStepTYPE *step3 = CALL(three, fmi3DoStep);
    double state[STATES], best[3] = {1.0e9, 1.0e9, 1.0e9};
    for (int i = 0; i < STATES; ++i) {
        state[i] = NAME(EQUATIONS, _start)[i];
    }
    for (int round = 0; round < ROUNDS; ++round) {
        double taken[3] = {arithmetic(state), steps2(step2, second, round), steps3(step3, third, round)};
        for (int i = 0; i < 3; ++i) {
            best[i] = taken[i] < best[i] ? taken[i] : best[i];
        }
    }
    for (int i = 0; i < 3; ++i) {
        printf("%.4g ", 1.0e6 * best[i]);
    }
    double before = resident();
    for (int i = 0; i < INSTANCES; ++i) {
        fmi2Component c = open2(two, given[2]);
        check((int)CALL(two, fmi2DoStep)(c, 0.0, LENGTH, 1));
    }
    printf("%.4g\n", 1.0e-6 * (resident() - before));
    return 0;
}
