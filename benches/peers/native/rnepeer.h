/* The C interface of a plugin of the comparison. A plugin is a shared library that offers rp_count() competitors.

   Everything is double precision; q, qd, qdd are positions, velocities and accelerations of the joints, base to tip. */
#ifndef RNEPEER_H
#define RNEPEER_H
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif
#define RP_EXPORT __attribute__((visibility("default")))

/* What a competitor computes. The driver checks the results of the kinds that say so against reference torques. */
enum {
  RP_ID = 0,         /* inverse dynamics: out = tau; checked */
  RP_FD = 1,         /* forward dynamics: third input = tau, out = qdd; checked */
  RP_OTHER = 2,      /* anything else, one state per call; checked as far as rp_result says */
  RP_ID_BATCH = 3,   /* inverse dynamics of many states per call; checked */
  RP_OTHER_BATCH = 4, /* anything else, many states per call; checked as far as rp_result says */
  RP_FD_BATCH = 5 /* forward dynamics of many states per call; checked */
};

/* One state per call: `q`, `qd`, `qdd` and `out` each hold as many numbers as the robot has joints. `out` overlaps
   nothing. */
typedef void (*rp_call)(void *ctx, const double *q, const double *qd, const double *qdd, double *out);
/* Many states per call, as structure of arrays: x[j*count + k] is joint j of state k. `count` is a multiple of 8 and
   every array is aligned to 64 bytes. `out` overlaps nothing. */
typedef void (*rp_batch)(void *ctx, const double *q, const double *qd, const double *qdd, double *out, size_t count);

RP_EXPORT int rp_count(void);
/* For 0 <= k < rp_count(): the name of a competitor, its kind, */
RP_EXPORT const char *rp_name(int k);
RP_EXPORT int rp_kind(int k);
/* its function (an rp_call or an rp_batch, by its kind; null: not offered for this robot), */
RP_EXPORT void *rp_func(int k, const char *robot);
/* and the `ctx` of its function. The folder `dir` holds the files of prepare.py. */
RP_EXPORT void *rp_open(int k, const char *robot, const char *dir);

/* What the driver has a reference of: torques, those at rest, those without acceleration, the mass matrix, the
   derivatives of the torques by q and by qd. Matrices are row-major, row = torque. */
enum {
  RP_TAU = 0,
  RP_GRAVITY = 1,
  RP_BIAS = 2,
  RP_MASS_MATRIX = 3,
  RP_DTAU_DQ = 4,
  RP_DTAU_DQD = 5,
  RP_QUANTITIES = 6
};
/* Optional: the quantity `what` of the last call of an RP_OTHER with this `ctx` and `out`, null if it computes no such
   thing. The driver checks all that are there. A matrix does not fit into `out`: a competitor keeps it and writes one
   element into `out`. After a batch the result has element e of state k at e*count + k. */
RP_EXPORT const double *rp_result(int k, void *ctx, const double *out, int what);
/* Optional: whether the results of the calls to come are checked. At first they are not. A competitor may keep results,
   or correct what it computes for another gravity, only then. */
RP_EXPORT void rp_keep(int k, void *ctx, int keep);
#ifdef __cplusplus
}
#endif
#endif
