// The functions for CasADi of a file with the prefix `arm` against the functions of that file: every element and every
// missing argument or result. Prints what is wrong, then how many numbers were compared.
#include <stdio.h>
#include <string.h>
#include "arm.h"

enum { N = (int)ARM_DOF };

typedef long long int integer;

#define DECLARED(f) \
    int f(const double **arg, double **res, integer *iw, double *w, int mem); \
    integer f##_n_in(void); \
    integer f##_n_out(void); \
    const char *f##_name_in(integer i); \
    const char *f##_name_out(integer i); \
    const integer *f##_sparsity_in(integer i); \
    const integer *f##_sparsity_out(integer i); \
    int f##_work(integer *sz_arg, integer *sz_res, integer *sz_iw, integer *sz_w);
#define WITH_DERIVATIVES(f) DECLARED(f) DECLARED(jac_##f) DECLARED(fwd1_##f) DECLARED(adj1_##f)

WITH_DERIVATIVES(inverse_dynamics)
WITH_DERIVATIVES(forward_dynamics)
WITH_DERIVATIVES(gravity_torques)
WITH_DERIVATIVES(bias_torques)
DECLARED(jac_adj1_inverse_dynamics)

static int compared = 0;

static void expect(const char *what, double found, double expected)
{
    const double size = (expected < 0 ? -expected : expected) + 1;
    const double difference = found < expected ? expected - found : found - expected;
    compared++;
    if (!(difference <= 1e-12 * size)) {
        printf("%s: %.17g, not %.17g\n", what, found, expected);
    }
}

static void is_text(const char *found, const char *expected)
{
    compared++;
    if ((found == 0) != (expected == 0) || (found && strcmp(found, expected) != 0)) {
        printf("%s, not %s\n", found ? found : "nothing", expected ? expected : "nothing");
    }
}

// Row, column and presence of the elements of compressed columns, spread to a full matrix.
static void spread(const integer *pattern, const double *from, double to[N][N])
{
    memset(to, 0, sizeof(double[N][N]));
    for (int column = 0; column < N; column++) {
        const int is_dense = pattern[2] == 1;
        const integer first = is_dense ? 0 : pattern[2 + column], last = is_dense ? N : pattern[3 + column];
        for (integer index = first; index < last; index++) {
            to[is_dense ? index : pattern[3 + N + index]][column] = *from++;
        }
    }
}

typedef int evaluated(const double **arg, double **res, integer *iw, double *w, int mem);

typedef struct {
    const char *name;
    int inputs;
    evaluated *value, *jacobian, *forward, *reverse;
    const integer *(*pattern)(integer i);
} function;

