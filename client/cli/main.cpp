#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <iterator>
#include <map>

#include "client/cli/commands.h"
#include "client/cli/flag_names.h"
#include "papilio/detail.h"
#include "proto/name_suggestion.h"
#include "proto/problem.h"
#include "proto/text.h"

using namespace papilio;
using namespace papilio::client;

namespace {

enum ExitStatus { success = 0, failed = 1, usage = 2 };

constexpr const char* mesh_file = "Mesh file (.drc .obj .ply .off .stl .glb .gltf), or - for standard input";

/// Adds a flag whose value is the name of a mesh format.
void add_format(CLI::App& command, const std::string& flag, std::optional<Format>& format,
                const std::string& description) {
  command
      .add_option_function<std::string>(
          flag, [&format](const std::string& name) { format = format_named(name); }, description)
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"drc", "obj", "ply", "off", "stl", "glb", "gltf"}));
}

void add_from(CLI::App& command, MeshPlace& input) {
  add_format(command, "--from", input.format, "Format of the input, instead of by its extension or content");
}

/// Values of the table's parameters by name, as typed; empty if not given.
using TypedParameters = std::map<std::string, std::string>;

/// Adds the table's parameters whose names start with `prefix` as flags: --levels, --view.eye.
void add_parameters(CLI::App& command, TypedParameters& typed, std::string_view prefix) {
  for (const proto::ParameterInfo& parameter : proto::parameter_table()) {
    if (!parameter.name.starts_with(prefix)) continue;
    const std::string name(parameter.name);
    const std::string description = std::string(parameter.description) + " (" + proto::describe_range(parameter) +
                                    "; default " + proto::describe_default(parameter) + ")";
    const std::string alias = name == "output.compress" ? ",--compress" : "";
    command.add_option("--" + name + alias, typed[name], description)->type_name("VALUE")->group("Parameters");
  }
}

proto::Parameters parse_parameters(const CLI::App& command, const TypedParameters& typed) {
  proto::QueryFields fields;
  for (const auto& [name, value] : typed)
    if (command.count("--" + name) > 0) fields.emplace_back(name, value);
  return proto::parse_query(fields);
}

void add_refine(CLI::App& app) {
  auto flags = std::make_shared<RefineFlags>();
  auto typed = std::make_shared<TypedParameters>();
  CLI::App* command = app.add_subcommand("refine", "Refine a mesh, or every mesh in a folder");
  command
      ->add_option("input", flags->input.path,
                   "Mesh file (.drc .obj .ply .off .stl .glb .gltf), folder, or - for standard input")
      ->required();
  command->add_option(
      "-o,--output", flags->output.path,
      "File whose extension names its format, folder, or - for standard output; without it NAME.refined.EXT "
      "beside the input, - where that is -");
  add_from(*command, flags->input);
  add_format(
      *command, "--to", flags->output.format,
      "Format of a folder's results and of standard output (default drc; scenes stay scenes), or of NAME.refined.EXT "
      "(default the input's)");
  command->add_option("--server", flags->server, "Refine there instead of here: http://host:port or https://");
  command
      ->add_option("--ca", flags->remote.ca_file,
                   "PEM file of the certificates to trust for https, instead of the system's")
      ->check(CLI::ExistingFile);
  command->add_option("--key", flags->remote.key, "Key that the server asks for; safer in the environment")
      ->envname("PAPILIO_KEY");
  command->add_option("--jobs", flags->jobs, "Meshes of a folder refined at once")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--json", flags->json,
                    "Statistics as JSON on standard output; on standard error where the mesh goes there");
  add_parameters(*command, *typed, "");
  command->callback([flags, typed, command] {
    flags->parameters = parse_parameters(*command, *typed);
    refine_command(*flags);
  });
}

void add_info(CLI::App& app) {
  auto flags = std::make_shared<InfoFlags>();
  CLI::App* command = app.add_subcommand("info", "Say what is in a mesh file");
  command->add_option("input", flags->input.path, mesh_file)->required();
  add_from(*command, flags->input);
  command->add_flag("--json", flags->json, "As JSON");
  command->callback([flags] { info_command(*flags); });
}

