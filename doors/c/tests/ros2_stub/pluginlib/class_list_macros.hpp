// See controller_interface.hpp of this folder.
#pragma once

#include <type_traits>

#define PLUGINLIB_EXPORT_CLASS(kind, base) \
  static_assert(std::is_base_of<base, kind>::value && !std::is_abstract<kind>::value, "a controller");
