#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace papilio::soak {

/// Raw connection to 127.0.0.1, for invalid requests.
class Socket {
 public:
  explicit Socket(int port);
  ~Socket() { close(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Returns false if the peer has disconnected.
  bool send(std::string_view bytes) const;
  /// Shuts down the sending side.
  void finish() const;
  /// Returns the status of the answer; 0 on a timeout, -1 if it is not HTTP. The code of its problem document is
  /// appended to `code`.
  int status(std::chrono::seconds longest, std::string* code = nullptr);
  /// Waits for the first bytes and discards them.
  void skip(size_t most, std::chrono::seconds longest);
  void close();
  /// Resets the connection.
  void reset();

 private:
  bool receive(std::string& bytes, size_t most, std::chrono::steady_clock::time_point deadline) const;

  int fd_;
};

}  // namespace papilio::soak
