/* The C library under hostile arguments. Arrays end where a page begins that nobody may touch, so that a number too far
 * is a fault. One argument names the part; every check that does not hold is a line, and the status is then 1. */
#include <math.h>
#include <pthread.h>
#include <rne.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { JOINTS = 6, PAGE = 4096 };

static int checks, failed;
static rne_arm *arm;
static uint32_t id;
static double q[JOINTS] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
static double zeros[JOINTS];

static void check(int holds, int line, const char *what) {
  checks++;
  if (!holds) {
    failed++;
    printf("line %d: %s: %s\n", line, what, rne_last_error());
  }
}
#define HOLDS(condition) check(condition, __LINE__, #condition)
#define OK(call) check((call) == RNE_STATUS_OK, __LINE__, #call)

/* A call with a wrong argument says so; it does not panic. */
static int is_refused(rne_status status) { return status != RNE_STATUS_OK && status != RNE_STATUS_PANIC; }
#define REFUSED(call) check(is_refused(call), __LINE__, #call)

/* Memory between two pages that nobody may touch; its end is where the second one begins. */
static void *at_end(size_t bytes) {
  size_t whole = (bytes + PAGE - 1) / PAGE * PAGE;
  char *place = mmap(NULL, whole + 2 * PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  mprotect(place, PAGE, PROT_NONE);
  mprotect(place + PAGE + whole, PAGE, PROT_NONE);
  return place + PAGE + whole - bytes;
}

static void give_back(void *place, size_t bytes) {
  size_t whole = (bytes + PAGE - 1) / PAGE * PAGE;
  munmap((char *)place + bytes - whole - PAGE, whole + 2 * PAGE);
}

/* Positions, velocities and accelerations of one state. */
static void state_of(rne_input in[3], double *positions) {
  in[0] = (rne_input){.name = "q", .data = positions, .count = JOINTS};
  in[1] = (rne_input){.name = "qd", .data = zeros, .count = JOINTS};
  in[2] = (rne_input){.name = "qdd", .data = zeros, .count = JOINTS};
}

static void no_arm(void) {
  rne_arm *other;
  REFUSED(rne_arm_builtin(NULL, &other));
  REFUSED(rne_arm_builtin("x", &other));
  REFUSED(rne_arm_builtin("\xff", &other));
  REFUSED(rne_arm_builtin("puma560", NULL));
  rne_arm_free(NULL);
  HOLDS(rne_arm_dof(NULL) == 0);
  HOLDS(rne_arm_name(NULL) == NULL);
  HOLDS(rne_arm_joint_name(NULL, 0) == NULL);
}

static void arms(void) {
  rne_joint_kind kind;
  rne_limits limits;
  size_t count;
  uint32_t other;
  const char *name;
  HOLDS(rne_arm_dof(arm) == JOINTS);
  HOLDS(rne_arm_joint_name(arm, JOINTS) == NULL);
  HOLDS(rne_arm_joint_name(arm, SIZE_MAX) == NULL);
  REFUSED(rne_arm_joint_kind(arm, JOINTS, &kind));
  REFUSED(rne_arm_joint_kind(arm, 0, NULL));
  REFUSED(rne_arm_joint_limits(arm, SIZE_MAX, &limits));
  REFUSED(rne_arm_joint_limits(NULL, 0, &limits));
  REFUSED(rne_function_find("x", &other));
  REFUSED(rne_function_find(NULL, &other));
  REFUSED(rne_function_find("inverse_dynamics", NULL));
  REFUSED(rne_function_outputs(arm, rne_function_count(), &count));
  REFUSED(rne_function_outputs(arm, UINT32_MAX, &count));
  REFUSED(rne_function_argument(arm, id, SIZE_MAX, &name, &count));
  OK(rne_function_argument(arm, id, 0, NULL, NULL));
  for (uint32_t function = 0; function < rne_function_count(); function++) {
    if (rne_function_prepare(arm, function) == RNE_STATUS_OK) continue;
    /* the arm has none of these */
    const char *const lacks[] = {"closed loops", "`floating_base`", "`contacts`"}, *error = rne_last_error();
    size_t i = 0;
    while (i < 3 && !strstr(error, lacks[i])) i++;
    if (i == 3) OK(rne_function_prepare(arm, function));
  }
  /* a place for a number that is not aligned */
  _Alignas(8) char memory[32];
  REFUSED(rne_function_outputs(arm, id, (size_t *)(memory + 1)));
  REFUSED(rne_function_find("inverse_dynamics", (uint32_t *)(memory + 1)));
}

static void arguments(void) {
  double tau[64];
  rne_input in[3];
  state_of(in, q);
  REFUSED(rne_evaluate(NULL, id, in, 3, tau, JOINTS));
  REFUSED(rne_evaluate(arm, UINT32_MAX, in, 3, tau, JOINTS));
  REFUSED(rne_evaluate(arm, id, in, 2, tau, JOINTS));
  REFUSED(rne_evaluate(arm, id, in, SIZE_MAX, tau, JOINTS));
  REFUSED(rne_evaluate(arm, id, NULL, 3, tau, JOINTS));
  REFUSED(rne_evaluate(arm, id, (rne_input *)1, 3, tau, JOINTS));
  REFUSED(rne_evaluate(arm, id, in, 3, NULL, JOINTS));
  const size_t counts[] = {0, 5, 7, SIZE_MAX, SIZE_MAX / 8};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) REFUSED(rne_evaluate(arm, id, in, 3, tau, counts[i]));
  /* results that are not aligned, overlap an input, or end beyond all memory */
  REFUSED(rne_evaluate(arm, id, in, 3, (double *)((char *)tau + 1), JOINTS));
  REFUSED(rne_evaluate(arm, id, in, 3, q, JOINTS));
  REFUSED(rne_evaluate(arm, id, in, 3, (double *)in, JOINTS));
  REFUSED(rne_evaluate(arm, id, in, 3, (double *)(UINTPTR_MAX - 7), JOINTS));
  double shared[JOINTS + 1] = {0};
  state_of(in, shared + 1);
  REFUSED(rne_evaluate(arm, id, in, 3, shared, JOINTS));
}

