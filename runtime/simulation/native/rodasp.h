/*
 * Coefficients of RODASP, a Rosenbrock method of order 4 in six stages: Steinebach, Order-reduction of
 * ROW-methods for DAEs and method of lines applications, Preprint 1741, TH Darmstadt, 1995. The form is that of
 * Hairer and Wanner, Solving Ordinary Differential Equations II, IV.7: with W = I / (h GAMMA) - J, and f the
 * rates,
 *
 *     W k_i = f(t + NODES_i h, y + sum_j A_ij k_j) + sum_j C_ij k_j / h + BY_TIME_i h df/dt,
 *     y(t + h) = y + sum_j A_6j k_j + k_6.
 */
#ifndef KINTRAFO_RODASP_H
#define KINTRAFO_RODASP_H

#define STAGES 6
#define GAMMA 0.25

static const double NODES[STAGES] = {0.0, 0.75, 0.21, 0.63, 1.0, 1.0};

static const double BY_TIME[STAGES] = {0.25, -0.5, -0.023504, -0.0362, 0.0, 0.0};

static const double A[STAGES][STAGES - 1] = {
    {0.0},
    {3.0},
    {1.831036793486759, 0.4955183967433795},
    {2.304376582692669, -0.05249275245743001, -1.176798761832782},
    {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401},
    {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401, 1.0},
};

static const double C[STAGES][STAGES - 1] = {
    {0.0},
    {-12.0},
    {-8.791795173947035, -2.207865586973518},
    {10.81793056857153, 6.780270611428266, 19.5348594464241},
    {34.19095006749676, 15.49671153725963, 54.7476087596413, 14.16005392148534},
    {34.62605830930532, 15.30084976114473, 56.99955578662667, 18.40807009793095, -5.714285714285717},
};

/*
 * Within the step, at the part s of it, the state is
 * y + s (y_end - y) + s (1 - s) sum_j (DENSE_1j + s DENSE_2j) k_j, of order 3.
 */
static const double DENSE[2][STAGES - 1] = {
    {25.09876703708589, 11.62013104361867, 28.49148307714626, -5.664021568594133},
    {1.638054557396973, -0.7373619806678748, 8.47791821923899, 15.9925314877952, -1.882352941176471},
};

#endif
