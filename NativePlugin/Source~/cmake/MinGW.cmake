# SPDX-License-Identifier: MIT
# Toolchain: Windows programs of x86-64 by MinGW-w64 (Debian: g++-mingw-w64-x86-64-posix), run by Wine where a test needs to.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)

set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
find_program(QUICKSES_WINE NAMES wine64 wine PATHS /usr/lib/wine DOC "Runs Windows programs")
if(QUICKSES_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR "${QUICKSES_WINE}")
  # At addresses that are not random: Wine 8 needs 0x7ffe0000, where Linux may put the heap of its loader. One program of some
  # ten thousand would end at once, with 1 ("failed to map the shared user data"). Not every container allows it.
  execute_process(COMMAND setarch --addr-no-randomize true RESULT_VARIABLE _refused OUTPUT_QUIET ERROR_QUIET)
  if(NOT _refused)
    list(PREPEND CMAKE_CROSSCOMPILING_EMULATOR setarch --addr-no-randomize)
  endif()
endif()

set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# Everything goes into the one file, and the same sources give the same file.
foreach(_kind IN ITEMS EXE SHARED MODULE)
  set(CMAKE_${_kind}_LINKER_FLAGS_INIT "-static -Wl,--no-insert-timestamp")
endforeach()
