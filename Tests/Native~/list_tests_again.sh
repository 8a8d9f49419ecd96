#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a program as it is told to. Where that is to list its tests, and it does not start, as Wine fails to at times on a busy
# machine, or does not end, it is tried twice more: else a whole build would fail.
#   list_tests_again.sh COMMAND [ARGUMENT...]
case " $* " in
  *" --gtest_list_tests "*)
    for seconds in 1 10; do
      if listed=$(timeout 90 "$@"); then
        printf '%s\n' "$listed"
        exit
      fi
      sleep "$seconds"
    done
    ;;
esac
exec "$@"
