// Pinocchio's RNEA run on CppADCodeGen's scalars: writes OUT/<robot>_cg/*.c with the function <robot>_forward_zero.
//
//   pinocchio_cppadcg ROBOTS_DIR OUT ROBOT...
// clang-format off: pinocchio's header must come before its algorithms
#include <pinocchio/codegen/cppadcg.hpp>
#include <pinocchio/algorithm/rnea.hpp>
// clang-format on

#include "pinocchio_model.hpp"

int main(int argc, char** argv) {
  using Code = CppAD::cg::CG<double>;
  using Scalar = CppAD::AD<Code>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  for (int i = 3; i < argc; i++) {
    const pinocchio::Model real = pinocchio_model(read_flat(argv[1], argv[i]));
    const auto model = real.cast<Scalar>();
    pinocchio::DataTpl<Scalar> data(model);
    const int n = model.nv;
    Vector x(3 * n);
    for (int k = 0; k < 3 * n; k++) x[k] = Scalar(0.1 + 0.01 * k);
    CppAD::Independent(x);
    const Vector q = x.head(n), qd = x.segment(n, n), qdd = x.tail(n);
    pinocchio::rnea(model, data, q, qd, qdd);
    const Vector tau = data.tau;
    CppAD::ADFun<Code> function;
    function.Dependent(x, tau);
    function.optimize("no_compare_op");
    CppAD::cg::ModelCSourceGen<double> source(function, argv[i]);
    source.setCreateForwardZero(true);
    source.setCreateJacobian(false);
    CppAD::cg::ModelLibraryCSourceGen<double> library(source);
    const std::string folder = std::string(argv[2]) + "/" + argv[i] + "_cg";
    CppAD::cg::SaveFilesModelLibraryProcessor<double>(library).saveSourcesTo(folder);
  }
}
