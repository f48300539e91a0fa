/* Exact partial derivatives, from the emitted Jacobians. */
#include "unit.h"

/* Evaluate the Jacobians that are not known at the present values. */
static int know(unit *u)
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
static double entry(const unit *u, int of_signal, int row, int by_input, int column)
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

/* Find the row of an unknown; reported where it has none. */
static int row_of(const unit *u, unsigned reference, int *of_signal, int *row)
{
    const km_model *m = &km_this;
    int place;
    enum ku_block block = ku_find(reference, &place);
    *of_signal = block != KU_RATE;
    *row = place;
    if (block == KU_EVENT && m->event[place].signal >= 0) {
        int needs = m->event[place].needs;
        /* an indicator that cannot cross is a number */
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

static int column_of(const unit *u, unsigned reference, int *by_input, int *column)
{
    enum ku_block block = ku_find(reference, column);
    *by_input = block == KU_INPUT;
    if (block == KU_TIME) {
        *column = -1; /* nothing depends on it */
        return KU_OK;
    }
    if (block == KU_STATE || block == KU_INPUT) {
        return KU_OK;
    }
    return ku_say(u, KU_ERROR,
                  "partial derivatives: the known with the value reference %u is neither a state nor an input.",
                  reference);
}

int ku_derivative(unit *u, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                  size_t columns, const double *seed, double *found, int transposed)
{
    int status = know(u), of_signal, row, by_input, column;
    for (size_t k = 0; k < (transposed ? columns : rows); ++k) {
        found[k] = 0.0;
    }
    for (size_t r = 0; status == KU_OK && r < rows; ++r) {
        status = row_of(u, unknowns[r], &of_signal, &row);
        for (size_t c = 0; status == KU_OK && c < columns; ++c) {
            status = column_of(u, knowns[c], &by_input, &column);
            if (status == KU_OK && row >= 0 && column >= 0) {
                double slope = entry(u, of_signal, row, by_input, column);
                found[transposed ? c : r] += slope * seed[transposed ? r : c];
            }
        }
    }
    return status;
}
