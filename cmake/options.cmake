# SPDX-License-Identifier: BSD-3-Clause
# Compiler flags for bitwise equal results on all machines and backends, warnings, and two helper functions for rooms.

option(GROUSER_WERROR "Treat warnings as errors (for developers)" OFF)

add_library(grouser_flags INTERFACE)
# Programs of users also need C++20; all other options are for the code of grouser alone.
target_compile_features(grouser_flags INTERFACE cxx_std_20)
target_include_directories(grouser_flags INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
# For bitwise equal results: no implicit fused multiply-add, no fast-math, no -march=native. x86-64-v2 (SSE4.2, every
# processor since 2009) has no fused multiply-add; it has an instruction for rounding.
target_compile_options(grouser_flags INTERFACE
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wshadow;-Wnon-virtual-dtor;-Wredundant-decls;-Wzero-as-null-pointer-constant;$<$<BOOL:${GROUSER_WERROR}>:-Werror>>>
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off;-march=x86-64-v2>>
  # SIMD values (base/simd.hpp) are passed only between inlined functions, so the ABI has no effect.
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>>)

# Output of `grouser --version`.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
set(GROUSER_FLAGS "${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} -ffp-contract=off -march=x86-64-v2")
if(GROUSER_SANITIZE)
  string(APPEND GROUSER_FLAGS " -fsanitize=${GROUSER_SANITIZE}")
endif()
string(REGEX REPLACE " +" " " GROUSER_FLAGS "${GROUSER_FLAGS}")

if(GROUSER_SANITIZE)
  target_compile_options(grouser_flags INTERFACE
    $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${GROUSER_SANITIZE} -fno-omit-frame-pointer>>)
  target_link_options(grouser_flags INTERFACE -fsanitize=${GROUSER_SANITIZE})
endif()

if(GROUSER_CUDA)
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 80 90)
  endif()
  if(NOT CMAKE_CUDA_COMPILER AND EXISTS /usr/local/cuda/bin/nvcc)
    set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)
  endif()
  enable_language(CUDA)
  # CMake 3.25 lacks the C++20 flag of nvcc 13.
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
  endif()
  set(CMAKE_CUDA_STANDARD 20)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  find_package(CUDAToolkit REQUIRED)
  target_compile_definitions(grouser_flags INTERFACE GROUSER_CUDA=1)
  target_link_libraries(grouser_flags INTERFACE CUDA::cudart_static)
  set(fatal)
  if(GROUSER_WERROR)
    set(fatal -Werror all-warnings)
  endif()
  target_compile_options(grouser_flags INTERFACE
    $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CUDA>:--fmad=false ${fatal} -Xcompiler=-Wall,-Wextra,-ffp-contract=off,-march=x86-64-v2,-fopenmp>>)
endif()

# grouser_room(NAME SOURCES... ): a static library grouser_NAME. *.cu files are CUDA if enabled, else plain C++.
function(grouser_room name)
  add_library(grouser_${name} STATIC ${ARGN})
  # A program of a user only links OpenMP; the option -fopenmp would activate the user's own directives.
  target_link_libraries(grouser_${name} PUBLIC grouser_flags $<BUILD_INTERFACE:OpenMP::OpenMP_CXX>
    $<INSTALL_INTERFACE:$<LINK_ONLY:OpenMP::OpenMP_CXX>>)
  grouser_cu_as_cxx(${ARGN})
endfunction()

function(grouser_cu_as_cxx)
  if(GROUSER_CUDA)
    return()
  endif()
  foreach(source ${ARGN})
    if(source MATCHES "\\.cu$")
      set_source_files_properties(${source} PROPERTIES LANGUAGE CXX COMPILE_OPTIONS "-xc++")
    endif()
  endforeach()
endfunction()
