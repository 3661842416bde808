#pragma once

#include <string>
#include <vector>

#include <gonio/mapping/diagram/diagram.h>

namespace gonio {

/// A generated input of the stability study: two neighbouring diagrams of a stack. Methods that use one
/// diagram take `first`.
struct StabilityInput {
  std::string name;
  std::string reason;  ///< what it is there for, one line
  DiagramGrid first, second;
};

/// All inputs, the same on every platform.
std::vector<StabilityInput> stability_inputs();

}  // namespace gonio
