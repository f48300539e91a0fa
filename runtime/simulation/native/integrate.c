/* Outputs, events, dead points and the end of an integration, from the steps of a solver. */
#include "pieces.h"
#include "worker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* -- tables ----------------------------------------------------------------------------------- */

static double *append(kt_table *table)
{
    if (table->rows == table->capacity) {
        long capacity = table->capacity ? 2 * table->capacity : 256;
        double *data = realloc(table->data, (size_t)capacity * table->width * sizeof *data);
        if (!data) {
            return NULL;
        }
        table->data = data;
        table->capacity = capacity;
    }
    return table->data + table->width * table->rows++;
}

static int append_state(kt_table *table, double time, const double *state, int count)
{
    double *row = append(table);
    if (!row) {
        return KT_MEMORY;
    }
    row[0] = time;
    memcpy(row + 1, state, (size_t)count * sizeof *state);
    return KT_DONE;
}

/* -- inputs ----------------------------------------------------------------------------------- */

/* Evaluate the inputs at a time by the polynomials of another, near time. */
static void evaluate_inputs_near(worker *w, double other, double time)
{
    for (int i = 0; i < w->problem->spline_count; ++i) {
        const kt_spline *s = &w->problem->splines[i];
        int piece = w->piece[i] = kt_find_piece(s->breaks, s->pieces, w->piece[i], other);
        double x = time - s->breaks[piece];
        const double *c = s->coefficients + piece;
        double a = c[0], b = c[s->pieces], d = c[2 * s->pieces], e = c[3 * s->pieces];
        const double values[3] = {
            ((a * x + b) * x + d) * x + e,
            (3.0 * a * x + 2.0 * b) * x + d,
            6.0 * a * x + 2.0 * b,
        };
        for (int k = 0; k < 3; ++k) {
            if (s->target[k] >= 0) {
                w->inputs[s->target[k]] = values[k];
            }
        }
    }
}

void kt_evaluate_inputs(worker *w, double time) { evaluate_inputs_near(w, time, time); }

double kt_next_turn(worker *w, double time, double end, double step)
{
    const kt_problem *p = w->problem;
    double sign = end > time ? 1.0 : -1.0;
    while (w->turn > 0 && sign * (p->turns[w->turn - 1] - time) > 0.0) {
        --w->turn;
    }
    while (w->turn < p->turn_count && sign * (p->turns[w->turn] - time) <= 0.0) {
        ++w->turn;
    }
    for (long k = w->turn; k < p->turn_count && sign * (p->turns[k] - end) < 0.0; ++k) {
        if (p->reaches[k] < step) {
            return p->turns[k];
        }
    }
    return end;
}

/* -- the model -------------------------------------------------------------------------------- */

/* A refused state is recoverable: the solver tries a smaller step, and ends if that fails, too. */
static int refuse(worker *w, int status, double time, const double *state)
{
    kt_result *r = w->result;
    r->refused_status = status;
    r->refused_time = time;
    memcpy(r->refused_state, state, (size_t)w->problem->state_count * sizeof *state);
    return 1;
}

int kt_rates(worker *w, double time, const double *state, double *out)
{
    const kt_problem *p = w->problem;
    kt_evaluate_inputs(w, time);
    int status = p->rhs(p->constants, state, w->inputs, out);
    return status ? refuse(w, status, time, state) : 0;
}

int kt_jacobian(worker *w, double time, const double *state, double *out)
{
    const kt_problem *p = w->problem;
    kt_evaluate_inputs(w, time);
    int status = p->jacobian(p->constants, state, w->inputs, out);
    return status ? refuse(w, status, time, state) : 0;
}

