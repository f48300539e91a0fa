/*
 * Coefficients of the method of Dormand and Prince, of order 5 with an error estimate of order 4: Hairer,
 * Norsett and Wanner, Solving Ordinary Differential Equations I, II.4 to II.6. They are those of a single
 * system (dormand_prince.c) and of systems in lanes (../lanes).
 */
#ifndef KINTRAFO_DORMAND_PRINCE_H
#define KINTRAFO_DORMAND_PRINCE_H

/* The last stage is the first one of the next step. */
#define STAGES 7

/* The order of the estimate and one, and the weight of the error before. */
#define OF_ERROR 0.17
#define OF_ERROR_BEFORE 0.04
#define SAFE 0.9
#define MOST_SHORTER 0.2
#define MOST_LONGER 10.0
/* Binary logarithms: of 1e-8, the square of an error that is too small to determine the next step; and of */
#define LOG2_LEAST_SQUARE (-26.5754248)
/* 1e-2, the error of the first step relative to the tolerance, estimated from the rates. */
#define LOG2_FIRST (-6.6438562)
/* The limit of stability of a step times the rate of the fastest motion; the motion is stiff if as many steps */
/* are at that limit, without the second number of consecutive steps that are not. */
#define STABLE 3.25
#define OFTEN_STIFF 15
#define OFTEN_CALM 6
/* A step below this part of the time is a rounding error. */
#define ROUNDING 4.0e-16

static const double NODES[STAGES] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};

static const double TABLE[STAGES][STAGES - 1] = {
    {0.0},
    {0.2},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
};

static const double ERROR[STAGES] = {
    71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -0.025,
};

/* Weights of the fifth term of the interpolant, with which it has order 4. */
static const double DENSE[STAGES] = {
    -12715105075.0 / 11282082432.0, 0.0, 87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0, 701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
};

#endif
