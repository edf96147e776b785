# SPDX-License-Identifier: BSD-3-Clause
# find_package(grouser): target grouser::grouser, and one target per room (grouser::multibody, grouser::terrain...).
@PACKAGE_INIT@
include(CMakeFindDependencyMacro)
enable_language(C)
find_dependency(OpenMP)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(MPI COMPONENTS C)
find_dependency(assimp)
find_dependency(CLI11)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
@GROUSER_CONFIG_CUDA@
include(${CMAKE_CURRENT_LIST_DIR}/grouser_targets.cmake)
check_required_components(grouser)
