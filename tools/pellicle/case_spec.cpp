#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

std::string CaseSpec::where(const std::string& path) const {
  const auto found = lines.find(path);
  return (found != lines.end() ? found->second : file) + ": " + path;
}

}  // namespace pellicle::tools
