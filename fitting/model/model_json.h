#pragma once

#include <nlohmann/json.hpp>

#include <gonio/fitting/model/model.h>

/// Not installed: keeps nlohmann::json out of the public headers.
namespace gonio::detail {

nlohmann::ordered_json model_json(const LobeModel& model);

}  // namespace gonio::detail
