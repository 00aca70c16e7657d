// Torques of a PUMA 560 in C++17: an arm that frees itself, errors as exceptions.
//
//     c++ -std=c++17 torque.cpp $(pkg-config --cflags --libs rne) -o torque
#include <array>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <rne.h>

class Arm {
 public:
  static Arm builtin(const std::string &name) {
    rne_arm *arm = nullptr;
    check(rne_arm_builtin(name.c_str(), &arm));
    return Arm(arm);
  }
  static Arm load(const std::string &path) {
    rne_arm *arm = nullptr;
    check(rne_arm_load_file(path.c_str(), &arm));
    return Arm(arm);
  }
  std::size_t dof() const { return rne_arm_dof(arm_.get()); }
  // One state of a function; it is computed into a vector that the caller keeps.
  void evaluate(std::uint32_t id, std::initializer_list<std::pair<const char *, const std::vector<double> &>> given,
                std::vector<double> &outputs) const {
    std::array<rne_input, 8> inputs{};
    std::size_t count = 0;
    for (const auto &[name, values] : given) inputs.at(count++) = {name, values.data(), values.size(), 0, 0};
    check(rne_evaluate(arm_.get(), id, inputs.data(), count, outputs.data(), outputs.size()));
  }
  static std::uint32_t function(const std::string &name) {
    std::uint32_t id = 0;
    check(rne_function_find(name.c_str(), &id));
    return id;
  }

 private:
  explicit Arm(rne_arm *arm) : arm_(arm, rne_arm_free) {}
  static void check(rne_status status) {
    if (status != RNE_STATUS_OK) throw std::runtime_error(rne_last_error());
  }
  std::unique_ptr<rne_arm, decltype(&rne_arm_free)> arm_;
};

int main() {
  const Arm arm = Arm::builtin("puma560");
  const std::vector<double> q{0, 0.5, -0.5, 0, 1, 0}, qd(arm.dof(), 1.0), qdd(arm.dof(), 0.0);
  std::vector<double> tau(arm.dof());
  arm.evaluate(Arm::function("inverse_dynamics"), {{"q", q}, {"qd", qd}, {"qdd", qdd}}, tau);
  for (const double torque : tau) std::printf("%9.4f N m\n", torque);
  try {
    Arm::builtin("puma");
  } catch (const std::runtime_error &error) {
    std::printf("%s\n", error.what());
    return 0;
  }
  return 1;
}
