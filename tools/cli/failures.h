#pragma once

#include <cstddef>
#include <new>
#include <string>
#include <vector>

#include <gonio/mapping/base/error.h>

namespace gonio {

/// What failed of a verb's many inputs: the others go on, and it is named at the end.
class Failures {
 public:
  /// Runs `work` and keeps what it throws. False if it threw.
  template <class Work>
  bool survives(const Work& work) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      messages_.push_back(error.what());
    } catch (const std::bad_alloc&) {
      messages_.push_back("not enough memory");
    }
    return false;
  }

  bool empty() const { return messages_.empty(); }

  /// @throws Error that names all, if any. @param inputs how many there were
  void throw_any(std::size_t inputs) const {
    if (messages_.empty()) return;
    if (inputs == 1) throw Error(messages_.front());
    std::string text = std::to_string(messages_.size()) + " of " + std::to_string(inputs) + " inputs failed";
    for (std::size_t k = 0; k < messages_.size(); ++k) text += (k == 0 ? ": " : "; ") + messages_[k];
    throw Error(text);
  }

 private:
  std::vector<std::string> messages_;
};

}  // namespace gonio
