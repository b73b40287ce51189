#include <fmt/format.h>
#include <Kokkos_Core.hpp>

#include <csignal>
#include <filesystem>

#include "core/error.hpp"
#include "core/log.hpp"
#include "core/units.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/commands.hpp"
#include "tools/pellicle/simulation.hpp"

namespace pellicle::tools {

namespace {

namespace fs = std::filesystem;

extern "C" void stop_on_signal(int signal) {
  request_stop();
  // A second one ends the program at once.
  std::signal(signal, SIG_DFL);
}

/// Refuses a folder that may not be written into, before anything is computed; changes nothing.
void check_results_folder(const fs::path& folder, const RunArguments& arguments) {
  if (arguments.resume && arguments.overwrite) {
    throw InputError("--resume: --overwrite is given too; one of them");
  }
  const bool there = fs::exists(folder);
  if (there && !fs::is_directory(folder)) {
    throw InputError(
        fmt::format("--output: {} is no folder; a folder, or a name that is not taken", folder.string()));
  }
  if (arguments.resume) {
    if (!there)
      throw InputError(
          fmt::format("--resume: there is no folder {}; one that a run has left", folder.string()));
  } else if (there && !arguments.overwrite && !fs::is_empty(folder)) {
    throw InputError(fmt::format(
        "--output: {} is there already; --overwrite replaces its results, --resume goes on with that run, "
        "--output names another folder",
        folder.string()));
  }
}

std::optional<Real> read_until(const RunArguments& arguments) {
  if (!arguments.until) return std::nullopt;
  try {
    const Real until = core::parse_quantity(*arguments.until, core::dimension::duration);
    if (until > 0) return until;
  } catch (const core::UnitError& error) {
    throw InputError(fmt::format("--until: {}", error.what()));
  }
  throw InputError(fmt::format("--until: \"{}\" is out of range; a time greater than 0", *arguments.until));
}

}  // namespace

int run_command(const RunArguments& arguments) {
  const CaseSpec spec = load_case(arguments.case_file, arguments.overrides);
  RunOptions options;
  options.output_folder =
      arguments.output ? *arguments.output : (fs::path("results") / case_name(arguments.case_file)).string();
  check_results_folder(options.output_folder, arguments);
  options.until = read_until(arguments);
  options.resume = arguments.resume;
  options.overwrite = arguments.overwrite;
  options.case_yaml_text = resolved_yaml(spec, options.output_folder);

  Kokkos::InitializationSettings settings;
  if (arguments.threads > 0) settings.set_num_threads(arguments.threads);
  const Kokkos::ScopeGuard kokkos(settings);
  options.threads = Kokkos::DefaultHostExecutionSpace().concurrency();

  core::log().info("{}", describe_case_text(spec));
  std::signal(SIGINT, stop_on_signal);
  std::signal(SIGTERM, stop_on_signal);
  return run_simulation(spec, options);
}

}  // namespace pellicle::tools
