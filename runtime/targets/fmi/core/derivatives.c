/* Exact partial derivatives: from the emitted Jacobians, and along directions of the parameters. */
#include "instance.h"

#include <math.h>
#include <string.h>

/* A step along a direction relative to the greatest length, after which assumptions are checked. */
#define STEP 1.0e-6

/* Evaluate the Jacobians that are not known at the present values. */
static int know(ku_instance *u)
{
    const km_model *m = &km_this;
    int status = ku_ready(u);
    if (status == KU_OK && !u->jacobian_known && m->jacobian) {
        int word = m->jacobian(u->constants, u->now.state, u->now.inputs, u->jacobian);
        status = word ? ku_refused(u, "partial derivatives", word) : KU_OK;
        u->jacobian_known = status == KU_OK;
    }
    if (status == KU_OK && !u->linearised_known && m->linearisation) {
        int word = m->linearisation(u->constants, u->now.state, u->now.inputs, u->linearised);
        status = word ? ku_refused(u, "partial derivatives", word) : KU_OK;
        u->linearised_known = status == KU_OK;
    }
    return status;
}

/* Return a derivative of a rate or a signal by a state or an input. */
static double entry(const ku_instance *u, int of_signal, int row, int by_input, int column)
{
    const km_model *m = &km_this;
    int width = by_input ? m->inputs : m->states;
    if (!of_signal && !by_input) {
        return u->jacobian[row * width + column];
    }
    int start = by_input ? m->places.rates_by_inputs : m->places.signals_by_states;
    if (of_signal && by_input) {
        start = m->places.signals_by_inputs;
    }
    return u->linearised[start + row * width + column];
}

/* Find the row of an unknown; report an error if it has none. */
static int row_of(const ku_instance *u, unsigned reference, int *of_signal, int *row)
{
    const km_model *m = &km_this;
    int place;
    enum ku_block block = ku_find(reference, &place);
    *of_signal = block != KU_RATE;
    *row = place;
    if (block == KU_EVENT && m->event[place].signal >= 0) {
        int needs = m->event[place].needs;
        /* an indicator that cannot cross is constant */
        *row = needs >= 0 && u->now.parameters[needs] == 0.0 ? -1 : m->event[place].signal;
        return KU_OK;
    }
    if (block == KU_RATE || block == KU_SIGNAL) {
        return KU_OK;
    }
    return ku_say(u, KU_ERROR,
                  "partial derivatives: the unknown with the value reference %u is neither a derivative of a "
                  "state, nor an output, nor an event indicator of one.", reference);
}

static int column_of(const ku_instance *u, unsigned reference, enum ku_block *block, int *column)
{
    *block = ku_find(reference, column);
    if (*block == KU_PARAMETER && !km_this.prepare_tangent) {
        return ku_say(u, KU_ERROR,
                      "partial derivatives: those by %s are not there. Export a mechanism that was compiled "
                      "with parameter_derivatives=True.", km_this.parameter[*column].name);
    }
    if (*block == KU_TIME || *block == KU_STATE || *block == KU_INPUT || *block == KU_PARAMETER) {
        return KU_OK;
    }
    return ku_say(u, KU_ERROR,
                  "partial derivatives: the known with the value reference %u is neither a state, nor an input, "
                  "nor a parameter of the equations.", reference);
}

/* -- by parameters ---------------------------------------------------------------------------- */

static int is_geometry(const char *unit)
{
    return !strcmp(unit, "m") || !strcmp(unit, "rad") || !strcmp(unit, "1");
}

/* Return the assumption of the equations that a direction breaks; NULL: none. */
static const km_assumption *left_by(ku_instance *u, const double *direction)
{
    const km_model *m = &km_this;
    double *values = u->tangents.parameters, size = 0.0, length = 0.0;
    for (int i = 0; i < m->parameters; ++i) {
        const char *unit = m->parameter[i].unit;
        size = is_geometry(unit) ? fmax(size, fabs(direction[i])) : size;
        length = strcmp(unit, "m") ? length : fmax(length, fabs(values[i]));
    }
    if (size == 0.0) {
        return NULL;
    }
    for (int i = 0; i < m->parameters; ++i) {
        values[i] += STEP * length / size * direction[i];
    }
    int number = m->prepare(values, u->tangents.constants) - m->constants;
    memcpy(values, u->now.parameters, (size_t)m->parameters * sizeof *values);
    return number > 0 && number <= m->zeros ? &m->assumption[number - 1] : NULL;
}

/* The same for the direction that follows the parameters: only for parameters that cannot change alone, which could
   be too small beside the others. */
static const km_assumption *broken(ku_instance *u)
{
    const km_model *m = &km_this;
    const double *direction = u->tangents.parameters + m->parameters;
    double *one = u->tangents.one, *bound = u->tangents.bound;
    for (int i = 0; m->zeros && i < m->parameters; ++i) {
        one[i] = 1.0;
        bound[i] = direction[i] != 0.0 && left_by(u, one) ? direction[i] : 0.0;
        one[i] = 0.0;
    }
    return m->zeros ? left_by(u, bound) : NULL;
}

