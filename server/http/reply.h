#pragma once

#include <string>

#include "server/http/connection.h"
#include "server/http/held_answers.h"
#include "server/http/http.h"

namespace papilio::server {

/// Form of an answer, as decided by the request.
struct Delivery {
  std::string request_id;
  bool head_only = false;   ///< whether HEAD is answered
  bool chunked = true;      ///< whether the client supports chunked encoding; else a stream ends with the connection
  bool keep_alive = false;  ///< whether another request may follow on this connection
};

/// Returns the answer for an error.
[[nodiscard]] Response problem_response(const proto::Problem& problem, const std::string& request_id);

/// Sends the whole answer; meanwhile its memory counts in `held`. Returns false if the client did not receive all of
/// it; the connection must then be closed.
[[nodiscard]] bool send_reply(Connection& connection, const Response& response, const Delivery& delivery,
                              HeldAnswers::Share& held);

}  // namespace papilio::server