int kt_rates_by_time(worker *w, double time, const double *state, double lapse, double *out,
                     double *scratch)
{
    const kt_problem *p = w->problem;
    double *const rates[2] = {scratch, out};
    for (int i = 0; i < 2; ++i) {
        double moved = time + (i ? lapse : -lapse);
        evaluate_inputs_near(w, time + lapse, moved); /* on the side of the step, also backward from a kink */
        int status = p->rhs(p->constants, state, w->inputs, rates[i]);
        if (status) {
            return refuse(w, status, moved, state);
        }
    }
    for (int i = 0; i < p->state_count; ++i) {
        out[i] = (out[i] - scratch[i]) / (2.0 * lapse);
    }
    return 0;
}

int kt_root_count(const worker *w) { return w->problem->event_count + w->problem->root_count; }

int kt_roots(worker *w, double time, const double *state, double *out)
{
    const kt_problem *p = w->problem;
    if (p->event_count) {
        kt_evaluate_inputs(w, time);
        int status = p->signals(p->constants, state, w->inputs, w->signals);
        if (status) {
            refuse(w, status, time, state);
            return -1;
        }
        for (int i = 0; i < p->event_count; ++i) {
            out[i] = w->signals[p->events[i].signal] - p->events[i].level;
        }
    }
    if (p->root_count && p->roots(time, state, out + p->event_count, p->root_data)) {
        w->caller_failed = 1;
        return -1;
    }
    return 0;
}

/* -- setting up ------------------------------------------------------------------------------- */

static int set_up(worker *w, const double *state, double start)
{
    const kt_problem *p = w->problem;
    kt_result *r = w->result;
    size_t n = (size_t)p->state_count, events = (size_t)kt_root_count(w);
    r->output.width = (int)n + 1;
    r->events.width = (int)n + 2;
    r->dense.width = 3 + (KT_MAX_ORDER + 1) * (int)n;
    r->state = calloc(n, sizeof *r->state);
    r->refused_state = calloc(n, sizeof *r->refused_state);
    w->y = calloc(n, sizeof *w->y);
    w->scratch = calloc(n, sizeof *w->scratch);
    w->inputs = calloc((size_t)p->input_count + 1, sizeof *w->inputs);
    w->signals = calloc((size_t)p->signal_count + 1, sizeof *w->signals);
    w->piece = calloc((size_t)p->spline_count + 1, sizeof *w->piece);
    w->crossings = calloc(events + 1, sizeof *w->crossings);
    w->moved = calloc(n, sizeof *w->moved);
    if (!kt_open_margins(&w->margins, p->guard_count, p->guards, p->usual_margins) || !w->moved
        || !kt_open_search(w, start) || !r->state || !r->refused_state || !w->y || !w->scratch
        || !w->inputs || !w->signals || !w->piece || !w->crossings) {
        return KT_MEMORY;
    }
    memcpy(w->inputs, p->inputs, (size_t)p->input_count * sizeof *w->inputs);
    memcpy(w->y, state, n * sizeof *state);
    memcpy(r->state, state, n * sizeof *state);
    r->time = w->reached = start;
    w->solver = kt_solver_of(w->options->method);
    return w->solver->open(w, start);
}

static void tear_down(worker *w)
{
    if (w->solver) {
        w->solver->close(w);
    }
    free(w->y);
    free(w->scratch);
    free(w->inputs);
    free(w->signals);
    free(w->piece);
    free(w->crossings);
    kt_close_search(w);
    free(w->moved);
    kt_close_margins(&w->margins);
}

/* -- stepping --------------------------------------------------------------------------------- */

/* Restart with a step of this length. */
static int restart(worker *w, double time, double step)
{
    w->solver->count(w, &w->result->statistics);
    memcpy(w->y, w->result->state, (size_t)w->problem->state_count * sizeof *w->y);
    w->reached = time;
    return w->solver->restart(w, time, w->end > w->start ? step : -step);
}

