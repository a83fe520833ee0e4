#pragma once

#include <string>

#include "server/http/connection.h"
#include "server/http/held_answers.h"
#include "server/http/http.h"

namespace papilio::server {

/// What the request's side decides about the form of its answer.
struct Delivery {
  std::string request_id;
  bool head_only = false;   ///< answering HEAD
  bool chunked = true;      ///< the client knows chunked encoding; without it a stream ends with the connection
  bool keep_alive = false;  ///< another request may follow on this connection
};

/// The answer to an error.
[[nodiscard]] Response problem_response(const proto::Problem& problem, const std::string& request_id);

/// Sends the whole answer, whose memory counts in `held` meanwhile. False when the client did not get all of it; the
/// connection is then of no further use.
[[nodiscard]] bool send_reply(Connection& connection, const Response& response, const Delivery& delivery,
                              HeldAnswers::Share& held);

}  // namespace papilio::server
