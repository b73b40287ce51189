# The distribution's packages that the build, the tests and the Python scripts need. Sourced by setup.sh.
# Debian 12 is what CI runs on; Debian 13 and Ubuntu 24.04 use the same names; Fedora's list is untested.

packages_debian=(
  build-essential cmake ninja-build ccache pkg-config git binutils
  libeigen3-dev libhdf5-dev hdf5-tools libyaml-cpp-dev libspdlog-dev libfmt-dev libcli11-dev libudunits2-dev
  nlohmann-json3-dev libboost-dev libgtest-dev libbenchmark-dev
  python3 python3-numpy python3-h5py python3-matplotlib
  clang-format clang-tidy time
)

packages_fedora=(
  gcc-c++ make cmake ninja-build ccache pkgconf-pkg-config git binutils
  eigen3-devel hdf5-devel hdf5 yaml-cpp-devel spdlog-devel fmt-devel cli11-devel udunits2-devel
  json-devel boost-devel gtest-devel google-benchmark-devel
  python3 python3-numpy python3-h5py python3-matplotlib
  clang-tools-extra time
)

# Prints the packages that are missing, one a line; nothing where the package manager is not known.
missing_packages() {
  if command -v dpkg-query >/dev/null; then
    local installed
    installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${packages_debian[@]}" 2>/dev/null |
      sed -n 's/^ii  *//p')
    comm -23 <(printf '%s\n' "${packages_debian[@]}" | sort) <(sort <<<"$installed")
  elif command -v rpm >/dev/null; then
    local package
    for package in "${packages_fedora[@]}"; do
      rpm -q --whatprovides "$package" >/dev/null 2>&1 || echo "$package"
    done
  fi
}

# Installs the packages named, or says what the user has to type and returns 2.
install_packages() {
  local as_root=() command
  if command -v apt-get >/dev/null; then
    command=(apt-get install -y --no-install-recommends "$@")
  elif command -v dnf >/dev/null; then
    command=(dnf install -y "$@")
  else
    echo "pellicle: missing packages, and no package manager known here (apt-get, dnf): $*" >&2
    return 2
  fi
  if [[ $(id -u) != 0 ]]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
      as_root=(sudo -n)
    else
      echo "pellicle: packages of the distribution are missing. Type this, then try again:" >&2
      echo "  sudo ${command[*]}" >&2
      return 2
    fi
  fi
  if [[ ${command[0]} == apt-get ]]; then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "${command[@]}"
  else
    "${as_root[@]}" "${command[@]}"
  fi
}
