// Torques in, motion out: the states are q and qd, the result is qdd.
enum { STATES = 2 * N, RESULT = QDD, THIRD = TAU, STEP = PARAMETERS };

static void evaluate(double *v)
{
FILLED    PREFIX_forward_dynamics_with_payload(v + Q, v + QD, v + TAU, v + PAYLOADVALUE_ARGUMENT, v + QDD);
}

static void derivatives(const double *v, Blocks blocks)
{
    PREFIX_acceleration_derivatives by;
FILLED    PREFIX_forward_dynamics_derivatives_with_payload(
        v + Q, v + QD, v + TAU, v + PAYLOADDERIVATIVES_ARGUMENT, &by);
    memcpy(blocks[0], by.dq, sizeof by.dq);
    memcpy(blocks[1], by.dqd, sizeof by.dqd);
    memcpy(blocks[2], by.dtau, sizeof by.dtau);
}

// One step of the classical Runge-Kutta method of order 4 for q'' = f(q, q').
static void runge_kutta_step(double *v, double h)
{
    double q[N], qd[N], a[4][N];
    int i, stage;
    memcpy(q, v + Q, sizeof q);
    memcpy(qd, v + QD, sizeof qd);
    for (stage = 0; stage < 4; stage++) {
        const double part = (stage == 0) ? 0.0 : ((stage == 3) ? h : 0.5 * h);
        for (i = 0; i < N && stage > 0; i++) {
            const double before = (stage == 1) ? 0.0 : 0.5 * h * part * a[stage - 2][i];
            v[Q + i] = q[i] + part * qd[i] + before;
            v[QD + i] = qd[i] + part * a[stage - 1][i];
        }
        evaluate(v);
        memcpy(a[stage], v + QDD, sizeof a[stage]);
    }
    for (i = 0; i < N; i++) {
        v[Q + i] = q[i] + h * qd[i] + h * h / 6.0 * (a[0][i] + a[1][i] + a[2][i]);
        v[QD + i] = qd[i] + h / 6.0 * (a[0][i] + 2.0 * (a[1][i] + a[2][i]) + a[3][i]);
    }
}

// Equal steps that are not longer than the parameter `step`. Returns what is wrong, or NULL.
static const char *integrate(double *v, double duration)
{
    const double ratio = duration / v[STEP];
    long count, i;
    if (!(v[STEP] > 0.0)) {
        return "the parameter step is not above 0 s";
    }
    if (!(ratio < 1e9)) {
        return "the step is 1e9 times as long as the parameter step, or longer; give a shorter step";
    }
    count = (long)ratio;
    // a quotient that rounding makes larger than a whole number
    if (ratio - (double)count > 1e-9 * ratio) {
        count++;
    }
    for (i = 0; i < count; i++) {
        runge_kutta_step(v, duration / (double)count);
    }
    return are_finite(v + Q, STATES) ? NULL : "the motion does not stay finite during the step";
}