/* Evaluate the changes of rates and signals along the direction that follows the parameters. */
static int follow(ku_instance *u)
{
    const km_model *m = &km_this;
    ku_tangents *t = &u->tangents;
    memcpy(t->parameters, u->now.parameters, (size_t)m->parameters * sizeof *t->parameters);
    const km_assumption *left = broken(u);
    if (left) {
        return ku_say(u, KU_ERROR,
                      "partial derivatives: these parameters cannot move alone. They leave what the equations "
                      "take to be zero: %s.", left->meaning);
    }
    if (m->prepare_tangent(t->parameters, t->constants + m->constants)) {
        return ku_say(u, KU_ERROR, "partial derivatives: what constants change by is not finite.");
    }
    memcpy(t->constants, u->constants, (size_t)m->constants * sizeof *t->constants);
    memcpy(t->state, u->now.state, (size_t)m->states * sizeof *t->state);
    memcpy(t->inputs, u->now.inputs, (size_t)m->inputs * sizeof *t->inputs);
    int word = m->rates_tangent ? m->rates_tangent(t->constants, t->state, t->inputs, t->rates) : 0;
    if (!word && m->signals_tangent) {
        word = m->signals_tangent(t->constants, t->state, t->inputs, t->signals);
    }
    return word ? ku_refused(u, "partial derivatives", word) : KU_OK;
}

/* Return the change of an unknown along it; the level of an indicator may be a parameter. */
static double followed(const ku_instance *u, unsigned unknown, int of_signal, int row)
{
    const km_model *m = &km_this;
    int place;
    double slope = of_signal ? u->tangents.signals[row] : u->tangents.rates[row];
    if (ku_find(unknown, &place) == KU_EVENT && m->event[place].parameter >= 0) {
        slope -= m->event[place].sign * u->tangents.parameters[m->parameters + m->event[place].parameter];
    }
    return slope;
}

static void clear_direction(ku_instance *u)
{
    const km_model *m = &km_this;
    if (m->prepare_tangent) {
        memset(u->tangents.parameters + m->parameters, 0, (size_t)m->parameters * sizeof *u->tangents.parameters);
    }
}

/* Add the effect of parameters: of all along a direction, or of each separately at its own place. */
static int add_parameters(ku_instance *u, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                          size_t columns, const double *seed, double *found, int transposed)
{
    int status = KU_OK, any = 0, of_signal, row;
    clear_direction(u);
    for (size_t c = 0; status == KU_OK && c < columns; ++c) {
        enum ku_block block;
        int column;
        status = column_of(u, knowns[c], &block, &column);
        if (status != KU_OK || block != KU_PARAMETER) {
            continue;
        }
        u->tangents.parameters[km_this.parameters + column] += transposed ? 1.0 : seed[c];
        any = 1;
        status = transposed ? follow(u) : KU_OK;
        for (size_t r = 0; transposed && status == KU_OK && r < rows; ++r) {
            status = row_of(u, unknowns[r], &of_signal, &row);
            found[c] += row < 0 ? 0.0 : seed[r] * followed(u, unknowns[r], of_signal, row);
        }
        if (transposed) {
            clear_direction(u);
        }
    }
    if (status != KU_OK || !any || transposed) {
        return status;
    }
    status = follow(u);
    for (size_t r = 0; status == KU_OK && r < rows; ++r) {
        status = row_of(u, unknowns[r], &of_signal, &row);
        found[r] += row < 0 ? 0.0 : followed(u, unknowns[r], of_signal, row);
    }
    return status;
}

/* -- all -------------------------------------------------------------------------------------- */

int ku_derivative(ku_instance *u, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                  size_t columns, const double *seed, double *found, int transposed)
{
    int status = know(u), of_signal, row, column;
    enum ku_block block;
    for (size_t k = 0; k < (transposed ? columns : rows); ++k) {
        found[k] = 0.0;
    }
    for (size_t r = 0; status == KU_OK && r < rows; ++r) {
        status = row_of(u, unknowns[r], &of_signal, &row);
        for (size_t c = 0; status == KU_OK && c < columns; ++c) {
            status = column_of(u, knowns[c], &block, &column);
            /* time has an effect through inputs only */
            if (status == KU_OK && row >= 0 && (block == KU_STATE || block == KU_INPUT)) {
                double slope = entry(u, of_signal, row, block == KU_INPUT, column);
                found[transposed ? c : r] += slope * seed[transposed ? r : c];
            }
        }
    }
    return status == KU_OK
        ? add_parameters(u, unknowns, rows, knowns, columns, seed, found, transposed) : status;
}
