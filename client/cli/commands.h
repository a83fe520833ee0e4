#pragma once

#include <stdexcept>
#include <string>

#include "client/lib/compare.h"
#include "client/lib/remote.h"
#include "proto/parameters.h"

// What the subcommands do, one function each. Failures are exceptions; `main` turns them into words and an
// exit status.

namespace papilio::client {

struct RefineFlags {
  std::string input;       ///< mesh file or folder
  std::string output;      ///< mesh file, folder, or "-" for standard output
  std::string server;      ///< URL; empty: refine in this process
  RemoteOptions remote;    ///< how that server is spoken to
  std::string to = "drc";  ///< kind of the results of a folder
  int jobs = 1;            ///< meshes of a folder refined at once
  bool json = false;       ///< statistics as JSON on standard output
  proto::Parameters parameters;
};
void refine_command(const RefineFlags& flags);

struct InfoFlags {
  std::string input;
  bool json = false;
};
void info_command(const InfoFlags& flags);

struct ConvertFlags {
  std::string input, output;
  bool exact = false;  ///< to .drc: positions to the bit
  proto::OutputOptions options;
};
void convert_command(const ConvertFlags& flags);

struct CompareFlags {
  std::string a, b;
  CompareOptions options;
  bool json = false;
};
void compare_command(const CompareFlags& flags);

struct HealthFlags {
  std::string server = "http://127.0.0.1:8080";
  RemoteOptions remote;
  bool ready = false;  ///< whether it takes work, not only whether it is alive
};
/// Prints the server's word for it; anything but yes is an exception.
void health_command(const HealthFlags& flags);

/// A mistake in how the program was called: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace papilio::client