// A function at a state; `by` are the derivatives by each input, row by row.
static void check(const function *f, const double *at[3], const double expected[N], double by[3][N][N])
{
    double seeds[3][N], multipliers[N], guard[N * N], store[3][N * N], result[N];
    for (int i = 0; i < N; i++) {
        multipliers[i] = 0.3 - 0.1 * i;
        for (int input = 0; input < 3; input++) {
            seeds[input][i] = 0.2 * (input + 1) - 0.05 * i;
        }
    }
    const double *arg[8] = {0};
    double *res[8] = {0};
    for (int i = 0; i < f->inputs; i++) {
        arg[i] = at[i];
    }
    f->value(arg, res, 0, 0, 0);
    res[0] = result;
    f->value(arg, res, 0, 0, 0);
    for (int i = 0; i < N; i++) {
        expect(f->name, result[i], expected[i]);
    }

    // each block alone, then all of them
    for (int asked = 0; asked <= f->inputs; asked++) {
        for (int i = 0; i < f->inputs; i++) {
            res[i] = asked == i || asked == f->inputs ? store[i] : 0;
            for (int k = 0; k < N * N; k++) {
                store[i][k] = guard[k] = -77;
            }
        }
        f->jacobian(arg, res, 0, 0, 0);
        for (int i = 0; i < f->inputs; i++) {
            if (!res[i]) {
                compared++;
                if (memcmp(store[i], guard, sizeof guard) != 0) {
                    printf("%s: block %d was written\n", f->name, i);
                }
                continue;
            }
            double full[N][N];
            spread(f->pattern(i), store[i], full);
            for (int k = 0; k < N * N; k++) {
                expect(f->name, full[k / N][k % N], by[i][k / N][k % N]);
            }
        }
    }

    // each direction alone, then all of them
    for (int asked = 0; asked <= f->inputs; asked++) {
        double sum[N] = {0};
        for (int i = 0; i < f->inputs; i++) {
            const int is_there = asked == i || asked == f->inputs;
            arg[f->inputs + 1 + i] = is_there ? seeds[i] : 0;
            for (int k = 0; is_there && k < N * N; k++) {
                sum[k / N] += by[i][k / N][k % N] * seeds[i][k % N];
            }
        }
        res[0] = result;
        f->forward(arg, res, 0, 0, 0);
        for (int i = 0; i < N; i++) {
            expect(f->name, result[i], sum[i]);
        }
    }
    res[0] = 0;
    f->forward(arg, res, 0, 0, 0);

    for (int asked = 0; asked <= f->inputs; asked++) {
        for (int i = 0; i < f->inputs; i++) {
            res[i] = asked == i || asked == f->inputs ? store[i] : 0;
        }
        arg[f->inputs + 1] = multipliers;
        f->reverse(arg, res, 0, 0, 0);
        for (int i = 0; i < f->inputs; i++) {
            for (int column = 0; res[i] && column < N; column++) {
                double sum = 0;
                for (int row = 0; row < N; row++) {
                    sum += multipliers[row] * by[i][row][column];
                }
                expect(f->name, res[i][column], sum);
            }
        }
    }
    arg[f->inputs + 1] = 0;
    f->reverse(arg, res, 0, 0, 0);
    for (int column = 0; column < N; column++) {
        expect(f->name, res[0][column], 0);
    }
}

// The second derivatives of the torques: blocks of the Hessian and of the Jacobian; each alone, then all of them.
static void check_second(const double *at[3], const double *given[3], double by[3][N][N])
{
    double multipliers[N], store[15][N * N], full[N][N];
    const double *arg[8] = {given[0], given[1], given[2], 0, multipliers, 0, 0, 0};
    double *res[15];
    arm_hessian twice;
    for (int i = 0; i < N; i++) {
        multipliers[i] = 0.3 - 0.1 * i;
    }
    arm_torque_hessian(at[0], at[1], at[2], multipliers, &twice);
    for (int asked = 0; asked <= 15; asked++) {
        for (int k = 0; k < 15; k++) {
            res[k] = asked == k || asked == 15 ? store[k] : 0;
        }
        jac_adj1_inverse_dynamics(arg, res, 0, 0, 0);
        for (int k = 0; k < 15; k++) {
            if (!res[k]) {
                continue;
            }
            spread(jac_adj1_inverse_dynamics_sparsity_out(k), store[k], full);
            for (int i = 0; i < N; i++) {
                for (int j = 0; j < N; j++) {
                    const double expected = k % 5 == 4 ? by[k / 5][j][i]
                        : k == 0 ? twice.dq_dq[i][j] : k == 1 ? twice.dq_dqd[i][j] : k == 2 ? twice.dq_dqdd[i][j]
                        : k == 5 ? twice.dq_dqd[j][i] : k == 6 ? twice.dqd_dqd[i][j] : k == 10 ? twice.dq_dqdd[j][i]
                        : 0;
                    expect("jac_adj1_inverse_dynamics", full[i][j], expected);
                }
            }
        }
    }
}

#define FUNCTION(f, inputs) {#f, inputs, f, jac_##f, fwd1_##f, adj1_##f, jac_##f##_sparsity_out}

