// Motion in, torques out: there are no states, the result is tau.
enum { STATES = 0, RESULT = TAU, THIRD = QDD };

static void evaluate(double *v)
{
FILLED    PREFIX_inverse_dynamics_with_payload(v + Q, v + QD, v + QDD, v + PAYLOADVALUE_ARGUMENT, v + TAU);
}

static void derivatives(const double *v, Blocks blocks)
{
    PREFIX_torque_derivatives by;
FILLED    PREFIX_inverse_dynamics_derivatives_with_payload(
        v + Q, v + QD, v + QDD, v + PAYLOADDERIVATIVES_ARGUMENT, &by);
    memcpy(blocks[0], by.dq, sizeof by.dq);
    memcpy(blocks[1], by.dqd, sizeof by.dqd);
    PREFIX_mass_matrix_with_payload(v + Q, v + PAYLOADMASS_ARGUMENT, blocks[2]);
}

// Returns what is wrong with the inputs, or NULL. There is nothing to integrate.
static const char *integrate(double *v, double duration)
{
    const int is_finite = are_finite(v + Q, TAU - Q) && are_finite(v + PARAMETERS, COUNT - PARAMETERS);
    (void)duration;
    return is_finite ? NULL : "an input or a parameter is not finite";
}
