// Pinocchio's RNEA run on CasADi's symbols: writes OUT/<robot>_pin.casadi.
//
//   pinocchio_casadi ROBOTS_DIR OUT ROBOT...
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/autodiff/casadi.hpp>

#include "pinocchio_model.hpp"

int main(int argc, char** argv) {
  using SX = casadi::SX;
  using Vector = Eigen::Matrix<SX, Eigen::Dynamic, 1>;
  for (int i = 3; i < argc; i++) {
    const pinocchio::Model real = pinocchio_model(read_flat(argv[1], argv[i]));
    const auto model = real.cast<SX>();
    pinocchio::DataTpl<SX> data(model);
    const int n = model.nv;
    const SX q = SX::sym("q", n), qd = SX::sym("v", n), qdd = SX::sym("a", n);
    auto vector = [n](const SX& x) {
      Vector v(n);
      for (int k = 0; k < n; k++) v[k] = x(k);
      return v;
    };
    pinocchio::rnea(model, data, vector(q), vector(qd), vector(qdd));
    SX tau(n, 1);
    for (int k = 0; k < n; k++) tau(k) = data.tau[k];
    casadi::Function("id", {q, qd, qdd}, {tau}).save(std::string(argv[2]) + "/" + argv[i] + "_pin.casadi");
  }
}
