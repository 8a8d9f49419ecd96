#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a Windows program by Wine, with a file in the system folder as nvcuda.dll, or without one if there is no such file.
#   with_fake_driver.sh FOLDER-FOR-WINE NVCUDA.DLL WINE COMMAND [ARGUMENT...]
set -eu
export WINEPREFIX="$1" WINEDEBUG=-all
driver="$2"
wine="$3"
shift 3
server="$(dirname "$wine")/wineserver"
[ -x "$server" ] || server=wineserver
mkdir -p "$WINEPREFIX"
# Wine's services keep the output of the program that starts them open: it must be none that CTest waits for.
"$server" -p </dev/null >/dev/null 2>&1
trap '"$server" -k' EXIT
"$wine" wineboot </dev/null >/dev/null 2>&1
system="$WINEPREFIX/drive_c/windows/system32"
rm -f "$system/nvcuda.dll"
if [ -f "$driver" ]; then cp "$driver" "$system/nvcuda.dll"; fi
"$@" </dev/null
