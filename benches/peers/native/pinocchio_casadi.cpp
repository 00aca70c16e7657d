// Pinocchio's algorithms run on CasADi's symbols: writes OUT/<robot>_<form>.casadi, where the form is pin (RNEA),
// pinm (CRBA), pinfd (ABA) or pind (RNEA derivatives); the last three of robots with branches only.
//
//   pinocchio_casadi ROBOTS_DIR OUT ROBOT...
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/autodiff/casadi.hpp>

#include "pinocchio_model.hpp"

using SX = casadi::SX;

template <class M>
SX symbols(const M& from) {
  SX to(from.rows(), from.cols());
  for (int i = 0; i < from.rows(); i++)
    for (int j = 0; j < from.cols(); j++) to(i, j) = from(i, j);
  return to;
}

int main(int argc, char** argv) {
  using Vector = Eigen::Matrix<SX, Eigen::Dynamic, 1>;
  for (int i = 3; i < argc; i++) {
    const FlatRobot robot = read_flat(argv[1], argv[i]);
    const auto model = pinocchio_model(robot).cast<SX>();
    const int n = model.nv;
    const SX q = SX::sym("q", n), qd = SX::sym("v", n), third = SX::sym("a", n);
    auto vector = [n](const SX& x) {
      Vector v(n);
      for (int k = 0; k < n; k++) v[k] = x(k);
      return v;
    };
    const Vector at_q = vector(q), at_qd = vector(qd), at_third = vector(third);
    auto save = [&](const std::string& form, const std::vector<SX>& results) {
      const std::string file = std::string(argv[2]) + "/" + argv[i] + "_" + form + ".casadi";
      casadi::Function("id", {q, qd, third}, results).save(file);
    };
    pinocchio::DataTpl<SX> data(model);
    pinocchio::rnea(model, data, at_q, at_qd, at_third);
    save("pin", {symbols(data.tau)});
    if (!robot.branches()) continue;
    data = pinocchio::DataTpl<SX>(model);
    pinocchio::crba(model, data, at_q);
    save("pinm", {SX::triu2symm(SX::triu(symbols(data.M)))});
    data = pinocchio::DataTpl<SX>(model);
    save("pinfd", {symbols(pinocchio::aba(model, data, at_q, at_qd, at_third))});
    data = pinocchio::DataTpl<SX>(model);
    pinocchio::computeRNEADerivatives(model, data, at_q, at_qd, at_third);
    save("pind", {symbols(data.dtau_dq).T(), symbols(data.dtau_dv).T()});
  }
}
