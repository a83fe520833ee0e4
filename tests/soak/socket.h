#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace papilio::soak {

/// A bare connection to 127.0.0.1, for what no decent client sends.
class Socket {
 public:
  explicit Socket(int port);
  ~Socket() { close(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// False when the other side has gone.
  bool send(std::string_view bytes) const;
  /// Says that nothing more will be sent.
  void finish() const;
  /// The status of the answer; 0 when there is none within the time, -1 when it is no HTTP. Its problem's code is
  /// appended to `code`.
  int status(std::chrono::seconds longest, std::string* code = nullptr);
  /// Waits for the first bytes and throws them away.
  void skip(size_t most, std::chrono::seconds longest);
  void close();
  /// Ends the connection with a reset.
  void reset();

 private:
  bool receive(std::string& bytes, size_t most, std::chrono::steady_clock::time_point deadline) const;

  int fd_;
};

}  // namespace papilio::soak
