#include <unistd.h>

#include <filesystem>

#include "client/cli/commands.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

Format format_as_called(const MeshPlace& output) {
  try {
    return output_format(output);
  } catch (const FileError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

void check_output(const MeshPlace& output) {
  const fs::path& path = output.path;
  if (!output.is_standard() && is_folder(path)) throw UsageError(path.string() + " is a folder. Name a file in it.");
  const Format format = format_as_called(output);
  if (output.is_standard()) {
    if (format == Format::gltf)
      throw UsageError("A .gltf file has a .bin file beside it. Name a file with -o, or write one file with --to glb.");
    const bool is_text = format == Format::obj || format == Format::off;
    if (!is_text && isatty(STDOUT_FILENO) == 1)
      throw UsageError("The result is binary, and standard output is a terminal. Name a file with -o, or use a pipe.");
    return;
  }
  const fs::path folder = path.parent_path();
  if (!folder.empty() && !is_folder(folder))
    throw FileError(path, "cannot be written: there is no folder " + folder.string() + "; make it first");
}

}  // namespace papilio::client
