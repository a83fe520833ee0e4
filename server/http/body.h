#pragma once

#include <cstdint>
#include <string>

#include "server/http/byte_budget.h"
#include "server/http/connection.h"
#include "server/http/head.h"

namespace papilio::server {

/// Delimitation of a request's body.
struct Framing {
  enum class Kind { none, length, chunked };
  Kind kind = Kind::none;
  uint64_t length = 0;  ///< bytes, for Kind::length
};

/// Reads `Content-Length` and `Transfer-Encoding`. Throws `Problem` bad_request if they are ambiguous: a proxy and this
/// server could disagree on the begin of the next request.
[[nodiscard]] Framing framing_of(const Head& head);

/// Refuses, by the head alone, a body without a length, too long or encoded; and a Range. Throws `Problem`.
void refuse_unreadable(const Head& head, const Framing& framing, uint64_t limit);

/// Reader of one request's body from its connection.
class BodyReader {
 public:
  /// Starts at the body. `held`, unless null, grows by the received bytes.
  BodyReader(Connection& connection, const Framing& framing, uint64_t limit, ByteBudget::Share* held = nullptr)
      : connection_(connection),
        framing_(framing),
        limit_(limit),
        held_(held),
        complete_(framing.kind == Framing::Kind::none) {}

  /// Reads the body. Throws `Problem`: body_too_large as soon as the limit is exceeded, bad_request for damaged chunks
  /// or an early end, request_timeout if it stalls, busy if all bodies together are too large.
  std::string read();
  /// Returns whether the body is completely read; only then may another request be read from the connection.
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  void read_exactly(uint64_t count, std::string& bytes);
  void hold(uint64_t bytes);
  void read_chunks(std::string& bytes);
  std::string read_line();

  Connection& connection_;
  const Framing framing_;
  const uint64_t limit_;
  ByteBudget::Share* const held_;
  bool complete_;
};

}  // namespace papilio::server
