/* Gravity and Coriolis compensation as a controller has it: what a ROS 2 controller does in on_configure, on_activate and
 * update, or a Simulink S-function in mdlStart, its first mdlOutputs and mdlOutputs.
 *
 *     cc controller.c $(pkg-config --cflags --libs rne) -o controller && ./controller puma560.yaml
 *
 * Without a file it takes the PUMA 560 of the box. */
#include <stdio.h>
#include <string.h>
#include <rne.h>

enum { MOST_JOINTS = 16 };

/* All that a controller keeps. `q` and `qd` are written by whoever reads the encoders. */
typedef struct controller {
  rne_arm *arm;
  uint32_t bias;
  size_t dof;
  double q[MOST_JOINTS], qd[MOST_JOINTS], tau[MOST_JOINTS];
  double effort[MOST_JOINTS];
  rne_input inputs[2];
} controller;

/* Reads and compiles: tens of milliseconds, files, memory. Not in the control loop. 0, or why not is on stderr. */
static int controller_configure(controller *self, const char *path) {
  memset(self, 0, sizeof *self);
  rne_status status = path ? rne_arm_load_file(path, &self->arm) : rne_arm_builtin("puma560", &self->arm);
  if (status != RNE_STATUS_OK) goto failed;
  self->dof = rne_arm_dof(self->arm);
  if (self->dof > MOST_JOINTS) {
    fprintf(stderr, "%s has %zu joints, more than %d\n", rne_arm_name(self->arm), self->dof, MOST_JOINTS);
    return 1;
  }
  for (size_t joint = 0; joint < self->dof; joint++) {
    rne_limits limits;
    if ((status = rne_arm_joint_limits(self->arm, joint, &limits)) != RNE_STATUS_OK) goto failed;
    self->effort[joint] = limits.effort;
  }
  if ((status = rne_function_find("bias_torques", &self->bias)) != RNE_STATUS_OK) goto failed;
  if ((status = rne_function_prepare(self->arm, self->bias)) != RNE_STATUS_OK) goto failed;
  self->inputs[0] = (rne_input){.name = "q", .data = self->q, .count = self->dof};
  self->inputs[1] = (rne_input){.name = "qd", .data = self->qd, .count = self->dof};
  return 0;
failed:
  fprintf(stderr, "status %d: %s\n", (int)status, rne_last_error());
  return 1;
}

/* One call: no allocation, no lock, no system call, once this thread has called it before. */
static rne_status controller_update(controller *self) {
  rne_status status = rne_evaluate(self->arm, self->bias, self->inputs, 2, self->tau, self->dof);
  if (status != RNE_STATUS_OK) return status;
  for (size_t joint = 0; joint < self->dof; joint++) {
    const double most = self->effort[joint];
    if (self->tau[joint] > most) self->tau[joint] = most;
    if (self->tau[joint] < -most) self->tau[joint] = -most;
  }
  return RNE_STATUS_OK;
}

/* In the thread of the control loop, before it starts: what the thread keeps is allocated here. */
static rne_status controller_activate(controller *self) { return controller_update(self); }

static void controller_cleanup(controller *self) {
  rne_arm_free(self->arm);
  self->arm = NULL;
}

int main(int count, char **arguments) {
  static controller self;
  if (controller_configure(&self, count > 1 ? arguments[1] : NULL) != 0) {
    controller_cleanup(&self);
    return 1;
  }
  if (controller_activate(&self) != RNE_STATUS_OK) {
    fprintf(stderr, "%s\n", rne_last_error());
    controller_cleanup(&self);
    return 1;
  }
  /* A second of a loop at 1 kHz, along a line of joint positions. */
  double largest = 0;
  for (int tick = 0; tick < 1000; tick++) {
    for (size_t joint = 0; joint < self.dof; joint++) {
      self.q[joint] = 0.001 * tick;
      self.qd[joint] = 1;
    }
    if (controller_update(&self) != RNE_STATUS_OK) break; /* a real one holds its brakes */
    for (size_t joint = 0; joint < self.dof; joint++) {
      const double size = self.tau[joint] < 0 ? -self.tau[joint] : self.tau[joint];
      if (size > largest) largest = size;
    }
  }
  printf("%s: largest torque %.4f N m\n", rne_arm_name(self.arm), largest);
  controller_cleanup(&self);
  return 0;
}
