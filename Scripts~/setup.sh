#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what the build needs and this machine lacks, by apt-get (Debian 12 and later, Ubuntu).
#   bash Scripts~/setup.sh [--with-cuda] [--with-mpi] [--with-windows]
# Does nothing, and needs no network and no rights, where everything is there. Uses sudo where it isn't root.
set -euo pipefail
export LC_ALL=C # apt's words are read below

with_cuda=no
with_mpi=no
with_windows=no
for argument in "$@"; do
  case "$argument" in
    --with-cuda) with_cuda=yes ;;
    --with-mpi) with_mpi=yes ;;
    --with-windows) with_windows=yes ;;
    -h | --help) sed -n '3,5s/^# //p' "$0"; exit 0 ;;
    *) echo "setup.sh: unknown option $argument (there are --with-cuda, --with-mpi and --with-windows)" >&2; exit 2 ;;
  esac
done

say() { echo "setup: $*"; }
fail() { echo "setup: $*" >&2; exit 1; }

# ---- what is needed: a package, and a command (word), a header (path) or a module of Python (python:name) that shows it
# is there, however it came
needs=(
  "cmake cmake"
  "ninja-build ninja"
  "g++ c++"
  "pkg-config pkg-config"
  "python3 python3"
  "python3-yaml python:yaml"
  "zlib1g-dev zlib.h"
  "libthrust-dev thrust/version.h"
  "libglm-dev glm/glm.hpp"
  "gemmi-dev gemmi/version.hpp"
  "gemmi gemmi" # the program, which the CMake files of Debian 13's gemmi-dev insist on
  "tao-pegtl-dev tao/pegtl.hpp"
  "libcli11-dev CLI/CLI.hpp"
  "libstb-dev stb/stb_image_write.h"
  "nlohmann-json3-dev nlohmann/json.hpp"
  "libgtest-dev gtest/gtest.h"
  "pigz pigz"
)

# The CUDA Toolkit that is there, or nothing.
cuda_toolkit() {
  local folder
  for folder in "${CUDA_PATH:-}" "${CUDA_HOME:-}" /usr/lib/cuda /usr/local/cuda /opt/cuda; do
    if [ -e "$folder/nvvm/libdevice/libdevice.10.bc" ]; then
      echo "$folder"
      return
    fi
  done
}

# From CUDA 13 on it takes a Clang that knows it (NativePlugin/Source~/cmake/QuicksesCuda.cmake).
clang=19
if grep -qsE '#define CUDA_VERSION +1[3-9]' "$(cuda_toolkit)/include/cuda.h"; then clang=22; fi
if [ "$with_cuda" = yes ]; then needs+=("clang-$clang clang++-$clang"); fi
if [ "$with_mpi" = yes ]; then needs+=("libopenmpi-dev mpicxx" "openmpi-bin mpirun"); fi
if [ "$with_windows" = yes ]; then
  needs+=(
    "g++-mingw-w64-x86-64-posix x86_64-w64-mingw32-g++-posix"
    "libz-mingw-w64-dev /usr/x86_64-w64-mingw32/include/zlib.h"
    "googletest /usr/src/googletest/CMakeLists.txt"
    "wine64 /usr/lib/wine/wine64"
  )
fi

