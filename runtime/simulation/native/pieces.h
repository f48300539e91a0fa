/* The piece of a piecewise polynomial at a time. */
#ifndef KINTRAFO_PIECES_H
#define KINTRAFO_PIECES_H

/* Times mostly increase, so the search starts at the piece of the last evaluation. */
static inline int kt_find_piece(const double *breaks, int pieces, int piece, double time)
{
    while (piece > 0 && time < breaks[piece]) {
        --piece;
    }
    while (piece < pieces - 1 && time >= breaks[piece + 1]) {
        ++piece;
    }
    return piece;
}

#endif
