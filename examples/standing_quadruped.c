/* HyQ stands on four feet: the torques that carry it, and the forces under its feet.
 *
 *     rne emit docs/standing_hyq.yaml --lang c --real double -o standing_hyq.c --function \
 *         inverse_dynamics_of_floating_base,centre_of_mass,tip_jacobians,forward_dynamics_in_contact
 *     cc -I. examples/standing_quadruped.c standing_hyq.c -o standing -lm */
#include <math.h>
#include <stdio.h>

#include "standing_hyq.h"

enum { JOINTS = STANDING_HYQ_DOF, FEET = 4 };

int main(void) {
  /* Hips level, knees bent; each leg is hip abduction, hip flexion, knee, rad. The trunk is level. */
  const double q[JOINTS] = {0, 0.75, -1.5, 0, -0.75, 1.5, 0, 0.75, -1.5, 0, -0.75, 1.5};
  const double rest[JOINTS] = {0}, zero[3] = {0}, gravity[3] = {0, 0, -9.81}, free[FEET][6] = {{0}};
  const double level[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  /* What carries the robot in the air: the weight, and the torques of the legs that hang. */
  standing_hyq_floating_torques hanging;
  standing_hyq_inverse_dynamics_of_floating_base(q, rest, rest, zero, zero, zero, gravity, free, &hanging);
  const double weight = hanging.wrench.force[2]; /* N */

  /* The feet share it by the lever rule. Row 2 of a Jacobian is z: the base that turns about x and y lifts the foot at
   * (x, y) by y and by -x. */
  double jacobians[FEET][6][6 + JOINTS], centre[3];
  standing_hyq_tip_jacobians(q, level, jacobians);
  standing_hyq_centre_of_mass(q, centre);
  const double x_front = -jacobians[0][2][4], x_hind = -jacobians[1][2][4];
  const double y_left = jacobians[0][2][3], y_right = jacobians[2][2][3];
  const double front = (centre[0] - x_hind) / (x_front - x_hind), left = (centre[1] - y_right) / (y_left - y_right);
  const double share[FEET] = {front * left, (1 - front) * left, front * (1 - left), (1 - front) * (1 - left)};
  double tau[JOINTS]; /* N m */
  for (int joint = 0; joint < JOINTS; joint++) {
    tau[joint] = hanging.tau[joint];
    for (int foot = 0; foot < FEET; foot++) tau[joint] -= jacobians[foot][2][6 + joint] * share[foot] * weight;
  }

  standing_hyq_accelerations_and_wrenches standing;
  standing_hyq_forward_dynamics_in_contact(q, rest, tau, zero, level, &standing);
  double sum = 0, fastest = 0;
  for (int foot = 0; foot < FEET; foot++) {
    const double *force = standing.wrenches_on_robot[foot].force; /* N, on the robot, in world axes */
    printf("foot %d: %.1f %.1f %.1f N\n", foot, force[0], force[1], force[2]);
    sum += force[2];
  }
  for (int joint = 0; joint < JOINTS; joint++) fastest = fmax(fastest, fabs(standing.accelerations.qdd[joint]));
  printf("weight %.3f N, under the feet %.3f N\n", weight, sum);
  printf("the fastest joint accelerates with %.0e rad/s^2\n", fastest);
  return fabs(sum - weight) < 1e-6 * weight && fastest < 1e-4 ? 0 : 1;
}
