#include "server/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

namespace papilio::server {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;
using prometheus::Registry;

const Histogram::BucketBoundaries seconds{.001, .0025, .005, .01, .025, .05, .1, .25, .5, 1, 2.5, 5, 10, 30, 60};

Family<Counter>& counters(Registry& registry, const std::string& name, const std::string& help) {
  return BuildCounter().Name("papilio_" + name).Help(help).Register(registry);
}
Counter& counter(Registry& registry, const std::string& name, const std::string& help) {
  return counters(registry, name, help).Add({});
}
Family<Histogram>& histograms(Registry& registry, const std::string& name, const std::string& help) {
  return BuildHistogram().Name("papilio_" + name).Help(help).Register(registry);
}
Family<Gauge>& gauges(Registry& registry, const std::string& name, const std::string& help) {
  return BuildGauge().Name(name).Help(help).Register(registry);
}

/// Returns the label of a method. Clients may send any token; methods outside a closed list share one label.
std::string method_label(const std::string& method) {
  constexpr std::array<std::string_view, 7> known{"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"};
  return std::ranges::find(known, method) == known.end() ? "other" : method;
}

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double pages = 0;
  in >> pages >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

struct Metrics::Families {
  Registry registry;
  Family<Counter>& requests = counters(registry, "requests_total", "Requests answered");
  Family<Histogram>& request_seconds =
      histograms(registry, "request_seconds", "From a request's first byte to its answer's last");
  Family<Counter>& problems = counters(registry, "problems_total", "Requests that ended in a problem, by its code");
  Family<Histogram>& stage_seconds = histograms(registry, "stage_seconds", "Time spent in each stage of a refinement");
  Histogram& queue = stage_seconds.Add({{"stage", "queue"}}, seconds);
  Histogram& decode = stage_seconds.Add({{"stage", "decode"}}, seconds);
  Histogram& refine = stage_seconds.Add({{"stage", "refine"}}, seconds);
  Histogram& encode = stage_seconds.Add({{"stage", "encode"}}, seconds);
  Counter& faces_in = counter(registry, "faces_in_total", "Faces of the meshes that were refined");
  Counter& faces_out = counter(registry, "faces_out_total", "Faces of the results");
  Counter& bytes_in = counter(registry, "received_bytes_total", "Bytes of requests");
  Counter& bytes_out = counter(registry, "sent_bytes_total", "Bytes of answers");
  Family<Counter>& lookups = counters(registry, "cache_lookups_total", "Questions to a cache");
  Counter& shared = counter(registry, "shared_results_total", "Results taken from a request that was making the same");
  Family<Gauge>& caches = gauges(registry, "papilio_cache_bytes", "Bytes that a cache holds");
  Family<Gauge>& held = gauges(registry, "papilio_held_bytes", "Bytes of requests' bodies, and of answers being sent");
  Gauge& slots = gauges(registry, "papilio_slots", "Requests that may compute at once, besides one small one").Add({});
  Gauge& computing = gauges(registry, "papilio_slots_busy", "Requests that compute now").Add({});
  Gauge& waiting =
      gauges(registry, "papilio_queue_length", "Requests that wait for a slot, or for another one").Add({});
  // A store of unknown contents (Redis) has no value, rather than 0.
  Family<Gauge>& meshes = gauges(registry, "papilio_store_meshes", "Meshes in the store, where it knows");
  Family<Gauge>& mesh_bytes = gauges(registry, "papilio_store_bytes", "Bytes of the meshes in the store");
  Gauge& memory = gauges(registry, "process_resident_memory_bytes", "Memory of this process").Add({});
};

namespace {

std::string name_of(Metrics::Cache cache) { return cache == Metrics::Cache::results ? "results" : "meshes"; }

}  // namespace

Metrics::Metrics() : families_(std::make_unique<Families>()) {
  gauges(families_->registry, "papilio_build_info", "1; the version is its label")
      .Add({{"version", PAPILIO_VERSION}})
      .Set(1);
}
Metrics::~Metrics() = default;

void Metrics::count_request(const Finished& request) {
  Families& f = *families_;
  const std::string route = request.route.empty() ? "none" : request.route;
  f.requests
      .Add({{"route", route}, {"method", method_label(request.method)}, {"status", std::to_string(request.status)}})
      .Increment();
  f.request_seconds.Add({{"route", route}}, seconds).Observe(request.milliseconds / 1000);
  if (!request.code.empty()) count_problem(request.code);
  f.bytes_in.Increment(static_cast<double>(request.bytes_in));
  f.bytes_out.Increment(static_cast<double>(request.bytes_out));
}

void Metrics::count_problem(const std::string& code) { families_->problems.Add({{"code", code}}).Increment(); }

void Metrics::count_refinement(uint64_t faces_in, const proto::Statistics& made) {
  Families& f = *families_;
  f.faces_in.Increment(static_cast<double>(faces_in));
  f.faces_out.Increment(static_cast<double>(made.faces));
  f.decode.Observe(made.times.decode / 1000);
  f.refine.Observe(made.times.refine / 1000);
  f.encode.Observe(made.times.encode / 1000);
}

void Metrics::count_lookup(Cache cache, bool hit) {
  families_->lookups.Add({{"cache", name_of(cache)}, {"outcome", hit ? "hit" : "miss"}}).Increment();
}

void Metrics::count_shared() { families_->shared.Increment(); }

void Metrics::observe_wait(double waited) { families_->queue.Observe(waited); }

std::string Metrics::text(const Gauges& now) {
  Families& f = *families_;
  f.slots.Set(now.slots);
  f.computing.Set(now.computing);
  f.waiting.Set(now.waiting);
  f.caches.Add({{"cache", "results"}}).Set(static_cast<double>(now.result_cache_bytes));
  f.caches.Add({{"cache", "meshes"}}).Set(static_cast<double>(now.mesh_cache_bytes));
  f.held.Add({{"what", "bodies"}}).Set(static_cast<double>(now.held.bodies));
  f.held.Add({{"what", "answers"}}).Set(static_cast<double>(now.held.answers));
  if (now.store_meshes) f.meshes.Add({}).Set(static_cast<double>(*now.store_meshes));
  if (now.store_bytes) f.mesh_bytes.Add({}).Set(static_cast<double>(*now.store_bytes));
  f.memory.Set(resident_bytes());
  return prometheus::TextSerializer().Serialize(f.registry.Collect());
}

}  // namespace papilio::server
