#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the package as it is released, org.quickses.unity-VERSION.tgz, with CUDA for Linux and Windows; checks it, and writes
# the SHA-256 sums of it and of its native libraries beside it. Installs what is missing first. Needs no GPU.
#   bash Scripts~/package.sh [--cpu-only] [FOLDER]
# FOLDER: where it is left, default .build/package. Packages of other versions there stay; no unchecked one is left.
# --cpu-only: without the CUDA back end, and without the need for the CUDA Toolkit.
# The same commit gives the same bytes in any folder, with the same compilers; Scripts~/package/verify-package proves it.
set -euo pipefail
from=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(cuda windows-cuda)
setup=(--with-windows --with-cuda)
check=(--cuda)
folder=.build/package
for argument in "$@"; do
  case "$argument" in
    --cpu-only) presets=(cpu windows) setup=(--with-windows) check=() ;;
    -h | --help) sed -n '3,8s/^# //p' Scripts~/package.sh; exit 0 ;;
    -*) echo "package.sh: unknown option $argument (there is --cpu-only)" >&2; exit 2 ;;
    /*) folder=$argument ;;
    *) folder=$from/$argument ;;
  esac
done
bash Scripts~/setup.sh "${setup[@]}"

# Build trees of its own, with the options of now: what somebody chose for another one, an architecture say, isn't in
# them, nor is what was the default at the run before.
unset CFLAGS CXXFLAGS CUDAFLAGS LDFLAGS
build_plugin() { # PRESET
  local build=.build/package/$1
  rm -f "$build/CMakeCache.txt"
  cmake --preset "$1" -B "$build" -DQUICKSES_BUILD_CLI=OFF -DQUICKSES_BUILD_TESTS=OFF &&
    cmake --build "$build" --target plugin --parallel "$(nproc)"
}
# At once: most of the time goes into one source, of all kernels, for several architectures.
builds=()
for preset in "${presets[@]}"; do
  build_plugin "$preset" &
  builds+=($!)
done
status=0
for build in "${builds[@]}"; do wait "$build" || status=$?; done
if [ $status -ne 0 ]; then exit $status; fi

# Checked first, then left where it was asked for.
mkdir -p .build/package "$folder"
new=$(mktemp -d .build/package/new.XXXXXX)
trap 'rm -rf "$new"' EXIT
python3 -B Scripts~/package/make-package "$new"
python3 -B Scripts~/package/check-package "$new"/org.quickses.unity-*.tgz \
  --platform linux-x86_64 --platform windows-x86_64 "${check[@]}"
(cd "$new" && sha256sum --check --ignore-missing org.quickses.unity-*.tgz.sha256)
mv "$new"/* "$folder"
echo "package.sh: it is in $folder"
