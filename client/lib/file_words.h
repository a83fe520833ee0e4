#pragma once

#include <string>

#include "client/lib/remote.h"
#include "client/mesh_file/file_bytes.h"
#include "papilio/error.h"
#include "proto/problem.h"

namespace papilio::client {

/// Runs `work` on the mesh of the file `name`. Converts errors of the core, `proto` or a server that concern the mesh
/// to a `FileError`; passes on all others.
template <class Work>
auto in_words_of_the_file(const std::string& name, const Work& work) {
  const auto is_of_the_mesh = [](std::string_view code) { return code.starts_with("mesh_"); };
  const auto code_of = [](const proto::Problem& problem) { return proto::problem_kind(problem.code()).name; };
  try {
    return work();
  } catch (const proto::Problem& problem) {
    if (is_of_the_mesh(code_of(problem))) throw FileError(name, problem.what());
    throw;
  } catch (const ServerError& error) {
    if (is_of_the_mesh(error.code())) throw FileError(name, error.what());
    throw;
  } catch (const Error& error) {
    if (is_of_the_mesh(code_of(proto::Problem(error)))) throw FileError(name, error.what());
    throw;
  }
}

}  // namespace papilio::client
