#include "server/http/http.h"

#include <mutex>
#include <optional>
#include <set>

#include "server/http/byte_budget.h"
#include "server/http/connection.h"
#include "server/http/gate.h"
#include "server/http/listener.h"
#include "server/http/routes.h"
#include "server/http/session.h"
#include "server/http/tls.h"

namespace papilio::server {

struct HttpServer::Impl {
  explicit Impl(HttpOptions given)
      : options(std::move(given)), listener(options.threads, [this](int fd) { serve(fd); }) {
    if (!options.tls_cert.empty()) tls.emplace(options.tls_cert, options.tls_key);
  }

  void serve(int fd) {
    try {
      Connection connection(tls ? tls->transport(fd) : plain_transport(fd), std::chrono::seconds(options.read_seconds),
                            std::chrono::seconds(options.write_seconds));
      const Listed listed(*this, connection);
      if (!listener.closed()) Session(connection, options, held, routes, gate, listener).run();
    } catch (...) {
      // Out of memory outside of a handler: this connection is lost, its thread goes on to the next.
    }
  }

  void stop() {
    gate.close();
    listener.close();
    const std::lock_guard lock(mutex);
    for (Connection* connection : connections) connection->abort();
  }

  /// A connection that `stop` cuts, for as long as this lives.
  class Listed {
   public:
    Listed(Impl& impl, Connection& connection) : impl_(impl), connection_(connection) {
      const std::lock_guard lock(impl_.mutex);
      impl_.connections.insert(&connection_);
    }
    ~Listed() {
      const std::lock_guard lock(impl_.mutex);
      impl_.connections.erase(&connection_);
    }
    Listed(const Listed&) = delete;
    Listed& operator=(const Listed&) = delete;

   private:
    Impl& impl_;
    Connection& connection_;
  };

  const HttpOptions options;
  ByteBudget held{options.max_held_bytes};
  std::optional<TlsContext> tls;
  Routes routes;
  Gate gate;
  std::mutex mutex;
  std::set<Connection*> connections;  ///< guarded by mutex: those being served
  Listener listener;
};

HttpServer::HttpServer(HttpOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

HttpServer::~HttpServer() { stop(); }

void HttpServer::add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options) {
  impl_->routes.add(method, path, std::move(handler), options);
}

int HttpServer::bind() { return impl_->listener.open(impl_->options.host, impl_->options.port); }

void HttpServer::run() { impl_->listener.run(); }

void HttpServer::reload_certificate() {
  if (impl_->tls) impl_->tls->reload();
}

int HttpServer::running() const { return impl_->gate.running(); }

bool HttpServer::drain(int seconds) {
  impl_->gate.close();
  const bool emptied = impl_->gate.wait_until_empty(std::chrono::seconds(seconds));
  stop();
  return emptied;
}

void HttpServer::stop() { impl_->stop(); }

}  // namespace papilio::server
