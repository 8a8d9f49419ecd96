#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of the documentation anew with the built program (bash Scripts~/demo.sh builds it).
#   bash Scripts~/pictures.sh FOLDER
# FOLDER holds 3EAM.pdb.gz and 1AON.pdb.gz of the Protein Data Bank (https://files.rcsb.org/download/3EAM.pdb.gz and
# .../1AON.pdb.gz). Takes some minutes.
set -euo pipefail
if [ $# -ne 1 ] || [ ! -d "$1" ]; then
  sed -n '3,6s/^# //p' "$0" >&2
  exit 2
fi
data=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quickses=.build/cpu/bin/quickses
work=.build/pictures
images=Documentation~/images
mkdir -p "$work" "$images"
g++ -O3 -march=native -std=c++17 -pthread Scripts~/render/render.cpp -lz -o "$work/render"

"$quickses" Tests/Data~/1CRN.pdb -o "$work/1CRN.ply" --quiet
"$quickses" "$data/3EAM.pdb.gz" -o "$work/3EAM.ply" --quiet
"$quickses" "$data/1AON.pdb.gz" -o "$work/1AON.ply" --quiet

"$work/render" "$work/1CRN.ply" Tests/Data~/1CRN.pdb "$images/1crn.png" --color element --size 640x520
"$work/render" "$work/1CRN.ply" Tests/Data~/1CRN.pdb "$images/1crn-triangles.png" --color element --edges --size 640x400 --zoom 2.6
"$work/render" "$work/3EAM.ply" "$data/3EAM.pdb.gz" "$images/3eam.png" --color chain \
  --up -0.4541,0,-0.8909 --turn 10,10 --size 480x640
"$work/render" "$work/1AON.ply" "$data/1AON.pdb.gz" "$images/1aon.png" --color chain --run 7 \
  --up 0,0,-1 --turn 0,12 --size 540x640
ls -l "$images"
