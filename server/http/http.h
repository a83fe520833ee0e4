#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/problem.h"

// HTTP server behind the project's own types. cpp-httplib only listens and accepts (listener.h). Messages are read and
// written in this folder, as the library's parsers read some requests differently from proxies (head.h, body.h,
// form.h).

namespace papilio::server {

/// Names and values in their original order; names may repeat.
using Fields = std::vector<std::pair<std::string, std::string>>;

/// Part of a `multipart/form-data` body.
struct FormPart {
  std::string name;
  std::string content_type;  ///< content type; empty if the part has none
  std::string bytes;
};

/// Complete body of a request.
struct Body {
  std::string bytes;            ///< raw body; empty for a form
  std::vector<FormPart> parts;  ///< parts of a `multipart/form-data` body, in order; else empty
  uint64_t size = 0;            ///< received bytes
};

/// Request that is being answered. Valid only during the calls of the handler and its stream; used by one thread.
class Request {
 public:
  virtual ~Request() = default;
  [[nodiscard]] virtual const std::string& method() const = 0;
  [[nodiscard]] virtual const std::string& path() const = 0;
  /// Returns the segment in place of `{name}` in the route's path; "" if the path has no such segment.
  [[nodiscard]] virtual std::string path_parameter(std::string_view name) const = 0;
  /// Returns the query fields, percent-decoded, with duplicates, in their original order.
  [[nodiscard]] virtual const Fields& query() const = 0;
  /// Returns the value of a header field, "" if absent; several lines are joined to one list. Names are
  /// case-insensitive.
  [[nodiscard]] virtual std::string header(std::string_view name) const = 0;
  /// Returns the address of the socket's other end, perhaps a proxy.
  [[nodiscard]] virtual const std::string& remote_address() const = 0;
  /// Returns the client that shares resources with others: the name of the key, or without keys the client's address.
  /// The address is the last in `X-Forwarded-For` if a trusted proxy sent it, else the address of the socket.
  [[nodiscard]] virtual const std::string& client() const = 0;
  /// Returns the `X-Request-Id` of the client if it is valid (1..64 of [A-Za-z0-9._-]), else a random id.
  [[nodiscard]] virtual const std::string& id() const = 0;
  /// Returns the content type without its parameters, in lower case: "multipart/form-data".
  [[nodiscard]] virtual std::string content_type() const = 0;
  /// Reads the body, once. Throws `Problem`: body_too_large as soon as the limit is exceeded (also in chunks),
  /// bad_request for an early end or a damaged form or chunk, request_timeout if it stalls.
  [[nodiscard]] virtual Body read_body() = 0;
  /// Returns whether the client has closed the connection, or only its sending side. Costs one system call, so that it
  /// may be polled between steps of the work.
  [[nodiscard]] virtual bool client_gone() const = 0;
};

/// Output of a streamed answer.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Writes bytes. Returns false if the client is gone; the rest of the answer is then useless.
  virtual bool write(std::string_view bytes) = 0;
  /// Sets the bytes that the answer holds in memory: made and not yet written. If all answers together hold too many,
  /// this one may be cut. Thread-safe.
  virtual void hold(uint64_t bytes) = 0;
};

/// Answer of a handler.
struct Response {
  int status = 200;
  std::string content_type;
  /// Header fields. Content-Length, Transfer-Encoding, Connection, Date and X-Request-Id are set by the server, and
  /// ignored here.
  Fields headers;
  std::string body;
  /// Body shared with other answers, so that slow clients need no copy. If set, `body` is ignored.
  std::shared_ptr<const std::string> shared;
  /// Function that writes the body, sent in chunks. If set, `body` and `shared` are ignored. It runs after the handler,
  /// on its thread, while the request is valid; not for HEAD. It must not throw: the answer would end without its last
  /// chunk.
  std::function<void(Sink&)> stream;
};

/// Function that answers a request. A `proto::Problem` that it throws becomes `application/problem+json`; any other
/// exception is logged, and becomes `internal` without its message.
using Handler = std::function<Response(Request&)>;

/// Treatment of a route's new requests while the server drains.
enum class WhileDraining { refuse, answer };

