#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "client/cli/refine_mesh.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

/// Throws if one folder contains the other: results among sources would replace them, or be refined the next time.
void check_folders_apart(const fs::path& input, const fs::path& output) {
  const fs::path inner = fs::weakly_canonical(output);
  const fs::path outer = fs::canonical(input);
  if (std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end())
    throw UsageError(output.string() + " lies in " + input.string() + ". Name a folder outside of it for the results.");
}

void check_flags(const RefineFlags& flags) {
  if (flags.output.path.empty()) throw UsageError("Name a folder for the results: -o FOLDER.");
  if (flags.output.is_standard())
    throw UsageError("The results of a folder cannot go to standard output. Name a folder: -o FOLDER.");
  if (flags.input.format)
    throw UsageError("--from is for one mesh; the format of each file in a folder is that of its extension.");
  check_folders_apart(flags.input.path, flags.output.path);
}

/// Contents of a folder.
struct Plan {
  std::vector<std::pair<fs::path, fs::path>> files;  ///< mesh files, each with the name of its result
  std::vector<fs::path> skipped;                     ///< other files, relative to the folder
};

/// Returns the format of a result without --to: scenes stay scenes, other meshes become Draco.
Format default_format(const fs::path& name) {
  const Format format = known_format_of(name).value_or(Format::drc);
  return is_scene(format) ? format : Format::drc;
}

/// Lists the files of a folder in alphabetical order.
Plan plan_folder(const fs::path& input, const fs::path& output, const std::optional<Format>& format) {
  Plan plan;
  std::map<fs::path, fs::path> taken;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(input)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const fs::path name = fs::relative(entry.path(), input);
    if (!entry.is_regular_file() || !known_format_of(name)) {
      plan.skipped.push_back(name);
      continue;
    }
    fs::path result = output / name;
    result.replace_extension(name_of(format.value_or(default_format(name))));
    const auto [other, is_new] = taken.emplace(result, entry.path());
    if (!is_new)
      throw UsageError(entry.path().string() + " and " + other->second.string() + " would both become " +
                       result.string() + ". Rename one.");
    plan.files.emplace_back(entry.path(), result);
  }
  if (plan.files.empty())
    throw UsageError(input.string() + " has no .drc, .obj, .ply, .off, .stl, .glb or .gltf file in it.");
  std::ranges::sort(plan.files);
  std::ranges::sort(plan.skipped);
  return plan;
}

/// Progress in one line, if standard error is a terminal.
class Progress {
 public:
  explicit Progress(size_t total) : total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

  /// Counts a finished file. `failure`: message with the file's name, or "".
  void step(const fs::path& path, const std::string& failure) {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (on_terminal_) std::cerr << "\r\033[K";
    if (!failure.empty()) {
      ++failed_;
      std::cerr << proto::escape_controls(failure) << '\n';
    }
    if (!on_terminal_) return;
    constexpr size_t width = 30;
    const size_t filled = width * done_ / total_;
    std::cerr << '[' << std::string(filled, '#') << std::string(width - filled, '.') << "] " << done_ << '/' << total_
              << ' ' << proto::escape_controls(path.filename().string()) << (done_ == total_ ? "\n" : "") << std::flush;
  }
  [[nodiscard]] size_t failed() const { return failed_; }

 private:
  const size_t total_;
  const bool on_terminal_;
  std::mutex mutex_;
  size_t done_ = 0;
  size_t failed_ = 0;
};

std::string refine_one_of_many(const fs::path& input, const MeshPlace& output, const RefineFlags& flags) {
  try {
    fs::create_directories(output.path.parent_path());
    save_refined(output, refine_mesh({.path = input}, output, flags, 1));
    return {};
  } catch (const FileError& error) {
    return error.what();
  } catch (const std::exception& error) {
    return input.string() + ": " + error.what();
  }
}

/// Formats "3 files: a.txt, b.txt, c.txt"; only the first names of many.
std::string list_of(const std::vector<fs::path>& names) {
  constexpr size_t most = 5;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i)
    proto::append_item(text, ", ", proto::escape_controls(names[i].string()));
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return std::to_string(names.size()) + (names.size() == 1 ? " file: " : " files: ") + text;
}

}  // namespace

void refine_folder(const RefineFlags& flags) {
  check_flags(flags);
  const Plan plan = plan_folder(flags.input.path, flags.output.path, flags.output.format);
  Progress progress(plan.files.size());
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < plan.files.size(); i = next++) {
      const auto& [input, output] = plan.files[i];
      progress.step(input, refine_one_of_many(input, {.path = output}, flags));
    }
  };
  std::vector<std::jthread> workers;
  for (int job = 1; job < flags.jobs; ++job) workers.emplace_back(work);
  work();
  workers.clear();
  const std::string total = std::to_string(plan.files.size());
  if (flags.json)
    std::cout << "{\"files\": " << total << ", \"failed\": " << progress.failed()
              << ", \"skipped\": " << plan.skipped.size() << "}\n";
  else
    std::cerr << plan.files.size() - progress.failed() << " of " << total << " meshes refined into "
              << proto::escape_controls(flags.output.path.string()) << '\n';
  if (!plan.skipped.empty()) std::cerr << "skipped, not meshes by their extension: " << list_of(plan.skipped) << '\n';
  if (progress.failed() > 0)
    throw std::runtime_error(std::to_string(progress.failed()) + " of " + total +
                             " meshes could not be refined; the reasons are above.");
}

}  // namespace papilio::client
