#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the package's tests in an Editor of Unity:   bash Scripts~/test-in-unity.sh EDITOR   (--help tells the rest)
set -euo pipefail
python=python3
command -v python3 >/dev/null || python=python # Windows
exec "$python" -B "$(dirname "${BASH_SOURCE[0]}")/package/test-in-unity" "$@"
