#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of the documentation anew with the built program (bash Scripts~/demo.sh builds it).
#   bash Scripts~/pictures.sh FOLDER
# FOLDER holds 3EAM.pdb.gz and 1AON.pdb.gz of the Protein Data Bank (https://files.rcsb.org/download/3EAM.pdb.gz and
# .../1AON.pdb.gz). Takes a minute. Needs pngquant and optipng, which make the files small.
set -euo pipefail
if [ "${1:-}" = -h ] || [ "${1:-}" = --help ]; then sed -n '3,6s/^# //p' "$0"; exit 0; fi
if [ $# -ne 1 ] || [ ! -d "$1" ]; then
  sed -n '3,6s/^# //p' "$0" >&2
  exit 2
fi
data=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."

images=Documentation~/images
draw() { # INPUT NAME FLAG...
  .build/cpu/bin/quickses "$1" -o "$images/$2" --quiet --background transparent "${@:3}"
  # 256 colours: half as large, and nobody sees it.
  pngquant --speed 1 --quality 70-95 --strip --force --output "$images/$2" "$images/$2"
  optipng -quiet -o5 "$images/$2"
}

draw Tests/Data~/1CRN.pdb 1crn.png --color residue --size 640x520
draw Tests/Data~/1CRN.pdb 1crn-triangles.png --color residue --edges --size 640x400 --zoom 2.6
draw "$data/3EAM.pdb.gz" 3eam.png --up -0.4541,0,-0.8909 --turn 10,10 --size 480x640
draw "$data/1AON.pdb.gz" 1aon.png --view x --up z --turn 0,12 --size 540x640
ls -l "$images"
