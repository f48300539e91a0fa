/*
 * Dormand and Prince's method of order 5 with an error estimate of order 4, a step size for each lane.
 * A lane whose system has ended gets the next one at once.
 */
#include "approach.h"
#include "outputs.h"
#include "solver.h"

#include "../native/powers.h"

/* -- waiting systems -------------------------------------------------------------------------- */

/* Load the parameters of some systems, one in each lane. */
static void set_parameters(const kt_problem *p, long first, int count, real *parameters)
{
    for (int i = 0; i < p->parameter_count; ++i) {
        parameters[i] = SPREAD(p->parameters[i]);
    }
    for (int l = 0; l < count; ++l) {
        const double *own = p->variants + p->varied_count * (first + l);
        for (int i = 0; i < p->varied_count; ++i) {
            parameters[p->varied[i]][l] = own[i];
        }
    }
}

/* Prepare the next systems, as many as there are lanes. */
static void fill_queue(lane_pool *w)
{
    const kt_problem *p = w->p;
    waiting *q = &w->queue;
    real *parameters = w->shown, *still = w->now;
    q->first = w->next;
    q->count = w->last - w->next < WIDTH ? (int)(w->last - w->next) : WIDTH;
    q->taken = 0;
    w->next += q->count;
    set_parameters(p, q->first, q->count, parameters);
    q->failed = w->prepare(parameters, q->constants);
    w->design_state(parameters, q->state);
    for (int i = 0; i < p->input_count; ++i) {
        still[i] = SPREAD(0.0);
    }
    w->margins(q->constants, q->state, still, q->margins);
    for (int i = 0; i < p->guard_count; ++i) {
        q->margins[i] = choose(is_finite(q->margins[i]), magnitude(q->margins[i]), SPREAD(0.0));
    }
}

/* -- begin and end of a system ---------------------------------------------------------------- */

/* Set the goal: the next milestone, or else the end of the segment. */
static void set_goal(lane_pool *w, int lane)
{
    const kt_segment *s = segment_of(w, lane);
    long next = w->milestone[lane];
    w->goal[lane] = next < s->milestone_count ? s->milestones[next] : s->end;
}

static void open_segment(lane_pool *w, int lane)
{
    w->milestone[lane] = w->turn[lane] = 0;
    w->fresh[lane] = -1;
    w->trusted[lane] = INFINITY;
    w->step[lane] = w->p->first_step;
    w->error[lane] = 0.0;
    for (int i = 0; i < STAGES * w->p->state_count; ++i) {
        w->rates[i][lane] = 0.0;
    }
    open_courses(w, lane);
    set_goal(w, lane);
}

static void end_system(lane_pool *w, int lane, int end, int code, double time)
{
    const kt_problem *p = w->p;
    long system = w->system[lane];
    int failed = end != KT_DONE;
    p->ends[system] = end;
    p->codes[system] = code;
    p->ended[system] = time;
    p->steps[system] = (long)w->taken[lane];
    for (int i = 0; i < p->state_count; ++i) {
        p->finals[system * p->state_count + i] = w->state[i][lane];
    }
    for (int i = 0; i < p->reduction_count; ++i) {
        p->reduced[system * p->reduction_count + i] = failed ? NAN : w->kept[i][lane];
    }
    for (int i = 0; i < p->bound_count; ++i) {
        p->beyond[system * p->bound_count + i] = w->beyond[i][lane];
    }
    w->running[lane] = 0;
}

/* Assign a prepared system to a lane. */
static void begin_system(lane_pool *w, int lane)
{
    const kt_problem *p = w->p;
    const waiting *q = &w->queue;
    int from = q->taken;
    long system = q->first + from;
    if (q->failed[from]) { /* it has no results */
        p->ends[system] = KT_PARAMETERS;
        p->codes[system] = (int)q->failed[from];
        return;
    }
    w->system[lane] = system;
    w->running[lane] = -1;
    for (int i = 0; i < p->constant_count; ++i) {
        w->constants[i][lane] = q->constants[i][from];
    }
    for (int i = 0; i < p->state_count; ++i) {
        double given = p->states[p->state_stride * system + i];
        w->state[i][lane] = isnan(given) ? q->state[i][from] : given;
    }
    for (int i = 0; i < p->input_count; ++i) {
        w->inputs[i][lane] = p->inputs[p->input_stride * system + i];
    }
    for (int i = 0; i < p->guard_count; ++i) {
        w->greatest[i][lane] = q->margins[i][from];
    }
    w->time[lane] = p->start;
    w->longest[lane] = 0.0;
    w->again[lane] = w->tried[lane] = w->taken[lane] = w->stuck[lane] = 0;
    w->stiff[lane] = w->calm[lane] = 0;
    w->segment[lane] = 0;
    begin_outputs(w, lane);
    open_segment(w, lane);
}