/* Return the outcome for an error code of the solver. */
static int explain(worker *w, int code)
{
    kt_result *r = w->result;
    r->code = code;
    if (w->caller_failed) {
        return KT_CALLER;
    }
    if (code == KT_UNSTABLE_STEP) {
        return KT_UNSTABLE;
    }
    if (code == KT_JUMPING_RATES) {
        return KT_JUMPS;
    }
    if (code == KT_SINGULAR_MATRIX) {
        return KT_SINGULAR_STEP;
    }
    if (code == w->solver->too_accurate) {
        return KT_TOO_ACCURATE;
    }
    return r->refused_status ? KT_STATE : KT_FAILED;
}

/* Note the crossings at the present root; return whether one of them ends the integration. */
static int note_events(worker *w, double time)
{
    const kt_problem *p = w->problem;
    int stop = 0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        if (!w->search.found[i]) {
            continue;
        }
        double *row = append(&w->result->events);
        if (!row) {
            return -1;
        }
        row[0] = i;
        row[1] = time;
        memcpy(row + 2, w->y, (size_t)p->state_count * sizeof *row);
        stop |= p->terminal[i] && ++w->crossings[i] >= p->terminal[i];
    }
    return stop;
}

/* Store the derivatives of the step's polynomial at its end. */
static int keep_polynomial(worker *w, double from, double to)
{
    int n = w->problem->state_count;
    double *row = append(&w->result->dense);
    if (!row) {
        return KT_MEMORY;
    }
    memset(row, 0, (size_t)w->result->dense.width * sizeof *row);
    row[0] = from;
    row[1] = to;
    for (int k = 0; k <= KT_MAX_ORDER && !w->solver->interpolate(w, to, k, row + 3 + k * n); ++k) {
        row[2] = k;
    }
    return KT_DONE;
}

/* -- margins ---------------------------------------------------------------------------------- */

static void evaluate_margins(worker *w, double time, const double *state, double *out)
{
    kt_evaluate_inputs(w, time);
    w->problem->margins(w->problem->constants, state, w->inputs, out);
}

/* Evaluate the margins a short time ahead of a state of the motion. */
static void look_ahead(worker *w, double time, const double *state, double lapse)
{
    const kt_problem *p = w->problem;
    double signed_lapse = w->end > w->start ? lapse : -lapse;
    const double *rates = state + p->position_count;
    if (p->position_count != p->speed_count) {
        kt_evaluate_inputs(w, time);
        p->rhs(p->constants, state, w->inputs, w->moved); /* the model accepted the state before */
        rates = w->moved;
    }
    for (int i = 0; i < p->state_count; ++i) {
        w->moved[i] = i < p->position_count ? state[i] + signed_lapse * rates[i] : state[i];
    }
    evaluate_margins(w, time + signed_lapse, w->moved, w->margins.ahead);
}

static double smallest_step(const worker *w)
{
    double of_time = KT_SMALLEST_OF_TIME * fabs(w->end - w->start);
    double of_step = KT_SMALLEST_OF_STEP * w->longest_step;
    return of_step > 0.0 && of_step < of_time ? of_step : of_time;
}

/* End at the dead point of a guard, some time after the state that was reached. */
static int end_at(worker *w, int guard, double left)
{
    kt_result *r = w->result;
    r->refused_guard = guard;
    r->refused_time = r->time + (w->end > w->start ? left : -left);
    memcpy(r->refused_state, r->state, (size_t)w->problem->state_count * sizeof *r->state);
    return KT_STATE;
}

/* Return to the state that was reached for a shorter step; KT_STATE if it is too short. */
static int shorten(worker *w, double step)
{
    step *= KT_SHORTER;
    if (!(step >= smallest_step(w))) { /* nor a NaN */
        return KT_STATE;
    }
    w->result->refused_status = 0;
    return restart(w, w->result->time, step) ? KT_FAILED : KT_DONE;
}

/* -- running ---------------------------------------------------------------------------------- */

/* Instead of the number of a guard, or of an outcome. */
enum { KT_NONE = -1, KT_NO_MEMORY = -2, KT_AGAIN = -3 };

