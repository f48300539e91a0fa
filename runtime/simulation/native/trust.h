/*
 * Limits of steps near a dead point; margins.h has the reasons. They are those of a single system (margins.c,
 * integrate.c) and of systems in lanes (../lanes/approach.h).
 */
#ifndef KINTRAFO_TRUST_H
#define KINTRAFO_TRUST_H

/* Effects of a guard of the model on an integration; a guard may have both bits. */
enum {
    KT_ACTS = 1,  /* the model refuses a state if the margin is not positive */
    KT_SINGULAR = 2 /* the rates are singular if the margin is zero, and no step passes over that */
};

/*
 * Longest step relative to the time left, margin over rate. The root of a margin is zero after twice that time:
 * a step takes a quarter of it, see KT_LEFT.
 */
#define KT_PART 0.5

/* Time until the root of a margin is zero along a straight line, relative to the longest step. */
#define KT_LEFT 4.0

/* Change of a margin in a step, relative to it, from which on its rate is evaluated. */
#define KT_LITTLE 0.125

/*
 * A falling margin counts as zero below this part of its greatest value. It is a difference of numbers of that
 * size or some ten times that, each with a rounding of 1e-16; the coordinates in it have the errors of the
 * integration, a hundredth of which is 1e-12 or more. The height, its root, is then a 100,000th of its greatest
 * value, and such errors hide whether the motion turns before zero.
 */
#define KT_NOTHING 1.0e-10

/*
 * Part of a step over which the rates of the margins are measured, along a tangent of the motion. The motion
 * leaves its tangent with its acceleration, which is great near a dead point: with a sixteenth of a step the time
 * left was ten times too long. A margin of 1e-10 of its greatest value changes by 1e-13 of that within this
 * part of a step, and its rounding is 1e-16 to 1e-15.
 */
#define KT_LAPSE (1.0 / 256.0)

/* Parts of the whole time and of the longest step: next to a refused state, a shorter step is the end. */
#define KT_SMALLEST_OF_TIME 1.0e-9
#define KT_SMALLEST_OF_STEP 1.0e-6

/* Part of the longest step: a dead point is near if less time is left. */
#define KT_NEAR 1.0e-3

/* This number of consecutive very short steps near a dead point is the end; one may end at an output. */
#define KT_MOST_STUCK 8

/* Some times the relative resolution of time in double precision. */
#define KT_SMALLEST_PART 1.0e-14

/* Length of a step after a refused state, relative to the last one. */
#define KT_SHORTER 0.25

#endif
