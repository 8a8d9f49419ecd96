# SPDX-License-Identifier: MIT
# Compiler options that every target of the project shares.

add_library(quickses_options INTERFACE)
target_compile_features(quickses_options INTERFACE cxx_std_17)

if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(quickses_options INTERFACE
    -Wall -Wextra "$<$<BOOL:${QUICKSES_WERROR}>:-Werror>")
endif()

if(WIN32)
  target_compile_definitions(quickses_options INTERFACE NOMINMAX) # no windows.h defines min and max
endif()

if(QUICKSES_SANITIZE)
  set(_sanitize "-fsanitize=${QUICKSES_SANITIZE};-fno-omit-frame-pointer")
  if(QUICKSES_SANITIZE MATCHES "undefined")
    # Thrust 1.17 binds references to null on purpose; what reads through one still ends in the address sanitizer.
    # What Tests/Native~/ubsan.supp names can be passed over only if it is not fatal at once; the tests make it so.
    list(APPEND _sanitize -fno-sanitize-recover=undefined -fsanitize-recover=shift-base -fno-sanitize=null)
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      # It tells of those references by other checks, too, and of numbers added to null: CountingExecutor counts so.
      list(APPEND _sanitize -fno-sanitize=object-size,pointer-overflow)
    endif()
  endif()
  target_compile_options(quickses_options INTERFACE "$<$<COMPILE_LANGUAGE:C,CXX>:${_sanitize}>")
  target_link_options(quickses_options INTERFACE "-fsanitize=${QUICKSES_SANITIZE}")
endif()

# The same source gives the same bits on every compiler: a*b+c is not contracted behind our back.
# (The CPU kernels, which ask for it, are given their own options instead of these.)
set(QUICKSES_EXACT_OPTIONS "")
set(QUICKSES_KERNEL_OPTIONS "")
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(QUICKSES_EXACT_OPTIONS
    "$<$<COMPILE_LANGUAGE:C,CXX>:-ffp-contract=off>")
  set(QUICKSES_KERNEL_OPTIONS
    "$<$<NOT:$<CONFIG:Debug>>:-O3>" -fno-math-errno -fno-trapping-math -ffp-contract=fast)
endif()
