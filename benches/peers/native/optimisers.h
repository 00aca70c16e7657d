/* The functions that optimisers.cpp times; optimisers.py writes their table. A state is q, qd, then qdd or tau, then
   multipliers. Matrices are row-major. */
#ifndef OPTIMISERS_H
#define OPTIMISERS_H
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif
typedef struct {
  const char *function, *name;
  void (*call)(const double *state, double *out);
  size_t outputs; /* 0: it keeps its results */
} optimiser;
extern const optimiser optimisers[];
extern const size_t optimiser_count;
#ifdef __cplusplus
}
#endif
#endif
