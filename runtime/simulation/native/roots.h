/*
 * Events: roots of functions of time and state within a step, by the polynomial of the solver.
 *
 * A search finds the first root that has not been passed yet. It counts only when it is passed, since the
 * step may be taken back before.
 */
#ifndef KINTRAFO_ROOTS_H
#define KINTRAFO_ROOTS_H

typedef struct worker worker;

typedef struct {
    double *memory;
    double *passed;       /* values at `seen`, or others of the same sign */
    double *last;         /* at the end of the step */
    double *low, *high;   /* at both ends of the search */
    double *middle;
    int *idle;            /* functions that have been zero since the motion began */
    int *found;           /* for each function: direction in which it passes zero in the step, then at the root; or 0 */
    double seen, next;    /* times up to which roots have been passed, and up to which the last search went */
    int begins;           /* no search has been made yet */
    int ends;             /* the last search reached the end of the step */
} kt_search;

/* Start at a time; returns whether there is memory. */
int kt_open_search(worker *w, double start);

void kt_close_search(worker *w);

/*
 * Search for the first root after those that were passed, up to the end of the last step; `rest` is whether
 * this is not the first search within it. Returns 0, 1 if there is one, or a negative code; w->y is then the
 * state at the root, or else at the end.
 */
int kt_find_root(worker *w, double end, int rest, double *time);

/* Pass the root that the last search has found. */
void kt_pass_root(worker *w);

#endif
