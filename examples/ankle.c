/* An ankle that two rods drive: the torques of its two motors, and how they map to pitch and roll of the foot.
 *
 *     rne emit benches/trees/loops/g1_ankle.yaml --lang c --real double -o g1_ankle.c --function \
 *         closure_step,loop_map,inverse_dynamics_of_loops
 *     cc -I. examples/ankle.c g1_ankle.c -o ankle -lm */
#include <math.h>
#include <stdio.h>

#include "g1_ankle.h"

enum { MOTORS = G1_ANKLE_DOF, PASSIVE = G1_ANKLE_PASSIVE, EQUATIONS = 6, STEPS = 5 };

int main(void) {
  const double q[MOTORS] = {0.15, -0.1}, qd[MOTORS] = {1.2, -0.8}, qdd[MOTORS] = {3.0, 5.0};

  /* The positions of the dependent joints, from a guess. The last step has the residual of the one before it. */
  g1_ankle_closure closed = {{0}, {0}};
  for (int step = 0; step <= STEPS; step++) {
    double guess[PASSIVE];
    for (int joint = 0; joint < PASSIVE; joint++) guess[joint] = closed.passive[joint];
    g1_ankle_closure_step(q, guess, &closed);
  }
  double left = 0; /* m */
  for (int equation = 0; equation < EQUATIONS; equation++) left = fmax(left, fabs(closed.residual[equation]));
  printf("pitch %.4f rad, roll %.4f rad; %.0e m are left\n", closed.passive[G1_ANKLE_PASSIVE_PITCH],
         closed.passive[G1_ANKLE_PASSIVE_ROLL], left);

  double tau[MOTORS], map[PASSIVE][MOTORS]; /* N m */
  g1_ankle_inverse_dynamics_of_loops(q, closed.passive, qd, qdd, tau);
  g1_ankle_loop_map(q, closed.passive, map);
  printf("motors: %.3f and %.3f N m\n", tau[0], tau[1]);
  printf("10 N m about pitch ask %.2f and %.2f N m of the motors\n", 10 * map[G1_ANKLE_PASSIVE_PITCH][0],
         10 * map[G1_ANKLE_PASSIVE_PITCH][1]);
  return left < 1e-12 ? 0 : 1;
}
