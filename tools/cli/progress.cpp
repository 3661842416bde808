#include "tools/cli/progress.h"

#include <chrono>
#include <cstdio>

#include <unistd.h>

namespace gonio {

using namespace std::chrono_literals;

ProgressLine::ProgressLine(std::string task) : task_(std::move(task)), thread_([this] { run(); }) {}

ProgressLine::~ProgressLine() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void ProgressLine::run() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const char* begin = terminal ? "\r\x1b[K" : "";
  const char* end = terminal ? "" : "\n";
  const auto start = std::chrono::steady_clock::now();
  auto next = start + 1s;
  bool shown = false;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_.wait_until(lock, next, [&] { return done_; })) {
    const auto elapsed = std::chrono::steady_clock::now() - start;
    const double seconds = std::chrono::duration<double>(elapsed).count(), share = share_;
    if (share >= 0) {
      std::fprintf(stderr, "%s%s: %.0f %%, %.0f s%s", begin, task_.c_str(), 100 * share, seconds, end);
    } else {
      std::fprintf(stderr, "%s%s: %.0f s%s", begin, task_.c_str(), seconds, end);
    }
    shown = true;
    next = terminal ? next + 200ms : start + 2 * (next - start);
  }
  if (terminal && shown) std::fputs("\r\x1b[K", stderr);
}

}  // namespace gonio
