// What the example of a controller uses of ros2_control (Jazzy), written anew from its documentation, so that the example
// compiles and runs where no ROS is. It is no part of ROS and no replacement for it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <rclcpp/rclcpp.hpp>

namespace hardware_interface {

class LoanedStateInterface {
 public:
  explicit LoanedStateInterface(const double *value) : value_(value) {}
  double get_value() const { return *value_; }

 private:
  const double *value_;
};

class LoanedCommandInterface {
 public:
  explicit LoanedCommandInterface(double *value) : value_(value) {}
  [[nodiscard]] bool set_value(double value) {
    *value_ = value;
    return true;
  }

 private:
  double *value_;
};

}  // namespace hardware_interface

namespace rclcpp_lifecycle {

class State {};

class Parameter {
 public:
  explicit Parameter(std::variant<std::string, std::vector<std::string>> value) : value_(std::move(value)) {}
  std::string as_string() const { return std::get<std::string>(value_); }
  std::vector<std::string> as_string_array() const { return std::get<std::vector<std::string>>(value_); }

 private:
  std::variant<std::string, std::vector<std::string>> value_;
};

class LifecycleNode {
 public:
  Parameter get_parameter(const std::string &name) const { return parameters.at(name); }
  rclcpp::Logger get_logger() const { return {}; }
  std::map<std::string, Parameter> parameters;
};

}  // namespace rclcpp_lifecycle

namespace controller_interface {

enum class return_type { OK, ERROR };
enum class CallbackReturn { SUCCESS, FAILURE, ERROR };
enum class interface_configuration_type { ALL, INDIVIDUAL, NONE };

struct InterfaceConfiguration {
  interface_configuration_type type;
  std::vector<std::string> names;
};

class ControllerInterface {
 public:
  virtual ~ControllerInterface() = default;
  virtual CallbackReturn on_init() = 0;
  virtual InterfaceConfiguration command_interface_configuration() const = 0;
  virtual InterfaceConfiguration state_interface_configuration() const = 0;
  virtual CallbackReturn on_configure(const rclcpp_lifecycle::State &) { return CallbackReturn::SUCCESS; }
  virtual return_type update(const rclcpp::Time &, const rclcpp::Duration &) = 0;
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> get_node() const { return node_; }
  void assign(std::vector<hardware_interface::LoanedCommandInterface> commands,
              std::vector<hardware_interface::LoanedStateInterface> states) {
    command_interfaces_ = std::move(commands);
    state_interfaces_ = std::move(states);
  }

 protected:
  template <typename T>
  void auto_declare(const std::string &name, const T &value) {
    node_->parameters.emplace(name, rclcpp_lifecycle::Parameter(value));
  }
  std::vector<hardware_interface::LoanedCommandInterface> command_interfaces_;
  std::vector<hardware_interface::LoanedStateInterface> state_interfaces_;

 private:
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> node_ = std::make_shared<rclcpp_lifecycle::LifecycleNode>();
};

}  // namespace controller_interface
