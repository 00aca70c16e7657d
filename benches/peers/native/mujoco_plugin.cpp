// MuJoCo: the whole mj_inverse, and the bare stages kinematics and RNE. Everything optional is disabled in the model.
#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "rnepeer.h"

namespace {

struct Context {
  mjModel* model;
  mjData* data;
};

void set(Context& c, const double* q, const double* qd, const double* qdd) {
  for (int i = 0; i < c.model->nv; i++) {
    c.data->qpos[i] = q[i];
    c.data->qvel[i] = qd[i];
    c.data->qacc[i] = qdd[i];
  }
}

void inverse(void* context, const double* q, const double* qd, const double* qdd, double* out) {
  Context& c = *static_cast<Context*>(context);
  set(c, q, qd, qdd);
  mj_inverse(c.model, c.data);
  for (int i = 0; i < c.model->nv; i++) out[i] = c.data->qfrc_inverse[i];
}

void stages(void* context, const double* q, const double* qd, const double* qdd, double* out) {
  Context& c = *static_cast<Context*>(context);
  set(c, q, qd, qdd);
  mj_kinematics(c.model, c.data);
  mj_comPos(c.model, c.data);
  mj_comVel(c.model, c.data);
  mj_rne(c.model, c.data, 1, out);
}

}  // namespace

extern "C" {
int rp_count(void) { return 2; }
const char* rp_name(int k) { return k == 0 ? "mj_inverse" : "mj_kin+rne"; }
int rp_kind(int) { return RP_ID; }
void* rp_func(int k, const char*) { return reinterpret_cast<void*>(k == 0 ? inverse : stages); }
void* rp_open(int, const char* robot, const char* dir) {
  const std::string file = std::string(dir) + "/" + robot + ".mjb";
  Context* c = new Context;
  c->model = mj_loadModel(file.c_str(), nullptr);
  if (!c->model) {
    std::fprintf(stderr, "cannot read %s\n", file.c_str());
    std::exit(2);
  }
  c->data = mj_makeData(c->model);
  return c;
}
}
