# SPDX-License-Identifier: MIT
# CUDA, for Linux and Windows alike: Clang compiles the .cu files, device and host side, with the toolkit's headers,
# libdevice, ptxas and fatbinary; cudart/ takes the place of NVIDIA's runtime. So MinGW-w64, which nvcc does not know,
# links them, and the same source gives the same device code on both platforms. (CMake's own CUDA language would do for
# Linux, but refuses Clang for Windows.)

if(NOT BUILD_SHARED_LIBS)
  message(FATAL_ERROR "QUICKSES_CUDA takes BUILD_SHARED_LIBS=ON: the functions of cudart/ have the names of those of NVIDIA's "
    "runtime, and only a shared library keeps them to itself.")
endif()

find_path(QUICKSES_CUDA_PATH nvvm/libdevice/libdevice.10.bc
  HINTS ENV CUDA_PATH ENV CUDA_HOME ${CUDAToolkit_ROOT} PATHS /usr/lib/cuda /usr/local/cuda /opt/cuda
  NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH DOC "The CUDA Toolkit")
find_path(QUICKSES_CUDA_HEADERS cuda_runtime.h HINTS "${QUICKSES_CUDA_PATH}/include" PATHS /usr/include
  NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH DOC "The CUDA Toolkit's headers") # Debian's are not below its folder
set(_version 0)
if(QUICKSES_CUDA_HEADERS)
  file(STRINGS "${QUICKSES_CUDA_HEADERS}/cuda.h" _version REGEX "#define CUDA_VERSION +[0-9]+")
  string(REGEX MATCH "[0-9]+$" _version "${_version}")
endif()
# Toolkits from 13.0 on lack a header and an option that earlier Clangs ask them for (LLVM's changes 151760 and 151766).
set(_least_clang 18)
set(_clangs clang++-19 clang++-20 clang++-21 clang++-18 clang++-22)
if(_version GREATER_EQUAL 13000)
  set(_least_clang 22)
  set(_clangs clang++-22 clang++-23 clang++-24)
endif()
find_program(QUICKSES_CLANG NAMES ${_clangs} clang++ DOC "The Clang that compiles CUDA, 18 or later; with CUDA 13, 22 or later")
mark_as_advanced(QUICKSES_CLANG QUICKSES_CUDA_PATH QUICKSES_CUDA_HEADERS)
if(NOT QUICKSES_CLANG OR NOT QUICKSES_CUDA_PATH OR NOT QUICKSES_CUDA_HEADERS)
  message(FATAL_ERROR "QUICKSES_CUDA is ON, which takes the CUDA Toolkit 11.8 or later (found: ${QUICKSES_CUDA_PATH}) and Clang "
    "${_least_clang} or later (found: ${QUICKSES_CLANG}). On Debian, bash Scripts~/setup.sh --with-cuda installs both; "
    "elsewhere set QUICKSES_CLANG and QUICKSES_CUDA_PATH.")
endif()
if(_version LESS 11080)
  message(FATAL_ERROR "The CUDA Toolkit in ${QUICKSES_CUDA_PATH} is too old (CUDA_VERSION ${_version}): 11.8 or later is needed.")
endif()
execute_process(COMMAND "${QUICKSES_CLANG}" -dumpversion OUTPUT_VARIABLE _clang OUTPUT_STRIP_TRAILING_WHITESPACE)
if(_clang VERSION_LESS _least_clang)
  message(FATAL_ERROR "${QUICKSES_CLANG} is Clang ${_clang}: ${_least_clang} or later is needed to compile with the CUDA Toolkit in "
    "${QUICKSES_CUDA_PATH} (CUDA_VERSION ${_version}).")
endif()
message(STATUS "CUDA: toolkit ${QUICKSES_CUDA_PATH} (${_version}), Clang ${_clang}, architectures ${QUICKSES_CUDA_ARCHITECTURES}")

# Before those of another toolkit; but /usr/include last, whose other headers are not for Windows.
set(QUICKSES_CUDA_INCLUDE -isystem "${QUICKSES_CUDA_HEADERS}")
if(QUICKSES_CUDA_HEADERS STREQUAL "/usr/include")
  set(QUICKSES_CUDA_INCLUDE -idirafter "${QUICKSES_CUDA_HEADERS}")
endif()

set(_flags "--cuda-path=${QUICKSES_CUDA_PATH}" --no-cuda-include-ptx=all)
foreach(_architecture IN LISTS QUICKSES_CUDA_ARCHITECTURES)
  string(REGEX MATCH "^[0-9]+" _number "${_architecture}")
  list(APPEND _flags --offload-arch=sm_${_number})
  if(_architecture STREQUAL _number)
    list(APPEND _flags --cuda-include-ptx=sm_${_number})
  endif()
endforeach()
string(TOUPPER "${CMAKE_BUILD_TYPE}" _config) # empty for generators of several configurations
separate_arguments(_config UNIX_COMMAND "${CMAKE_CXX_FLAGS_${_config}}")
list(APPEND _flags -Xcuda-fatbinary --compress-all -std=c++17 -O3 ${_config}
  # On the device a*b+c is one operation where an expression says so, whatever the optimizer sees beyond it: so all
  # versions of Clang give the same bytes, and functions can be taken apart. On the host nothing is contracted (see
  # QuicksesTargets.cmake).
  -Xarch_device -ffp-contract=on -Xarch_host -ffp-contract=off -fvisibility=hidden -UTHRUST_DEVICE_SYSTEM
  # Kernels in headers are for one source each; masks of the CPU's vectors, which are bool here, have no && and ||.
  -Wall -Wextra -Wno-unneeded-internal-declaration -Wno-bitwise-instead-of-logical -Wno-pass-failed "$<$<BOOL:${QUICKSES_WERROR}>:-Werror>"
  --system-header-prefix=cub/ --system-header-prefix=thrust/ --system-header-prefix=glm/)
if(MINGW)
  list(APPEND _flags --target=x86_64-w64-windows-gnu "-I${CMAKE_CURRENT_LIST_DIR}/mingw_cuda"
    -Wno-ignored-attributes) # dllexport means nothing on the device
  # Clang and GCC pad the names of types differently, of which the linker warns for each object, by the hundred.
  add_link_options(-Wl,--no-warnings)
else()
  list(APPEND _flags -fPIC)
endif()
set(QUICKSES_CUDA_FLAGS ${_flags} ${QUICKSES_CUDA_INCLUDE})

# quickses_compile_cuda(<variable> <target> <source.cu>...): objects of the sources, compiled with the target's
# definitions and include folders.
function(quickses_compile_cuda out target)
  set(_objects "")
  foreach(_source IN LISTS ARGN)
    get_filename_component(_source "${_source}" ABSOLUTE)
    get_filename_component(_name "${_source}" NAME)
    set(_object "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/${_name}${CMAKE_CXX_OUTPUT_EXTENSION}")
    add_custom_command(OUTPUT "${_object}" DEPFILE "${_object}.d" DEPENDS "${_source}" "${QUICKSES_CLANG}"
      COMMAND "${QUICKSES_CLANG}" -x cuda "-I$<JOIN:$<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>,;-I>"
        "-D$<JOIN:$<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>,;-D>" ${QUICKSES_CUDA_FLAGS}
        -MD -MF "${_object}.d" -MT "${_object}" -c "${_source}" -o "${_object}"
      COMMAND_EXPAND_LISTS VERBATIM COMMENT "Compiling ${_name}")
    list(APPEND _objects "${_object}")
  endforeach()
  set(${out} "${_objects}" PARENT_SCOPE)
endfunction()
