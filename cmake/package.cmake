# SPDX-License-Identifier: BSD-3-Clause
# `cpack -G DEB`: grouser, and grouser-dev with headers and libraries. With CUDA: grouser-cuda and grouser-cuda-dev,
# which replace the packages without CUDA.

# Maintainer, as in Debian's tools: DEBFULLNAME and DEBEMAIL, else the git user.
set(name "$ENV{DEBFULLNAME}")
set(mail "$ENV{DEBEMAIL}")
foreach(part name mail)
  string(REPLACE "mail" "email" key "user.${part}")
  if("${${part}}" STREQUAL "")
    execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} config ${key}
      OUTPUT_VARIABLE ${part} OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE ignored)
  endif()
endforeach()
if(name STREQUAL "" OR mail STREQUAL "")
  # A reserved invalid address (RFC 2606).
  set(name "unknown maintainer (set DEBFULLNAME and DEBEMAIL)")
  set(mail "nobody@grouser.invalid")
endif()
set(CPACK_PACKAGE_CONTACT "${name} <${mail}>")

set(CPACK_PACKAGE_NAME grouser)
set(CPACK_PACKAGE_VENDOR "grouser")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "tracked vehicles on granular terrain")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(suffix "")
set(backend "This build runs on the CPU, on one or several hosts with MPI.")
if(GROUSER_CUDA)
  set(suffix "-cuda")
  set(backend "This build runs on NVIDIA GPUs, or on the CPU if there is none, on one or\nseveral hosts with MPI.")
endif()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME grouser${suffix})
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME grouser${suffix}-dev)
if(GROUSER_CUDA)
  foreach(relation PROVIDES CONFLICTS REPLACES)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_${relation} grouser)
    set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_${relation} grouser-dev)
  endforeach()
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "grouser simulates tracked vehicles on granular terrain: discrete elements
coupled with multibody dynamics. Results have the same bits on CPU and GPU and
for any number of processes; it quantifies their error and run time.
${backend}")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, static libraries and the CMake package of grouser, a simulation of
tracked vehicles on granular terrain, to build other programs:
find_package(grouser), grouser::grouser.")

# Plots, reports, films and MPI require the recommended packages; the program names missing packages.
# The extension module is for one version of Python 3, so the dependencies are those that dh_python3 would write.
set(python "python3 (>= 3.11)")
if(GROUSER_PYTHON_MODULE_VERSION MATCHES "^3\\.([0-9]+)$")
  math(EXPR next "${CMAKE_MATCH_1} + 1")
  set(python "python3 (>= ${GROUSER_PYTHON_MODULE_VERSION}~), python3 (<< 3.${next})")
endif()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${python}, python3-numpy, python3-h5py")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
  "python3-matplotlib, openmpi-bin, libjs-three, libjs-dygraphs")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "ffmpeg, bash-completion, paraview, grouser${suffix}-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Assets and plots are in the program's package.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "grouser${suffix} (= ${PROJECT_VERSION}), g++, libassimp-dev, \
libcli11-dev, libeigen3-dev, libfmt-dev, libhdf5-openmpi-dev, libopenmpi-dev, libpng-dev, libstb-dev, \
libtomlplusplus-dev, nlohmann-json3-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake, pkg-config")

# Permissions of files as required by Debian policy, whatever the umask; no Python bytecode.
set(debian ${PROJECT_SOURCE_DIR}/cmake/debian)
foreach(script postinst prerm)
  configure_file(${debian}/${script} debian/${script} @ONLY)
endforeach()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_BINARY_DIR}/debian/postinst;${CMAKE_CURRENT_BINARY_DIR}/debian/prerm")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${debian}/finish.cmake)
set(CPACK_GROUSER_SUFFIX "${suffix}")
set(CPACK_GROUSER_ARCHITECTURE ${CMAKE_CXX_LIBRARY_ARCHITECTURE})
set(CPACK_GROUSER_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
include(CPack)
