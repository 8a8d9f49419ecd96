#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds everything, runs every test.
#   bash Scripts~/test.sh [--with-cuda]
# --with-cuda: the CUDA Toolkit and the CUDA back end as well. Its tests need a GPU and are skipped where there is none.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(cpu)
for argument in "$@"; do
  case "$argument" in
    --with-cuda) presets+=(cuda) ;;
    -h | --help) sed -n '3,5s/^# //p' "$0"; exit 0 ;;
    *) echo "test.sh: unknown option $argument (there is --with-cuda)" >&2; exit 2 ;;
  esac
done

bash Scripts~/setup.sh "$@"

# One architecture keeps the build short: the GPU's own, or the newest of those that releases are made for.
architecture=90-real
if capability=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null | sed -n 1p) && [ -n "$capability" ]; then
  architecture=${capability/./}-real
fi

for preset in "${presets[@]}"; do
  options=()
  if [ "$preset" = cuda ]; then options=("-DQUICKSES_CUDA_ARCHITECTURES=$architecture"); fi
  echo "==== $preset: configure"
  cmake --preset "$preset" "${options[@]}"
  echo "==== $preset: build"
  cmake --build --preset "$preset" --parallel "$(nproc)"
  echo "==== $preset: test"
  if [ "$preset" = cuda ] && ! nvidia-smi >/dev/null 2>&1; then
    echo "No CUDA device here: tests of the CUDA back end are skipped."
  fi
  ctest --preset "$preset" --parallel "$(nproc)"
done
