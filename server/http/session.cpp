#include "server/http/session.h"

#include <chrono>
#include <new>
#include <optional>
#include <string_view>

#include "server/http/reply.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

Problem internal() { return {Code::internal, "An internal error occurred. The log lists it under the request id."}; }

/// Returns the trace id of a `traceparent` (W3C Trace Context, version 00), "" if it is invalid.
std::string trace_id(const std::string& traceparent) {
  const auto is_hex = [](std::string_view text) {
    return text.find_first_not_of("0123456789abcdef") == std::string_view::npos &&
           text.find_first_not_of('0') != std::string_view::npos;
  };
  const std::string_view text = traceparent;
  const bool valid = text.size() == 55 && text.starts_with("00-") && text[35] == '-' && text[52] == '-' &&
                     is_hex(text.substr(3, 32)) && is_hex(text.substr(36, 16)) &&
                     text.substr(53).find_first_not_of("0123456789abcdef") == std::string_view::npos;
  return valid ? std::string(text.substr(3, 32)) : "";
}

/// Time for which a thread waits on a connection before it serves others: the next request of a busy client, and the
/// first of a new one, arrive sooner.
constexpr std::chrono::milliseconds short_wait{5};

/// Count of a running request, from its complete head until its answer is sent and logged.
class Pass {
 public:
  explicit Pass(Gate& gate) : gate_(gate), entered_(gate.enter()) {}
  ~Pass() {
    if (entered_) gate_.leave();
  }
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;
  [[nodiscard]] bool entered() const { return entered_; }

 private:
  Gate& gate_;
  const bool entered_;
};

}  // namespace

Session::Session(std::unique_ptr<Transport> transport, const HttpOptions& options, ByteBudget& held,
                 HeldAnswers& answers, const Routes& routes, Gate& gate, const Listener& listener)
    : connection_(std::move(transport), std::chrono::seconds(options.read_seconds),
                  std::chrono::seconds(options.write_seconds)),
      options_(options),
      held_(held),
      answers_(answers),
      routes_(routes),
      gate_(gate),
      listener_(listener) {
  connection_.await_request(std::chrono::seconds(options_.idle_seconds));
}

Session::Next Session::run() {
  const bool others_wait = listener_.others_wait();
  const auto [state, wait_for] =
      connection_.gather_head(options_.max_header_bytes, others_wait ? std::chrono::milliseconds(0) : short_wait);
  if (state == Connection::Gathered::State::waiting) {
    connection_.shrink();
    return {Next::What::bytes, wait_for};
  }
  if (state == Connection::Gathered::State::ended) return {Next::What::nothing};
  if (answer_one(++served_ == options_.keep_alive_requests)) {
    connection_.await_request(std::chrono::seconds(options_.idle_seconds));
    return {Next::What::request};
  }
  connection_.linger();
  return {Next::What::nothing};
}

bool Session::answer_one(bool last) {
  const auto start = connection_.head_begun();
  const uint64_t in_before = connection_.bytes_in();
  const uint64_t out_before = connection_.bytes_out();
  Exchange exchange(connection_, options_, held_);
  Finished finished;
  std::optional<Pass> pass;
  Response response;
  try {
    exchange.receive();
    pass.emplace(gate_);
    RouteMatch match = routes_.find(exchange.method(), exchange.path());
    finished.route = std::move(match.pattern);
    exchange.set_path_parameters(std::move(match.parameters));
    const RouteOptions& route = match.route->options;
    if (!pass->entered() && route.while_draining == WhileDraining::refuse)
      throw Problem(Code::draining, "The server is shutting down. Use another server.");
    if (options_.authorize) finished.client = options_.authorize(exchange, route.access);
    exchange.set_client(finished.client);
    exchange.refuse_unreadable();
    response = match.route->handler(exchange);
  } catch (const Problem& problem) {
    response = refusal(exchange, problem, finished);
  } catch (const std::bad_alloc&) {
    response =
        refusal(exchange, Problem(Code::out_of_memory, "There is not enough memory for this request now."), finished);
  } catch (const std::exception& error) {
    response = refusal(exchange, internal(), finished);
    finished.detail = error.what();
  } catch (...) {
    response = refusal(exchange, internal(), finished);
    finished.detail = "an exception of an unknown kind";
  }
  finished.trace = trace_id(exchange.header("traceparent"));
  if (!finished.trace.empty()) response.headers.emplace_back("traceparent", exchange.header("traceparent"));
  if (options_.decorate) options_.decorate(exchange, response);

  exchange.release_body();
  HeldAnswers::Share held(answers_, connection_);
  const bool keep_alive = !last && exchange.may_keep_alive() && !gate_.closed();
  const bool sent = send_reply(connection_, response,
                               {.request_id = exchange.id(),
                                .head_only = exchange.method() == "HEAD",
                                .chunked = exchange.head().minor_version == 1,
                                .keep_alive = keep_alive},
                               held);
  if (!sent && finished.code.empty()) {
    finished.code = "not_sent";
    finished.detail = held.is_cut() ? "the answer was cut: all answers together passed --max-held-bytes"
                                    : "the answer was not sent to its end";
  }
  if (options_.on_finished) {
    finished.id = exchange.id();
    finished.method = exchange.method();
    finished.path = exchange.head().target.substr(0, exchange.head().target.find('?'));
    finished.remote_address = exchange.remote_address();
    finished.status = response.status;
    finished.bytes_in = connection_.bytes_in() - in_before;
    finished.bytes_out = connection_.bytes_out() - out_before;
    finished.milliseconds = std::chrono::duration<double, std::milli>(Connection::Clock::now() - start).count();
    options_.on_finished(finished);
  }
  return sent && keep_alive;
}

Response Session::refusal(const Exchange& exchange, const Problem& problem, Finished& finished) const {
  finished.code = proto::problem_kind(problem.code()).name;
  finished.detail = problem.what();
  Response response = problem_response(problem, exchange.id());
  if (problem.code() == Code::method_not_allowed)
    response.headers.emplace_back("Allow", routes_.allowed(exchange.path()));
  return response;
}

}  // namespace papilio::server
