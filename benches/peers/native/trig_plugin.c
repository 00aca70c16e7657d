/* The trigonometry alone, of the angles of all revolute joints: glibc one by one; one pair of libmvec calls for the
   angles of one state; and libmvec over many states. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "rnepeer.h"
#include "vector.h"

struct context {
  int revolute[64], count; /* indices of the revolute joints */
};

static void glibc(void *context, const double *q, const double *qd, const double *qdd, double *out) {
  const struct context *c = context;
  (void)qd, (void)qdd;
  for (int i = 0; i < c->count; i++) {
    double s = sin(q[c->revolute[i]]), d = cos(q[c->revolute[i]]);
    out[i] = s + 2 * d;
  }
}

static void libmvec(void *context, const double *q, const double *qd, const double *qdd, double *out) {
  const struct context *c = context;
  (void)qd, (void)qdd;
  for (int i = 0; i < c->count; i += LANES) {
    vec t = {0};
    for (int j = 0; j < LANES && i + j < c->count; j++) t[j] = q[c->revolute[i + j]];
    t = vec_sin(t) + 2 * vec_cos(t);
    for (int j = 0; j < LANES && i + j < c->count; j++) out[i + j] = t[j];
  }
}

static void batch(void *context, const double *q, const double *qd, const double *qdd, double *out, size_t count) {
  const struct context *c = context;
  (void)qd, (void)qdd;
  for (size_t k = 0; k < count; k += LANES)
    for (int i = 0; i < c->count; i++) {
      vec t = *(const vec *)(q + (size_t)c->revolute[i] * count + k);
      *(vec *)(out + (size_t)i * count + k) = vec_sin(t) + 2 * vec_cos(t);
    }
}

static const struct {
  const char *name;
  int kind;
  void *function;
} table[] = {{"trig_only_glibc", RP_OTHER, (void *)glibc},
             {"trig_only_libmvec", RP_OTHER, (void *)libmvec},
             {"trig_only_simd", RP_OTHER_BATCH, (void *)batch}};

RP_EXPORT int rp_count(void) { return sizeof table / sizeof *table; }
RP_EXPORT const char *rp_name(int k) { return table[k].name; }
RP_EXPORT int rp_kind(int k) { return table[k].kind; }
RP_EXPORT void *rp_func(int k, const char *robot) { return (void)robot, table[k].function; }
RP_EXPORT void *rp_open(int k, const char *robot, const char *dir) {
  char path[4096];
  int joints, parent, prismatic;
  double skipped;
  (void)k;
  snprintf(path, sizeof path, "%s/%s.txt", dir, robot);
  FILE *file = fopen(path, "r");
  struct context *c = calloc(1, sizeof *c);
  if (!file || !c || fscanf(file, "%d %lf %lf %lf", &joints, &skipped, &skipped, &skipped) != 4) exit(2);
  for (int i = 0; i < joints; i++) {
    if (fscanf(file, "%d %d", &parent, &prismatic) != 2) exit(2);
    for (int j = 0; j < 34; j++)
      if (fscanf(file, "%lf", &skipped) != 1) exit(2);
    if (!prismatic) c->revolute[c->count++] = i;
  }
  fclose(file);
  return c;
}