typedef struct {
    const double *times;
    long count, next; /* `next` is the first time that was not reached yet */
    int every_step;
    double sign;    /* of the time's direction */
    long milestone; /* the first one not reached yet */
} course;

/* Return a guard that prevents the evaluation of an output within a step. */
static int crossed_at(worker *w, double time, const double *state)
{
    evaluate_margins(w, time, state, w->margins.between);
    return kt_crossed(&w->margins, w->margins.between);
}

/* Write the outputs up to the time reached; return a guard that prevents the evaluation of one. */
static int put_out(worker *w, course *c, double reached)
{
    int n = w->problem->state_count, steady = kt_steady(&w->margins);
    for (; c->next < c->count && c->sign * (c->times[c->next] - reached) <= 0.0; ++c->next) {
        double time = c->times[c->next];
        const double *row = w->y;
        if (time != reached) {
            w->solver->interpolate(w, time, 0, w->scratch); /* cannot fail within the step */
            row = w->scratch;
            int guard = steady ? KT_NONE : crossed_at(w, time, row);
            if (guard != KT_NONE) {
                return guard;
            }
        }
        if (append_state(&w->result->output, time, row, n)) {
            return KT_NO_MEMORY;
        }
    }
    return KT_NONE;
}

/*
 * Return a guard that makes a step untrustworthy; else write the outputs in the step. `looked` returns whether
 * the margins ahead had to be evaluated.
 */
static int doubt(worker *w, course *c, double reached, double step, int *looked)
{
    evaluate_margins(w, reached, w->y, w->margins.now);
    int guard = kt_crossed(&w->margins, w->margins.now);
    *looked = kt_changes(&w->margins, w->solver->next_step(w) / step);
    if (guard == KT_NONE && *looked) {
        look_ahead(w, reached, w->y, KT_LAPSE * step);
        guard = kt_reflected(&w->margins, KT_LAPSE * step, step);
    }
    if (guard != KT_NONE) {
        return guard;
    }
    if (c->every_step) {
        return append_state(&w->result->output, reached, w->y, w->problem->state_count)
            ? KT_NO_MEMORY : KT_NONE;
    }
    return put_out(w, c, reached);
}

/*
 * Limit the next step by the margins ahead; return whether this is a dead point. That is also the case where
 * rounding, not the margin, has made the solver's own steps too short for any progress.
 */
static int limit(worker *w, double lapse)
{
    int nearest = KT_NONE, over = 0;
    w->trusted = kt_longest_step(&w->margins, lapse, &nearest, &over);
    int stuck = lapse < KT_LAPSE * smallest_step(w) && w->trusted < KT_NEAR * w->longest_step;
    w->stuck = stuck ? w->stuck + 1 : 0;
    over = over || w->stuck >= KT_MOST_STUCK || w->trusted < KT_SMALLEST_PART * fabs(w->result->time);
    return over ? end_at(w, nearest, KT_LEFT * w->trusted) : KT_DONE;
}

/* Accept the end of a step as the state that is reached, or take the step back. */
static int accept(worker *w, course *c, double reached)
{
    kt_result *r = w->result;
    long rows = r->output.rows, next = c->next;
    double step = fabs(reached - r->time);
    int looked = 0, guard = doubt(w, c, reached, step, &looked);
    if (guard == KT_NO_MEMORY
        || (guard == KT_NONE && w->options->dense && keep_polynomial(w, r->time, reached))) {
        return KT_MEMORY;
    }
    if (guard != KT_NONE) {
        r->output.rows = rows;
        c->next = next;
        int outcome = shorten(w, step);
        return outcome == KT_STATE ? end_at(w, guard, 0.0) : outcome ? outcome : KT_AGAIN;
    }
    r->time = reached;
    memcpy(r->state, w->y, (size_t)w->problem->state_count * sizeof *r->state);
    w->longest_step = fmax(w->longest_step, step);
    kt_reach(&w->margins);
    kt_pass_root(w);
    w->trusted = INFINITY;
    int outcome = looked ? limit(w, KT_LAPSE * step) : KT_DONE;
    return outcome;
}

