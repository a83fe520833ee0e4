#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "proto/multipart.h"
#include "proto/problem.h"
#include "server/log.h"
#include "server/routes/refined_answer.h"

namespace papilio::server {
namespace {

using proto::BodyPart;
using proto::Code;
using proto::EncodedLevel;
using proto::Problem;

/// Queue of parts between the thread that makes them and the one that sends them.
class Outbox {
 public:
  /// Reports the held bytes to the sink.
  explicit Outbox(Sink& sink) : sink_(sink) {}

  void put(BodyPart part) {
    const std::lock_guard lock(mutex_);
    bytes_ += part.body.size();
    parts_.push_back(std::move(part));
    sink_.hold(bytes_);
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }
  /// Takes a part; nothing if none arrives within `longest`, or none is left. Releases the part taken before.
  std::optional<BodyPart> take(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    if (taken_ > 0) sink_.hold(bytes_ -= std::exchange(taken_, 0));
    changed_.wait_for(lock, longest, [&] { return !parts_.empty() || closed_; });
    if (parts_.empty()) return std::nullopt;
    BodyPart part = std::move(parts_.front());
    taken_ = part.body.size();
    parts_.pop_front();
    return part;
  }
  [[nodiscard]] bool finished() const {
    const std::lock_guard lock(mutex_);
    return closed_ && parts_.empty();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Sink& sink_;
  std::deque<BodyPart> parts_;
  uint64_t bytes_ = 0;  ///< bytes of the parts, and of the part taken last
  uint64_t taken_ = 0;
  bool closed_ = false;
};

BodyPart level_part(const EncodedLevel& level, const std::string& type) {
  BodyPart part{{{"Content-Type", type}}, level.bytes};
  for (auto& header : proto::statistics_headers(level.statistics)) part.headers.push_back(std::move(header));
  return part;
}

/// Reports a problem to log and metrics, as the status, a success, was already sent.
void report(Engine& engine, const std::string& request_id, Code code, const std::string& detail) {
  const proto::ProblemKind& kind = proto::problem_kind(code);
  engine.metrics().count_problem(std::string(kind.name));
  log_event(kind.status >= 500 ? "error" : "info", "stream",
            {{"id", request_id}, {"code", std::string(kind.name)}, {"detail", detail}});
}

/// Makes all parts of the stream; after a failure, the last part is a problem. Throws only if there is no memory for
/// it.
void make_parts(Engine& engine, const RunRefinement& run, const std::string& type, const std::string& request_id,
                Admission::Slot& slot, const std::function<bool()>& abandoned, Outbox& outbox) {
  const auto fail = [&](const Problem& problem) {
    outbox.put({{{"Content-Type", "application/problem+json"}}, problem.json(request_id)});
  };
  try {
    const EncodedLevel last = run(
        {.on_level = [&](const EncodedLevel& level) { outbox.put(level_part(level, type)); }, .cancelled = abandoned},
        slot);
    outbox.put({{{"Content-Type", json_type}}, proto::statistics_json(last.statistics)});
  } catch (const Problem& problem) {
    if (problem.code() == Code::cancelled) return;  // there is no reader, and the sender reports it
    report(engine, request_id, problem.code(), problem.what());
    fail(problem);
  } catch (const std::exception& error) {
    report(engine, request_id, Code::internal, error.what());
    fail(Problem(Code::internal, "An internal error occurred. The log lists it under the request id."));
  }
}

constexpr std::chrono::milliseconds check_interval{50};

}  // namespace

Response level_stream(Engine& engine, Request& request, std::shared_ptr<Admission::Slot> slot, const std::string& type,
                      RunRefinement run) {
  const proto::MultipartWriter writer;
  Response response;
  response.content_type = writer.content_type();
  response.headers = {{"Vary", "Accept"},
                      {"Cache-Control", "no-store"},
                      {"X-Accel-Buffering", "no"}};  // a proxy must pass on each level at once
  response.stream = [&engine, &request, writer, type, slot = std::move(slot),
                     run = std::move(run)](Sink& sink) mutable {
    Outbox outbox(sink);
    std::atomic<bool> gone = false;
    std::atomic<bool> failed = false;
    const std::jthread maker([&] {
      try {
        make_parts(
            engine, run, type, request.id(), *slot, [&] { return gone.load(); }, outbox);
      } catch (...) {
        failed = true;
      }
      run = nullptr;
      slot.reset();
      outbox.close();
    });
    while (!outbox.finished()) {
      const std::optional<BodyPart> part = outbox.take(check_interval);
      gone = gone || request.client_gone() || (part && !sink.write(writer.part(*part)));
    }
    if (gone) throw Problem(Code::cancelled, "The client went away.");
    if (failed) throw Problem(Code::out_of_memory, "The stream could not be carried on.");
    sink.write(writer.end());
  };
  return response;
}

}  // namespace papilio::server
