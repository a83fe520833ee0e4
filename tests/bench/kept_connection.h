#pragma once

#include <string>
#include <string_view>

namespace papilio::bench {

/// A persistent connection to a server on loopback at minimal cost: a request is one system call, and an answer's body
/// is not copied.
class KeptConnection {
 public:
  explicit KeptConnection(int port) : port_(port) {}
  ~KeptConnection() { close(); }
  KeptConnection(const KeptConnection&) = delete;
  KeptConnection& operator=(const KeptConnection&) = delete;

  /// Sends a complete request and returns the body of its answer, valid until the next request. Reconnects if the
  /// server has closed the connection. Throws std::runtime_error unless the answer is 200 with a Content-Length.
  std::string_view ask(std::string_view request);

 private:
  [[nodiscard]] bool is_closed_by_peer() const;
  void connect();
  void close();
  void receive();

  const int port_;
  int fd_ = -1;
  std::string bytes_;  ///< of the answer, up to end_
  size_t end_ = 0;
};

}  // namespace papilio::bench
