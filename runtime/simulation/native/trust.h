/*
 * For how long a step may be trusted near a dead point, in numbers; margins.h says why. One system alone
 * (margins.c, integrate.c) and systems in lanes (../lanes/approach.h) go by the same ones.
 */
#ifndef KINTRAFO_TRUST_H
#define KINTRAFO_TRUST_H

/* What a guard of the model means for an integration; a guard may have both bits. */
enum {
    KT_ACTS = 1,  /* where its margin is not positive, the model refuses to be evaluated */
    KT_SINGULAR = 2 /* the rates are singular where its margin is zero, and no step passes over that */
};

/*
 * Part of the time that is left, margin over rate, which a step may take. The root of a margin is used
 * up in twice that time: a step takes a quarter of it, see KT_LEFT.
 */
#define KT_PART 0.5

/* How much longer than the longest step the root of a margin takes to zero in a straight line. */
#define KT_LEFT 4.0

/* Part of a margin that may change in a step before its rate is looked at. */
#define KT_LITTLE 0.125

/*
 * Part of its greatest value below which a margin that falls is taken for zero. It is a difference of
 * numbers of that size or some ten times that, each with a rounding of 1e-16; the coordinates behind it
 * carry the errors of the integration, of which a hundredth is a part of 1e-12 or more. The height that
 * is its root is then a 100,000th of what it has been, and no motion of that accuracy tells whether it
 * turns before zero.
 */
#define KT_NOTHING 1.0e-10

/*
 * Part of a step over which the rates of the margins are measured, along a straight line of the motion.
 * The line leaves the motion with its acceleration, which is great near a dead point: a sixteenth of a
 * step made the time that is left ten times too long. A margin of 1e-10 of its greatest changes by 1e-13
 * of that within this part of a step, and its rounding is 1e-16 to 1e-15.
 */
#define KT_LAPSE (1.0 / 256.0)

/* Parts of the whole time, and of the longest step: one below both, next to what is refused, is the end. */
#define KT_SMALLEST_OF_TIME 1.0e-9
#define KT_SMALLEST_OF_STEP 1.0e-6

/* Part of the longest step: where less is left, a dead point is near. */
#define KT_NEAR 1.0e-3

/* So many very short steps in a row near a dead point lead nowhere; one may end at an output. */
#define KT_MOST_STUCK 8

/* Part of the time since zero that a clock of double precision tells apart, some times. */
#define KT_SMALLEST_PART 1.0e-14

/* Part of a step that remains after a state was refused. */
#define KT_SHORTER 0.25

#endif
