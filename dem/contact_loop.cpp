#include "dem/contact_loop.hpp"

namespace pellicle::dem {

// The instances are in files of their own, contact_loop_*.cpp, which compile side by side.
template <class Tangential>
void run_contact_loop(const ContactInput& input, const Tangential& tangential, const ContactOptions& options,
                      const ContactResult& result);

void compute_contact_forces(const ContactInput& input, const ContactOptions& options,
                            const ContactResult& result) {
  std::visit([&](const auto& tangential) { run_contact_loop(input, tangential, options, result); },
             options.tangential);
}

}  // namespace pellicle::dem
