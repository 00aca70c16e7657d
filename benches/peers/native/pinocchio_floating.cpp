// Pinocchio's functions of a robot that nothing holds, behind a C interface of ../floating. Vectors are those
// of JointModelFreeFlyer, then the joints in the order of Pinocchio.
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/centroidal.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio_model.hpp"

using Eigen::VectorXd;

struct Robot {
  pinocchio::Model model;
  pinocchio::Data data;
  explicit Robot(const pinocchio::Model& m) : model(m), data(model) {}
  Eigen::Map<const VectorXd> q(const double* x) const { return Eigen::Map<const VectorXd>(x, model.nq); }
  Eigen::Map<const VectorXd> v(const double* x) const { return Eigen::Map<const VectorXd>(x, model.nv); }
  Eigen::Map<VectorXd> out(double* x) const { return Eigen::Map<VectorXd>(x, model.nv); }
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
};

#define EXPORT extern "C" __attribute__((visibility("default")))

// The folder has the files of prepare.py.
EXPORT Robot* pf_open(const char* folder, const char* robot, double gravity) {
  pinocchio::Model model = pinocchio_model(read_flat(folder, robot));
  model.gravity.linear() = Eigen::Vector3d(0, 0, -gravity);
  return new Robot(model);
}
// The place of joint i, counted from 1, among the velocities.
EXPORT int pf_place(const Robot* r, int i) {
  return r->model.joints[r->model.getJointId("j" + std::to_string(i))].idx_v();
}
EXPORT void pf_rnea(Robot* r, const double* q, const double* v, const double* a, double* out) {
  r->out(out) = pinocchio::rnea(r->model, r->data, r->q(q), r->v(v), r->v(a));
}
EXPORT void pf_aba(Robot* r, const double* q, const double* v, const double* tau, double* out) {
  r->out(out) = pinocchio::aba(r->model, r->data, r->q(q), r->v(v), r->v(tau));
}
EXPORT void pf_crba(Robot* r, const double* q, const double*, const double*, double* out) {
  pinocchio::crba(r->model, r->data, r->q(q));
  out[0] = r->data.M(0, 0);
}
// The matrix is column-major, 6 rows.
EXPORT void pf_ccrba(Robot* r, const double* q, const double* v, const double*, double* out) {
  pinocchio::ccrba(r->model, r->data, r->q(q), r->v(v));
  out[0] = r->data.Ag(0, 0);
}
EXPORT const double* pf_momentum_matrix(const Robot* r) { return r->data.Ag.data(); }
EXPORT const double* pf_mass_matrix(Robot* r) {
  r->data.M.triangularView<Eigen::StrictlyLower>() = r->data.M.transpose().triangularView<Eigen::StrictlyLower>();
  return r->data.M.data();
}
