#include "server/http/listener.h"

#include <httplib.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "server/http/thread_pool.h"

namespace papilio::server {
namespace {

/// Backlog of the socket. cpp-httplib's is 5, compiled into the library: a burst of clients would wait for
/// retransmissions.
constexpr int backlog = 1024;

/// Idle time after which a thread ends: longer than a client's pause between two connections, and shorter than the time
/// after which memory is returned.
constexpr std::chrono::milliseconds idle_thread{1000};

/// Adapter of the thread pool and the parked sockets for cpp-httplib.
class TaskQueue : public httplib::TaskQueue {
 public:
  TaskQueue(size_t threads, size_t most_parked, std::atomic<TaskQueue*>& known)
      : pool_(threads, idle_thread), parking_(most_parked), known_(known) {
    known_ = this;
  }
  ~TaskQueue() override { known_ = nullptr; }

  // Returns void in 0.11 and bool in 0.18.
  using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));
  Enqueued enqueue(std::function<void()> serve) override {
    pool_.enqueue(std::move(serve));
    return Enqueued(true);
  }
  void shutdown() override {
    parking_.close();  // first, as it must not resume work in a pool that is shut down
    pool_.shutdown();
  }

  void park(int fd, short events, Parking::Clock::time_point deadline, std::function<void()> resume) {
    parking_.park(fd, events, deadline,
                  [this, resume = std::move(resume)]() mutable { pool_.enqueue(std::move(resume)); });
  }
  [[nodiscard]] bool has_waiting() const { return pool_.has_waiting(); }

 private:
  ThreadPool pool_;
  Parking parking_;
  std::atomic<TaskQueue*>& known_;
};

/// Returns the number of file descriptors left beside those of served connections, stores and files.
size_t most_parked(size_t threads) {
  constexpr size_t most = 4096, least = 16, others = 64;
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  const size_t descriptors = limit.rlim_cur;
  return std::clamp(descriptors > threads + others ? descriptors - threads - others : 0, least, most);
}

/// Sets the options of the socket. The library's default sets SO_REUSEPORT, with which two servers silently share a
/// port.
void set_listening_options(int fd) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

class Listener::Server : public httplib::Server {
 public:
  Server(int threads, std::function<void(int)> serve) : serve_(std::move(serve)) {
    new_task_queue = [this, threads] {
      return new TaskQueue(static_cast<size_t>(threads), most_parked(static_cast<size_t>(threads)), tasks_);
    };
    set_socket_options(set_listening_options);
    // Accepted sockets inherit TCP_NODELAY. Otherwise a small answer would wait 40 ms for the client's delayed
    // acknowledgement.
    set_tcp_nodelay(true);
  }

  ~Server() override {
    if (fd_ != INVALID_SOCKET) ::close(fd_);
  }

  int open(const std::string& host, int port) {
    errno = 0;
    const int bound = port == 0 ? bind_to_any_port(host) : bind_to_port(host, port) ? port : -1;
    fd_ = svr_sock_.load();
    if (bound < 0 || ::listen(fd_, backlog) != 0) {
      const std::string reason = errno == 0 ? "the host is unknown" : std::strerror(errno);
      throw std::runtime_error("cannot listen on " + host + ":" + std::to_string(port) + ": " + reason);
    }
    return bound;
  }

  void run() {
    if (fd_ == INVALID_SOCKET) throw std::runtime_error("the server was not bound");
    if (listen_after_bind() || closed_) return;
    fd_ = INVALID_SOCKET;  // the library has closed it
    throw std::runtime_error("connections can no longer be accepted");
  }

  // The library's stop() has no effect before listening has begun, and closes the descriptor under the accepting
  // thread. Here the descriptor stays open until the end, and `shutdown` wakes that thread.
  void stop_listening() {
    closed_ = true;
    if (svr_sock_.exchange(INVALID_SOCKET) != INVALID_SOCKET) ::shutdown(fd_, SHUT_RDWR);
  }

  [[nodiscard]] bool closed() const { return closed_; }
  [[nodiscard]] bool others_wait() const {
    const TaskQueue* const tasks = tasks_;
    return tasks != nullptr && tasks->has_waiting();
  }
  void park(int fd, short events, Parking::Clock::time_point deadline, std::function<void()> resume) {
    tasks_.load()->park(fd, events, deadline, std::move(resume));
  }
  void enqueue(std::function<void()> work) { tasks_.load()->enqueue(std::move(work)); }

 private:
  bool process_and_close_socket(socket_t fd) override {
    serve_(fd);
    return true;
  }

  const std::function<void(int)> serve_;
  std::atomic<socket_t> fd_ = INVALID_SOCKET;
  std::atomic<TaskQueue*> tasks_ = nullptr;  ///< task queue, owned by the library
  std::atomic<bool> closed_ = false;
};

Listener::Listener(int threads, std::function<void(int fd)> serve)
    : server_(std::make_unique<Server>(threads, std::move(serve))) {}
Listener::~Listener() = default;
int Listener::open(const std::string& host, int port) { return server_->open(host, port); }
void Listener::run() { server_->run(); }
void Listener::close() { server_->stop_listening(); }
bool Listener::closed() const { return server_->closed(); }
bool Listener::others_wait() const { return server_->others_wait(); }
void Listener::enqueue(std::function<void()> work) { server_->enqueue(std::move(work)); }
void Listener::park(int fd, short events, Parking::Clock::time_point deadline, std::function<void()> resume) {
  server_->park(fd, events, deadline, std::move(resume));
}

}  // namespace papilio::server