/* Assign systems to idle lanes. */
static void refill(lane_pool *w)
{
    for (int l = 0; l < WIDTH; ++l) {
        while (!w->running[l]) {
            if (w->queue.taken == w->queue.count) {
                if (w->next == w->last) {
                    break;
                }
                fill_queue(w);
            }
            if (w->p->ends[w->queue.first + w->queue.taken] == KT_WAITING) {
                begin_system(w, l);
            }
            ++w->queue.taken;
        }
    }
}

/* -- a step ----------------------------------------------------------------------------------- */

/* Return the first extremum of a lane's inputs that limits a step of some length, or else the goal. */
static double next_turn(lane_pool *w, int lane, double step)
{
    const kt_segment *s = segment_of(w, lane);
    double time = w->time[lane], far = time + 2.0 * step;
    long *turn = &w->turn[lane];
    while (*turn < s->turn_count && s->turns[*turn] <= time) {
        ++*turn;
    }
    for (long k = *turn; k < s->turn_count && s->turns[k] < far; ++k) {
        if (s->reaches[k] < step) {
            return s->turns[k] < w->goal[lane] ? s->turns[k] : w->goal[lane];
        }
    }
    return w->goal[lane];
}

/* Set the target of each lane: its goal, or an earlier extremum of its inputs. */
static void take_aim(lane_pool *w, real step)
{
    w->aim = w->goal;
    for (int l = 0; l < WIDTH; ++l) {
        if (w->running[l] && segment_of(w, l)->turn_count) {
            w->aim[l] = next_turn(w, l, step[l]);
        }
    }
}

/* Return the lengths of steps; `lands` are the lanes that reach their target. */
static real planned(lane_pool *w, bits *lands)
{
    real most = lesser(lesser(w->step, w->trusted), SPREAD(w->p->max_step));
    take_aim(w, most);
    real left = w->aim - w->time;
    /* two equal steps instead of one and a short remainder */
    real step = choose(left < 2.0 * most, 0.5 * left, most);
    *lands = (left <= most) & ~w->fresh;
    step = choose(*lands, left, step);
    return choose(w->fresh | ~w->running, SPREAD(0.0), step);
}

/* Compute the rates of all stages and the state at the end; return the lanes that the model refuses. */
static bits attempt(lane_pool *w, real step)
{
    int n = w->p->state_count;
    w->status = (bits){0};
    for (int s = 1; s < STAGES; ++s) {
        real *stage = s == STAGES - 1 ? w->end_state : w->stage;
        for (int i = 0; i < n; ++i) {
            real sum = TABLE[s][0] * w->rates[i];
            for (int k = 1; k < s; ++k) {
                sum += TABLE[s][k] * w->rates[k * n + i];
            }
            stage[i] = w->state[i] + step * sum;
        }
        evaluate_inputs(w, w->time + NODES[s] * step);
        bits status = w->rhs(w->constants, stage, w->inputs, w->rates + s * n);
        w->status = choose_bits(w->status == 0, status, w->status);
    }
    return w->running & (w->status != 0);
}

/* Return the mean square of some numbers, each divided by its tolerance. */
static real mean_square(const lane_pool *w, const real *numbers)
{
    int n = w->p->state_count;
    real sum = {0.0};
    for (int i = 0; i < n; ++i) {
        real size = greater(magnitude(w->state[i]), magnitude(w->end_state[i]));
        real measured = numbers[i] / (w->p->atol[i] + w->p->rtol * size);
        sum += measured * measured;
    }
    return sum / (double)n;
}

static real error_of(lane_pool *w, real step)
{
    int n = w->p->state_count;
    for (int i = 0; i < n; ++i) {
        real sum = ERROR[0] * w->rates[i];
        for (int s = 2; s < STAGES; ++s) {
            sum += ERROR[s] * w->rates[s * n + i];
        }
        w->stage[i] = step * sum;
    }
    return mean_square(w, w->stage);
}

/*
 * Note the lanes in which stability, not accuracy, limits the step: Hairer and Wanner, Solving Ordinary
 * Differential Equations II, IV.2. The last two stages are at one time, and the difference of their rates shows
 * the rate of the fastest motion; if it times the step is more than 3.25, the method is not stable.
 */