void add_convert(CLI::App& app) {
  auto flags = std::make_shared<ConvertFlags>();
  auto typed = std::make_shared<TypedParameters>();
  CLI::App* command = app.add_subcommand("convert", "Turn a mesh file into another kind");
  command->add_option("input", flags->input.path, mesh_file)->required();
  command
      ->add_option("-o,--output,output", flags->output.path,
                   "Mesh file whose extension names its format, or - for standard output")
      ->required();
  add_from(*command, flags->input);
  add_format(*command, "--to", flags->output.format, "Format of standard output; default drc");
  command->add_flag("--exact", flags->exact, "To .drc: keep positions to the bit instead of quantising them");
  add_parameters(*command, *typed, "output.");
  command->callback([flags, typed, command] {
    flags->options = parse_parameters(*command, *typed).output;
    convert_command(*flags);
  });
}

void add_compare(CLI::App& app) {
  auto flags = std::make_shared<CompareFlags>();
  CLI::App* command = app.add_subcommand("compare", "Distances between two surfaces");
  command->add_option("a", flags->a.path, mesh_file)->required();
  command->add_option("b", flags->b.path, mesh_file)->required();
  command->add_option("--samples", flags->options.samples, "Points sampled on each surface, besides its vertices")
      ->check(CLI::Range(size_t{0}, size_t{100'000'000}))
      ->capture_default_str();
  command->add_flag("--json", flags->json, "As JSON");
  command->callback([flags] { compare_command(*flags); });
}

void add_pack(CLI::App& app) {
  auto flags = std::make_shared<PackFlags>();
  CLI::App* command =
      app.add_subcommand("pack", "Pack a fine mesh: a coarse .glb file with its detail, level by level");
  command->add_option("input", flags->input.path, mesh_file)->required();
  command->add_option("-o,--output", flags->output.path, ".glb file, or - for standard output")->required();
  add_from(*command, flags->input);
  constexpr double least = 1e-6, most = 0.1;
  command
      ->add_option("--rms", flags->rms,
                   "RMS distance to the original that is wanted, a share of the bounding box's diagonal; default 1e-4")
      ->check(CLI::Range(least, most));
  command
      ->add_option("--max", flags->largest,
                   "In place of --rms: largest distance that is allowed, in either direction, a share of the diagonal")
      ->check(CLI::Range(least, 1.0));
  command->add_option("--bytes", flags->bytes, "In place of --rms: most bytes of the file")
      ->check(CLI::Range(int64_t{1}, int64_t{1} << 40));
  command->add_flag("--no-simplify", flags->no_simplify,
                    "With --rms: do not write a simplified mesh without levels where that is smaller");
  command
      ->add_option("--jobs", flags->jobs,
                   "Threads that encode at once for --max and --bytes, which take up to seven encodings, two at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option("--piece-bytes", flags->piece_bytes,
                   "Bytes of a piece, about: levels of more are written in pieces, each decoded with the coarser ones "
                   "around it")
      ->check(CLI::Range(uint64_t{64}, uint64_t{1} << 32))
      ->capture_default_str();
  command->add_flag("--json", flags->json, "Report as JSON; on standard error where the model goes to standard output");
  command->callback([flags] { pack_command(*flags); });
}

void add_unpack(CLI::App& app) {
  auto flags = std::make_shared<UnpackFlags>();
  CLI::App* command = app.add_subcommand("unpack", "Decode the fine mesh of a packed model");
  command->add_option("input", flags->input.path, "Packed .glb file, or - for standard input")->required();
  command
      ->add_option("-o,--output", flags->output.path,
                   "Mesh file whose extension names its format, or - for standard output")
      ->required();
  add_from(*command, flags->input);
  add_format(*command, "--to", flags->output.format, "Format of standard output; default drc");
  command->add_option("--levels", flags->levels, "Levels of detail at most; default all")
      ->check(CLI::Range(0, most_detail_levels));
  command
      ->add_option(
          "--normals", flags->normals,
          "true or false: whether the mesh has normals, split at creases; default true for .glb and .gltf, and "
          "where the original has them, but not where its faces are flat")
      ->type_name("BOOL");
  command->add_flag("--truncated", flags->may_be_cut, "Read a file that is cut: its whole levels and pieces");
  command->callback([flags] { unpack_command(*flags); });
}

