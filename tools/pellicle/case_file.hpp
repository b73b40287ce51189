// From a case file to a CaseSpec, and back.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Reads a case file, applies overrides (`path=value`), fills in all defaults and checks everything that can be checked
/// without building the simulation. Throws InputError with all that is wrong, one a line, each
/// `file:line: key.path: what is wrong; what is allowed`.
CaseSpec load_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same for the text of a case file; `name` stands for the file in messages.
CaseSpec parse_case(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides = {});

/// The case as a case file with all defaults filled in, in SI. Reading it gives the same case. With the folder that it is
/// meant for, paths of meshes lead from there, so that both can be moved together; without, they are absolute.
std::string resolved_yaml(const CaseSpec& spec, const std::optional<std::string>& folder = std::nullopt);

/// Name of a case: of its folder if the file is called case.yaml, else of the file without its ending.
std::string case_name(const std::string& path);

}  // namespace pellicle::tools
