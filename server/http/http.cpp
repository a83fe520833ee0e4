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
      go_on(std::make_shared<Client>(*this, tls ? tls->transport(fd) : plain_transport(fd)));
    } catch (...) {
      // Out of memory outside a handler: this connection is lost, and its thread serves the next.
    }
  }

  struct Client;
  /// Serves the client while it has requests and no other client waits for the thread.
  void go_on(const std::shared_ptr<Client>& client) {
    const auto later = [this, client] {
      try {
        go_on(client);
      } catch (...) {
        // Out of memory: the connection is lost.
      }
    };
    while (!listener.closed()) {
      const Session::Next next = client->session.run();
      if (next.what == Session::Next::What::nothing) return;
      const Connection& connection = client->session.connection();
      if (next.what == Session::Next::What::bytes)
        return listener.park(connection.fd(), next.wait_for, connection.deadline(), later);
      if (listener.others_wait()) return listener.enqueue(later);
    }
  }

  void stop() {
    gate.close();
    listener.close();
    const std::lock_guard lock(mutex);
    for (Connection* connection : connections) connection->abort();
  }

  /// Registration of a connection that stop() cuts, during its lifetime.
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

  struct Client {
    Client(Impl& impl, std::unique_ptr<Transport> transport)
        : session(std::move(transport), impl.options, impl.held, impl.answers, impl.routes, impl.gate, impl.listener),
          listed(impl, session.connection()) {}
    Session session;
    Listed listed;
  };

  const HttpOptions options;
  ByteBudget held{options.max_held_bytes};
  HeldAnswers answers{options.max_held_bytes};
  std::optional<TlsContext> tls;
  Routes routes;
  Gate gate;
  std::mutex mutex;
  std::set<Connection*> connections;  ///< open connections, guarded by mutex
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

HeldBytes HttpServer::held() const { return {impl_->held.held(), impl_->answers.bytes()}; }

bool HttpServer::drain(int seconds) {
  impl_->gate.close();
  const bool emptied = impl_->gate.wait_until_empty(std::chrono::seconds(seconds));
  stop();
  return emptied;
}

void HttpServer::stop() { impl_->stop(); }

}  // namespace papilio::server
