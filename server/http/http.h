#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/problem.h"

// The HTTP server behind the project's own types. cpp-httplib listens and accepts
// (listener.h is the only place that knows it); the messages themselves are read and written in this folder,
// because the library's parsers read some requests otherwise than any proxy in front of them does (head.h,
// body.h and form.h name the cases).

namespace papilio::server {

/// Names and values in the order in which they came; a name may come twice.
using Fields = std::vector<std::pair<std::string, std::string>>;

/// One part of a `multipart/form-data` body.
struct FormPart {
  std::string name;
  std::string content_type;  ///< empty when the part has none
  std::string bytes;
};

/// A request's body, read whole.
struct Body {
  std::string bytes;            ///< the raw body; empty for a form
  std::vector<FormPart> parts;  ///< the parts of a `multipart/form-data` body, in order; else empty
  uint64_t size = 0;            ///< bytes received
};

/// One request while it is being answered. Valid only during the handler's call (and its stream's); used by
/// one thread.
class Request {
 public:
  virtual ~Request() = default;
  [[nodiscard]] virtual const std::string& method() const = 0;
  [[nodiscard]] virtual const std::string& path() const = 0;
  /// What stands in the place of `{name}` in the route's path; "" when the route has no such place.
  [[nodiscard]] virtual std::string path_parameter(std::string_view name) const = 0;
  /// Query fields, percent-decoded, duplicates kept, in their original order.
  [[nodiscard]] virtual const Fields& query() const = 0;
  /// A header field's value, "" when absent; several lines of one name are one list. Names are matched without regard
  /// to case.
  [[nodiscard]] virtual std::string header(std::string_view name) const = 0;
  /// Of the socket's other end: of a proxy where there is one.
  [[nodiscard]] virtual const std::string& remote_address() const = 0;
  /// Who is asking, for sharing what there is among clients: the name of the key, or without keys the client's address.
  /// The address is the last in `X-Forwarded-For` where a trusted proxy has sent it, else that of the socket.
  [[nodiscard]] virtual const std::string& client() const = 0;
  /// `X-Request-Id`: the client's when it sent a sane one (1..64 of [A-Za-z0-9._-]), else a fresh random one.
  [[nodiscard]] virtual const std::string& id() const = 0;
  /// The type without its parameters, in lower case: "multipart/form-data".
  [[nodiscard]] virtual std::string content_type() const = 0;
  /// Reads the body, once. Throws `Problem`: body_too_large as soon as the limit is passed (chunked bodies
  /// too), bad_request when it ends early or the form or chunking is damaged, request_timeout when it stalls.
  [[nodiscard]] virtual Body read_body() = 0;
  /// True once the client has closed the connection, be it only its sending side; cheap enough (one system
  /// call) to ask between steps of the work.
  [[nodiscard]] virtual bool client_gone() const = 0;
};

/// Where a streamed answer goes.
class Sink {
 public:
  virtual ~Sink() = default;
  /// False once the client is gone; the rest of the answer is then not worth making.
  virtual bool write(std::string_view bytes) = 0;
  /// The bytes that the answer holds in memory from now on: what is made and not yet written. Where all answers hold
  /// too many, this one may be cut. Any thread may call it.
  virtual void hold(uint64_t bytes) = 0;
};

/// What a handler answers.
struct Response {
  int status = 200;
  std::string content_type;
  /// Content-Length, Transfer-Encoding, Connection, Date and X-Request-Id are the server's own: ignored here.
  Fields headers;
  std::string body;
  /// When set, this is the body: bytes that the handler shares with others, so that none are copied for a client that
  /// takes its time. `body` is ignored.
  std::shared_ptr<const std::string> shared;
  /// When set, the body is what this writes, sent chunked as it is written; the others are ignored. It runs after
  /// the handler has returned, on the same thread, while the Request is still valid; not for HEAD. It must
  /// not throw: the answer would end there without its last chunk.
  std::function<void(Sink&)> stream;
};

/// Answers one request. May throw `proto::Problem`, which becomes `application/problem+json`; anything else
/// it throws is logged and becomes `internal` without a word of what it was.
using Handler = std::function<Response(Request&)>;

/// What becomes of a route's new requests once the server drains.
enum class WhileDraining { refuse, answer };

/// Who may call a route, where keys are asked for at all.
enum class Access {
  open,    ///< anyone
  use,     ///< any key
  manage,  ///< a key with the right to manage
};

struct RouteOptions {
  WhileDraining while_draining = WhileDraining::refuse;
  Access access = Access::open;
};

/// What the log gets to know of a finished request.
struct Finished {
  std::string id, method, remote_address;
  std::string path;    ///< as it was sent, without the query: visible ASCII, which cannot break a log's lines
  std::string route;   ///< the path as it was added, "" when there is no such route
  std::string client;  ///< as `HttpOptions::authorize` named it
  std::string trace;   ///< the trace id of a valid `traceparent` (which the answer repeats), else ""
  int status = 0;
  uint64_t bytes_in = 0, bytes_out = 0;
  double milliseconds = 0;
  std::string code;    ///< the problem's public code, "" when all went well
  std::string detail;  ///< what went wrong, for the log only (for `internal`: the exception's text)
};

/// Everything that can be set, each with its default and unit.
struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 8080;                             ///< 0: any free one
  std::string tls_cert;                        ///< PEM file of a certificate and its intermediates; "": plain HTTP
  std::string tls_key;                         ///< PEM file of its key; given when tls_cert is
  uint64_t max_body_bytes = 64u << 20;         ///< larger: 413, before it is read where a length is declared
  uint64_t max_held_bytes = 512u << 20;        ///< bodies held in memory at once: 429; and answers: the oldest are cut
  uint64_t max_header_bytes = 32u << 10;       ///< request line and header fields together: 431
  int threads = 128;                           ///< requests served at once, each on a thread
  int idle_seconds = 5;                        ///< a silent connection is closed after this, or when there are too many
  int read_seconds = 10;                       ///< for a whole head, and for each 1 KiB times this of a body: 408
  int write_seconds = 30;                      ///< longest wait for the client to take any further byte of an answer
  int keep_alive_requests = 1000;              ///< requests on one connection
  std::vector<std::string> trusted_proxies{};  ///< addresses whose `X-Forwarded-For` is believed
  /// Who is asking: a name for the log. Throws `Problem` unauthorized or forbidden. Empty: everybody may do all.
  std::function<std::string(const Request&, Access)> authorize{};
  /// May add headers to any answer, refusals too, before it is sent.
  std::function<void(const Request&, Response&)> decorate{};
  /// Called after each answer, from the connection's thread. Must not throw.
  std::function<void(const Finished&)> on_finished{};
};

