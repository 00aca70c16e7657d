// A controller of ros2_control that commands the gravity torques of an arm: the arm can be moved by hand and stays where
// it is left. The parameters are `robot`, a robot file or the name of a shipped robot, and `joints`, the names of the
// joints in ros2_control, base to tip.
#include <string>
#include <vector>

#include <controller_interface/controller_interface.hpp>
#include <pluginlib/class_list_macros.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rne.h>

namespace rne_controllers {

using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;
using controller_interface::interface_configuration_type;
using controller_interface::return_type;

class GravityController : public controller_interface::ControllerInterface {
 public:
  ~GravityController() override { rne_arm_free(arm_); }

  CallbackReturn on_init() override {
    auto_declare<std::string>("robot", "");
    auto_declare<std::vector<std::string>>("joints", {});
    return CallbackReturn::SUCCESS;
  }

  InterfaceConfiguration command_interface_configuration() const override { return interfaces("/effort"); }
  InterfaceConfiguration state_interface_configuration() const override { return interfaces("/position"); }

  // Reads and compiles the arm, which takes tens of milliseconds: not in the control loop.
  CallbackReturn on_configure(const rclcpp_lifecycle::State &) override {
    const std::string robot = get_node()->get_parameter("robot").as_string();
    joints_ = get_node()->get_parameter("joints").as_string_array();
    rne_arm_free(arm_);
    arm_ = nullptr;
    if (rne_arm_load_file(robot.c_str(), &arm_) != RNE_STATUS_OK ||
        rne_function_find("gravity_torques", &gravity_) != RNE_STATUS_OK ||
        rne_function_prepare(arm_, gravity_) != RNE_STATUS_OK) {
      RCLCPP_ERROR(get_node()->get_logger(), "%s", rne_last_error());
      return CallbackReturn::ERROR;
    }
    if (rne_arm_dof(arm_) != joints_.size()) {
      RCLCPP_ERROR(get_node()->get_logger(), "`joints` has %zu names, but %s has %zu joints", joints_.size(),
                   rne_arm_name(arm_), rne_arm_dof(arm_));
      return CallbackReturn::ERROR;
    }
    q_.assign(joints_.size(), 0.0);
    tau_.assign(joints_.size(), 0.0);
    return CallbackReturn::SUCCESS;
  }

  // No allocation, no lock, no system call, except in the first call of a thread.
  return_type update(const rclcpp::Time &, const rclcpp::Duration &) override {
    for (std::size_t joint = 0; joint < joints_.size(); joint++) q_[joint] = state_interfaces_[joint].get_value();
    const rne_input q{"q", q_.data(), q_.size(), 0, 0};
    if (rne_evaluate(arm_, gravity_, &q, 1, tau_.data(), tau_.size()) != RNE_STATUS_OK) return return_type::ERROR;
    bool is_set = true;
    for (std::size_t joint = 0; joint < joints_.size(); joint++) {
      is_set = command_interfaces_[joint].set_value(tau_[joint]) && is_set;
    }
    return is_set ? return_type::OK : return_type::ERROR;
  }

 private:
  // ros2_control lends them in this order, base to tip.
  InterfaceConfiguration interfaces(const char *kind) const {
    InterfaceConfiguration configuration{interface_configuration_type::INDIVIDUAL, {}};
    for (const std::string &joint : joints_) configuration.names.push_back(joint + kind);
    return configuration;
  }

  rne_arm *arm_ = nullptr;
  std::uint32_t gravity_ = 0;
  std::vector<std::string> joints_;
  std::vector<double> q_, tau_;
};

}  // namespace rne_controllers

PLUGINLIB_EXPORT_CLASS(rne_controllers::GravityController, controller_interface::ControllerInterface)
