
// The Jacobians of the positions and of the velocities after a step, each by q, qd and tau.
static void PREFIX_step_jacobians(
    const casadi_real q[DOF], const casadi_real qd[DOF], const casadi_real tau[DOF], casadi_real step,
    PREFIX_acceleration_derivatives *by, casadi_real jacobians[6][DOF][DOF])
{
    PREFIX_forward_dynamics_derivatives(q, qd, tau, by);
    for (int row = 0; row < DOF; row++) {
        for (int column = 0; column < DOF; column++) {
            const casadi_real unit = row == column ? 1 : 0;
            jacobians[3][row][column] = step * by->dq[row][column];
            jacobians[4][row][column] = unit + step * by->dqd[row][column];
            jacobians[5][row][column] = step * by->dtau[row][column];
            jacobians[0][row][column] = unit + step * jacobians[3][row][column];
            jacobians[1][row][column] = step * jacobians[4][row][column];
            jacobians[2][row][column] = step * jacobians[5][row][column];
        }
    }
}
// next function
    PREFIX_next_state next;
    PREFIX_euler_step(
        PREFIX_given(arg[0]), PREFIX_given(arg[1]), PREFIX_given(arg[2]), *PREFIX_given(arg[3]), &next);
    PREFIX_copy(next.q, res[0]);
    PREFIX_copy(next.qd, res[1]);
// next function
    const casadi_real *q = PREFIX_given(arg[0]), *qd = PREFIX_given(arg[1]), *tau = PREFIX_given(arg[2]);
    const casadi_real step = *PREFIX_given(arg[3]);
    PREFIX_acceleration_derivatives by;
    casadi_real jacobians[6][DOF][DOF], by_step[2][DOF];
    PREFIX_step_jacobians(q, qd, tau, step, &by, jacobians);
    PREFIX_forward_dynamics(q, qd, tau, by_step[1]);
    for (int row = 0; row < DOF; row++) {
        by_step[0][row] = qd[row] + 2 * step * by_step[1][row];
    }
// next function
    for (int output = 0; output < 2; output++) {
        casadi_real *to = res[output];
        for (int row = 0; to && row < DOF; row++) {
            to[row] = by_step[output][row] * *PREFIX_given(arg[9]);
        }
        for (int input = 0; to && input < 3; input++) {
            PREFIX_add(jacobians[3 * output + input], arg[6 + input], to);
        }
    }
// next function
    const casadi_real *of_q = PREFIX_given(arg[6]), *of_qd = PREFIX_given(arg[7]);
    for (int input = 0; input < 3; input++) {
        casadi_real of_velocities[DOF], *to = res[input];
        PREFIX_multiply_row(of_q, jacobians[input], to);
        PREFIX_multiply_row(of_qd, jacobians[3 + input], of_velocities);
        for (int row = 0; to && row < DOF; row++) {
            to[row] += of_velocities[row];
        }
    }
    if (res[3]) {
        *res[3] = 0;
        for (int row = 0; row < DOF; row++) {
            *res[3] += of_q[row] * by_step[0][row] + of_qd[row] * by_step[1][row];
        }
    }
// next function
    // the numbers after the step are step² or step times the accelerations, and what is linear
    const casadi_real *of_q = PREFIX_given(arg[6]), *of_qd = PREFIX_given(arg[7]);
    casadi_real multipliers[DOF], slopes[DOF], second[4][DOF][DOF];
    for (int row = 0; row < DOF; row++) {
        multipliers[row] = step * (step * of_q[row] + of_qd[row]);
        slopes[row] = 2 * step * of_q[row] + of_qd[row];
    }
    PREFIX_second_of_motion(q, qd, by_step[1], &by, multipliers, second);
    // by the duration, and the duration by q, qd and tau
    for (int by_adjoint = 0; by_adjoint < 2; by_adjoint++) {
        casadi_real *const *to = by_adjoint ? res + 24 : res;
        const int stride = by_adjoint ? 1 : 8, first = by_adjoint ? 0 : 3;
        PREFIX_multiply_row(slopes, by.dq, to[first]);
        PREFIX_multiply_row(slopes, by.dqd, to[first + stride]);
        PREFIX_multiply_row(slopes, by.dtau, to[first + 2 * stride]);
        for (int row = 0; to[first + stride] && row < DOF; row++) {
            to[first + stride][row] += of_q[row];
        }
    }
    if (res[27]) {
        *res[27] = 0;
        for (int row = 0; row < DOF; row++) {
            *res[27] += 2 * of_q[row] * by_step[1][row];
        }
    }
    PREFIX_copy(by_step[0], res[30]);
    PREFIX_copy(by_step[1], res[31]);