static void see_stiff(lane_pool *w, bits good, real step)
{
    const kt_problem *p = w->p;
    int n = p->state_count;
    bits asked = good & (w->tried >= p->stiff_after);
    if (!p->stiff_after || !any(asked)) {
        return;
    }
    real rates = {0.0}, states = {0.0};
    for (int i = 0; i < n; ++i) {
        real rate = w->rates[(STAGES - 1) * n + i] - w->rates[(STAGES - 2) * n + i];
        real state = w->end_state[i] - w->stage[i];
        rates += rate * rate;
        states += state * state;
    }
    bits limited = step * step * rates > STABLE * STABLE * states;
    w->calm = choose_bits(asked, choose_bits(limited, (bits){0}, w->calm + 1), w->calm);
    w->stiff = choose_bits(asked & limited, w->stiff + 1, w->stiff);
    w->stiff &= ~(asked & (w->calm >= OFTEN_CALM));
}

/* Return the first step, from the size of the state and of its rates at the start. */
static real first_step(const lane_pool *w)
{
    const kt_problem *p = w->p;
    real size = mean_square(w, w->state);
    real rate = bounded_logarithm(mean_square(w, w->rates + (STAGES - 1) * p->state_count));
    real step = exponential(0.2 * (LOG2_FIRST - 0.5 * rate));
    real of_state = exponential(0.5 * (bounded_logarithm(size) - rate));
    step = lesser(step, choose(size > 1.0e-10, of_state, SPREAD(1.0e-4)));
    return lesser(step, SPREAD(p->end - p->start));
}

/* Return the next step after an accepted one, or after one with too large an error. */
static real next_step(lane_pool *w, real step, real error, bits good)
{
    real now = bounded_logarithm(error);
    /* logarithms of squares */
    real power = 0.5 * (OF_ERROR_BEFORE * w->error - OF_ERROR * now);
    real factor = SAFE * exponential(power);
    factor = lesser(greater(factor, SPREAD(MOST_SHORTER)), SPREAD(MOST_LONGER));
    factor = choose(w->again | ~good, lesser(factor, SPREAD(1.0)), factor);
    real next = step * factor;
    /* a step that was shortened to reach its goal does not reduce the planned length */
    next = choose(good & ~w->again & (step < w->step), greater(next, w->step), next);
    w->error = choose(good & ~w->fresh, greater(now, SPREAD(LOG2_LEAST_SQUARE)), w->error);
    return choose(w->running & ~w->fresh, next, w->step);
}

/* -- acceptance of a step ---------------------------------------------------------------------- */

/* Check the margins; return the lanes whose margins ahead were evaluated, and the lapse. */
static bits ask_margins(lane_pool *w, bits lanes, real reached, real step, real next, real *lapse)
{
    w->guard = (bits){0} + NO_GUARD;
    *lapse = choose(w->fresh, SPREAD(KT_SMALLEST_OF_STEP * (w->p->end - w->p->start)), KT_LAPSE * step);
    w->margins(w->constants, w->end_state, w->inputs, w->now);
    see_crossed(w, lanes);
    bits looks = lanes & (w->guard == NO_GUARD) & (w->fresh | changed(w, step, next));
    if (any(looks)) {
        look_ahead(w, reached, *lapse);
        see_reflected(w, looks & ~w->fresh, *lapse, step);
    }
    return looks;
}

/* Accept the step's end as the state that is reached. */
static void commit(lane_pool *w, bits lanes, real step, real reached)
{
    int n = w->p->state_count;
    for (int i = 0; i < n; ++i) {
        w->state[i] = choose(lanes, w->end_state[i], w->state[i]);
        w->rates[i] = choose(lanes, w->rates[(STAGES - 1) * n + i], w->rates[i]);
    }
    w->time = choose(lanes, reached, w->time);
    w->longest = choose(lanes & (step > w->longest), step, w->longest);
    w->trusted = choose(lanes, SPREAD(INFINITY), w->trusted);
    w->taken -= lanes & ~w->fresh;
    reach(w, lanes);
}

/* Continue to the next milestone or segment; a system ends with its last segment. */
static void pass_goal(lane_pool *w, int lane)
{
    const kt_problem *p = w->p;
    if (w->milestone[lane] < segment_of(w, lane)->milestone_count) {
        ++w->milestone[lane];
        set_goal(w, lane);
    } else if (w->segment[lane] + 1 < p->drives[drive_number(p, w->system[lane])].segment_count) {
        ++w->segment[lane];
        open_segment(w, lane);
    } else {
        end_system(w, lane, KT_DONE, 0, w->time[lane]);
    }
}

/* End a system whose steps cannot become shorter. */
static void give_up(lane_pool *w, int lane, real step)
{
    if (w->guard[lane] != NO_GUARD) {
        end_system(w, lane, KT_DEAD_POINT, (int)w->guard[lane], w->time[lane]);
    } else if (w->status[lane]) {
        end_system(w, lane, KT_REFUSED, (int)w->status[lane], w->time[lane] + step[lane]);
    } else {
        end_system(w, lane, KT_SMALL_STEP, 0, w->time[lane]);
    }
}

