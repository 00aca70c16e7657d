
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
