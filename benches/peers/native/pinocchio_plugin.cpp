// Pinocchio, instantiated from its headers: no algorithm of its shared libraries is called.
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio_model.hpp"
#include "rnepeer.h"

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Context {
  pinocchio::Model model;
  pinocchio::Data data;
  Matrix result;  // for the driver's check
  explicit Context(const pinocchio::Model& m) : model(m), data(model) {}
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
};

Context& open(void* context) { return *static_cast<Context*>(context); }
auto in(const Context& c, const double* x) { return Eigen::Map<const Eigen::VectorXd>(x, c.model.nv); }
auto to(const Context& c, double* x) { return Eigen::Map<Eigen::VectorXd>(x, c.model.nv); }

void rnea(void* context, const double* q, const double* qd, const double* qdd, double* out) {
  Context& c = open(context);
  to(c, out) = pinocchio::rnea(c.model, c.data, in(c, q), in(c, qd), in(c, qdd));
}
void nle(void* context, const double* q, const double* qd, const double*, double* out) {
  Context& c = open(context);
  to(c, out) = pinocchio::nonLinearEffects(c.model, c.data, in(c, q), in(c, qd));
}
void gravity(void* context, const double* q, const double*, const double*, double* out) {
  Context& c = open(context);
  to(c, out) = pinocchio::computeGeneralizedGravity(c.model, c.data, in(c, q));
}
void crba(void* context, const double* q, const double*, const double*, double* out) {
  Context& c = open(context);
  pinocchio::crba(c.model, c.data, in(c, q));
  out[0] = c.data.M(0, 0);
}
void aba(void* context, const double* q, const double* qd, const double* tau, double* out) {
  Context& c = open(context);
  to(c, out) = pinocchio::aba(c.model, c.data, in(c, q), in(c, qd), in(c, tau));
}
void derivatives(void* context, const double* q, const double* qd, const double* qdd, double* out) {
  Context& c = open(context);
  pinocchio::computeRNEADerivatives(c.model, c.data, in(c, q), in(c, qd), in(c, qdd));
  out[0] = c.data.dtau_dq(0, 0);
}

// Results that are not in `out`; of a mass matrix Pinocchio fills the upper triangle.
const double* result(void* context, const double* out, rp_call call, int what) {
  Context& c = open(context);
  if (call == nle && what == RP_BIAS) return out;
  if (call == gravity && what == RP_GRAVITY) return out;
  if (call == derivatives && what == RP_TAU) return c.data.tau.data();
  if (call == derivatives && what == RP_DTAU_DQ)
    c.result = c.data.dtau_dq;
  else if (call == derivatives && what == RP_DTAU_DQD)
    c.result = c.data.dtau_dv;
  else if ((call == crba || call == derivatives) && what == RP_MASS_MATRIX)
    c.result = c.data.M.selfadjointView<Eigen::Upper>();
  else
    return nullptr;
  return c.result.data();
}

const struct {
  const char* name;
  int kind;
  rp_call call;
} table[] = {{"pin_rnea", RP_ID, rnea},    {"pin_nle", RP_OTHER, nle}, {"pin_gravity", RP_OTHER, gravity},
             {"pin_crba", RP_OTHER, crba}, {"pin_aba", RP_FD, aba},    {"pin_rnea_deriv", RP_OTHER, derivatives}};

}  // namespace

extern "C" {
int rp_count(void) { return sizeof table / sizeof *table; }
const char* rp_name(int k) { return table[k].name; }
int rp_kind(int k) { return table[k].kind; }
void* rp_func(int k, const char*) { return reinterpret_cast<void*>(table[k].call); }
void* rp_open(int, const char* robot, const char* dir) { return new Context(pinocchio_model(read_flat(dir, robot))); }
RP_EXPORT const double* rp_result(int k, void* context, const double* out, int what) {
  return result(context, out, table[k].call, what);
}
}
