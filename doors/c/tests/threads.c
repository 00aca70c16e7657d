/* Sixteen threads, one arm, which none of them has used before: every result has the same bits. So have the rows of a
 * batch that the library computes in sixteen threads of its own. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <rne.h>

enum { THREADS = 16, CALLS = 200 };
static const char *const NAMES[] = {"inverse_dynamics", "bias_torques", "mass_matrix", "jacobian"};
enum { FUNCTIONS = sizeof NAMES / sizeof *NAMES };

static rne_arm *arm;
static double results[THREADS][FUNCTIONS][36];

static void *work(void *place) {
  double(*mine)[36] = place;
  const double row[6] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const rne_input inputs[] = {{"q", row, 6, 0, 0}, {"qd", row, 6, 0, 0}, {"qdd", row, 6, 0, 0}};
  for (int call = 0; call < CALLS; call++) {
    for (int function = 0; function < FUNCTIONS; function++) {
      uint32_t id;
      size_t outputs;
      if (rne_function_find(NAMES[function], &id) != RNE_STATUS_OK) return "find";
      if (rne_function_outputs(arm, id, &outputs) != RNE_STATUS_OK) return "outputs";
      if (rne_evaluate(arm, id, inputs, 3, mine[function], outputs) != RNE_STATUS_OK) return "evaluate";
      if (call % 50 == 0 && rne_evaluate(arm, id, inputs, 3, mine[function], 0) != RNE_STATUS_WRONG_SIZE) return "room";
    }
  }
  return strstr(rne_last_error(), "0 were given") ? NULL : "the words of another thread";
}

int main(void) {
  pthread_t threads[THREADS];
  if (rne_arm_builtin("puma560", &arm) != RNE_STATUS_OK) return 1;
  for (int t = 0; t < THREADS; t++)
    if (pthread_create(&threads[t], NULL, work, results[t]) != 0) return 1;
  for (int t = 0; t < THREADS; t++) {
    void *why = NULL;
    pthread_join(threads[t], &why);
    if (why) return fprintf(stderr, "thread %d: %s: %s\n", t, (const char *)why, rne_last_error());
    if (memcmp(results[t], results[0], sizeof results[0]) != 0) return fprintf(stderr, "thread %d differs\n", t);
  }
  enum { STATES = 40000 };
  static double rows[STATES][6], expected[STATES][6], found[STATES][6];
  for (int s = 0; s < STATES; s++)
    for (int joint = 0; joint < 6; joint++) rows[s][joint] = 0.001 * ((7 * s + joint) % 1000);
  const rne_input inputs[] = {{"q", rows[0], 6 * STATES, 6, 0}, {"qd", rows[1], 6, 0, 0}};
  uint32_t id;
  if (rne_function_find("bias_torques", &id) != RNE_STATUS_OK) return 1;
  if (rne_evaluate_batch(arm, id, STATES, inputs, 2, expected[0], 6 * STATES) != RNE_STATUS_OK) return 1;
  if (rne_evaluate_batch_threads(arm, id, THREADS, STATES, inputs, 2, found[0], 6 * STATES) != RNE_STATUS_OK)
    return fprintf(stderr, "batch: %s\n", rne_last_error());
  if (memcmp(found, expected, sizeof expected) != 0) return fprintf(stderr, "a batch differs\n");
  rne_arm_free(arm);
  printf("%d threads, %d calls each: the same bits\n", THREADS, CALLS * FUNCTIONS);
  return 0;
}
