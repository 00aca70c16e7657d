// The example of a controller in the hands of a stub of ros2_control: its effort commands are the gravity torques of the
// PUMA 560, and what is wrong with its parameters is an error and not a crash.
#include <cmath>
#include <cstdio>

#include "../examples/ros2_control/gravity_controller.cpp"

namespace {

using Names = std::vector<std::string>;

const Names JOINTS{"a", "b", "c", "d", "e", "f"};

controller_interface::CallbackReturn configured(rne_controllers::GravityController &controller, const char *robot, const Names &joints) {
  auto &parameters = controller.get_node()->parameters;
  parameters.at("robot") = rclcpp_lifecycle::Parameter(std::string(robot));
  parameters.at("joints") = rclcpp_lifecycle::Parameter(joints);
  return controller.on_configure({});
}

}  // namespace

int main() {
  using controller_interface::CallbackReturn;
  rne_controllers::GravityController controller;
  if (controller.on_init() != CallbackReturn::SUCCESS) return 1;
  if (configured(controller, "no_robot", JOINTS) != CallbackReturn::ERROR) return 2;
  if (configured(controller, "puma560", {"a"}) != CallbackReturn::ERROR) return 3;
  if (configured(controller, "puma560", JOINTS) != CallbackReturn::SUCCESS) return 4;
  const Names commanded = controller.command_interface_configuration().names;
  if (commanded != Names{"a/effort", "b/effort", "c/effort", "d/effort", "e/effort", "f/effort"}) return 5;
  if (controller.state_interface_configuration().names.at(2) != "c/position") return 6;
  const double q[6] = {0, 0.5, -0.5, 0, 1, 0};
  double tau[6] = {};
  std::vector<hardware_interface::LoanedStateInterface> states;
  std::vector<hardware_interface::LoanedCommandInterface> commands;
  for (int joint = 0; joint < 6; joint++) {
    states.emplace_back(&q[joint]);
    commands.emplace_back(&tau[joint]);
  }
  controller.assign(commands, states);
  if (controller.update({}, {}) != controller_interface::return_type::OK) return 7;
  // rne eval puma560 --function gravity_torques --q=0,0.5,-0.5,0,1,0
  const double expected[6] = {0, 32.41070113883995, 0.22515483856041946, 0, -0.02377391143958054, 0};
  for (int joint = 0; joint < 6; joint++) {
    if (std::abs(tau[joint] - expected[joint]) > 1e-9) return 8;
  }
  std::printf("effort commands of ros2_control: %.4f %.4f %.4f N m, …\n", tau[0], tau[1], tau[2]);
  return 0;
}
