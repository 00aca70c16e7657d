// Second derivatives of the torques by Pinocchio, whose Python has none: `tests/witnesses/derivatives.py` compiles and calls it.
//
// The headers of Pinocchio do all; its library is not linked. The standard input has the robot and states, as numbers:
//
//   joints n, gravity (3)
//   for each joint: parent (0: the world), 1 if it slides, axis (3), rotation by rows and origin of its frame in that
//     of the parent (9 + 3), mass, centre of mass (3), inertia about it by rows (9)
//   for each state: q, v, a, and the multipliers of the torques (4 n)
//
// A line of the output has four matrices by rows: the second derivatives of the sum of the torques, each times its
// multiplier, by q and q, by q and v, by v and v, and by q and a.

#include <pinocchio/algorithm/rnea-second-order-derivatives.hpp>

#include <cstdio>
#include <iostream>
#include <string>

namespace {

Eigen::VectorXd read(Eigen::Index length) {
  Eigen::VectorXd numbers(length);
  for (double & number : numbers) std::cin >> number;
  return numbers;
}

Eigen::Matrix3d rows(const Eigen::VectorXd & numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

pinocchio::Model robot() {
  int joints = 0;
  std::cin >> joints;
  pinocchio::Model model;
  model.gravity.linear(read(3));
  for (int joint = 1; joint <= joints; ++joint) {
    int parent = 0, slides = 0;
    std::cin >> parent >> slides;
    const Eigen::Vector3d axis = read(3);
    const Eigen::Matrix3d rotation = rows(read(9));
    const pinocchio::SE3 placement(rotation, read(3));
    const double mass = read(1)[0];
    const Eigen::Vector3d centre = read(3);
    const pinocchio::Inertia inertia(mass, centre, rows(read(9)));
    const std::string name = std::to_string(joint);
    if (slides)
      model.addJoint(parent, pinocchio::JointModelPrismaticUnaligned(axis), placement, name);
    else
      model.addJoint(parent, pinocchio::JointModelRevoluteUnaligned(axis), placement, name);
    model.appendBodyToJoint(joint, inertia);
  }
  return model;
}

}  // namespace

int main() {
  const pinocchio::Model model = robot();
  pinocchio::Data data(model);
  const int n = model.nv;
  while (true) {
    const Eigen::VectorXd q = read(n), v = read(n), a = read(n), multipliers = read(n);
    if (!std::cin) return 0;
    // elements of the torques by q and q, by v and v, by q and v, by a and q
    Eigen::Tensor<double, 3> q_q(n, n, n), v_v(n, n, n), q_v(n, n, n), a_q(n, n, n);
    for (auto * tensor : {&q_q, &v_v, &q_v, &a_q}) tensor->setZero();
    pinocchio::ComputeRNEASecondOrderDerivatives(model, data, q, v, a, q_q, v_v, q_v, a_q);
    const auto print = [&](const Eigen::Tensor<double, 3> & tensor, bool transposed) {
      for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
          double sum = 0;
          for (int torque = 0; torque < n; ++torque)
            sum += multipliers[torque] * (transposed ? tensor(torque, column, row) : tensor(torque, row, column));
          std::printf("%.17g ", sum);
        }
    };
    print(q_q, false);
    print(q_v, false);
    print(v_v, false);
    print(a_q, true);
    std::printf("\n");
  }
}
