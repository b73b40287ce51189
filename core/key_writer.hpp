// Writes the values that a description refers to as a YAML file which reads back to the same values.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/keys.hpp"

namespace pellicle::core {

/// All keys that have a value, defaults included, in SI with the unit as a comment.
std::string write_keys(const std::function<void(Keys&)>& describe);

/// YAML text of a value; numbers have as many digits as it takes to read back the same double.
std::string to_yaml(Real value);
std::string to_yaml(const std::string& text);
std::string to_yaml(const std::vector<Real>& values);
std::string to_yaml(const std::vector<std::int64_t>& values);
std::string to_yaml(const std::vector<std::string>& texts);

}  // namespace pellicle::core
