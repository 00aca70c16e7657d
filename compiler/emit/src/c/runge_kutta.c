// x + h times what changes it.
static void PREFIX_moved(const REAL x[DOF], const REAL change[DOF], const REAL step, REAL moved[DOF])
{
    for (int i = 0; i < DOF; i++) {
        moved[i] = x[i] + (step * change[i]);
    }
}

// The four states at which the method has the accelerations, and the accelerations at the first three of them.
static void PREFIX_stages(
    const REAL q[DOF], const REAL qd[DOF], const REAL tau[DOF], const REAL step, TAKENPREFIX_next_state states[4],
    REAL qdd[3][DOF])
{
    const REAL durations[3] = {HALF * step, HALF * step, step};
    for (int i = 0; i < DOF; i++) {
        states[0].q[i] = q[i];
        states[0].qd[i] = qd[i];
    }
    for (int stage = 0; stage < 3; stage++) {
        PREFIX_forward_dynamics(states[stage].q, states[stage].qd, tauGIVEN, qdd[stage]);
        PREFIX_moved(q, states[stage].qd, durations[stage], states[stage + 1].q);
        PREFIX_moved(qd, qdd[stage], durations[stage], states[stage + 1].qd);
    }
}

HEAD_OF_STEP
{
    const REAL sixth = step / SIX;
    PREFIX_next_state states[4];
    REAL qdd[4][DOF];
    PREFIX_stages(q, qd, tau, step, PASSEDstates, qdd);
    PREFIX_forward_dynamics(states[3].q, states[3].qd, tauGIVEN, qdd[3]);
    for (int i = 0; i < DOF; i++) {
        const REAL middle = qdd[1][i] + qdd[2][i];
        const REAL mean = states[0].qd[i] + ((qdd[0][i] + middle) * sixth);
        next->q[i] = states[0].q[i] + (step * mean);
        next->qd[i] = states[0].qd[i] + (((qdd[0][i] + (middle + middle)) + qdd[3][i]) * sixth);
    }
}
// the derivatives
// The derivatives of the accelerations at a state by one of the step's arguments. `own` are those at the state, `block`
// those by this argument. The velocities of the state are those of the step and `duration` times the accelerations
// `before`. Its positions are those of the step and `duration` times the velocities of the state before, which change
// by `part` times the accelerations `earlier`.
static void PREFIX_chain(
    PREFIX_acceleration_derivatives *own, REAL block[DOF][DOF], const int is_by_rates, const REAL duration,
    REAL before[DOF][DOF], const REAL part, REAL earlier[DOF][DOF], REAL found[DOF][DOF])
{
    for (int i = 0; i < DOF; i++) {
        for (int j = 0; j < DOF; j++) {
            REAL change = is_by_rates ? own->dq[i][j] : ZERO;
            for (int k = 0; k < DOF; k++) {
                change = change + (own->dqd[i][k] * before[k][j]);
                if (earlier) {
                    change = change + ((own->dq[i][k] * part) * earlier[k][j]);
                }
            }
            found[i][j] = block[i][j] + (duration * change);
        }
    }
}

// The derivatives of the next positions and velocities by one of the step's arguments, from those of the accelerations
// at the four states.
static void PREFIX_weigh(
    REAL first[DOF][DOF], REAL second[DOF][DOF], REAL third[DOF][DOF], REAL fourth[DOF][DOF], const REAL step,
    const int is_by_positions, const int is_by_rates, REAL positions[DOF][DOF], REAL rates[DOF][DOF])
{
    const REAL sixth = step / SIX;
    for (int i = 0; i < DOF; i++) {
        for (int j = 0; j < DOF; j++) {
            const REAL one = (i == j) ? ONE : ZERO;
            const REAL middle = second[i][j] + third[i][j];
            const REAL mean = ((first[i][j] + middle) * sixth) + (is_by_rates ? one : ZERO);
            rates[i][j] = (((first[i][j] + (middle + middle)) + fourth[i][j]) * sixth) + (is_by_rates ? one : ZERO);
            positions[i][j] = (step * mean) + (is_by_positions ? one : ZERO);
        }
    }
}

HEAD_OF_DERIVATIVES
{
    const REAL half = HALF * step;
    const REAL durations[4] = {ZERO, half, half, step};
    PREFIX_next_state states[4];
    PREFIX_acceleration_derivatives by[4];
    PREFIX_acceleration_derivatives own;
    REAL qdd[3][DOF];
    PREFIX_stages(q, qd, tau, step, PASSEDstates, qdd);
    PREFIX_forward_dynamics_derivatives(q, qd, tauGIVEN, &by[0]);
    for (int stage = 1; stage < 4; stage++) {
        PREFIX_acceleration_derivatives *const last = &by[stage - 1];
        PREFIX_acceleration_derivatives *const earlier = (stage == 1) ? 0 : &by[stage - 2];
        PREFIX_forward_dynamics_derivatives(states[stage].q, states[stage].qd, tauGIVEN, &own);
        PREFIX_chain(
            &own, own.dq, 0, durations[stage], last->dq, half, earlier ? earlier->dq : 0, by[stage].dq);
        PREFIX_chain(
            &own, own.dqd, 1, durations[stage], last->dqd, half, earlier ? earlier->dqd : 0, by[stage].dqd);
        PREFIX_chain(
            &own, own.dtau, 0, durations[stage], last->dtau, half, earlier ? earlier->dtau : 0, by[stage].dtau);
    }
    PREFIX_weigh(by[0].dq, by[1].dq, by[2].dq, by[3].dq, step, 1, 0, derivatives->q.dq, derivatives->qd.dq);
    PREFIX_weigh(by[0].dqd, by[1].dqd, by[2].dqd, by[3].dqd, step, 0, 1, derivatives->q.dqd, derivatives->qd.dqd);
    PREFIX_weigh(
        by[0].dtau, by[1].dtau, by[2].dtau, by[3].dtau, step, 0, 0, derivatives->q.dtau, derivatives->qd.dtau);
}