/* Each member of an input, wrong in each way. */
static void spoil(rne_input *in, int way) {
  switch (way) {
    case 0: in->name = NULL; break;
    case 1: in->name = "\xff"; break;
    case 2: in->name = "x"; break;
    case 3: in->name = "q"; break;
    case 4: in->name = ""; break;
    case 5: in->data = NULL; break;
    case 6: in->data = (double *)((char *)zeros + 4); break;
    case 7: in->count = 0; break;
    case 8: in->count = JOINTS - 1; break;
    case 9: in->count = SIZE_MAX; break;
    case 10: in->count = SIZE_MAX / 8; break;
    case 11: in->element_stride = 2; break;
    case 12: in->element_stride = SIZE_MAX; break;
    default: in->element_stride = SIZE_MAX / 5; break;
  }
}

static void inputs(void) {
  for (int way = 0; way < 14; way++) {
    double tau[JOINTS] = {1, 2, 3, 4, 5, 6}, before[JOINTS];
    rne_input in[3];
    state_of(in, q);
    spoil(&in[1], way);
    memcpy(before, tau, sizeof before);
    REFUSED(rne_evaluate(arm, id, in, 3, tau, JOINTS));
    REFUSED(rne_evaluate_batch(arm, id, 1, in, 3, tau, JOINTS));
    REFUSED(rne_evaluate_batch_threads(arm, id, 0, 1, in, 3, tau, JOINTS));
    HOLDS(memcmp(before, tau, sizeof before) == 0);
  }
}

