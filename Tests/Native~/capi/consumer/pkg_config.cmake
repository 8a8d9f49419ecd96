# SPDX-License-Identifier: MIT
# Compiles consumer.c by hand with what pkg-config says, and runs it.
set(ENV{PKG_CONFIG_PATH} "${PREFIX}/${LIBDIR}/pkgconfig")
execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs quickses RESULT_VARIABLE _result OUTPUT_VARIABLE _flags
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT _result EQUAL 0)
  message(FATAL_ERROR "pkg-config does not know quickses")
endif()
separate_arguments(_flags UNIX_COMMAND "${_flags}")
file(MAKE_DIRECTORY "${OUT}")
execute_process(COMMAND "${CC}" -std=c99 "${SOURCE}" -o "${OUT}/consumer" ${_flags} RESULT_VARIABLE _result)
if(NOT _result EQUAL 0)
  message(FATAL_ERROR "consumer.c did not compile with: ${_flags}")
endif()
set(ENV{LD_LIBRARY_PATH} "${PREFIX}/${LIBDIR}:$ENV{LD_LIBRARY_PATH}")
execute_process(COMMAND "${OUT}/consumer" RESULT_VARIABLE _result)
if(NOT _result EQUAL 0)
  message(FATAL_ERROR "The consumer failed: ${_result}")
endif()
