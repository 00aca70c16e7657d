
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