/// Access to a route, if keys are required.
enum class Access {
  open,    ///< without a key
  use,     ///< any key
  manage,  ///< a key with the right to manage
};

struct RouteOptions {
  WhileDraining while_draining = WhileDraining::refuse;
  Access access = Access::open;
};

/// Finished request, for the log.
struct Finished {
  std::string id, method, remote_address;
  std::string path;    ///< path as sent, without the query: visible ASCII, which cannot break a line of the log
  std::string route;   ///< path of the route, "" if there is none
  std::string client;  ///< name by `HttpOptions::authorize`
  std::string trace;   ///< trace id of a valid `traceparent` (which the answer repeats), else ""
  int status = 0;
  uint64_t bytes_in = 0, bytes_out = 0;
  double milliseconds = 0;
  std::string code;    ///< public code of the problem, "" for success
  std::string detail;  ///< detail of the problem, for the log only (for `internal`: the exception's message)
};

/// Options of the server.
struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 8080;                             ///< port; 0: any free one
  std::string tls_cert;                        ///< PEM file of a certificate and its intermediates; "": plain HTTP
  std::string tls_key;                         ///< PEM file of the certificate's key; required with tls_cert
  uint64_t max_body_bytes = 64u << 20;         ///< limit of a body: 413, before it is read if its length is declared
  uint64_t max_held_bytes = 512u << 20;        ///< limit of all bodies: 429; and of all answers: the oldest are cut
  uint64_t max_header_bytes = 32u << 10;       ///< limit of request line and header fields together: 431
  int threads = 128;                           ///< limit of concurrent requests, each on a thread
  int idle_seconds = 5;                        ///< time after which a silent connection is closed; earlier if too many
  int read_seconds = 10;                       ///< time for a whole head, and for each 1 KiB times this of a body: 408
  int write_seconds = 30;                      ///< longest wait for the client to take a further byte of an answer
  int keep_alive_requests = 1000;              ///< limit of requests on one connection
  std::vector<std::string> trusted_proxies{};  ///< addresses of proxies whose `X-Forwarded-For` is trusted
  /// Function that authorizes a request and returns the client's name for the log. Throws `Problem` unauthorized or
  /// forbidden. Empty: no keys are required.
  std::function<std::string(const Request&, Access)> authorize{};
  /// Function that may add headers to any answer, including refusals, before it is sent.
  std::function<void(const Request&, Response&)> decorate{};
  /// Function called after each answer, on the connection's thread. Must not throw.
  std::function<void(const Finished&)> on_finished{};
};

/// Memory of all requests together.
struct HeldBytes {
  uint64_t bodies = 0;   ///< bodies of requests that are read or worked on
  uint64_t answers = 0;  ///< answers that are sent; shared objects count once
};

/// HTTP/1.1 server: add routes, bind, run, drain. Call add() before bind(). drain() and stop() are thread-safe. run()
/// must have returned before the server is destroyed.
class HttpServer {
 public:
  /// Reads the certificate, if any. Throws std::runtime_error, with the setting's name, if it or its key cannot be
  /// used.
  explicit HttpServer(HttpOptions options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Adds a route of any method; HEAD follows GET, and OPTIONS lists the path's methods. A segment `{name}` of the path
  /// matches any text; paths without one have priority. Unknown paths are answered with 404, and known paths with
  /// another method with 405 and `Allow`.
  void add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options = {});
  /// Binds and listens; returns the port. Throws std::runtime_error with the reason, host and port.
  int bind();
  /// Serves until stop() or drain() is done; returns at once if one was called before. Call after bind(). Throws
  /// std::runtime_error if connections can no longer be accepted.
  void run();
  /// Reloads certificate and key for new connections; does nothing without TLS. Thread-safe. Throws std::runtime_error
  /// if they cannot be used; the old ones then stay in use.
  void reload_certificate();
  /// Returns the number of running requests.
  [[nodiscard]] int running() const;
  [[nodiscard]] HeldBytes held() const;
  /// Refuses new requests with 503 `draining`, except on routes added with `answer`; waits until running requests are
  /// done or `seconds` have passed, then stops. Returns whether no request was cut.
  bool drain(int seconds);
  /// Stops at once: cuts every connection (`client_gone` is then true); run() returns as soon as the handlers have.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace papilio::server
