
static void PREFIX_copy(const casadi_real from[DOF], casadi_real *to)
{
    for (int row = 0; to && row < DOF; row++) {
        to[row] = from[row];
    }
}

// to = the elements of a matrix that the pattern has, column by column.
static void PREFIX_put(casadi_real from[DOF][DOF], const casadi_int *pattern, casadi_real *to)
{
    const int is_dense = pattern[2] == 1;
    for (int column = 0; to && column < DOF; column++) {
        const casadi_int first = is_dense ? 0 : pattern[2 + column];
        const casadi_int last = is_dense ? DOF : pattern[3 + column];
        for (casadi_int index = first; index < last; index++) {
            *to++ = from[is_dense ? index : pattern[3 + DOF + index]][column];
        }
    }
}

// to += matrix * vector
static void PREFIX_add(casadi_real matrix[DOF][DOF], const casadi_real *vector, casadi_real to[DOF])
{
    for (int row = 0; vector && row < DOF; row++) {
        for (int column = 0; column < DOF; column++) {
            to[row] += matrix[row][column] * vector[column];
        }
    }
}

// to = the elements of the transpose that the pattern has, column by column.
static void PREFIX_put_transposed(casadi_real from[DOF][DOF], const casadi_int *pattern, casadi_real *to)
{
    casadi_real transposed[DOF][DOF];
    for (int row = 0; row < DOF; row++) {
        for (int column = 0; column < DOF; column++) {
            transposed[column][row] = from[row][column];
        }
    }
    PREFIX_put(transposed, pattern, to);
}
