#include "tools/pellicle/case_file.hpp"

#include <filesystem>

#include "core/key_reader.hpp"
#include "core/key_writer.hpp"
#include "core/yaml_tree.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/case_defaults.hpp"
#include "tools/pellicle/case_keys.hpp"

namespace pellicle::tools {

namespace {

CaseSpec read_case(core::YamlNode root, const std::string& name, const std::vector<std::string>& overrides) {
  for (const auto& assignment : overrides) core::apply_override(root, assignment);
  CaseSpec spec;
  spec.file = name;
  core::InputProblems problems;
  core::read_keys(
      root, [&](core::Keys& keys) { describe_case(keys, spec); }, problems, spec.lines);
  problems.throw_if_any();
  fill_in_defaults(spec, problems);
  problems.throw_if_any();
  check_case(spec, problems);
  problems.throw_if_any();
  return spec;
}

}  // namespace

CaseSpec load_case(const std::string& path, const std::vector<std::string>& overrides) {
  return read_case(core::read_yaml_file(path), path, overrides);
}

CaseSpec parse_case(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides) {
  return read_case(core::parse_yaml(text, name), name, overrides);
}

std::string resolved_yaml(const CaseSpec& spec, const std::optional<std::string>& folder) {
  CaseSpec copy = spec;
  for (WallSpec& wall : copy.walls) {
    // The way through the folders as they are, whatever links lead there.
    if (wall.stl && folder) wall.stl = std::filesystem::relative(*wall.stl, *folder).generic_string();
  }
  return "# The case as run: every default filled in, numbers in SI units.\n" +
         core::write_keys([&](core::Keys& keys) { describe_case(keys, copy); });
}

std::string case_name(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.filename() != "case.yaml") return file.stem().string();
  const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path().filename().string();
  return folder.empty() ? "case" : folder;
}

}  // namespace pellicle::tools
