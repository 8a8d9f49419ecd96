#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds everything, runs every test.
#   bash Scripts~/test.sh [--with-cuda] [--with-mpi]
# --with-cuda: the CUDA Toolkit and the CUDA back end as well. Its tests need a GPU and are skipped where there is none.
# --with-mpi: Open MPI, and the program that shares frames among processes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(cpu)
with_mpi=no
for argument in "$@"; do
  case "$argument" in
    --with-cuda) presets+=(cuda) ;;
    --with-mpi) with_mpi=yes ;;
    -h | --help) sed -n '3,6s/^# //p' "$0"; exit 0 ;;
    *) echo "test.sh: unknown option $argument (there are --with-cuda and --with-mpi)" >&2; exit 2 ;;
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

# Of the build with MPI, the program alone: the library is the same.
if [ "$with_mpi" = yes ]; then
  echo "==== mpi: configure"
  cmake --preset mpi
  echo "==== mpi: build"
  cmake --build --preset mpi --parallel "$(nproc)" --target quickses_cli
  echo "==== mpi: test"
  ctest --preset mpi --tests-regex '^cli_mpi_test$' --no-tests=error
fi
