#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs with apt-get what grouser needs and the machine lacks. Sourced by runs/quickstart, tests/run and tests/lint.

GROUSER_PACKAGES=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libeigen3-dev libassimp-dev libstb-dev libpng-dev libhdf5-openmpi-dev libopenmpi-dev openmpi-bin libthrust-dev
  libcli11-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev libgtest-dev
  fonts-dejavu-core python3 python3-h5py python3-numpy python3-matplotlib libjs-three libjs-dygraphs)

install_packages() {
  local missing=() package
  for package in "${GROUSER_PACKAGES[@]}" "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "installing: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "these packages are missing, and there is no sudo to install them: ${missing[*]}" >&2; return 1; }
    sudo=(sudo)
  fi
  "${sudo[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# configure_and_build FOLDER TARGET...: with CUDA where the toolkit and a GPU are there, without elsewhere.
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
  cmake --preset "$preset" -B "$folder" "${launcher[@]}" >"$log" 2>&1 || { tail -n 20 "$log" >&2; return 1; }
  cmake --build "$folder" --target "$@"
}
