#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the missing packages that grouser requires, with apt-get. Sourced by runs/quickstart, tests/run, tests/lint.

# docs/install.md lists all packages, cmake/package.cmake those required at run time; tests/python/docs_test.py compares.

GROUSER_BUILD=(
  g++ cmake ninja-build pkg-config git ca-certificates python3
  libeigen3-dev libassimp-dev libstb-dev libpng-dev libhdf5-openmpi-dev libopenmpi-dev libthrust-dev
  libcli11-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev pybind11-dev python3-dev fonts-dejavu-core)
GROUSER_RUN=(
  python3 python3-numpy python3-h5py python3-matplotlib openmpi-bin libjs-three libjs-dygraphs)
GROUSER_TESTS=(libgtest-dev clang-format-14)
# Without these packages, tests of pages in a browser and of the web site are skipped.
GROUSER_PAGES=(chromium-headless-shell mkdocs)

is_installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }

# install_packages PACKAGE...: installs these, and the packages to build and run grouser. Debian 12 has packages of clang 14;
# other releases have other versions, and their default version is installed instead.
install_packages() {
  local missing=() package k
  for package in "${GROUSER_BUILD[@]}" "${GROUSER_RUN[@]}" libgtest-dev "$@"; do
    is_installed "$package" || is_installed "${package/-14/}" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "installing: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "packages are missing, and sudo is not available to install them; install as root: ${missing[*]}" >&2; return 1; }
    sudo=(sudo)
  fi
  "${sudo[@]}" apt-get update -qq
  for k in "${!missing[@]}"; do
    apt-cache show "${missing[k]}" >/dev/null 2>&1 || missing[k]=${missing[k]/-14/}
  done
  DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# configure_and_build FOLDER TARGET...: builds the targets, with CUDA if the toolkit and a GPU are present. CONFIGURE:
# additional options of cmake.
CONFIGURE=()
configure_and_build() {
  local folder=$1 preset=cpu
  shift
  local nvcc
  nvcc=$(command -v nvcc || { [ -x /usr/local/cuda/bin/nvcc ] && echo /usr/local/cuda/bin/nvcc; } || true)
  if [ -n "$nvcc" ] && command -v nvidia-smi >/dev/null && nvidia-smi -L 2>/dev/null | grep -q GPU; then preset=cuda; fi
  local launcher=()
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  local log=$folder/configure.log
  mkdir -p "$folder"
  cmake --preset "$preset" -B "$folder" "${launcher[@]}" "${CONFIGURE[@]}" >"$log" 2>&1 || { tail -n 20 "$log" >&2; return 1; }
  cmake --build "$folder" --target "$@"
}
