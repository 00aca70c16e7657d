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
// next function
    const casadi_real *x = arg[0], *qd = x ? x + DOF : PREFIX_zeros, *multipliers = arg[3];
    const casadi_real *of_qdd = multipliers ? multipliers + DOF : PREFIX_zeros;
    PREFIX_acceleration_derivatives by;
    casadi_real qdd[DOF], second[4][DOF][DOF], moved[3 * DOF][3 * DOF], product[3 * DOF];
    casadi_real *to = res[1];
    PREFIX_forward_dynamics_derivatives(PREFIX_given(x), qd, PREFIX_given(arg[4]), &by);
    if (res[0]) {
        PREFIX_multiply_row(of_qdd, by.dq, res[0]);
        PREFIX_multiply_row(of_qdd, by.dqd, res[0] + DOF);
        PREFIX_multiply_row(of_qdd, by.dtau, res[0] + 2 * DOF);
        for (int row = 0; multipliers && row < DOF; row++) {
            res[0][DOF + row] += multipliers[row];
        }
    }
    if (!to) {
        return 0;
    }
    PREFIX_forward_dynamics(PREFIX_given(x), qd, PREFIX_given(arg[4]), qdd);
    PREFIX_second_of_motion(PREFIX_given(x), qd, qdd, &by, of_qdd, second);
    for (int column = 0; column < 3 * DOF; column++) {
        const int is_of_u = column >= 2 * DOF, at = is_of_u ? column - 2 * DOF : column;
        const casadi_real *from = arg[is_of_u ? 2 : 1];
        from = from ? from + 2 * DOF * at : 0;
        PREFIX_copy(from ? from : PREFIX_zeros, moved[column]);
        PREFIX_copy(from ? from + DOF : PREFIX_zeros, moved[column] + DOF);
        for (int row = 0; row < DOF; row++) {
            moved[column][2 * DOF + row] = is_of_u && row == at ? 1 : 0;
        }
    }
    for (int column = 0; column < 3 * DOF; column++) {
        const casadi_real *from = moved[column];
        PREFIX_multiply_row(from, second[0], product);
        PREFIX_add(second[1], from + DOF, product);
        PREFIX_add(second[2], from + 2 * DOF, product);
        PREFIX_multiply_row(from, second[1], product + DOF);
        PREFIX_add(second[3], from + DOF, product + DOF);
        PREFIX_multiply_row(from, second[2], product + 2 * DOF);
        // the lower triangle, column by column
        for (int row = column; row < 3 * DOF; row++) {
            *to = 0;
            for (int index = 0; index < 3 * DOF; index++) {
                *to += moved[row][index] * product[index];
            }
            to++;
        }
    }
