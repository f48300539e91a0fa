/* Where in a piecewise polynomial a time is. */
#ifndef KINTRAFO_PIECES_H
#define KINTRAFO_PIECES_H

/* Times go forward mostly, so the piece of the last evaluation, or a near one, is the right one. */
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
