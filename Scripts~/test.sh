#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds everything, runs every test.
#   bash Scripts~/test.sh [--with-cuda] [--with-mpi] [--with-windows] [--long]
# --with-cuda: the CUDA Toolkit and the CUDA back end as well. Its tests need a GPU and are skipped where there is none.
# --with-mpi: Open MPI, and the program that shares frames among processes.
# --with-windows: the library, the program and the tests for Windows by MinGW-w64, run by Wine; with CUDA if that is asked
# for as well.
# --long: 100,000 random sets of atoms instead of 2,000, on all cores, and 20,000 on the GPU if there is one
# (Tests/Native~/properties/property_test.cpp); QUICKSES_PROPERTY_SEED is the first set's.
# Instructions of the CPU back end are counted where Valgrind is, and must not have grown: Scripts~/measure/count-instructions.
# That sources are written as clang-format 14 writes them is one of the tests; without that version it is skipped.
# The C# tests need a .NET SDK, which is not installed, and NuGet packages; without them they are skipped, and that is
# said. With CI=true in the environment, packages that can't be had are an error. Where Mono is, they run there as well.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(cpu)
with_mpi=no
with_windows=no
long=no
setup=()
for argument in "$@"; do
  case "$argument" in
    --with-cuda) presets+=(cuda) setup+=("$argument") ;;
    --with-mpi) with_mpi=yes setup+=("$argument") ;;
    --with-windows) with_windows=yes setup+=("$argument") ;;
    --long) long=yes ;;
    -h | --help) sed -n '3,14s/^# //p' Scripts~/test.sh; exit 0 ;;
    *) echo "test.sh: unknown option $argument (there are --with-cuda, --with-mpi, --with-windows and --long)" >&2; exit 2 ;;
  esac
done

bash Scripts~/setup.sh "${setup[@]}"

# Much is the same in all build trees.
if command -v ccache >/dev/null; then
  export CCACHE_DIR=${CCACHE_DIR:-$PWD/.build/ccache} CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

# One architecture keeps the build short: the GPU's own, or the newest of those that releases are made for.
architecture=90-real
if capability=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null | sed -n 1p) && [ -n "$capability" ]; then
  architecture=${capability/./}-real
fi

say() { echo "==== $*, after $((SECONDS / 60)) min"; }

# What has nothing to do with the platform or the back end is tested with the first preset.
others='check_.*|configure|consumer_add_subdirectory|make_package_.*|measure_scripts|page_browser_test|page_paths|release_scripts|rooms|script_help|setup|shaders.*|test_in_unity'
# Long tests of the CPU back end, whose source is the same with CUDA; those of the GPU are others, or end in _on_cuda.
of_cpu='(bricks_test|determinism_test|exact_ses_test|memory_test|property_test)/.*'

for preset in "${presets[@]}"; do
  options=()
  if [ "$preset" = cuda ]; then options=("-DQUICKSES_CUDA_ARCHITECTURES=$architecture"); fi
  say "$preset: configure"
  cmake --preset "$preset" "${options[@]}"
  say "$preset: build"
  cmake --build --preset "$preset" --parallel "$(nproc)"
  say "$preset: test"
  if [ "$preset" = cuda ] && ! nvidia-smi >/dev/null 2>&1; then
    echo "No CUDA device here: tests of the CUDA back end are skipped."
  fi
  left_out=()
  if [ "$preset" = cuda ]; then left_out=(--exclude-regex "^($others|$of_cpu)\$"); fi
  ctest --preset "$preset" --parallel "$(nproc)" "${left_out[@]}"
  # Those of the CPU back end, which is the same in all of them. With another compiler nothing is judged, which is then said.
  if [ "$preset" = cpu ]; then
    say "cpu: instructions"
    python3 -B Scripts~/measure/count-instructions .build/cpu/bin/quickses || [ $? -eq 77 ]
  fi
done

# Sets per family, the worst of each, and faults by kind are printed at the end; faults are shrunk first.
if [ "$long" = yes ]; then
  for preset in "${presets[@]}"; do
    sets=100000
    backend=cpu
    if [ "$preset" = cuda ]; then
      nvidia-smi >/dev/null 2>&1 || continue
      sets=20000
      backend=cuda
    fi
    say "$preset: $sets random sets"
    QUICKSES_TEST_BACKEND=$backend QUICKSES_PROPERTY_SETS=$sets QUICKSES_PROPERTY_PROCESSES=$(nproc) \
      ".build/$preset/bin/property_test" --gtest_filter='Properties.*'
  done
fi

# Of the build with MPI, the program alone: the library is the same.
if [ "$with_mpi" = yes ]; then
  say "mpi: configure"
  cmake --preset mpi
  say "mpi: build"
  cmake --build --preset mpi --parallel "$(nproc)" --target quickses_cli
  say "mpi: test"
  ctest --preset mpi --tests-regex '^cli_mpi_test$' --no-tests=error
fi