static void strides(void) {
  double tau[64];
  rne_input in[3];
  state_of(in, q);
  /* one state has no next one, however far that is */
  in[1].state_stride = SIZE_MAX;
  OK(rne_evaluate(arm, id, in, 3, tau, JOINTS));
  REFUSED(rne_evaluate_batch(arm, id, 2, in, 3, tau, 2 * JOINTS));
  in[1].state_stride = SIZE_MAX / 2;
  REFUSED(rne_evaluate_batch(arm, id, 3, in, 3, tau, 3 * JOINTS));
  in[1].state_stride = 0;
  OK(rne_evaluate_batch(arm, id, 0, in, 3, NULL, 0));
  REFUSED(rne_evaluate_batch(arm, id, SIZE_MAX, in, 3, tau, JOINTS));
  REFUSED(rne_evaluate_batch(arm, id, SIZE_MAX / JOINTS + 1, in, 3, tau, 2));
  REFUSED(rne_evaluate_batch(arm, id, SIZE_MAX / JOINTS + 1, in, 3, tau, 0));
  REFUSED(rne_evaluate_batch_threads(arm, id, 4, SIZE_MAX / JOINTS + 1, in, 3, tau, 2));
  /* an input that the function does not take may have any strides: it is not read */
  enum { STATES = 20000 };
  double *rows = calloc(STATES * JOINTS, sizeof *rows), *out = malloc(STATES * JOINTS * sizeof *out);
  rne_input more[4];
  state_of(more, rows);
  more[0].count = STATES * JOINTS;
  more[0].state_stride = JOINTS;
  more[3] = (rne_input){.name = "tau", .data = zeros, .count = JOINTS};
  more[3].state_stride = SIZE_MAX / 2 + 3;
  more[3].element_stride = SIZE_MAX;
  rne_status status = rne_evaluate_batch_threads(arm, id, 2, STATES, more, 4, out, STATES * JOINTS);
  HOLDS(status == RNE_STATUS_OK || is_refused(status));
  free(rows);
  free(out);
}

/* One batch: state by state, every state apart, or element by element. */
static void batch(size_t states, int layout, size_t threads) {
  size_t apart = layout == 0 ? 7 : layout == 1 ? JOINTS : 1;
  size_t element = layout == 2 ? states : 1;
  size_t count = layout == 2 ? JOINTS * states : (states - 1) * apart + JOINTS;
  double *positions = at_end(count * sizeof *positions), *out = at_end(states * JOINTS * sizeof *out);
  for (size_t i = 0; i < count; i++) positions[i] = sin((double)i);
  rne_input in[3];
  state_of(in, positions);
  in[0].count = count;
  in[0].state_stride = apart;
  in[0].element_stride = element;
  if (threads == 0)
    OK(rne_evaluate_batch(arm, id, states, in, 3, out, states * JOINTS));
  else
    OK(rne_evaluate_batch_threads(arm, id, threads, states, in, 3, out, states * JOINTS));
  for (size_t k = 0; k < states; k += 1 + states / 13) {
    double row[JOINTS], one[JOINTS];
    for (size_t joint = 0; joint < JOINTS; joint++) row[joint] = positions[k * apart + joint * element];
    rne_input alone[3];
    state_of(alone, row);
    OK(rne_evaluate(arm, id, alone, 3, one, JOINTS));
    HOLDS(memcmp(one, out + JOINTS * k, sizeof one) == 0);
  }
  in[0].count = count - 1;
  REFUSED(rne_evaluate_batch_threads(arm, id, 2, states, in, 3, out, states * JOINTS));
  give_back(positions, count * sizeof *positions);
  give_back(out, states * JOINTS * sizeof *out);
}

/* About the width of vectors and of tasks. */
static void lengths(void) {
  const size_t states[] = {1,  2,  3,  4,  5,   7,   8,   9,   15,   16,   17,   31,   33,   63,
                           64, 65, 127, 129, 255, 257, 1023, 1025, 4095, 4096, 4097, 8191, 8193, 12289};
  const size_t threads[] = {0, 1, 2, 1000000};
  for (size_t i = 0; i < sizeof states / sizeof *states; i++)
    for (int layout = 0; layout < 3; layout++)
      for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) batch(states[i], layout, threads[t]);
}