/* Return the goal, or the next milestone if that comes before it. */
static double sooner(const worker *w, course *c, double goal)
{
    const kt_problem *p = w->problem;
    long *next = &c->milestone;
    while (*next < p->milestone_count && c->sign * (p->milestones[*next] - w->result->time) <= 0.0) {
        ++*next;
    }
    return *next < p->milestone_count && c->sign * (p->milestones[*next] - goal) < 0.0
        ? p->milestones[*next] : goal;
}

/* Return the time up to which the solver may step, which must not be one that it has passed. */
static double stop_of(worker *w, const course *c, double goal)
{
    if (w->solver->heeds_trust) {
        return goal;
    }
    double time = w->result->time, stop = time + c->sign * w->trusted;
    int limits = c->sign * (goal - stop) > 0.0 && c->sign * (stop - w->reached) > 0.0;
    return limits ? stop : goal;
}

/* Ask the caller after some steps, and some seconds, whether to continue. */
#define STEPS_BETWEEN 16
#define SECONDS_BETWEEN 0.05

/* Wall-clock time, which is faster to read than the time of the process; it may be set back. */
static double seconds(void)
{
#ifdef _WIN32
    /* some libraries of C for Windows lack timespec_get; clock() is there wall-clock time */
    return (double)clock() / CLOCKS_PER_SEC;
#else
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
#endif
}

static int interrupted(worker *w, long tried)
{
    if (!w->problem->interrupted || tried % STEPS_BETWEEN) {
        return 0;
    }
    double now = seconds();
    if (fabs(now - w->asked) < SECONDS_BETWEEN) {
        return 0;
    }
    w->asked = now;
    return w->problem->interrupted(w->problem->interrupted_data);
}

/* Take a step, or continue within the last one after a root; w->y is the state at the time reached. */
static int move(worker *w, double goal, double *time, int *root)
{
    int rest = w->reached != w->result->time;
    int code = rest ? 0 : w->solver->step(w, goal, &w->reached);
    *time = w->reached;
    if (code < 0 || !kt_root_count(w)) {
        return code;
    }
    code = kt_find_root(w, w->reached, rest, time);
    *root = code > 0;
    return code;
}

/* Take a step; KT_AGAIN if it was taken back and a shorter one is to be tried. */
static int advance(worker *w, course *c, int *root)
{
    kt_result *r = w->result;
    double goal = c->times[w->options->stop_at_outputs ? c->next : c->count - 1], reached = r->time;
    goal = sooner(w, c, goal);
    if (w->solver->set_stop(w, stop_of(w, c, goal))) {
        return KT_FAILED;
    }
    *root = 0;
    int code = move(w, goal, &reached, root);
    if (code < 0) {
        int outcome = explain(w, code);
        if (outcome == KT_STATE) {
            outcome = shorten(w, w->solver->next_step(w));
            return outcome ? outcome : KT_AGAIN;
        }
        return outcome;
    }
    /* Steps that shrink towards a refused state would never end. */
    if (r->refused_status && fabs(reached - r->time) < smallest_step(w)) {
        return KT_STATE;
    }
    r->refused_status = 0; /* a smaller step has passed it */
    return accept(w, c, reached);
}

/* Check for a dead point at the state from which a motion begins. */
static int look(worker *w, double lapse)
{
    kt_result *r = w->result;
    evaluate_margins(w, r->time, r->state, w->margins.now);
    look_ahead(w, r->time, r->state, lapse);
    kt_reach(&w->margins);
    return limit(w, lapse);
}

