#include "margins.h"

#include "number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int kt_open_margins(kt_margins *m, int count, const int *meaning, const double *scale)
{
    size_t size = (size_t)count * sizeof *m->now;
    double *memory = malloc(5 * size + 1);
    if (!memory) {
        return 0;
    }
    m->count = count;
    m->meaning = meaning;
    m->before = memory;
    m->now = memory + count;
    m->ahead = memory + 2 * count;
    m->between = memory + 3 * count;
    m->greatest = memory + 4 * count;
    memcpy(m->greatest, scale, size);
    return 1;
}

void kt_close_margins(kt_margins *m) { free(m->before); }

int kt_crossed(const kt_margins *m, const double *values)
{
    for (int i = 0; i < m->count; ++i) {
        if ((m->meaning[i] & KT_ACTS) && !(values[i] > 0.0)) {
            return i;
        }
    }
    return -1;
}

int kt_steady(const kt_margins *m)
{
    for (int i = 0; i < m->count; ++i) {
        double change = fabs(m->now[i] - m->before[i]);
        if ((m->meaning[i] & KT_ACTS) && !(change <= KT_LITTLE * m->now[i])) {
            return 0;
        }
    }
    return 1;
}

int kt_changes(const kt_margins *m, double next)
{
    double little = KT_LITTLE / greater(next, 1.0);
    for (int i = 0; i < m->count; ++i) {
        double now = m->now[i], change = fabs(now - m->before[i]);
        int calm = change <= little * now && now > KT_NOTHING * m->greatest[i];
        if ((m->meaning[i] & KT_SINGULAR) && !calm) {
            return 1;
        }
    }
    return 0;
}

int kt_reflected(const kt_margins *m, double lapse, double step)
{
    for (int i = 0; i < m->count; ++i) {
        double gained = m->ahead[i] - m->now[i];
        if ((m->meaning[i] & KT_SINGULAR) && 2.0 * m->now[i] * lapse < gained * step) {
            return i;
        }
    }
    return -1;
}

void kt_reach(kt_margins *m)
{
    for (int i = 0; i < m->count; ++i) {
        m->before[i] = m->now[i];
        m->greatest[i] = greater(m->greatest[i], m->now[i]);
    }
}

double kt_longest_step(const kt_margins *m, double lapse, int *nearest, int *over)
{
    double longest = INFINITY;
    *over = 0;
    for (int i = 0; i < m->count; ++i) {
        double now = m->now[i], lost = now - m->ahead[i];
        if (!(m->meaning[i] & KT_SINGULAR) || !(lost > 0.0)) {
            continue;
        }
        double step = KT_PART * fmax(now, 0.0) * lapse / lost;
        int nothing = now <= KT_NOTHING * m->greatest[i];
        if (nothing > *over || (nothing == *over && step < longest)) {
            longest = step;
            *nearest = i;
            *over = nothing;
        }
    }
    return longest;
}
