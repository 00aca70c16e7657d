/* Torques of a PUMA 560: one state, a batch, and a mistake in a robot file.
 *
 *     cc torque.c $(pkg-config --cflags --libs rne) -o torque */
#include <stdio.h>
#include <rne.h>

/* Tells why a call failed. */
static int failed(const char *what) {
  fprintf(stderr, "%s: %s\n", what, rne_last_error());
  return 1;
}

int main(void) {
  rne_arm *arm;
  if (rne_arm_builtin("puma560", &arm) != RNE_STATUS_OK) return failed("puma560");
  printf("%s %s: %zu joints\n", rne_version(), rne_arm_name(arm), rne_arm_dof(arm));

  uint32_t torques;
  if (rne_function_find("inverse_dynamics", &torques) != RNE_STATUS_OK) return failed("inverse_dynamics");

  /* One state: rad, rad/s, rad/s^2 in, N m out. */
  const double q[6] = {0, 0.5, -0.5, 0, 1, 0}, qd[6] = {1, 1, 1, 1, 1, 1}, qdd[6] = {0};
  const rne_input state[] = {
      {.name = "q", .data = q, .count = 6},
      {.name = "qd", .data = qd, .count = 6},
      {.name = "qdd", .data = qdd, .count = 6},
  };
  double tau[6];
  if (rne_evaluate(arm, torques, state, 3, tau, 6) != RNE_STATUS_OK) return failed("one state");
  for (int joint = 0; joint < 6; joint++) printf("%s %9.4f N m\n", rne_arm_joint_name(arm, joint), tau[joint]);

  /* A thousand states: a row of q for each, velocities and accelerations the same for all. */
  enum { STATES = 1000 };
  static double many[STATES][6], results[STATES][6];
  for (int s = 0; s < STATES; s++)
    for (int joint = 0; joint < 6; joint++) many[s][joint] = q[joint] + 0.001 * s;
  const rne_input batch[] = {
      {.name = "q", .data = many[0], .count = 6 * STATES, .state_stride = 6},
      {.name = "qd", .data = qd, .count = 6},
      {.name = "qdd", .data = qdd, .count = 6},
  };
  if (rne_evaluate_batch(arm, torques, STATES, batch, 3, results[0], 6 * STATES) != RNE_STATUS_OK)
    return failed("batch");
  printf("state 999: %.4f N m at joint 2\n", results[999][1]);
  for (int joint = 0; joint < 6; joint++)
    if (results[0][joint] != tau[joint]) return fprintf(stderr, "the first row differs\n");
  rne_arm_free(arm);

  /* What is wrong with a robot file is said with line and column. */
  if (rne_arm_load_text("format: 1\nname: rod\njoints: 3\n", &arm) != RNE_STATUS_INVALID_FILE || arm != NULL)
    return failed("a wrong file was taken");
  printf("%s\n", rne_last_error());
  return 0;
}
