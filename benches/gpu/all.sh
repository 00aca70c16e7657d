#!/usr/bin/env bash
# Everything that a machine with a card of NVIDIA can tell, by one command: benches/gpu/all.sh [FOLDER].
# First it writes the kernels and what the processor computes into FOLDER (target/gpu), then it runs them. What needs more
# than the driver and Python's standard library is skipped with one line, where it is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder="${1:-target/gpu}"
skip() { printf '\n== skipped: %s\n' "$*"; }

cargo run --release --quiet -p rne-emit --example gpu_folder -- "$folder"
printf '\n== kernels and rollouts: numbers, then times\n'
RNE_GPU_SECONDS="${RNE_GPU_SECONDS:-300}" python3 "$folder/run.py" | grep -v '^JSON '

# MPPI: the package of Python with PyTorch
if python3 -c 'import torch, rne' 2>/dev/null; then
    printf '\n== MPPI\n'
    python3 benches/gpu/mppi.py
else
    skip "MPPI (pip install torch ./doors/python)"
fi

# GRiD: CUDA's toolkit, and GRiD with its parts, whose addresses are those of git over ssh
if command -v nvcc >/dev/null; then
    grid="$folder/GRiD"
    if [ ! -d "$grid" ]; then
        git -c url.https://github.com/.insteadOf=git@github.com: clone --quiet --recurse-submodules \
            https://github.com/robot-acceleration/GRiD "$grid"
        python3 -m pip install --quiet -r "$grid/requirements.txt"
    fi
    cargo run --release --quiet -p rne-cli -- export panda --urdf -o "$PWD/$grid/panda.urdf" --force
    printf '\n== GRiD\n'
    (cd "$grid" && python3 generateGRiD.py panda.urdf && nvcc -std=c++17 -O3 -arch=native -I. -o grid.exe "$OLDPWD/benches/gpu/grid.cu" && ./grid.exe)
else
    skip "GRiD (there is no nvcc)"
fi
