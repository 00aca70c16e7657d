// See controller_interface.hpp of this folder.
#pragma once

#include <cstdio>

namespace rclcpp {

class Logger {};
class Time {};
class Duration {};

}  // namespace rclcpp

#define RCLCPP_ERROR(logger, ...) \
  do {                            \
    static_cast<void>(logger);    \
    std::printf(__VA_ARGS__);     \
    std::printf("\n");            \
  } while (false)