void add_health(CLI::App& app) {
  auto flags = std::make_shared<HealthFlags>();
  CLI::App* command = app.add_subcommand("health", "Ask a server whether it is alive: exit status 0 or 1");
  command->add_option("--server", flags->server, "http://host:port or https://")->capture_default_str();
  command->add_option("--ca", flags->remote.ca_file, "PEM file of the certificates to trust for https")
      ->check(CLI::ExistingFile);
  command->add_flag("--ready", flags->ready, "Ask whether it takes work now");
  command->callback([flags] { health_command(*flags); });
}

void add_parameters_command(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("parameters", "Print the table of refinement parameters as Markdown");
  command->add_flag("--json", *json, "As JSON");
  command->callback([json] { std::cout << (*json ? proto::parameters_json() + "\n" : proto::parameters_markdown()); });
}

int complain(const std::string& what, ExitStatus status) {
  std::cerr << "papilio: " << proto::escape_controls(what) << '\n';
  return status;
}

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  return names;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Returns the arguments in CLI11's order, which is reversed, with flags under their known names.
std::vector<std::string> arguments(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) std::ranges::copy(flags_of(*command), std::back_inserter(names));
  std::vector<std::string> reversed;
  for (int i = 1; i < argc; ++i) reversed.push_back(known_flag(argv[i], names));
  std::ranges::reverse(reversed);
  return reversed;
}

/// Returns the program and the command, as called.
std::string called_as(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  return called.empty() ? "papilio" : "papilio " + called[0]->get_name();
}

/// Returns the message for the first unexpected argument, flags first; "" if there is none.
std::string unexpected(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  const CLI::App& command = called.empty() ? app : *called[0];
  std::vector<std::string> left = command.remaining();
  if (left.empty()) return "";
  const auto is_flag = [](const std::string& word) { return word.starts_with("--"); };
  std::stable_partition(left.begin(), left.end(), is_flag);  // the ranges' form is beyond clang-tidy 14
  if (!called.empty() || is_flag(left[0])) return unexpected_argument(left[0], called_as(app), flags_of(command));
  std::vector<std::string_view> commands;
  for (const CLI::App* known : commands_of(app)) commands.push_back(known->get_name());
  const auto meant = proto::suggest_name(left[0], commands);
  return "There is no command " + proto::quote(left[0]) + ". " +
         (meant ? "Did you mean " + std::string(*meant) + "?" : "papilio --help lists them.");
}

/// Returns the message for a missing argument in the words of the usage, which names positionals; "" if none is
/// missing.
std::string missing_argument(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  if (called.empty()) return "";
  for (const CLI::Option* option : called[0]->get_options())
    if (option->get_required() && option->count() == 0 && option->get_positional())
      return option->get_name(true) + " is required. " + called_as(app) + " --help lists what it takes.";
  return "";
}

int run(int argc, char** argv) {
  CLI::App app{"papilio: refines triangle meshes where they are curved, visible and large on screen.", "papilio"};
  app.set_version_flag("--version", "papilio " PAPILIO_VERSION);
  app.require_subcommand(1);
  add_refine(app);
  add_info(app);
  add_convert(app);
  add_compare(app);
  add_pack(app);
  add_unpack(app);
  add_health(app);
  add_parameters_command(app);
  try {
    app.parse(arguments(app, argc, argv));
    return std::cout.flush() ? success : complain("Could not write all output.", failed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (const std::string what = unexpected(app); !what.empty()) return complain(what, usage);
    if (const std::string what = missing_argument(app); error.get_name() == "RequiredError" && !what.empty())
      return complain(what, usage);
    return complain(std::string(error.what()) + ". " + called_as(app) + " --help lists what it takes.", usage);
  } catch (const UsageError& error) {
    return complain(error.what(), usage);
  } catch (const proto::Problem& problem) {
    return complain(problem.what(), problem.status() == 400 ? usage : failed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return complain("There is not enough memory.", failed);
  } catch (const std::exception& error) {
    return complain(error.what(), failed);
  }
}
