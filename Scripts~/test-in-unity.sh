#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the package's tests in an Editor of Unity:   bash Scripts~/test-in-unity.sh EDITOR   (--help tells the rest)
set -euo pipefail
# On Windows Python may be any of these, and python3 a program that only leads to a shop.
for python in python3 python "py -3"; do
  if $python -c 'import sys; sys.exit(sys.version_info < (3, 7))' >/dev/null 2>&1; then
    exec $python -B "$(dirname "${BASH_SOURCE[0]}")/package/test-in-unity" "$@"
  fi
done
echo "test-in-unity.sh: there is no Python 3 (tried: python3, python, py -3)" >&2
exit 2