static void single(void) {
  float zero[JOINTS] = {0}, tau[JOINTS + 1];
  rne_input_f32 in[3] = {
      {.name = "q", .data = zero, .count = JOINTS},
      {.name = "qd", .data = zero, .count = JOINTS},
      {.name = "qdd", .data = zero, .count = JOINTS},
  };
  OK(rne_evaluate_f32(arm, id, in, 3, tau, JOINTS));
  REFUSED(rne_evaluate_f32(arm, id, in, 3, (float *)((char *)tau + 2), JOINTS));
  REFUSED(rne_evaluate_batch_f32(arm, id, 3, in, 3, tau, JOINTS));
}

static void not_finite(void) {
  const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, 5e-324};
  for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
    double positions[JOINTS], one[JOINTS], other[JOINTS];
    memcpy(positions, q, sizeof q);
    positions[2] = odd[i];
    rne_input in[3];
    state_of(in, positions);
    OK(rne_evaluate(arm, id, in, 3, one, JOINTS));
    OK(rne_evaluate_batch(arm, id, 1, in, 3, other, JOINTS));
    for (int joint = 0; joint < JOINTS; joint++)
      HOLDS(memcmp(&one[joint], &other[joint], sizeof *one) == 0 || (isnan(one[joint]) && isnan(other[joint])));
  }
}

static double expected[JOINTS];

static void *evaluates(void *unused) {
  double tau[JOINTS];
  rne_input in[3];
  state_of(in, q);
  for (uint32_t i = 0; i < 2000; i++) {
    if (rne_evaluate(arm, id, in, 3, tau, JOINTS) != RNE_STATUS_OK || memcmp(tau, expected, sizeof tau) != 0)
      return "another answer";
    if (i % 50 == 0) rne_function_prepare(arm, i / 50 % rne_function_count());
    if (!is_refused(rne_evaluate(arm, 9999, in, 3, tau, JOINTS)) || !strstr(rne_last_error(), "9999"))
      return "the words of another thread";
  }
  return unused;
}

static void threads(void) {
  enum { THREADS = 8 };
  pthread_t started[THREADS];
  rne_input in[3];
  state_of(in, q);
  OK(rne_evaluate(arm, id, in, 3, expected, JOINTS));
  for (int i = 0; i < THREADS; i++) pthread_create(&started[i], NULL, evaluates, NULL);
  for (int i = 0; i < THREADS; i++) {
    void *why;
    pthread_join(started[i], &why);
    check(why == NULL, __LINE__, why ? why : "");
  }
}

static void lifetimes(void) {
  for (int i = 0; i < 200; i++) {
    rne_arm *other;
    uint32_t matrix;
    double out[4], two[2] = {0.1, 0.2};
    rne_input in = {.name = "q", .data = two, .count = 2};
    OK(rne_arm_builtin("planar2", &other));
    OK(rne_function_find("mass_matrix", &matrix));
    OK(rne_evaluate(other, matrix, &in, 1, out, 4));
    rne_arm_free(other);
  }
}

int main(int count, char **words) {
  const struct {
    const char *name;
    void (*run)(void);
  } parts[] = {
      {"no_arm", no_arm}, {"arms", arms},     {"arguments", arguments},   {"inputs", inputs},   {"strides", strides},
      {"single", single}, {"lengths", lengths}, {"not_finite", not_finite}, {"threads", threads}, {"lifetimes", lifetimes},
  };
  OK(rne_arm_builtin("puma560", &arm));
  OK(rne_function_find("inverse_dynamics", &id));
  int found = 0;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    if (count == 2 && strcmp(words[1], parts[i].name) == 0) {
      parts[i].run();
      found = 1;
    }
  rne_arm_free(arm);
  if (!found) return fprintf(stderr, "there is no such part\n"), 2;
  printf("%d checks, %d failed\n", checks, failed);
  return failed != 0;
}
