#pragma once

#include <cstdint>
#include <string>

#include "server/http/byte_budget.h"
#include "server/http/connection.h"
#include "server/http/head.h"

namespace papilio::server {

/// How a request's body is delimited.
struct Framing {
  enum class Kind { none, length, chunked };
  Kind kind = Kind::none;
  uint64_t length = 0;  ///< for Kind::length
};

/// Reads `Content-Length` and `Transfer-Encoding`. Throws bad_request when there is more than one answer, for
/// then a proxy and this server could disagree on where the next request begins.
[[nodiscard]] Framing framing_of(const Head& head);

/// Refuses, from the head alone, a body that will not be read: no length, too long, encoded; and a Range.
void refuse_unreadable(const Head& head, const Framing& framing, uint64_t limit);

/// Reads one request's body from its connection.
class BodyReader {
 public:
  /// `held` (null: none) is asked for as much memory as has arrived.
  BodyReader(Connection& connection, const Framing& framing, uint64_t limit, ByteBudget::Share* held = nullptr)
      : connection_(connection),
        framing_(framing),
        limit_(limit),
        held_(held),
        complete_(framing.kind == Framing::Kind::none) {}

  /// Throws body_too_large as soon as the limit is passed, bad_request when the chunking is damaged or the
  /// body ends early, request_timeout when it stalls, busy when all bodies together are too large.
  std::string read();
  /// True when nothing of this body is left in the connection: only then may another request be read from it.
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
