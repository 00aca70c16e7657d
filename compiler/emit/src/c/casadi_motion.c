
// to = row * matrix
static void PREFIX_multiply_row(const casadi_real row[DOF], casadi_real matrix[DOF][DOF], casadi_real *to)
{
    for (int column = 0; to && column < DOF; column++) {
        to[column] = row[0] * matrix[0][column];
        for (int index = 1; index < DOF; index++) {
            to[column] += row[index] * matrix[index][column];
        }
    }
}

// The second derivatives of the accelerations times multipliers λ by (q, q), (q, q̇), (q, τ) and (q̇, q̇); those by
// (q̇, τ) and (τ, τ) are zero. With q, q̇, τ → q, q̇, q̈ they are less those of the torques times λᵀ M⁻¹.
static void PREFIX_second_of_motion(
    const casadi_real q[DOF], const casadi_real qd[DOF], const casadi_real qdd[DOF],
    PREFIX_acceleration_derivatives *by, const casadi_real multipliers[DOF], casadi_real second[4][DOF][DOF])
{
    casadi_real of_torques[DOF];
    PREFIX_hessian twice;
    PREFIX_multiply_row(multipliers, by->dtau, of_torques);
    PREFIX_torque_hessian(q, qd, qdd, of_torques, &twice);
    for (int row = 0; row < DOF; row++) {
        for (int column = 0; column < DOF; column++) {
            casadi_real sums[3] = {twice.dq_dq[row][column], twice.dq_dqd[row][column], 0};
            for (int index = 0; index < DOF; index++) {
                sums[0] += twice.dq_dqdd[row][index] * by->dq[index][column];
                sums[0] += twice.dq_dqdd[column][index] * by->dq[index][row];
                sums[1] += twice.dq_dqdd[row][index] * by->dqd[index][column];
                sums[2] += twice.dq_dqdd[row][index] * by->dtau[index][column];
            }
            second[0][row][column] = -sums[0];
            second[1][row][column] = -sums[1];
            second[2][row][column] = -sums[2];
            second[3][row][column] = -twice.dqd_dqd[row][column];
        }
    }
}
// next function
    const casadi_real *q = PREFIX_given(arg[0]), *qd = PREFIX_given(arg[1]), *tau = PREFIX_given(arg[2]);
    PREFIX_acceleration_derivatives by;
    casadi_real qdd[DOF], second[4][DOF][DOF];
    PREFIX_forward_dynamics(q, qd, tau, qdd);
    PREFIX_forward_dynamics_derivatives(q, qd, tau, &by);
    PREFIX_second_of_motion(q, qd, qdd, &by, PREFIX_given(arg[4]), second);