// Without `q` or without velocities they are zero.
static void check_state(const double *q, const double *qd, const double *qdd)
{
    static const double zeros[N] = {0};
    const double *full[3] = {q ? q : zeros, qd ? qd : zeros, qdd ? qdd : zeros};
    const double *given[3] = {q, qd, qdd};
    double tau[N], by[3][N][N];
    arm_torque_derivatives of_torques;

    const function inverse = FUNCTION(inverse_dynamics, 3);
    arm_inverse_dynamics(full[0], full[1], full[2], tau);
    arm_inverse_dynamics_derivatives(full[0], full[1], full[2], &of_torques);
    memcpy(by[0], of_torques.dq, sizeof by[0]);
    memcpy(by[1], of_torques.dqd, sizeof by[1]);
    arm_mass_matrix(full[0], by[2]);
    check(&inverse, given, tau, by);
    check_second(full, given, by);

    const function bias = FUNCTION(bias_torques, 2);
    arm_inverse_dynamics(full[0], full[1], zeros, tau);
    arm_inverse_dynamics_derivatives(full[0], full[1], zeros, &of_torques);
    memcpy(by[0], of_torques.dq, sizeof by[0]);
    memcpy(by[1], of_torques.dqd, sizeof by[1]);
    check(&bias, given, tau, by);

    const function gravity = FUNCTION(gravity_torques, 1);
    arm_inverse_dynamics(full[0], zeros, zeros, tau);
    arm_inverse_dynamics_derivatives(full[0], zeros, zeros, &of_torques);
    memcpy(by[0], of_torques.dq, sizeof by[0]);
    check(&gravity, given, tau, by);

    const function forward = FUNCTION(forward_dynamics, 3);
    arm_acceleration_derivatives of_accelerations;
    arm_forward_dynamics(full[0], full[1], full[2], tau);
    arm_forward_dynamics_derivatives(full[0], full[1], full[2], &of_accelerations);
    memcpy(by[0], of_accelerations.dq, sizeof by[0]);
    memcpy(by[1], of_accelerations.dqd, sizeof by[1]);
    memcpy(by[2], of_accelerations.dtau, sizeof by[2]);
    check(&forward, given, tau, by);
}

int main(void)
{
    double q[N], qd[N], qdd[N];
    for (int i = 0; i < N; i++) {
        q[i] = 0.4 - 0.3 * i;
        qd[i] = 0.7 - 0.2 * i;
        qdd[i] = 0.1 + 0.15 * i;
    }
    check_state(q, qd, qdd);
    check_state(q, 0, qdd);
    check_state(q, qd, 0);
    check_state(0, qd, qdd);

    static const char *const in[] = {"q", "qd", "tau", "out_qdd", "adj_qdd", 0};
    static const char *const out[] = {"adj_q", "adj_qd", "adj_tau", 0};
    for (int i = 0; i < 6; i++) {
        is_text(adj1_forward_dynamics_name_in(i), in[i]);
    }
    for (int i = 0; i < 4; i++) {
        is_text(adj1_forward_dynamics_name_out(i), out[i]);
    }
    is_text(adj1_forward_dynamics_name_in(-1), 0);
    is_text(jac_inverse_dynamics_name_out(2), "jac_tau_qdd");
    is_text(fwd1_inverse_dynamics_name_in(6), "fwd_qdd");
    integer sizes[4] = {-1, -1, -1, -1};
    fwd1_inverse_dynamics_work(&sizes[0], &sizes[1], &sizes[2], &sizes[3]);
    expect("sizes", (double)(sizes[0] * 1000 + sizes[1] * 100 + sizes[2] * 10 + sizes[3]), 7100);
    expect("sizes", (double)(jac_gravity_torques_n_in() * 10 + jac_gravity_torques_n_out()), 21);
    const integer *absent = jac_inverse_dynamics_sparsity_in(3);
    expect("absent", (double)(absent[0] * 1000 + absent[1] * 100 + absent[2] * 10 + absent[3]), N * 1000 + 100);
    printf("%d numbers\n", compared);
    return 0;
}