if [ "$with_windows" = yes ]; then
  # Names of files that are not ASCII are Wine's in a locale of UTF-8 only.
  export WINEPREFIX="$PWD/.build/wine" WINEDEBUG=-all LC_ALL=C.UTF-8
  mkdir -p "$WINEPREFIX"
  # Wine's server and services stay until the end: to start them anew for each program takes seconds. They keep the output
  # of the program that starts them open, which therefore must be none that a test waits for.
  start_wine() {
    /usr/lib/wine/wineserver -k || true # of a run that was ended
    /usr/lib/wine/wineserver -w
    /usr/lib/wine/wineserver -p
    /usr/lib/wine/wine64 wineboot --init </dev/null >/dev/null 2>&1
  }
  start_wine
  trap '/usr/lib/wine/wineserver -k || true' EXIT # its status would be that of the whole where the server is gone already
  windows=windows options=()
  if [ "${presets[-1]}" = cuda ]; then windows=windows-cuda options=("-DQUICKSES_CUDA_ARCHITECTURES=$architecture"); fi
  say "$windows: configure"
  cmake --preset "$windows" "${options[@]}"
  # What fails gets one more chance with Wine started anew, tests alone: it may be Wine that failed.
  say "$windows: build"
  if ! cmake --build --preset "$windows" --parallel "$(nproc)"; then
    say "$windows: build once more"
    start_wine
    cmake --build --preset "$windows"
  fi
  say "$windows: test"
  if ! ctest --preset "$windows" --parallel "$(nproc)" --exclude-regex "^($others)\$"; then
    say "$windows: test what failed once more"
    start_wine
    ctest --preset "$windows" --rerun-failed
  fi
  say "$windows: the same mesh"
  .build/cpu/bin/quickses --quiet Tests/Data~/1CRN.pdb -o .build/cpu/1crn.ply
  /usr/lib/wine/wine64 ".build/$windows/bin/quickses.exe" --quiet Tests/Data~/1CRN.pdb -o ".build/$windows/1crn.ply"
  cmp .build/cpu/1crn.ply ".build/$windows/1crn.ply"
fi

# The package with all that was asked for; with --with-cuda --with-windows it is the one that is released.
say "package: make and check"
mkdir -p .build/package
rm -f .build/package/org.quickses.unity-*.tgz{,.sha256}
if [ "$with_windows" = yes ]; then
  package_options=()
  if [ "${presets[-1]}" != cuda ]; then package_options=(--cpu-only); fi
  bash Scripts~/package.sh "${package_options[@]}"
else
  cmake --build --preset "${presets[-1]}" --target plugin
  python3 -B Scripts~/package/make-package .build/package
  python3 -B Scripts~/package/check-package .build/package/org.quickses.unity-*.tgz --platform linux-x86_64
fi

# What it takes to make these systems may be missing here, which is then said.
say "package: where nothing is installed"
bare_systems=(bookworm)
if [ "$with_windows" = yes ]; then bare_systems+=(wine); fi
for system in "${bare_systems[@]}"; do
  bash Scripts~/package/load-in-bare-system .build/package/org.quickses.unity-*.tgz "$system" || [ $? -eq 77 ]
done

# The C# layers, with the plug-in of that package: what Unity compiles runs against a double of the engine, as in a player
# and, with collections checks, as in the Editor.
say "dotnet: test"
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
for_each_dotnet_test() {
  for checks in false true; do
    for tests in Core Engine Unity Editor Manual; do
      # What these compile knows nothing of the engine.
      if [ "$tests" = Core ] && [ "$checks" = true ]; then continue; fi
      "$@" "Tests/DotNet~/$tests.Tests" -p:CollectionsChecks="$checks" || return
    done
  done
}
if [ -z "$(dotnet --list-sdks 2>/dev/null)" ]; then
  echo "No .NET SDK here (command dotnet): the C# tests are skipped."
elif ! for_each_dotnet_test dotnet restore; then
  echo "The NuGet packages of the C# tests could not be had (is there a network?)." >&2
  if [ "${CI:-}" = true ]; then exit 1; fi
  echo "The C# tests are skipped."
else
  export QUICKSES_NATIVE="$PWD/UnityPackage/Plugins/linux-x86_64/libquickses.so"
  # A test that hangs ends the run, which then says which one it was.
  for_each_dotnet_test dotnet test --no-restore --blame-hang-timeout 10m --blame-hang-dump-type none \
    --results-directory .build/dotnet
  # The runtime that Unity has is a Mono, with another collector; IL2CPP compiles everything beforehand.
  say "mono: test"
  has_mono() {
    local needed
    for needed in mono-sgen mono-boehm as ld /usr/lib/mono/4.5/Facades/netstandard.dll; do
      command -v "$needed" >/dev/null || [ -e "$needed" ] || return
    done
  }
  if ! has_mono; then
    echo "No Mono here (Debian's packages mono-devel and mono-runtime-boehm)." >&2
    if [ "${CI:-}" = true ]; then exit 1; fi
    echo "The C# tests on Mono are skipped."
  elif ! bash Tests/DotNet~/Mono/run-tests --restore; then
    echo "The NuGet packages of the C# tests on Mono could not be had (is there a network?)." >&2
    if [ "${CI:-}" = true ]; then exit 1; fi
    echo "The C# tests on Mono are skipped."
  else
    bash Tests/DotNet~/Mono/run-tests
  fi
fi
