/*
 * The functions of exported equations in some states: the bits of all results and, on the board, the instructions
 * of a call. VALUES is the header of the numbers, EQUATIONS the name of the equations, FUNCTIONS a list of
 * CALL(name, length), LARGEST the greatest of these lengths, STATES the number of states.
 */
#include VALUES

#include <stdio.h>
#include <string.h>

enum { POSITIONS = 20, CALLS = 20, DEEPEST = 32768 };

#define JOINED(a, b) a##_##b
#define NAME(a, b) JOINED(a, b)

typedef int (*function)(const double *, const double *, const double *, double *);

typedef struct {
    const char *name;
    function call;
    int length;
} entry;

#define CALL(name, length) {#name, NAME(EQUATIONS, name), length},
static const entry functions[] = {FUNCTIONS};
enum { COUNT = sizeof functions / sizeof *functions };

static double state[STATES], out[LARGEST];

/* Go to a state near the start. */
static void move_to(int position)
{
    for (int i = 0; i < STATES; ++i) {
        state[i] = NAME(EQUATIONS, start)[i] + 0.001 * (double)((7 * position + 3 * i) % 11 - 5);
    }
}

static void print_bits(const entry *one)
{
    int status = one->call(NAME(EQUATIONS, constants), state, NAME(EQUATIONS, inputs), out);
    printf("%s %d", one->name, status);
    for (int i = 0; i < one->length; ++i) {
        unsigned word[2];
        memcpy(word, out + i, sizeof word);
        printf(" %08x%08x", word[1], word[0]);
    }
    printf("\n");
}

#ifdef BOARD
/* A timer that counts down by 1 in 40 ns; QEMU lets an instruction take 32 ns. */
#define SYST_CSR (*(volatile unsigned *)0xE000E010u)
#define SYST_RVR (*(volatile unsigned *)0xE000E014u)
#define SYST_CVR (*(volatile unsigned *)0xE000E018u)

static int nothing(const double *constants, const double *given, const double *inputs, double *result)
{
    (void)constants, (void)given, (void)inputs, (void)result;
    return 0;
}

/* A loop of a thousand instructions shows whether they are counted. */
static int thousand(const double *constants, const double *given, const double *inputs, double *result)
{
    (void)constants, (void)given, (void)inputs, (void)result;
    __asm volatile(".rept 1000\n\tnop\n\t.endr");
    return 0;
}

static double ticks_of(volatile function call)
{
    unsigned begin = SYST_CVR;
    for (int i = 0; i < CALLS; ++i) {
        call(NAME(EQUATIONS, constants), state, NAME(EQUATIONS, inputs), out);
    }
    return (double)(begin - SYST_CVR);
}

static void count(const char *name, function call)
{
    double found = ticks_of(call) - ticks_of(nothing);
    printf("count %s %.0f\n", name, found * 40.0 / 32.0 / CALLS);
}

/* Paint the stack below, call, and look how far it is painted over. */
static void look_at_stack(const char *name, volatile function call)
{
    const unsigned char mark = 0x5A;
    unsigned top;
    __asm volatile("mov %0, sp" : "=r"(top));
    volatile unsigned char *lowest = (volatile unsigned char *)(top - DEEPEST);
    int free = 0;
    for (int i = 0; i < DEEPEST; ++i) {
        lowest[i] = mark;
    }
    call(NAME(EQUATIONS, constants), state, NAME(EQUATIONS, inputs), out);
    while (free < DEEPEST && lowest[free] == mark) {
        ++free;
    }
    printf("stack %s %d\n", name, DEEPEST - free);
}

static void count_all(void)
{
    SYST_RVR = 0xFFFFFFu;
    SYST_CVR = 0u;
    SYST_CSR = 5u; /* by the clock of the processor */
    move_to(0);
    count("thousand", thousand);
    for (int i = 0; i < COUNT; ++i) {
        SYST_CVR = 0u;
        count(functions[i].name, functions[i].call);
        look_at_stack(functions[i].name, functions[i].call);
    }
}
#endif

int main(void)
{
    for (int position = 0; position < POSITIONS; ++position) {
        move_to(position);
        for (int i = 0; i < COUNT; ++i) {
            print_bits(functions + i);
        }
    }
#ifdef BOARD
    count_all();
#endif
    return 0;
}
