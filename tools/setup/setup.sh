#!/bin/bash
# Sets up what the build needs: the distribution's packages, and Kokkos and AMGCL by one of three ways. Called by
# ./pellicle; what it prints goes to build/setup.log there. Exit 2: the user has to do something, which is printed.
#
# PELLICLE_DEPS   auto (default): the first of these that works
#   system        Kokkos and AMGCL are installed (CMAKE_PREFIX_PATH, Kokkos_ROOT, amgcl_ROOT count)
#   fetch         CMake downloads the upstream releases (FetchContent) when it configures
#   debian        a private prefix, .deps/usr, from newer Debian suites' packages
# The way taken is left in .deps/way, where ./pellicle build reads it.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$top/tools/setup/packages.sh"

asked=${PELLICLE_DEPS:-auto}
case $asked in
  auto | system | fetch | debian) ;;
  *)
    echo "pellicle: PELLICLE_DEPS is '$asked'; allowed: auto, system, fetch, debian" >&2
    exit 2
    ;;
esac

mapfile -t missing < <(missing_packages)
if ((${#missing[@]})); then
  echo "installing ${#missing[@]} packages: ${missing[*]}"
  install_packages "${missing[@]}"
fi

# Does CMake find both libraries by itself?
system_has_them() {
  cmake -S "$top/tools/setup/probe" -B "$top/.deps/probe" --fresh -G Ninja >"$top/.deps/probe.log" 2>&1
}

# Can upstream be reached? Asked for the very tag that CMake would fetch.
upstream_has_them() {
  local repository tag
  while read -r repository tag; do
    GIT_TERMINAL_PROMPT=0 timeout 15 git ls-remote --exit-code "$repository" "refs/tags/$tag" >/dev/null 2>&1 ||
      return 1
  done < <(sed -nE 's/^ *GIT_REPOSITORY ([^ ]+) GIT_TAG \$\{([A-Z_]+)\}.*/\1 \2/p' "$dependencies" |
    while read -r repository variable; do
      echo "$repository $(sed -nE "s/^set\($variable (.*)\)/\1/p" "$dependencies")"
    done)
}
dependencies="$top/cmake/PellicleDependencies.cmake"

mkdir -p "$top/.deps"
way=$asked
if [[ $way == auto ]]; then
  if system_has_them; then
    way=system
  elif upstream_has_them; then
    way=fetch
  else
    way=debian
  fi
fi
if [[ $way == debian ]]; then
  if ! "$top/tools/setup/private_prefix.sh" "$top/.deps"; then
    echo "pellicle: found no Kokkos >= 4.6 and AMGCL on this system, and could neither reach their upstream nor" >&2
    echo "  fill a private prefix from Debian packages. Install both and name their prefix:" >&2
    echo "  PELLICLE_DEPS=system CMAKE_PREFIX_PATH=/path/to/prefix ./pellicle setup" >&2
    exit 2
  fi
fi
echo "Kokkos and AMGCL: $way"
echo "$way" >"$top/.deps/way"
