/*
 * Events: where functions of time and state pass zero within a step, by the polynomial of the solver.
 *
 * A search finds the first of them that has not been passed yet. What it has found counts only when it is
 * passed, since the step may be taken back before.
 */
#ifndef KINTRAFO_ROOTS_H
#define KINTRAFO_ROOTS_H

typedef struct worker worker;

typedef struct {
    double *memory;
    double *passed;       /* values at `seen`, or any of the same sign */
    double *last;         /* at the end of the step */
    double *low, *high;   /* at both ends of what is searched */
    double *middle;
    int *idle;            /* functions that have been zero since the motion began */
    int *found;           /* of each function: the sense in which it passes zero in the step, then at the root; or 0 */
    double seen, next;    /* up to where roots have been passed, and up to where the last search went */
    int begins;           /* nothing has been looked at yet */
    int ends;             /* the last search came to the end of the step */
} kt_search;

/* Begin at a time; returns whether there is memory. */
int kt_open_search(worker *w, double start);

void kt_close_search(worker *w);

/*
 * Look for the first root behind what is passed, up to the end of the last step; `rest` tells whether
 * this is not the first search within it. Returns 0, 1 where there is one, or a negative code; the time
 * of the root, or else the end, has its state in w->y then.
 */
int kt_find_root(worker *w, double end, int rest, double *time);

/* Pass what the last search has found. */
void kt_pass_root(worker *w);

#endif
