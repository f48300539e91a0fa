/*
 * Loops without a closed form, followed in all lanes together: each line does for lanes what that of the emitted
 * function `follow` does for one system, with the same limits and so the same bits. Each lane has its own stages;
 * steps in which it does not take part do not change it. Emitted code includes this file after its limits and
 * `struct loops`.
 */
#ifndef KINTRAFO_FOLLOW_H
#define KINTRAFO_FOLLOW_H

#include "vectors.h"

#include <string.h>

static real square(const real *values, int count)
{
    real sum = {0.0};
    for (int i = 0; i < count; ++i) {
        sum += values[i] * values[i];
    }
    return sum;
}

/* Assign a number in some lanes. */
INLINE void put(bits lanes, real *place, real value) { *place = choose(lanes, value, *place); }

/* Follows loops in some lanes; returns those in which they reach the end. */
static bits follow(const struct loops *loops, const real *given, const real *start, const real *end,
                   const real *unit, bits lanes, real *found)
{
    const int n = loops->unknowns, place = n + loops->elements;
    const real zero = {0.0}, one = SPREAD(1.0);
    real from[UNKNOWNS] = {{0.0}}, step[UNKNOWNS] = {{0.0}}, held[ELEMENTS] = {{0.0}};
    real base[UNKNOWNS] = {{0.0}}, left[UNKNOWNS] = {{0.0}}, slope[UNKNOWNS] = {{0.0}};
    real gone[UNKNOWNS] = {{0.0}}, ahead[UNKNOWNS] = {{0.0}}, back[UNKNOWNS] = {{0.0}};
    real now[DRIVEN] = {{0.0}}, way[DRIVEN] = {{0.0}};
    real out[3 * UNKNOWNS + ELEMENTS + 3];
    real farthest = zero, side = one;
    for (int c = 0; c < loops->driven; ++c) {
        farthest = greater(farthest, magnitude(end[c] - start[c]) / unit[c]);
    }
    const real most = choose(farthest > LONGEST, LONGEST / farthest, one);
    real part = choose(farthest > 0.0, zero, one), target = part, size = most;
    real before = SPREAD(INFINITY);
    bits started = {0}, arrived = {0};
    memset(found, 0, (size_t)(place + 2) * sizeof *found);
    for (int i = 0; i < ITERATIONS && any(lanes); ++i) {
        const bits last = ~(target < 1.0);
        const real passed = target - part, scale = choose(passed > 0.0, passed, one);
        for (int c = 0; c < loops->driven; ++c) {
            now[c] = choose(last, end[c], start[c] + target * (end[c] - start[c]));
            way[c] = scale * (end[c] - start[c]);
        }
        loops->once(given, now, way, from, step, held, out);
        const real *correction = out + place + 2, *tangent = correction + n, changed = tangent[n];
        const real change = square(correction, n), moved = square(gone, n);
        const real enough = choose(last, zero, CLOSE * CLOSE * moved);
        const bits close = change <= greater(SPREAD(CONVERGED * CONVERGED), enough);
        const bits stalled = (change <= STALLED * STALLED) & (change > before / 4.0);
        const bits steady = ~started | ((changed <= TURNED * TURNED) & (moved <= LONGEST * LONGEST)
                                        & (change <= LONGEST * LONGEST));
        const real room = 0.7 * TURNED / root(changed);
        for (int k = 0; k < n; ++k) {
            const real went = gone[k] + correction[k] - left[k];
            ahead[k] = went - slope[k] * passed;
            back[k] = went - tangent[k];
        }
        const real bent = greater(4.0 * square(ahead, n), square(tangent, n) / 4.0);
        const bits even = ~started | (square(back, n) <= greater(SPREAD(STALLED * STALLED), bent));
        const bits done = lanes & steady & even & (close | stalled), further = done & ~last;
        const bits on = lanes & steady & ~close & ~stalled & (change <= before / 4.0);
        const bits again = lanes & ~done & ~on & started & (size > SHORTEST);

        /* the stage is done */
        put(done & ~started, &side, with_sign_of(one, out[place]));
        started |= done;
        for (int k = 0; k < place + 2; ++k) {
            put(done, &found[k], k >= n && k <= place ? out[k] * side : out[k]);
        }
        arrived |= done & last;
        for (int k = 0; k < n; ++k) {
            put(further, &slope[k], tangent[k] / scale);
            put(further, &left[k], correction[k]);
            put(further, &base[k], out[k]);
        }
        for (int k = 0; k < loops->elements; ++k) {
            put(further, &held[k], out[n + k] / out[place]);
        }
        put(further & (passed > 0.0), &size, lesser(most, size * lesser(SPREAD(2.0), room)));
        put(further, &size, lesser(0.95 * LONGEST / root(square(slope, n)), size));
        put(further, &part, target);

        /* the same stage continues */
        for (int k = 0; k < n; ++k) {
            put(on, &from[k], out[k]);
            put(on, &step[k], correction[k]);
            put(on, &gone[k], gone[k] + correction[k]);
        }
        put(on, &before, change);

        /* a shorter stage, or the next one */
        put(again, &size, size * greater(SPREAD(0.1), lesser(SPREAD(0.5), room)));
        const bits next = further | again;
        put(next, &target, lesser(one, part + size));
        for (int k = 0; k < n; ++k) {
            put(next, &from[k], base[k]);
            put(next, &step[k], left[k] + slope[k] * (target - part));
            put(next, &gone[k], step[k]);
        }
        put(next, &before, SPREAD(INFINITY));
        lanes &= next | on;
    }
    return arrived;
}

/* The same without whole turns of an angle. Returns 0, or 1 if loops do not reach the end. */
static real follow_turns(const struct loops *loops, const real *given, const real *start, real *end,
                         const real *unit, real *found)
{
    const bits all = ~(bits){0};
    for (int c = 0; c < loops->driven; ++c) {
        real turns;
        for (int i = 0; i < WIDTH; ++i) {
            turns[i] = trunc((end[c][i] - start[c][i]) / FULL_TURN);
        }
        const bits whole = turns != 0.0;
        if (loops->turns[c] && any(whole)) {
            real around[DRIVEN];
            memcpy(around, start, (size_t)loops->driven * sizeof *around);
            around[c] += with_sign_of(SPREAD(FULL_TURN), turns);
            bits back = follow(loops, given, start, around, unit, whole, found);
            back &= found[loops->unknowns + loops->elements + 1] <= CLOSED * CLOSED;
            put(back, &end[c], end[c] - turns * FULL_TURN);
        }
    }
    return choose(follow(loops, given, start, end, unit, all, found), SPREAD(0.0), SPREAD(1.0));
}

#endif
