/* Slider-crank, one degree of freedom: numbers of one parameter set. Written by kintrafo. */
#include "model.h"

/*
 * After the mark, kintrafo writes the numbers of another parameter set into a compiled library. Nothing else in it
 * depends on them.
 */
typedef struct {
    char mark[32], token[64];
    double values[20];
} km_numbers;

/* Not static, so that no compiler folds them as constants in other files. */
extern const km_numbers km_slider_crank_numbers;

const km_numbers km_slider_crank_numbers = {
    "kintrafo: numbers of a model", "",
    {
        0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0,
        0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0,
        0x0.0p+0, 0x0.0p+0,
    },
};

const char *km_token(void) { return km_slider_crank_numbers.token; }

double km_value(int place) { return km_slider_crank_numbers.values[place]; }