/* `goes_on`: the motion continues from this state. */
static int run(worker *w, const double *times, long count, int every_step, int goes_on)
{
    kt_result *r = w->result;
    course c = {times, count, 1, every_step, w->end > w->start ? 1.0 : -1.0, 0};
    if (append_state(&r->output, times[0], r->state, w->problem->state_count)) {
        return KT_MEMORY;
    }
    int outcome = goes_on ? KT_DONE : look(w, KT_SMALLEST_OF_STEP * fabs(w->end - w->start)), root = 0;
    for (long tried = 0; outcome == KT_DONE && c.sign * (w->end - r->time) > 0.0; ++tried) {
        if (tried >= w->options->max_steps) {
            return KT_TOO_MANY_STEPS;
        }
        if (interrupted(w, tried)) {
            return KT_CALLER;
        }
        outcome = advance(w, &c, &root);
        if (outcome == KT_DONE && root) {
            int terminal = note_events(w, r->time);
            outcome = terminal < 0 ? KT_MEMORY : terminal ? KT_EVENT : KT_DONE;
        } else if (outcome == KT_AGAIN) {
            outcome = KT_DONE;
        }
    }
    return outcome;
}

static int open(worker *w, const double *state)
{
    memset(w->result, 0, sizeof *w->result);
    w->result->refused_guard = KT_NONE;
    w->trusted = INFINITY;
    w->asked = seconds();
    return set_up(w, state, w->start);
}

int kt_integrate(const kt_problem *problem, const kt_options *options, const double *state,
                 const double *times, long count, int every_step, kt_result *result)
{
    worker w = {
        .problem = problem, .options = options, .result = result, .start = times[0],
        .end = times[count - 1],
    };
    int outcome = open(&w, state);
    if (outcome == KT_DONE) {
        outcome = run(&w, times, count, every_step, 0);
        w.solver->count(&w, &result->statistics);
    }
    tear_down(&w);
    return outcome;
}

kt_motion *kt_open_motion(const kt_problem *problem, const kt_options *options, const double *state,
                          double length, kt_result *result)
{
    worker *w = calloc(1, sizeof *w);
    if (w) {
        *w = (worker){.problem = problem, .options = options, .result = result, .end = length};
        if (open(w, state) != KT_DONE) {
            kt_close_motion(w);
            return NULL;
        }
    }
    return w;
}

int kt_advance(kt_motion *w, const double *state, const double *inputs, const double *times)
{
    kt_result *r = w->result;
    size_t size = (size_t)w->problem->state_count * sizeof *state;
    size_t held = (size_t)w->problem->input_count * sizeof *inputs;
    int goes_on = r->time == times[0] && r->output.rows && !memcmp(r->state, state, size);
    w->rates_known = goes_on && w->steady && !memcmp(w->inputs, inputs, held);
    w->steady = !w->problem->spline_count;
    memcpy(w->inputs, inputs, held);
    memcpy(r->state, state, size);
    r->time = w->start = times[0];
    w->end = times[1];
    r->refused_status = r->code = 0;
    r->refused_guard = KT_NONE;
    r->output.rows = 0;
    if (!goes_on) {
        w->trusted = INFINITY;
        w->longest_step = 0.0;
        w->stuck = 0;
    }
    double first = w->options->first_step > 0.0 ? w->options->first_step : fabs(times[1] - times[0]);
    int outcome = restart(w, times[0], first) ? KT_FAILED : KT_DONE;
    w->rates_known = 0;
    outcome = outcome == KT_DONE ? run(w, times, 2, 0, goes_on) : outcome;
    if (outcome != KT_DONE) {
        r->output.rows = 0; /* the integration has ended */
    }
    return outcome;
}

double kt_next_step(kt_motion *w) { return w->solver->next_step(w); }

void kt_close_motion(kt_motion *w)
{
    if (w) {
        tear_down(w);
        free(w);
    }
}

void kt_free(kt_result *result)
{
    free(result->output.data);
    free(result->events.data);
    free(result->dense.data);
    free(result->state);
    free(result->refused_state);
    memset(result, 0, sizeof *result);
}