is_there() {
  case "$1" in
    /*) [ -e "$1" ] ;;
    python:*) python3 -c "import ${1#python:}" 2>/dev/null || /usr/bin/python3 -c "import ${1#python:}" 2>/dev/null ;;
    *.h | *.hpp) [ -e "/usr/local/include/$1" ] || [ -e "/usr/include/$1" ] ;;
    *) command -v "$1" >/dev/null ;;
  esac
}

has_candidate() { [[ $(apt-cache policy "$1" 2>/dev/null) == *"  Candidate: "[!\(]* ]]; }

# ---- what pages (-o x.html) and more tests need, which are left out without it: where the system does not offer it, it is not missing
optional=(
  # Draws in pages (quickses x.pdb -o x.html): a part of the program.
  "libjs-three /usr/share/javascript/three/three.min.js"
  # Versions differ in small things, so check-format asserts what 14 writes (Debian 12; Ubuntu 22.04, 24.04).
  "clang-format-14 clang-format-14"
  # Compile the package's shaders and draw with them.
  "glslang-tools glslangValidator"
  "spirv-cross spirv-cross"
  "libosmesa6 /usr/lib/x86_64-linux-gnu/libOSMesa.so.8"
  # Compiles what several build trees have in common once (Scripts~/test.sh).
  "ccache ccache"
  # Counts the instructions of the CPU back end (Scripts~/measure/count-instructions).
  "valgrind valgrind"
  # Draws how time grows with size (Scripts~/measure/plot-growth).
  "python3-matplotlib python:matplotlib"
  # Checks reports against their schema.
  "python3-jsonschema python:jsonschema"
  # Another program's areas, to compare with.
  "freesasa freesasa"
  # Looks for what is to be mended in STL files.
  "admesh admesh"
  # Finds triangles that pass through each other.
  "libcgal-dev CGAL/Surface_mesh.h"
)
# For Scripts~/package/load-in-bare-system, which only root can use.
if [ "$(id -u)" -eq 0 ]; then optional+=("debootstrap /usr/sbin/debootstrap"); fi
# For the C# tests, which a .NET SDK compiles. These bring 150 packages, of 120 MB.
if is_there dotnet; then
  optional+=("mono-devel /usr/lib/mono/4.5/Facades/netstandard.dll" "mono-devel mono-sgen" "mono-runtime-boehm mono-boehm")
fi

add_missing() { # NEED
  if ! is_there "${1#* }" && [[ " ${missing[*]} " != *" ${1%% *} "* ]]; then missing+=("${1%% *}"); fi
}
add_missing_optional() {
  local need
  for need in "${optional[@]}"; do
    if has_candidate "${need%% *}"; then add_missing "$need"; fi
  done
}

missing=()
for need in "${needs[@]}"; do add_missing "$need"; done
if [ "$with_cuda" = yes ] && [ -z "$(cuda_toolkit)" ]; then missing+=(nvidia-cuda-toolkit); fi
add_missing_optional
if [ ${#missing[@]} -eq 0 ]; then
  say "everything is installed"
  exit 0
fi

# ---- where it can be had
system="this system" codename=""
if [ -r /etc/os-release ]; then
  system=$(. /etc/os-release && echo "${PRETTY_NAME:-$ID}")
  codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
fi
if ! command -v apt-get >/dev/null; then
  fail "can install on Debian and Ubuntu only, and $system has no apt-get.
Missing here (Debian's package names): ${missing[*]}
Needed in all: CMake 3.22, Ninja, a C++17 compiler, Python 3, zlib, Thrust 1.15, GLM, gemmi (and PEGTL with
gemmi 0.5), CLI11, nlohmann-json, stb, GoogleTest, PyYAML, pigz; for the GPU the CUDA Toolkit 11.8 or later and Clang 18
or later; for many processes an MPI library."
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || fail "needs root rights for: apt-get install ${missing[*]}"
  as_root=(sudo)
fi
apt_get() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q "$@"; }

# The CUDA Toolkit is in Debian's non-free section. A new entry for it repeats the options of the entry that offers
# "main", above all Signed-By: apt refuses two entries of one archive that differ in it.
add_debian_non_free() {
  local entry suite source target text
  entry=$(apt-get indextargets --format '$(COMPONENT)|$(CODENAME)|$(ORIGIN)|$(RELEASE)|$(SOURCESENTRY)' 'Created-By: Packages' |
    grep "^main|$codename|Debian|") || return 1
  entry=${entry%%$'\n'*} # the first one
  suite=$(cut -d'|' -f4 <<<"$entry")
  source=$(cut -d'|' -f5 <<<"$entry")
  source=${source%:*}
  [ -r "$source" ] || return 1
  case "$source" in
    *.sources)
      target=/etc/apt/sources.list.d/quickses-non-free.sources
      text=$(awk -v suite="$suite" '
        function has(field, word) { return ("\n" $0 "\n") ~ ("\n" field ":[^\n]*[ \t]" word "[ \t\n]") }
        BEGIN { RS = ""; FS = "\n" }
        has("Types", "deb") && has("Suites", suite) && has("Components", "main") && !has("Enabled", "no") {
          for (i = 1; i <= NF; ++i) {
            if ($i ~ /^#/) continue
            if ($i ~ /^Types:/) print "Types: deb"
            else if ($i ~ /^Suites:/) print "Suites: " suite
            else if ($i ~ /^Components:/) print "Components: contrib non-free"
            else print $i
          }
          exit
        }' "$source") ;;
    *)
      target=/etc/apt/sources.list.d/quickses-non-free.list
      text=$(sed -nE "s|^deb[[:space:]]+((\[[^]]*\][[:space:]]+)?[^[:space:]]+[[:space:]]+$suite)[[:space:]]+(.*[[:space:]])?main([[:space:]].*)?\$|deb \1 contrib non-free|p;t end;b;:end;q" "$source") ;;
  esac
  [ -n "$text" ] || return 1
  say "adding Debian's contrib and non-free sections in $target"
  printf '# Added by Scripts~/setup.sh of QuickSES for Unity, for nvidia-cuda-toolkit.\n%s\n' "$text" |
    "${as_root[@]}" tee "$target" >/dev/null
}

say "$system lacks ${missing[*]}"
apt_get update
add_missing_optional # what is offered was perhaps not known before
for package in "${missing[@]}"; do
  if [ "$package" = nvidia-cuda-toolkit ] && ! has_candidate "$package" && [ "$(. /etc/os-release && echo "$ID")" = debian ]; then
    add_debian_non_free || fail "found no entry of Debian $codename in apt's sources to add non-free to. Please add it, or install the CUDA Toolkit."
    apt_get update
  fi
  has_candidate "$package" || fail "$system offers no package $package. On Ubuntu the components universe and multiverse are needed (sudo add-apt-repository universe multiverse)."
done
apt_get install --no-install-recommends "${missing[@]}"

say "done"