/// Memory of all requests together.
struct HeldBytes {
  uint64_t bodies = 0;   ///< of requests that are read or worked on
  uint64_t answers = 0;  ///< of answers that are sent, each object once
};

/// An HTTP/1.1 server: add routes, bind, run, drain. `add` before `bind`; `drain` and `stop` may be called
/// from any thread. `run` must have returned before the server is destroyed.
class HttpServer {
 public:
  /// Throws std::runtime_error when the certificate or its key cannot be used, naming the setting.
  explicit HttpServer(HttpOptions options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Any method (HEAD follows GET, OPTIONS lists the path's methods). A segment `{name}` of the path stands for any
  /// text; paths without one come first. Unknown paths answer 404, known ones with another method 405 with `Allow`.
  void add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options = {});
  /// Binds and listens; returns the port. Throws std::runtime_error with the reason, naming host and port.
  int bind();
  /// Serves until `stop` or `drain` is done; returns at once when one was called before. Call after `bind`.
  /// Throws std::runtime_error when connections can no longer be accepted.
  void run();
  /// Reads certificate and key anew, for the connections made from then on; nothing without TLS. Any thread may call
  /// it. Throws std::runtime_error when they cannot be used; the old ones then stay.
  void reload_certificate();
  /// Requests being answered now.
  [[nodiscard]] int running() const;
  [[nodiscard]] HeldBytes held() const;
  /// Refuses new requests with 503 `draining` from now on (but for routes added with `answer`), waits until
  /// the running ones are done or the time is over, then stops. True when none was cut short.
  bool drain(int seconds);
  /// Stops at once: cuts every connection (`client_gone` is then true), and `run` returns as soon as the
  /// handlers have.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace papilio::server
