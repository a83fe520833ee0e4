#include <array>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/bench/markdown_table.h"
#include "tests/bench/report.h"

// The WebAssembly module compared with the native library, measured by tests/npm/times.mjs.

namespace papilio::bench {
namespace {

std::string output_of(const char* command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command, "r"), [](FILE* file) { return ::pclose(file); });
  if (!pipe) throw std::runtime_error("no pipe");
  std::string text;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

std::vector<ReportRow> print() {
  std::vector<ReportRow> rows;
  MarkdownTable table(
      {"processor time, ms", "WebAssembly", "and copied out", "native", "WebAssembly / native", "copied out / native"});
  std::istringstream lines(output_of("node tests/npm/times.mjs"));
  std::string name;
  double ours = 0, copied = 0, peer = 0;
  while (lines >> name >> ours >> copied >> peer) {
    rows.push_back({name, ours, peer, "ms"});
    rows.push_back({name + " copied out", copied, peer, "ms"});
    table.add({name, fixed(ours, 2), fixed(copied, 2), fixed(peer, 2), fixed(ours / peer, 2), fixed(copied / peer, 2)});
  }
  if (rows.empty()) throw std::runtime_error("tests/npm/times.mjs has failed; ./dev wasm builds what it needs");
  table.print();
  return rows;
}

}  // namespace

void add_wasm() { add({"wasm", print}); }

}  // namespace papilio::bench