/* Continue or end systems after a step. */
static void settle(lane_pool *w, bits good, bits lands, bits refused, real step)
{
    const kt_problem *p = w->p;
    real rounding = ROUNDING * greater(magnitude(w->time), SPREAD(p->end - p->start));
    bits over = good & (w->guard != NO_GUARD), passed = good & lands & (w->aim == w->goal) & ~over;
    bits stuck = w->running & ~good
        & (~(w->step >= rounding) | (refused & ~(w->step >= smallest_step(w))));
    bits many = w->running & (w->tried >= p->max_steps), stiff = w->running & (w->stiff >= OFTEN_STIFF);
    if (!any(over | passed | stuck | many | stiff)) {
        return;
    }
    for (int l = 0; l < WIDTH; ++l) {
        if (over[l]) {
            end_system(w, l, KT_DEAD_POINT, (int)w->guard[l], w->time[l] + KT_LEFT * w->trusted[l]);
        } else if (passed[l]) {
            pass_goal(w, l);
        } else if (stuck[l]) {
            give_up(w, l, step);
        }
        if (many[l] && w->running[l]) {
            end_system(w, l, KT_MANY_STEPS, 0, w->time[l]);
        } else if (stiff[l] && w->running[l]) {
            end_system(w, l, KT_STIFF, 0, w->time[l]);
        }
    }
}

/* -- all steps -------------------------------------------------------------------------------- */

/* Take a step in every lane, or note that it must be shorter. */
static void sweep(lane_pool *w)
{
    bits lands, fresh = w->fresh;
    real step = planned(w, &lands), lapse;
    real reached = choose(lands, w->aim, w->time + step);
    real took = reached - w->time; /* the difference of times, which margins use */
    bits refused = attempt(w, step);
    see_stiff(w, w->running & ~refused & ~fresh, step);
    real error = error_of(w, step);
    bits good = w->running & ~refused & (fresh | (error <= 1.0));
    real next = next_step(w, step, error, good);
    bits looks = ask_margins(w, good, reached, took, next, &lapse);
    bits doubted = good & (w->guard != NO_GUARD);
    doubted |= put_out(w, good & ~doubted, reached);
    good &= ~doubted;
    refused |= doubted;
    commit(w, good, took, reached);
    if (any(good & looks)) {
        limit(w, good & looks, lapse, took);
    }
    w->again = ~good & ~refused; /* a refused step restarts */
    w->error = choose(refused, SPREAD(0.0), w->error);
    w->step = choose(refused, KT_SHORTER * choose(doubted, took, step), next);
    w->tried -= w->running & ~fresh;
    if (any(fresh & good)) {
        w->step = choose(fresh & good & (w->step == 0.0), first_step(w), w->step);
        w->fresh &= ~good;
    }
    settle(w, good, lands, refused, step);
}

/* Return 0, or 1 without memory. */
static int open_lane_pool(lane_pool *w, const kt_problem *p)
{
    int n = p->state_count, shown = p->signal_count + n, margins = p->guard_count;
    if (shown < p->parameter_count) {
        shown = p->parameter_count;
    }
    if (margins < p->input_count) {
        margins = p->input_count;
    }
    const part parts[] = {
        {&w->constants, p->constant_count}, {&w->queue.constants, p->constant_count},
        {&w->state, n}, {&w->end_state, n}, {&w->stage, n}, {&w->queue.state, n},
        {&w->rates, STAGES * n}, {&w->terms, 5 * n}, {&w->inputs, p->input_count},
        {&w->before, margins}, {&w->now, margins}, {&w->ahead, margins},
        {&w->greatest, margins}, {&w->queue.margins, margins}, {&w->shown, shown},
        {&w->kept, p->reduction_count}, {&w->kept_before, p->reduction_count},
        {&w->beyond, p->bound_count}, {&w->beyond_before, p->bound_count},
        {&w->limits, p->bound_count},
    };
    size_t courses = (size_t)p->course_count * sizeof *w->courses;
    w->courses = reserve(parts, sizeof parts / sizeof *parts, courses);
    return !w->courses;
}

int NAME_OF(kt_integrate_, WIDTH)(const kt_problem *p, long first, long last, const volatile int *stop)
{
    lane_pool w = {
        .p = p, .next = first, .last = last, .prepare = (kt_prepare)p->prepare,
        .design_state = (kt_prepare)p->design_state, .rhs = (kt_function)p->rhs,
        .signals = (kt_function)p->signals, .margins = (kt_function)p->margins,
    };
    if (open_lane_pool(&w, p)) {
        return 1;
    }
    for (refill(&w); any(w.running) && !*stop; refill(&w)) {
        sweep(&w);
    }
    free(w.constants); /* begin of the memory */
    return 0;
}
