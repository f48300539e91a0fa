/* Inputs over time, with a time of its own for each lane. */
#ifndef KINTRAFO_COURSES_H
#define KINTRAFO_COURSES_H

#include "../native/pieces.h"
#include "lane_pool.h"

static void load_piece(course_now *now, const kt_course *course, int lane, int piece)
{
    const double *c = course->coefficients + piece;
    int n = course->pieces;
    now->piece[lane] = piece;
    now->left[lane] = course->breaks[piece];
    now->right[lane] = piece == n - 1 ? INFINITY : course->breaks[piece + 1];
    now->cubic[lane] = c[0];
    now->square[lane] = c[n];
    now->linear[lane] = c[2 * n];
    now->constant[lane] = c[3 * n];
}

/* Start a segment. */
static void open_courses(lane_pool *w, int lane)
{
    const kt_segment *segment = segment_of(w, lane);
    for (int i = 0; i < w->p->course_count; ++i) {
        load_piece(&w->courses[i], &segment->courses[i], lane, 0);
    }
}

/* Load for each lane the piece of its time. */
static void follow_course(lane_pool *w, int which, real time)
{
    course_now *now = &w->courses[which];
    bits gone = w->running & ((time < now->left) | (time >= now->right));
    if (!any(gone)) {
        return;
    }
    for (int i = 0; i < WIDTH; ++i) {
        if (gone[i]) {
            const kt_course *course = &segment_of(w, i)->courses[which];
            int piece = kt_find_piece(course->breaks, course->pieces, now->piece[i], time[i]);
            if (piece != now->piece[i]) {
                load_piece(now, course, i, piece);
            }
        }
    }
}

static void evaluate_inputs(lane_pool *w, real time)
{
    for (int i = 0; i < w->p->course_count; ++i) {
        follow_course(w, i, time);
        const course_now *c = &w->courses[i];
        const int *target = w->p->targets + 3 * i;
        real x = time - c->left;
        w->inputs[target[0]] = ((c->cubic * x + c->square) * x + c->linear) * x + c->constant;
        if (target[1] >= 0) {
            w->inputs[target[1]] = (3.0 * c->cubic * x + 2.0 * c->square) * x + c->linear;
        }
        if (target[2] >= 0) {
            w->inputs[target[2]] = 6.0 * c->cubic * x + 2.0 * c->square;
        }
    }
}

#endif
