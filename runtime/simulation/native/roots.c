#include "roots.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Times whose relative difference is smaller are equal. */
#define RESOLVED (100.0 * DBL_EPSILON)

int kt_open_search(worker *w, double start)
{
    kt_search *s = &w->search;
    size_t count = (size_t)kt_root_count(w);
    s->memory = calloc(5 * count + 1, sizeof *s->memory);
    s->idle = calloc(2 * count + 1, sizeof *s->idle);
    s->passed = s->memory;
    s->last = s->passed + count;
    s->low = s->last + count;
    s->high = s->low + count;
    s->middle = s->high + count;
    s->found = s->idle + count;
    s->seen = s->next = start;
    s->begins = 1;
    return s->memory && s->idle;
}

void kt_close_search(worker *w)
{
    free(w->search.memory);
    free(w->search.idle);
}

/* Evaluate the functions at a time within the last step. */
static int look_at(worker *w, double time, double *values)
{
    if (w->solver->interpolate(w, time, 0, w->y) || kt_roots(w, time, w->y, values)) {
        return KT_NO_ROOTS;
    }
    return 0;
}

/* Return the direction in which a function passes zero between two values, if it is requested; else 0. */
static int sense(const worker *w, int which, double from, double to)
{
    int wanted = w->problem->directions[which], way = from < 0.0 ? 1 : -1;
    int passes = !w->search.idle[which] && from != 0.0 && (to == 0.0 || (from < 0.0) != (to < 0.0));
    return passes && wanted * way >= 0 ? way : 0;
}

/* Return whether a function that passes in this step does so between two rows of values. */
static int any_passes(const worker *w, const double *from, const double *to)
{
    int some = 0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        some |= w->search.found[i] && sense(w, i, from[i], to[i]);
    }
    return some;
}

/* Set functions that are zero at the beginning of the search to their values just after it. */
static void leave(worker *w)
{
    kt_search *s = &w->search;
    for (int i = 0; i < kt_root_count(w); ++i) {
        if (s->passed[i] == 0.0) {
            s->passed[i] = s->middle[i];
            s->idle[i] |= s->middle[i] == 0.0 && s->begins; /* it does not count until it leaves zero */
        }
    }
}

/* Return whether a function is zero at the root that was passed, after it, and at the end of a step. */
static int stays_zero(const worker *w)
{
    const kt_search *s = &w->search;
    int some = 0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        some |= s->found[i] && s->passed[i] == 0.0 && s->last[i] == 0.0;
    }
    return some;
}

static int leaves_zero(const worker *w)
{
    const kt_search *s = &w->search;
    int some = 0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        some |= s->passed[i] == 0.0 && !s->idle[i];
    }
    return some;
}

/* Return the part of a time span after which a function first passes zero, by straight lines. */
static double first_crossing(const worker *w, double weight)
{
    const kt_search *s = &w->search;
    double part = 1.0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        if (s->found[i] && sense(w, i, s->low[i], s->high[i])) {
            double crossed = s->low[i] / (s->low[i] - weight * s->high[i]);
            /* half way to an end that is zero, since it may be zero before, too */
            part = fmin(part, s->high[i] == 0.0 ? 0.5 : crossed);
        }
    }
    return part;
}

/* Bracket the first root between two times: false position with the Illinois modification. */
static int narrow(worker *w, double from, double *end, double resolved)
{
    kt_search *s = &w->search;
    size_t size = (size_t)kt_root_count(w) * sizeof *s->middle;
    int moved = 0; /* +1: the end in the last turn, -1: the begin */
    double weight = 1.0;
    while (fabs(*end - from) > resolved) {
        double room = 0.5 * resolved / fabs(*end - from);
        double part = fmin(fmax(first_crossing(w, weight), room), 1.0 - room);
        double time = from + part * (*end - from);
        int code = look_at(w, time, s->middle);
        if (code) {
            return code;
        }
        /* the value of the end that stays is halved */
        if (any_passes(w, s->low, s->middle)) {
            *end = time;
            memcpy(s->high, s->middle, size);
            weight = moved > 0 ? 2.0 * weight : 1.0;
            moved = 1;
        } else {
            from = time;
            memcpy(s->low, s->middle, size);
            weight = moved < 0 ? 0.5 * weight : 1.0;
            moved = -1;
        }
    }
    return 0;
}

/* Evaluate the functions after the begin of the motion or after the root that was passed. */
static int set_out(worker *w, double end, double resolved)
{
    kt_search *s = &w->search;
    if (s->begins && kt_roots(w, s->seen, w->result->state, s->passed)) {
        return KT_NO_ROOTS;
    }
    if (leaves_zero(w)) {
        double part = fmin(1.0, resolved / fabs(end - s->seen));
        int code = look_at(w, s->seen + part * (end - s->seen), s->middle);
        if (code) {
            return code;
        }
        leave(w);
    }
    s->begins = 0;
    return 0;
}

int kt_find_root(worker *w, double end, int rest, double *time)
{
    kt_search *s = &w->search;
    int count = kt_root_count(w), root = 0, code;
    size_t size = (size_t)count * sizeof *s->low;
    double resolved = RESOLVED * (fabs(end) + fabs(end - s->seen));
    code = set_out(w, end, resolved);
    if (code || (!rest && look_at(w, end, s->last))) {
        return code ? code : KT_NO_ROOTS;
    }
    if (stays_zero(w)) {
        return KT_FLAT;
    }
    memcpy(s->low, s->passed, size);
    memcpy(s->high, s->last, size);
    for (int i = 0; i < count; ++i) {
        s->found[i] = sense(w, i, s->passed[i], s->last[i]);
        root |= s->found[i] != 0;
    }
    code = root ? narrow(w, s->seen, &end, resolved) : 0;
    if (code) {
        return code;
    }
    for (int i = 0; i < count; ++i) {
        s->found[i] *= sense(w, i, s->low[i], s->high[i]) != 0;
    }
    *time = s->next = end;
    s->ends = !root;
    w->solver->interpolate(w, end, 0, w->y); /* cannot fail within the step */
    return root;
}

/*
 * Functions that pass zero together up to rounding may come in any order, and each of them would be on its
 * old side again at the root of the next one. So a function that has passed gets its value at the end of the
 * step: each function passes at most once in a step, and once if its values at the ends have different signs.
 */
void kt_pass_root(worker *w)
{
    kt_search *s = &w->search;
    for (int i = 0; i < kt_root_count(w); ++i) {
        if (s->ends || s->found[i]) {
            s->passed[i] = s->last[i];
            s->idle[i] = s->idle[i] && s->last[i] == 0.0;
        }
    }
    s->seen = s->next;
}
