/* A child of fork after batches in threads: it computes the bits of its parent, alone and in threads of its own. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <rne.h>

enum { STATES = 40000 };
static double rows[STATES][6], expected[STATES][6], found[STATES][6];
static rne_arm *arm;

/* 0, or which call is another one in this process. */
static int differs(uint32_t id) {
  const rne_input inputs[] = {{"q", rows[0], 6 * STATES, 6, 0}, {"qd", rows[1], 6, 0, 0}};
  for (size_t threads = 0; threads < 4; threads++) {
    memset(found, 0xff, sizeof found);
    if (rne_evaluate_batch_threads(arm, id, threads, STATES, inputs, 2, found[0], 6 * STATES) != RNE_STATUS_OK) return 1;
    if (memcmp(found, expected, sizeof expected) != 0) return 2;
  }
  memset(found, 0xff, sizeof found);
  if (rne_evaluate_batch(arm, id, STATES, inputs, 2, found[0], 6 * STATES) != RNE_STATUS_OK) return 3;
  if (memcmp(found, expected, sizeof expected) != 0) return 4;
  return 0;
}

int main(void) {
  uint32_t id;
  for (int s = 0; s < STATES; s++)
    for (int joint = 0; joint < 6; joint++) rows[s][joint] = 0.001 * ((7 * s + joint) % 1000);
  const rne_input inputs[] = {{"q", rows[0], 6 * STATES, 6, 0}, {"qd", rows[1], 6, 0, 0}};
  if (rne_arm_builtin("puma560", &arm) != RNE_STATUS_OK) return 1;
  if (rne_function_find("bias_torques", &id) != RNE_STATUS_OK) return 1;
  if (rne_evaluate_batch(arm, id, STATES, inputs, 2, expected[0], 6 * STATES) != RNE_STATUS_OK) return 1;
  if (differs(id) != 0) return fprintf(stderr, "the parent: %s\n", rne_last_error());
  pid_t child = fork();
  if (child < 0) return 1;
  if (child == 0) {
    alarm(300); /* a child that waits for ever is ended by a signal, and has no status 0 */
    int which = differs(id);
    rne_arm_free(arm);
    return which;
  }
  int status = -1;
  if (waitpid(child, &status, 0) != child) return 1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return fprintf(stderr, "the child: status %d\n", status);
  rne_arm_free(arm);
  printf("a child of fork: the same bits\n");
  return 0;
}
