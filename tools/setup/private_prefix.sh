#!/bin/bash
# Fills a private prefix with Kokkos, AMGCL and the C and C++ libraries they need, from the binary packages of newer
# Debian suites (way 3 of docs/building.md). Nothing outside the prefix is touched: apt runs with its own state and
# only downloads; the packages are unpacked, never installed.
#
# Usage: private_prefix.sh DIR     (the prefix is DIR/usr, its C library lies in DIR/usr/lib/MULTIARCH)
set -euo pipefail

deps=$1
recipe=3 # raise it when this file changes what lands in the prefix
stamp="$deps/private-prefix.stamp"
if [[ -f $stamp ]] && head -n 1 "$stamp" | grep -qx "recipe $recipe"; then
  exit 0
fi

fail() {
  echo "private_prefix.sh: $*" >&2
  exit 1
}

for program in apt-get apt-cache dpkg ar; do
  command -v "$program" >/dev/null || fail "$program is missing (this way needs Debian's tools)"
done
architecture=$(dpkg --print-architecture)
multiarch=$(gcc -print-multiarch 2>/dev/null || true)
[[ $architecture == amd64 ]] || fail "only tried on amd64, this is $architecture"
multiarch=${multiarch:-x86_64-linux-gnu}

# The mirror is the one this machine's apt already uses; security and other archives are left out by their label.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' 2>/dev/null |
  sort -u | head -n 1)
if [[ -z $mirror ]]; then # no lists fetched yet: go by the shape of the address
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
    grep -E '/debian/?$' | sort -u | head -n 1 || true)
fi
[[ -n $mirror ]] || fail "apt's configuration names no Debian mirror"

keyring=/usr/share/keyrings/debian-archive-keyring.gpg
options=""
[[ -f $keyring ]] && options="[signed-by=$keyring] "

new="$deps/.filling"
rm -rf "$new"
mkdir -p "$new/state/lists/partial" "$new/cache/archives/partial" "$new/debs" "$new/unpacked"
for suite in trixie sid; do
  echo "deb $options$mirror $suite main"
done >"$new/sources.list"

apt_options=(
  -o "Dir::State::Lists=$new/state/lists" -o "Dir::Cache=$new/cache"
  -o "Dir::Etc::sourcelist=$new/sources.list" -o "Dir::Etc::sourceparts=/dev/null"
  -o "APT::Sandbox::User=$(id -un)" -o "Acquire::Languages=none" -o "Acquire::Retries=3"
)
echo "private prefix: reading the package lists of trixie and sid"
apt-get "${apt_options[@]}" -qq update

# The library's package name carries its version, so it is read from what the development package depends on.
library=$(apt-cache "${apt_options[@]}" depends libkokkos-dev/sid 2>/dev/null |
  sed -n 's/^ *Depends: \(libkokkos[0-9][0-9.]*\)$/\1/p' | head -n 1)
if [[ -z $library ]]; then
  library=$(apt-cache "${apt_options[@]}" depends libkokkos-dev |
    sed -n 's/^ *Depends: \(libkokkos[0-9][0-9.]*\)$/\1/p' | head -n 1)
fi
[[ -n $library ]] || fail "cannot tell the Kokkos library's package from libkokkos-dev"

echo "private prefix: fetching $library, AMGCL and the C and C++ libraries"
(cd "$new/debs" && apt-get "${apt_options[@]}" -qq download libkokkos-dev/sid "$library/sid" libamgcl-dev/sid \
  libc6/trixie libstdc++6/trixie libgcc-s1/trixie libgomp1/trixie)
for package in "$new"/debs/*.deb; do
  dpkg -x "$package" "$new/unpacked"
done

usr="$new/unpacked/usr"
# Where the suite keeps /lib apart from /usr/lib, bring both together.
if [[ -d $new/unpacked/lib && ! -L $new/unpacked/lib ]]; then
  cp -a "$new/unpacked/lib/." "$usr/lib/"
fi

# The C and C++ libraries fetched must be new enough for what the Kokkos library asks.
kokkos_core=$(find "$usr/lib" -name 'libkokkoscore.so.*' -type f | head -n 1)
[[ -n $kokkos_core ]] || fail "no libkokkoscore.so in the fetched packages"
for symbol in GLIBC GLIBCXX; do
  case $symbol in
    GLIBC) provider="$usr/lib/$multiarch/libc.so.6" ;;
    GLIBCXX) provider="$usr/lib/$multiarch/libstdc++.so.6" ;;
  esac
  needed=$(grep -aoE "\b${symbol}_[0-9]+(\.[0-9]+)*" "$kokkos_core" | sort -uV | tail -n 1)
  if [[ -n $needed ]] && ! grep -aqF "$needed" "$provider"; then
    fail "$(basename "$kokkos_core") needs $needed, which ${provider##*/} does not have"
  fi
done

# Relocate: the package's CMake files name the system's include folder.
find "$usr" -name '*.cmake' -path '*okkos*' -print0 |
  xargs -0 sed -i 's#"/usr/include/kokkos"#"${_IMPORT_PREFIX}/include/kokkos"#g'
# They also name two archives that the package does not ship (the libraries are header-only and empty).
for archive in libkokkosalgorithms.a libkokkossimd.a; do
  [[ -e $usr/lib/$multiarch/$archive ]] || ar rcs "$usr/lib/$multiarch/$archive"
done
# Headers of the newer C library must never be found before the system's own: only libraries are kept of those packages.
[[ ! -e $usr/include/stdio.h ]] || fail "C library headers in the prefix"
rm -rf "$usr/share/doc" "$usr/share/man" "$usr/share/lintian" "$usr/lib/$multiarch/gconv" "$usr/lib/$multiarch/audit"

{
  echo "recipe $recipe"
  for package in "$new"/debs/*.deb; do
    dpkg-deb -f "$package" Package Version | paste -sd ' '
  done
} >"$new/stamp"
rm -rf "${deps:?}/usr"
mv "$usr" "$deps/usr"
mv "$new/stamp" "$stamp"
rm -rf "$new"
