#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "client/cli/commands.h"
#include "client/lib/mesh_stream.h"
#include "client/lib/remote.h"
#include "proto/findings.h"
#include "proto/refinement.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;
using proto::EncodedLevel;

/// Here or there: both go the same way from the same stream, so the bytes are the same.
EncodedLevel refine_stream(const std::string& draco, const RefineFlags& flags, unsigned threads) {
  if (!flags.server.empty()) return Remote(flags.server, flags.remote).refine(draco, flags.parameters);
  constexpr proto::Limits own_limits{face_count_limit, face_count_limit, face_count_limit};
  return proto::Refinement(draco, flags.parameters, own_limits).run({.threads = static_cast<int>(threads)});
}

void report(std::ostream& out, const RefineFlags& flags, const proto::Statistics& statistics, size_t bytes) {
  if (flags.json) {
    out << proto::statistics_json(statistics);
    return;
  }
  std::cerr << flags.output << ": " << statistics.vertices << " vertices, " << statistics.faces << " faces, " << bytes
            << " bytes of Draco, " << statistics.level << " levels; decode " << statistics.times.decode
            << " ms, refine " << statistics.times.refine << " ms, encode " << statistics.times.encode << " ms\n";
  if (const std::string found = proto::defects_text(statistics.found); !found.empty())
    std::cerr << flags.input << ": worked round " << found << '\n';
}

/// Refuses a bad name before the work.
void check_output_name(const std::string& name) {
  try {
    (void)format_of(name);
  } catch (const FileError& error) {
    throw UsageError(error.what());
  }
}

/// Results among the sources would replace them, or be refined themselves the next time.
void check_folders_apart(const fs::path& input, const fs::path& output) {
  const fs::path inner = fs::weakly_canonical(output);
  const fs::path outer = fs::canonical(input);
  if (std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end())
    throw UsageError(output.string() + " lies in " + input.string() + ". Name a folder outside of it for the results.");
}

void refine_file(const RefineFlags& flags) {
  const bool to_standard_output = flags.output == "-";
  if (!to_standard_output) check_output_name(flags.output);
  const EncodedLevel made = refine_stream(load_draco(flags.input), flags, std::thread::hardware_concurrency());
  if (to_standard_output) {
    std::cout.write(made.draco.data(), static_cast<std::streamsize>(made.draco.size()));
  } else {
    save_draco(flags.output, made.draco);
  }
  report(to_standard_output ? std::cerr : std::cout, flags, made.statistics, made.draco.size());
}

/// Mesh files below a folder, each with the name of its result, in alphabetical order.
std::map<fs::path, fs::path> plan_folder(const RefineFlags& flags) {
  std::map<fs::path, fs::path> plan;
  std::map<fs::path, fs::path> taken;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(flags.input)) {
    if (!entry.is_regular_file()) continue;
    try {
      (void)format_of(entry.path());
    } catch (const FileError&) {
      continue;  // not a mesh file
    }
    fs::path result = flags.output / fs::relative(entry.path(), flags.input);
    result.replace_extension(flags.to);
    const auto [other, is_new] = taken.emplace(result, entry.path());
    if (!is_new)
      throw UsageError(entry.path().string() + " and " + other->second.string() + " would both become " +
                       result.string() + ". Rename one.");
    plan.emplace(entry.path(), result);
  }
  if (plan.empty()) throw UsageError(flags.input + " has no .drc, .obj, .ply, .off or .stl file in it.");
  return plan;
}

/// One line on a terminal, nothing elsewhere.
class Progress {
 public:
  explicit Progress(size_t total) : total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

  /// One more is done; `failure` says why it failed, "" when it did not.
  void step(const fs::path& path, const std::string& failure) {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (on_terminal_) std::cerr << "\r\033[K";
    if (!failure.empty()) {
      ++failed_;
      std::cerr << path.string() << ": " << failure << '\n';
    }
    if (!on_terminal_) return;
    constexpr size_t width = 30;
    const size_t filled = width * done_ / total_;
    std::cerr << '[' << std::string(filled, '#') << std::string(width - filled, '.') << "] " << done_ << '/' << total_
              << ' ' << path.filename().string() << (done_ == total_ ? "\n" : "") << std::flush;
  }
  [[nodiscard]] size_t failed() const { return failed_; }

 private:
  const size_t total_;
  const bool on_terminal_;
  std::mutex mutex_;
  size_t done_ = 0;
  size_t failed_ = 0;
};

std::string refine_one_of_many(const fs::path& input, const fs::path& output, const RefineFlags& flags) {
  try {
    fs::create_directories(output.parent_path());
    save_draco(output, refine_stream(load_draco(input), flags, 1).draco);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

void refine_folder(const RefineFlags& flags) {
  if (flags.output == "-") throw UsageError("The results of a folder cannot go to standard output; name a folder.");
  check_folders_apart(flags.input, flags.output);
  const std::map<fs::path, fs::path> plan = plan_folder(flags);
  const std::vector<std::pair<fs::path, fs::path>> files(plan.begin(), plan.end());
  Progress progress(files.size());
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < files.size(); i = next++)
      progress.step(files[i].first, refine_one_of_many(files[i].first, files[i].second, flags));
  };
  std::vector<std::jthread> workers;
  for (int job = 1; job < flags.jobs; ++job) workers.emplace_back(work);
  work();
  workers.clear();
  if (flags.json)
    std::cout << "{\"files\": " << files.size() << ", \"failed\": " << progress.failed() << "}\n";
  else
    std::cerr << files.size() - progress.failed() << " of " << files.size() << " meshes refined into " << flags.output
              << '\n';
  if (progress.failed() > 0)
    throw std::runtime_error(std::to_string(progress.failed()) + " of " + std::to_string(files.size()) +
                             " meshes could not be refined; the reasons are above.");
}

}  // namespace

void refine_command(const RefineFlags& flags) {
  try {
    if (!flags.server.empty()) (void)Remote(flags.server);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (fs::is_directory(flags.input))
    refine_folder(flags);
  else
    refine_file(flags);
}

}  // namespace papilio::client
