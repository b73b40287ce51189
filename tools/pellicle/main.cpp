// The command line of pellicle.
#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

#include "core/error.hpp"
#include "core/version.hpp"
#include "tools/pellicle/commands.hpp"

namespace {

using pellicle::ExitCode;

constexpr const char* examples = R"(Examples:
  pellicle check cases/quickstart/case.yaml
  pellicle run cases/quickstart/case.yaml
  pellicle run cases/single_spout/case.yaml --output results/koch_hill --set coupling.drag=koch_hill
  pellicle run cases/single_spout/case.yaml --resume --set time.end="8 s"
  pellicle run case.yaml --set output.lines.z50mm.points=58 --set particles.0.count=1000
  pellicle report results/quickstart

Exit codes: 0 done, 2 bad input, 3 failed while running, 130 interrupted (a checkpoint is written).)";

/// OpenMP reads where to put its threads before main: starts the program anew with them set, once. Threads are bound only
/// where they take all processors: two runs of one thread each would be bound to the same one.
/// `asked_for`: the number of threads; 0: OMP_NUM_THREADS says, if anything does.
void bind_threads(char** argv, int asked_for) {
  if (std::getenv("OMP_PROC_BIND") != nullptr) return;
  const char* number = std::getenv("OMP_NUM_THREADS");
  const int threads = asked_for > 0 || number == nullptr ? asked_for : std::atoi(number);
  cpu_set_t allowed;
  if (threads > 0 && sched_getaffinity(0, sizeof allowed, &allowed) == 0 && threads < CPU_COUNT(&allowed)) {
    setenv("OMP_PROC_BIND", "false", 1);
    return;
  }
  setenv("OMP_PROC_BIND", "spread", 1);
  if (std::getenv("OMP_PLACES") == nullptr) setenv("OMP_PLACES", "threads", 1);
  execv("/proc/self/exe", argv);
  // Could not: go on with threads that may wander.
}

int run_program(int argc, char** argv) {
  CLI::App app{"pellicle: how particles get coated in a gas, each particle followed one by one (CFD-DEM)"};
  app.footer(examples);
  app.set_version_flag("--version", pellicle::version_text());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  pellicle::tools::RunArguments run;
  auto* run_app = app.add_subcommand("run", "Run a case");
  run_app->add_option("case", run.case_file, "Case file")->required()->type_name("CASE.yaml");
  run_app->add_option("--output", run.output, "Results folder (default: results/ and the name of the case)")
      ->type_name("DIR");
  run_app
      ->add_option("--set", run.overrides,
                   "Override a key, may be repeated: PATH=VALUE; an empty value removes the key")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  run_app->add_option("--until", run.until, "Stop at this time with a checkpoint, for example \"0.5 s\"")
      ->type_name("TIME");
  run_app->add_flag("--resume", run.resume, "Go on from the checkpoint in the results folder");
  run_app->add_flag("--overwrite", run.overwrite, "Replace the results of an earlier run");
  run_app
      ->add_option("--threads", run.threads, "Number of threads (default: OMP_NUM_THREADS, else all cores)")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  run_app->footer(examples);

  std::string check_file;
  std::vector<std::string> check_overrides;
  auto* check_app =
      app.add_subcommand("check", "Read a case, say what is wrong with it and what it comes to");
  check_app->add_option("case", check_file, "Case file")->required()->type_name("CASE.yaml");
  check_app->add_option("--set", check_overrides, "Override a key, as with run")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);

  std::string family;
  auto* models_app = app.add_subcommand("models", "List the models that a case can choose from");
  models_app->add_option("family", family, "One family, for example drag")->type_name("FAMILY");

  bool markdown = false;
  auto* schema_app = app.add_subcommand("schema", "Print the JSON schema of case files");
  schema_app->add_flag("--markdown", markdown, "Print the reference of all keys instead");

  std::string info_path;
  auto* info_app = app.add_subcommand("info", "Show what a results folder or a checkpoint holds");
  info_app->add_option("path", info_path, "Results folder or checkpoint.h5")->required()->type_name("PATH");

  std::string report_folder;
  auto* report_app = app.add_subcommand("report", "Print an account of a run");
  report_app->add_option("folder", report_folder, "Results folder")->required()->type_name("DIR");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }

  if (*run_app) {
    bind_threads(argv, run.threads);
    return pellicle::tools::run_command(run);
  }
  if (*check_app) return pellicle::tools::check_command(check_file, check_overrides);
  if (*models_app) return pellicle::tools::models_command(family);
  if (*schema_app) return pellicle::tools::schema_command(markdown);
  if (*info_app) return pellicle::tools::info_command(info_path);
  return pellicle::tools::report_command(report_folder);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const pellicle::InputError& error) {
    std::cerr << error.what() << "\n";
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::exception& error) {
    std::cerr << "pellicle: " << error.what() << "\n";
    return static_cast<int>(ExitCode::run_failed);
  }
}
