#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace gonio {

/// Says on stderr that a task goes on, from its first second until this object is destroyed. On a
/// terminal it is one line that is overwritten and finally erased; otherwise a line after 1, 2, 4,
/// 8 ... seconds. A task of less than a second shows nothing.
class ProgressLine {
 public:
  explicit ProgressLine(std::string task);
  ~ProgressLine();

  /// The share of the task that is done, in [0, 1]; not shown until it is known. A smaller one than
  /// before, when work turned out to be more than thought, is not shown. From one thread at a time.
  void update(double share) noexcept { share_ = std::max<double>(share, share_); }

 private:
  void run();

  std::string task_;
  std::atomic<double> share_{-1};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace gonio
