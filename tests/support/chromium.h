#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gonio {

/// A headless Chromium with one tab, driven by the DevTools protocol over a pipe. What the tab logs,
/// throws and requests is kept. Every failure of the driver throws std::runtime_error.
class Chromium {
 public:
  explicit Chromium(const std::filesystem::path& profile) {
    signal(SIGPIPE, SIG_IGN);  // a browser that has gone is an error of write()
    int commands[2], answers[2];
    if (pipe2(commands, O_CLOEXEC) != 0 || pipe2(answers, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const std::string data = "--user-data-dir=" + profile.string();
    const std::vector<const char*> arguments = {"chromium",
                                                "--headless",
                                                "--no-sandbox",
                                                "--disable-gpu",
                                                "--disable-quic",
                                                "--no-first-run",
                                                "--disable-background-networking",
                                                "--disable-component-update",
                                                "--disable-sync",
                                                "--disable-dev-shm-usage",
                                                "--hide-scrollbars",
                                                "--remote-debugging-pipe",
                                                data.c_str(),
                                                "about:blank",
                                                nullptr};
    child_ = fork();
    if (child_ == 0) {
      setpgid(0, 0);
      // The protocol wants these two numbers; the copies in between are out of their way.
      const int in = fcntl(commands[0], F_DUPFD_CLOEXEC, 10), out = fcntl(answers[1], F_DUPFD_CLOEXEC, 10);
      const int quiet = open("/dev/null", O_WRONLY | O_CLOEXEC);
      dup2(in, 3);
      dup2(out, 4);
      dup2(quiet, 2);
      execvp("chromium", const_cast<char* const*>(arguments.data()));
      _exit(127);
    }
    close(commands[0]);
    close(answers[1]);
    to_ = commands[1];
    from_ = answers[0];
    const auto targets = call("Target.getTargets", {});
    for (const auto& target : targets["targetInfos"]) {
      if (target["type"] != "page") continue;
      session_ = call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
    }
    if (session_.empty()) throw std::runtime_error("chromium has no tab");
    for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable", {});
  }

  ~Chromium() {
    close(to_);
    close(from_);
    kill(-child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  /// Sends a command and waits for its answer; events that come before it are kept.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters) {
    nlohmann::json command = {
        {"id", ++id_}, {"method", method}, {"params", parameters.is_null() ? nlohmann::json::object() : parameters}};
    if (!session_.empty()) command["sessionId"] = session_;
    std::string text = command.dump();
    text.push_back('\0');
    for (std::size_t sent = 0; sent < text.size();) {
      const auto n = write(to_, text.data() + sent, text.size() - sent);
      if (n <= 0) throw std::runtime_error("chromium has gone");
      sent += static_cast<std::size_t>(n);
    }
    for (;;) {
      nlohmann::json message = read_message();
      if (message.value("id", 0) != id_) {
        note(message);
        continue;
      }
      if (message.contains("error")) throw std::runtime_error(method + ": " + message["error"].dump());
      return message["result"];
    }
  }

  /// The value of an expression; a promise is awaited.
  nlohmann::json evaluate(const std::string& expression) {
    const auto result =
        call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (result.contains("exceptionDetails"))
      throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
    return result["result"].value("value", nlohmann::json());
  }

  /// Waits until an expression is true. @return whether it came to be within 30 s.
  bool wait_for(const std::string& expression) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < end) {
      if (evaluate("Boolean(" + expression + ")") == true) return true;
      usleep(50'000);
    }
    return false;
  }

  /// The top left part of the page as the bytes of a PNG.
  std::string screenshot(int width, int height) {
    const nlohmann::json clip = {{"x", 0}, {"y", 0}, {"width", width}, {"height", height}, {"scale", 1}};
    const std::string text = call("Page.captureScreenshot", {{"clip", clip}, {"captureBeyondViewport", true}})["data"];
    std::string bytes;  // base64
    unsigned bits = 0, pending = 0;
    for (const char c : text) {
      static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      const auto digit = digits.find(c);
      if (digit == std::string::npos) break;
      pending = pending << 6 | static_cast<unsigned>(digit);
      bits += 6;
      if (bits < 8) continue;
      bits -= 8;
      bytes.push_back(static_cast<char>(pending >> bits & 255));
    }
    return bytes;
  }

  std::vector<std::string> complaints;  ///< errors, warnings and exceptions of the tab
  std::vector<std::string> requests;    ///< addresses that the tab asked for

 private:
  nlohmann::json read_message() {
    for (;;) {
      const auto end = buffer_.find('\0');
      if (end != std::string::npos) {
        nlohmann::json message = nlohmann::json::parse(buffer_.substr(0, end));
        buffer_.erase(0, end + 1);
        return message;
      }
      pollfd ready{from_, POLLIN, 0};
      if (poll(&ready, 1, 60'000) != 1) throw std::runtime_error("chromium does not answer");
      char block[1 << 16];
      const auto n = read(from_, block, sizeof block);
      if (n <= 0) throw std::runtime_error("chromium has gone");
      buffer_.append(block, static_cast<std::size_t>(n));
    }
  }

  void note(const nlohmann::json& event) {
    const std::string method = event.value("method", "");
    const nlohmann::json parameters = event.value("params", nlohmann::json::object());
    if (method == "Network.requestWillBeSent") requests.push_back(parameters["request"]["url"]);
    if (method == "Runtime.exceptionThrown" || method == "Log.entryAdded") complaints.push_back(parameters.dump());
    if (method == "Runtime.consoleAPICalled" && parameters["type"] != "log") complaints.push_back(parameters.dump());
  }

  pid_t child_ = 0;
  int to_ = -1, from_ = -1, id_ = 0;
  std::string session_, buffer_;
};

}  // namespace gonio
