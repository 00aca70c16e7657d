// The step for CasADi of a file with the prefix `arm`: its Jacobians beside difference quotients, and its directional
// derivatives beside the Jacobians. Prints what is wrong, then how many numbers were compared.
#include <stdio.h>
#include <string.h>
#include "arm.h"

enum { N = (int)ARM_DOF, INPUTS = 12, OUTPUTS = 32, LONGEST = N * N };

typedef long long int integer;
typedef int evaluated(const double **arg, double **res, integer *iw, double *w, int mem);
typedef const integer *compressed(integer i);
typedef integer count(void);

#define DECLARED(f) \
    int f(const double **arg, double **res, integer *iw, double *w, int mem); \
    integer f##_n_in(void); \
    integer f##_n_out(void); \
    const integer *f##_sparsity_in(integer i); \
    const integer *f##_sparsity_out(integer i);
DECLARED(euler_step)
DECLARED(jac_euler_step)
DECLARED(fwd1_euler_step)
DECLARED(adj1_euler_step)
DECLARED(jac_adj1_euler_step)

static int compared = 0;

static void expect(const char *what, int output, int input, double found, double expected, double tolerance)
{
    const double difference = found < expected ? expected - found : found - expected;
    const double size = expected < 0 ? 1 - expected : 1 + expected;
    compared++;
    if (!(difference <= tolerance * size)) {
        printf("%s: output %d by input %d: %.17g, not %.17g\n", what, output, input, found, expected);
    }
}

static integer elements(const integer *pattern)
{
    return pattern[2] == 1 ? pattern[0] * pattern[1] : pattern[2 + pattern[1]];
}

// An element of compressed columns.
static double element(const integer *pattern, const double *from, integer row, integer column)
{
    if (pattern[2] == 1) {
        return from[column * pattern[0] + row];
    }
    for (integer index = pattern[2 + column]; index < pattern[3 + column]; index++) {
        if (pattern[3 + pattern[1] + index] == row) {
            return from[index];
        }
    }
    return 0;
}

static double at[INPUTS][LONGEST], results[OUTPUTS][LONGEST];

static void call(evaluated *f, double to[OUTPUTS][LONGEST], int results_of_f)
{
    const double *arg[INPUTS];
    double *res[OUTPUTS] = {0};
    for (int input = 0; input < INPUTS; input++) {
        arg[input] = at[input];
    }
    for (int output = 0; output < results_of_f; output++) {
        res[output] = to[output];
    }
    if (f(arg, res, 0, 0, 0) != 0) {
        printf("a call failed\n");
    }
}

// The Jacobians of f beside its central differences by each input that has elements.
static void check(const char *name, evaluated *f, count *inputs, count *outputs, compressed *input_of,
                  compressed *output_of, evaluated *jacobian, compressed *block)
{
    static double after[OUTPUTS][LONGEST], before[OUTPUTS][LONGEST];
    const int n_in = (int)inputs(), n_out = (int)outputs();
    const double small = 1e-5;
    call(jacobian, results, n_in * n_out);
    for (int input = 0; input < n_in; input++) {
        for (integer column = 0; column < elements(input_of(input)); column++) {
            const double middle = at[input][column];
            at[input][column] = middle + small;
            call(f, after, n_out);
            at[input][column] = middle - small;
            call(f, before, n_out);
            at[input][column] = middle;
            for (int output = 0; output < n_out; output++) {
                const int place = output * n_in + input;
                for (integer row = 0; row < elements(output_of(output)); row++) {
                    const double slope = (after[output][row] - before[output][row]) / (2 * small);
                    const double found = element(block(place), results[place], row, column);
                    expect(name, output, input, found, slope, 1e-5);
                }
            }
        }
    }
    // what is missing is zero, and what is not asked for is not written
    const double *no_arguments[INPUTS] = {0};
    double *no_results[OUTPUTS] = {0};
    if (f(no_arguments, no_results, 0, 0, 0) != 0 || jacobian(no_arguments, no_results, 0, 0, 0) != 0) {
        printf("%s: a call without arguments failed\n", name);
    }
}

// Directional derivatives beside products with the Jacobians, which are in `results`.
static void directions(void)
{
    static double moved[OUTPUTS][LONGEST], pulled[OUTPUTS][LONGEST];
    call(fwd1_euler_step, moved, 2);
    call(adj1_euler_step, pulled, 4);
    for (int output = 0; output < 2; output++) {
        for (int row = 0; row < N; row++) {
            double sum = 0;
            for (int input = 0; input < 4; input++) {
                for (integer column = 0; column < (input < 3 ? N : 1); column++) {
                    const int place = output * 4 + input;
                    const double slope = element(jac_euler_step_sparsity_out(place), results[place], row, column);
                    sum += slope * at[6 + input][column];
                }
            }
            expect("fwd1", output, row, moved[output][row], sum, 1e-12);
        }
    }
    for (int input = 0; input < 4; input++) {
        for (integer column = 0; column < (input < 3 ? N : 1); column++) {
            double sum = 0;
            for (int place = input; place < 8; place += 4) {
                for (int row = 0; row < N; row++) {
                    const double slope = element(jac_euler_step_sparsity_out(place), results[place], row, column);
                    sum += slope * at[6 + place / 4][row];
                }
            }
            expect("adj1", input, (int)column, pulled[input][column], sum, 1e-12);
        }
    }
}

int main(void)
{
    const double steps[3] = {0.02, -0.1, 0};
    for (int state = 0; state < 3; state++) {
        for (int input = 0; input < INPUTS; input++) {
            for (int index = 0; index < LONGEST; index++) {
                at[input][index] = 0.3 - 0.07 * ((index + 3 * input + 2 * state) % 11);
            }
        }
        at[3][0] = steps[state];
        check("jac", euler_step, euler_step_n_in, euler_step_n_out, euler_step_sparsity_in, euler_step_sparsity_out,
              jac_euler_step, jac_euler_step_sparsity_out);
        directions();
        check("jac_adj1", adj1_euler_step, adj1_euler_step_n_in, adj1_euler_step_n_out, adj1_euler_step_sparsity_in,
              adj1_euler_step_sparsity_out, jac_adj1_euler_step, jac_adj1_euler_step_sparsity_out);
    }
    printf("%d numbers\n", compared);
    return 0;
}
