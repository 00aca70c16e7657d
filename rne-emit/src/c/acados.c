    const casadi_real *x = arg[0];
    if (res[0]) {
        PREFIX_copy(x ? x + DOF : PREFIX_zeros, res[0]);
        PREFIX_forward_dynamics(
            PREFIX_given(x), x ? x + DOF : PREFIX_zeros, PREFIX_given(arg[1]), res[0] + DOF);
    }
// next function
    const casadi_real *x = arg[0], *qd = x ? x + DOF : PREFIX_zeros;
    PREFIX_acceleration_derivatives by;
    if (res[0]) {
        PREFIX_copy(qd, res[0]);
        PREFIX_forward_dynamics(PREFIX_given(x), qd, PREFIX_given(arg[3]), res[0] + DOF);
    }
    if (!res[1] && !res[2]) {
        return 0;
    }
    PREFIX_forward_dynamics_derivatives(PREFIX_given(x), qd, PREFIX_given(arg[3]), &by);
    for (int column = 0; column < 3 * DOF; column++) {
        const int is_of_u = column >= 2 * DOF, at = is_of_u ? column - 2 * DOF : column;
        const casadi_real *from = arg[is_of_u ? 2 : 1];
        casadi_real *to = res[is_of_u ? 2 : 1];
        if (!to) {
            continue;
        }
        from = from ? from + 2 * DOF * at : 0;
        to += 2 * DOF * at;
        PREFIX_copy(from ? from + DOF : PREFIX_zeros, to);
        for (int row = 0; row < DOF; row++) {
            to[DOF + row] = is_of_u ? by.dtau[row][at] : 0;
        }
        PREFIX_add(by.dq, from, to + DOF);
        PREFIX_add(by.dqd, from ? from + DOF : 0, to + DOF);
    }
// next function
    const casadi_real *x = arg[0], *qd = x ? x + DOF : PREFIX_zeros, *multipliers = arg[1];
    const casadi_real *second = multipliers ? multipliers + DOF : PREFIX_zeros;
    PREFIX_acceleration_derivatives by;
    if (res[0]) {
        PREFIX_forward_dynamics_derivatives(PREFIX_given(x), qd, PREFIX_given(arg[2]), &by);
        PREFIX_multiply_row(second, by.dq, res[0]);
        PREFIX_multiply_row(second, by.dqd, res[0] + DOF);
        PREFIX_multiply_row(second, by.dtau, res[0] + 2 * DOF);
        for (int row = 0; multipliers && row < DOF; row++) {
            res[0][DOF + row] += multipliers[row];
        }
    }
