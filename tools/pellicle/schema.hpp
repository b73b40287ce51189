// The keys of case files as a JSON schema and as the reference in the docs, both from the keys' declarations.
#pragma once

#include <string>

namespace pellicle::tools {

/// JSON schema (draft 2020-12) of case files, for editors that complete and check YAML.
std::string case_schema_json();

/// Tables of all keys, section by section, of all models and of all quantities, in Markdown: the second half of
/// docs/case_file.md.
std::string case_schema_markdown();

}  // namespace pellicle::tools
