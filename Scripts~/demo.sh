#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds the quickses program for the CPU, computes the surface of crambin (PDB entry 1CRN), draws
# it, and says what it made and where.
#   bash Scripts~/demo.sh
# Results are left in .build/demo, the program in .build/cpu/bin.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for argument in "$@"; do
  case "$argument" in
    -h | --help) sed -n '3,6s/^# //p' Scripts~/demo.sh; exit 0 ;;
    *) echo "demo.sh: unknown option $argument (there is none but --help)" >&2; exit 2 ;;
  esac
done

bash Scripts~/setup.sh
mkdir -p .build/demo
if ! cmake --preset cpu >.build/demo/configure.log 2>&1; then
  cat .build/demo/configure.log
  exit 1
fi
cmake --build --preset cpu --parallel "$(nproc)" --target quickses_cli

program=.build/cpu/bin/quickses
input=Tests/Data~/1CRN.pdb
"$program" "$input" -o .build/demo/1crn.obj --json .build/demo/1crn.json --quiet
"$program" "$input" -o .build/demo/1crn.ply --quiet
"$program" "$input" -o .build/demo/1crn.png --color residue --quiet
page=.build/demo/1crn.html
rm -f "$page"
"$program" "$input" -o "$page" --color residue --quiet || page= # it says why: pages need libjs-three

python3 - "$input" .build/demo/1crn.json <<'PYTHON'
import json, sys
report = json.load(open(sys.argv[2]))
mesh, settings = report["mesh"], report["settings"]
print(f"\nSolvent-excluded surface of crambin ({sys.argv[1]}, {report['atoms']} atoms), back end {report['backend']}:")
print(f"  {mesh['vertices']} vertices, {mesh['triangles']} triangles, computed in {report['time_ms']['compute']:.1f} ms")
print(f"  area {report['area']:.1f} Å², volume {report['volume']:.1f} Å³")
PYTHON
for file in .build/demo/1crn.obj .build/demo/1crn.ply; do
  echo "  $PWD/$file ($(du -h "$file" | cut -f1))"
done
echo "Open either file with a mesh viewer such as MeshLab or Blender."
echo "  $PWD/.build/demo/1crn.png: a picture of it"
if [ -n "$page" ]; then echo "  $PWD/$page: a page to turn it in a browser"; fi
echo "The program: $PWD/$program --help"
